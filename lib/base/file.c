#define _GNU_SOURCE
#include "base/file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

enum { READ_BYTES = 1 << 20 };

static dem_status refuse(dem_error *error, const char *path, const char *what)
{
    return dem_fail_at(error, DEM_BAD_INPUT, path, 0, "%s", what);
}

static dem_status read_all(int file, const char *path, dem_buffer *bytes, dem_error *error)
{
    struct stat about;
    if (fstat(file, &about) == 0) {
        if (S_ISDIR(about.st_mode))
            return refuse(error, path, "is a directory; name a file in it");
        if (S_ISREG(about.st_mode) && about.st_size > 0) {  // one allocation instead of growing
            bytes->data = malloc((size_t)about.st_size + 2);
            if (!bytes->data)
                return dem_fail_memory(error);
            bytes->capacity = (size_t)about.st_size + 2;
        }
    }
    for (;;) {
        if (bytes->capacity - bytes->size < 2) {
            size_t wanted = bytes->capacity * 2 + READ_BYTES;
            char *grown = realloc(bytes->data, wanted);
            if (!grown)
                return dem_fail_memory(error);
            bytes->data = grown;
            bytes->capacity = wanted;
        }
        ssize_t got = read(file, bytes->data + bytes->size, bytes->capacity - bytes->size - 1);
        if (got < 0 && errno == EINTR)
            continue;
        if (got < 0)
            return refuse(error, path, strerror(errno));
        if (got == 0)
            break;
        bytes->size += (size_t)got;
    }
    bytes->data[bytes->size] = 0;
    return bytes->size ? DEM_OK : refuse(error, path, "file is empty; nothing to read");
}

dem_status dem_file_read(const char *path, dem_buffer *bytes, dem_error *error)
{
    *bytes = (dem_buffer){0};
    if (strcmp(path, "-") == 0) {
        dem_status status = read_all(STDIN_FILENO, "standard input", bytes, error);
        if (status != DEM_OK)
            dem_buffer_release(bytes);
        return status;
    }
    int file = open(path, O_RDONLY | O_CLOEXEC);
    if (file < 0) {
        struct stat link;
        if (errno == ENOENT && lstat(path, &link) == 0)
            return refuse(error, path, "is a link to a file that does not exist; mend the link");
        if (errno == ENOENT)
            return refuse(error, path, "no such file; check the name");
        if (errno == EACCES)
            return refuse(error, path, "permission denied; make it readable (chmod +r)");
        return refuse(error, path, strerror(errno));
    }
    dem_status status = read_all(file, path, bytes, error);
    close(file);
    if (status != DEM_OK)
        dem_buffer_release(bytes);
    return status;
}

static bool write_all(int file, const char *bytes, size_t size)
{
    while (size) {
        ssize_t put = write(file, bytes, size);
        if (put < 0 && errno == EINTR)
            continue;
        if (put <= 0)
            return false;
        bytes += put;
        size -= (size_t)put;
    }
    return true;
}

static dem_status cannot_write(dem_error *error, const char *path)
{
    return dem_fail_at(error, DEM_CANNOT_WRITE, path, 0, "cannot write: %s; choose another place with -o",
                       strerror(errno));
}

