#define _GNU_SOURCE
#include "clump_table.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/file.h"
#include "clump_report.h"

static dem_status cannot_write(const clump_table *table, dem_error *error)
{
    return dem_fail_at(error, DEM_CANNOT_WRITE, table->path, 0,
                       "cannot write the table: %s; choose another place with -o", strerror(errno));
}

static dem_status put(clump_table *table, dem_buffer *text, dem_error *error)
{
    bool fine = !text->failed;
    if (fine)
        fine = fwrite(text->data, 1, text->size, table->file) == text->size && fflush(table->file) == 0;
    dem_buffer_release(text);
    return fine ? DEM_OK : cannot_write(table, error);
}

// keeps the rows of an earlier run, if they have the same columns; else none
static void load_old(clump_table *table, const char *path, const char *header)
{
    dem_buffer text;
    dem_error ignored;
    if (access(path, R_OK) != 0 || dem_file_read(path, &text, &ignored) != DEM_OK)
        return;
    size_t length = strlen(header);
    if (text.size > length && memcmp(text.data, header, length) == 0) {
        table->old_at = table->old = text.data;
        return;
    }
    dem_buffer_release(&text);
}

static dem_status open_part(clump_table *table, dem_error *error)
{
    struct stat about;
    if (strcmp(table->path, "-") == 0) {
        table->file = stdout;
        return DEM_OK;
    }
    if (stat(table->path, &about) == 0 && !S_ISREG(about.st_mode)) {
        table->file = fopen(table->path, "w");
        return table->file ? DEM_OK : cannot_write(table, error);
    }
    if (asprintf(&table->part, "%s.part", table->path) < 0) {
        table->part = NULL;
        return dem_fail_memory(error);
    }
    table->file = fopen(table->part, "w");
    return table->file ? DEM_OK : cannot_write(table, error);
}

dem_status clump_table_open(clump_table *table, const char *path, bool labels, bool resume, dem_error *error)
{
    *table = (clump_table){.path = path, .labels = labels};
    if (!path)
        return DEM_OK;
    dem_buffer header = {0};
    char *part = NULL;
    report_csv_header(&header, labels);
    if (resume && header.data && asprintf(&part, "%s.part", path) >= 0) {
        // what a killed run left behind is the newer one
        load_old(table, part, header.data);
        if (!table->old)
            load_old(table, path, header.data);
        free(part);
    }
    dem_status status = open_part(table, error);
    if (status == DEM_OK)
        status = put(table, &header, error);
    dem_buffer_release(&header);
    if (status != DEM_OK) {
        dem_error ignored;
        clump_table_close(table, &ignored);
    }
    return status;
}

// the row of a grain that was done, from where the last one was found on and once around; length with its newline
static const char *old_row(clump_table *table, const job_result *result, size_t *length)
{
    dem_buffer start = {0};
    report_csv_start(&start, result, "done");
    const char *found = NULL, *begin = table->old_at, *at = begin;
    while (start.data && at && !found) {
        const char *end = strchr(at, '\n');
        if (end && strncmp(at, start.data, start.size) == 0) {
            found = at;
            *length = (size_t)(end + 1 - at);
        }
        at = end && end[1] ? end + 1 : table->old;
        if (at == begin)
            break;
    }
    dem_buffer_release(&start);
    if (found)
        table->old_at = at;
    return found;
}

dem_status clump_table_add(clump_table *table, const job_result *result, dem_error *error)
{
    if (!table->file)
        return DEM_OK;
    dem_buffer row = {0};
    size_t length;
    const char *old = result->kept && table->old ? old_row(table, result, &length) : NULL;
    if (old)
        dem_buffer_bytes(&row, old, length);
    else
        report_csv_row(&row, result, table->labels);
    return put(table, &row, error);
}

dem_status clump_table_close(clump_table *table, dem_error *error)
{
    dem_status status = DEM_OK;
    if (table->file && table->file != stdout && fclose(table->file) != 0)
        status = cannot_write(table, error);
    if (table->file && table->part && status == DEM_OK && rename(table->part, table->path) != 0)
        status = cannot_write(table, error);
    free(table->part);
    free(table->old);
    *table = (clump_table){0};
    return status;
}
