#include "base/file_queue.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

typedef struct item {
    struct item *next;
    char *path;
    dem_buffer buffer;
    size_t size;
} item;

struct dem_file_queue {
    pthread_t thread;
    pthread_mutex_t lock;  // of everything below
    pthread_cond_t changed;
    item *first, **last;  // the first is the one that is being written
    size_t bytes;
    bool ended;
    dem_status status;  // of the first that failed
    dem_error error;
};

static void release(item *it)
{
    if (it) {
        free(it->path);
        dem_buffer_release(&it->buffer);
    }
    free(it);
}

static void *write_all(void *user)
{
    dem_file_queue *q = user;
    pthread_mutex_lock(&q->lock);
    for (;;) {
        while (!q->first && !q->ended)
            pthread_cond_wait(&q->changed, &q->lock);
        item *it = q->first;
        if (!it)
            break;
        bool good = q->status == DEM_OK;
        pthread_mutex_unlock(&q->lock);
        dem_error error;
        dem_status status = good ? dem_file_write_buffer(it->path, &it->buffer, &error) : DEM_OK;
        pthread_mutex_lock(&q->lock);
        if (status != DEM_OK) {
            q->status = status;
            q->error = error;
        }
        q->first = it->next;
        if (!q->first)
            q->last = &q->first;
        q->bytes -= it->size;
        release(it);
        pthread_cond_broadcast(&q->changed);
    }
    pthread_mutex_unlock(&q->lock);
    return NULL;
}

dem_status dem_file_queue_create(dem_file_queue **queue, dem_error *error)
{
    dem_file_queue *q = *queue = dem_alloc_zero(1, sizeof *q);
    if (!q)
        return dem_fail_memory(error);
    q->last = &q->first;
    pthread_mutex_init(&q->lock, NULL);
    pthread_cond_init(&q->changed, NULL);
    if (pthread_create(&q->thread, NULL, write_all, q) == 0)
        return DEM_OK;
    pthread_cond_destroy(&q->changed);
    pthread_mutex_destroy(&q->lock);
    free(q);
    *queue = NULL;
    return dem_fail_memory(error);
}

// with the lock held
static dem_status outcome(const dem_file_queue *q, dem_error *error)
{
    if (q->status != DEM_OK && error)
        *error = q->error;
    return q->status;
}

dem_status dem_file_queue_put(dem_file_queue *q, const char *path, dem_buffer *buffer, dem_error *error)
{
    if (!q)
        return dem_file_write_buffer(path, buffer, error);
    item *it = dem_alloc_zero(1, sizeof *it);
    if (it)
        *it = (item){.path = strdup(path), .buffer = *buffer, .size = buffer->size};
    if (!it || !it->path || buffer->failed) {
        if (!it)
            dem_buffer_release(buffer);
        release(it);
        *buffer = (dem_buffer){0};
        return dem_fail_memory(error);
    }
    *buffer = (dem_buffer){0};
    pthread_mutex_lock(&q->lock);
    while (q->first && q->bytes + it->size > DEM_QUEUE_BYTES)
        pthread_cond_wait(&q->changed, &q->lock);
    q->bytes += it->size;
    *q->last = it;
    q->last = &it->next;
    pthread_cond_broadcast(&q->changed);
    dem_status status = outcome(q, error);
    pthread_mutex_unlock(&q->lock);
    return status;
}

dem_status dem_file_queue_wait(dem_file_queue *q, dem_error *error)
{
    if (!q)
        return DEM_OK;
    pthread_mutex_lock(&q->lock);
    while (q->first)
        pthread_cond_wait(&q->changed, &q->lock);
    dem_status status = outcome(q, error);
    pthread_mutex_unlock(&q->lock);
    return status;
}

void dem_file_queue_destroy(dem_file_queue *q)
{
    if (!q)
        return;
    pthread_mutex_lock(&q->lock);
    q->ended = true;
    pthread_cond_broadcast(&q->changed);
    pthread_mutex_unlock(&q->lock);
    pthread_join(q->thread, NULL);
    pthread_cond_destroy(&q->changed);
    pthread_mutex_destroy(&q->lock);
    free(q);
}