// A new file in the same folder, with the rights a new file has; its name is to be freed. Below 0: none, see errno.
// mkstemp would make it unreadable for others, and the mask of rights cannot be read without being changed, for all
// threads.
static int open_beside(const char *path, char **name)
{
    enum { ATTEMPTS = 100 };
    int file = -1;
    *name = NULL;
    for (unsigned i = 0; i < ATTEMPTS && file < 0 && (i == 0 || errno == EEXIST); i++) {
        free(*name);
        if (asprintf(name, "%s.%lx-%x", path, (long)getpid(), i) < 0) {
            *name = NULL;
            errno = ENOMEM;
            return -1;
        }
        file = open(*name, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    }
    return file;
}

dem_status dem_file_begin(const char *path, dem_file_making *f, dem_error *error)
{
    struct stat about;
    *f = (dem_file_making){.path = path, .file = STDOUT_FILENO, .whole = true};
    if (strcmp(path, "-") == 0) {
        f->path = "standard output";
        return DEM_OK;
    }
    bool plain = stat(path, &about) != 0 || S_ISREG(about.st_mode);
    f->file = plain ? open_beside(path, &f->beside) : open(path, O_WRONLY | O_CLOEXEC);
    if (f->file >= 0)
        return DEM_OK;
    dem_status status = cannot_write(error, path);
    free(f->beside);
    f->beside = NULL;
    return status;
}

dem_status dem_file_put(dem_file_making *f, const dem_piece *pieces, size_t count, dem_error *error)
{
    for (size_t i = 0; i < count && f->whole; i++)
        f->whole = write_all(f->file, pieces[i].bytes, pieces[i].size);
    return f->whole ? DEM_OK : cannot_write(error, f->path);
}

dem_status dem_file_end(dem_file_making *f, dem_error *error)
{
    if (f->file == STDOUT_FILENO)
        return DEM_OK;
    dem_status status = DEM_OK;
    if (f->beside && f->whole && fsync(f->file) != 0)
        status = cannot_write(error, f->path);
    if (close(f->file) != 0 && f->whole && status == DEM_OK)
        status = cannot_write(error, f->path);
    bool good = f->whole && status == DEM_OK;
    if (f->beside && good && rename(f->beside, f->path) != 0) {
        status = cannot_write(error, f->path);
        good = false;
    }
    if (f->beside && !good)
        unlink(f->beside);
    free(f->beside);
    f->beside = NULL;
    return status;
}

dem_status dem_file_write_pieces(const char *path, const dem_piece *pieces, size_t count, dem_error *error)
{
    dem_file_making f;
    DEM_TRY(dem_file_begin(path, &f, error));
    dem_status status = dem_file_put(&f, pieces, count, error);
    dem_status ended = dem_file_end(&f, status == DEM_OK ? error : NULL);
    return status == DEM_OK ? ended : status;
}

dem_status dem_file_write(const char *path, const void *bytes, size_t size, dem_error *error)
{
    return dem_file_write_pieces(path, &(dem_piece){bytes, size}, 1, error);
}

dem_status dem_file_write_buffer(const char *path, dem_buffer *buffer, dem_error *error)
{
    dem_status status =
        buffer->failed ? dem_fail_memory(error) : dem_file_write(path, buffer->data, buffer->size, error);
    dem_buffer_release(buffer);
    return status;
}

bool dem_folder_exists(const char *path)
{
    struct stat about;
    return stat(path, &about) == 0 && S_ISDIR(about.st_mode);
}

bool dem_folder_is_meant(const char *path)
{
    size_t length = strlen(path);
    return (length && path[length - 1] == '/') || dem_folder_exists(path);
}

dem_status dem_folder_create(const char *path, dem_error *error)
{
    char *part = strdup(path);
    if (!part)
        return dem_fail_memory(error);
    bool made = true;
    for (char *slash = part; made && slash;) {
        slash = strchr(slash + 1, '/');
        if (slash)
            *slash = 0;
        made = mkdir(part, 0777) == 0 || errno == EEXIST;
        if (slash)
            *slash = '/';
    }
    free(part);
    struct stat about;
    if (made && stat(path, &about) == 0 && !S_ISDIR(about.st_mode))
        return dem_fail_at(error, DEM_CANNOT_WRITE, path, 0, "is a file, no folder; choose another place with -o");
    return made ? DEM_OK : cannot_write(error, path);
}

char *dem_path_join(const char *folder, const char *format, ...)
{
    char *name, *path;
    va_list args;
    va_start(args, format);
    int length = vasprintf(&name, format, args);
    va_end(args);
    if (length < 0)
        return NULL;
    if (asprintf(&path, "%s/%s", folder, name) < 0)
        path = NULL;
    free(name);
    return path;
}

const char *dem_file_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

bool dem_file_has_suffix(const char *path, const char *suffix)
{
    const char *dot = strrchr(dem_file_name(path), '.');
    return dot && strcasecmp(dot + 1, suffix) == 0;
}
