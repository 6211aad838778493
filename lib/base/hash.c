#include "base/hash.h"

#include <errno.h>
#include <nettle/sha2.h>
#include <stdio.h>
#include <string.h>

static void finish(struct sha256_ctx *state, char text[65])
{
    uint8_t digest[SHA256_DIGEST_SIZE];
    sha256_digest(state, sizeof digest, digest);
    for (int i = 0; i < SHA256_DIGEST_SIZE; i++)
        snprintf(text + 2 * i, 3, "%02x", digest[i]);
}

void dem_sha256_pieces(const dem_piece *pieces, size_t count, char text[65])
{
    struct sha256_ctx state;
    sha256_init(&state);
    for (size_t i = 0; i < count; i++)
        sha256_update(&state, pieces[i].size, pieces[i].bytes);
    finish(&state, text);
}

void dem_sha256(const void *bytes, size_t size, char text[65])
{
    dem_sha256_pieces(&(dem_piece){bytes, size}, 1, text);
}

dem_status dem_sha256_file(const char *path, char text[65], dem_error *error)
{
    FILE *file = fopen(path, "rb");
    if (!file)
        return dem_fail_at(error, DEM_BAD_INPUT, path, 0, "%s", strerror(errno));
    struct sha256_ctx state;
    sha256_init(&state);
    uint8_t bytes[1 << 14];
    size_t got;
    while ((got = fread(bytes, 1, sizeof bytes, file)) > 0)
        sha256_update(&state, got, bytes);
    bool failed = ferror(file);
    fclose(file);
    if (failed)
        return dem_fail_at(error, DEM_BAD_INPUT, path, 0, "cannot be read; check the disk");
    finish(&state, text);
    return DEM_OK;
}
