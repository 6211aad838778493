#include "base/crew.h"

#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>
#include <stdlib.h>

#include "base/memory.h"

// How long a helper looks out for more before it sleeps: about as long as the caller has something to do between two
// lots, then some turns for others.
enum { SPINS = 3000, YIELDS = 100 };

// The lot at hand in one word, so that who takes a part knows which lot it is of: its number, its parts, and how many
// of them are taken.
enum { PARTS_SHIFT = 16, LOT_SHIFT = 32, FIELD = 0xffff };

struct dem_crew {
    int started;
    pthread_t *threads;
    void (*work)(void *user, int part);
    void *user;
    _Alignas(64) atomic_ullong lot;
    _Alignas(64) atomic_int done;  // parts
    atomic_int asleep;
    atomic_bool over;
    pthread_mutex_t lock;
    pthread_cond_t called;
};

static inline void breathe(void)
{
#if defined(__x86_64__)
    __builtin_ia32_pause();
#endif
}

static unsigned long long lot_number(unsigned long long lot)
{
    return lot >> LOT_SHIFT;
}

// Takes parts until none is left; returns the number of the lot. While a part is taken and not done, the lot cannot
// end, and `work` and `user` stay.
static unsigned long long take_parts(dem_crew *c)
{
    for (;;) {
        unsigned long long lot = atomic_fetch_add(&c->lot, 1);
        int part = (int)(lot & FIELD), parts = (int)(lot >> PARTS_SHIFT & FIELD);
        if (part >= parts)
            return lot_number(lot);
        c->work(c->user, part);
        atomic_fetch_add(&c->done, 1);
    }
}

static bool nothing_new(dem_crew *c, unsigned long long last)
{
    return lot_number(atomic_load(&c->lot)) == last && !atomic_load(&c->over);
}

static void wait_for_more(dem_crew *c, unsigned long long last)
{
    for (int i = 0; i < SPINS && nothing_new(c, last); i++)
        breathe();
    for (int i = 0; i < YIELDS && nothing_new(c, last); i++)
        sched_yield();
    if (!nothing_new(c, last))
        return;
    pthread_mutex_lock(&c->lock);
    atomic_fetch_add(&c->asleep, 1);
    while (nothing_new(c, last))
        pthread_cond_wait(&c->called, &c->lock);
    atomic_fetch_sub(&c->asleep, 1);
    pthread_mutex_unlock(&c->lock);
}

static void *help(void *user)
{
    dem_crew *c = user;
    unsigned long long last = 0;
    while (!atomic_load(&c->over)) {
        wait_for_more(c, last);
        if (!atomic_load(&c->over))
            last = take_parts(c);
    }
    return NULL;
}

static void wake(dem_crew *c)
{
    if (!atomic_load(&c->asleep))
        return;
    pthread_mutex_lock(&c->lock);
    pthread_cond_broadcast(&c->called);
    pthread_mutex_unlock(&c->lock);
}

dem_crew *dem_crew_create(int size)
{
    if (size < 2)
        return NULL;
    dem_crew *c = aligned_alloc(64, (sizeof *c + 63) / 64 * 64);
    if (!c)
        return NULL;
    *c = (dem_crew){.threads = dem_alloc((size_t)size, sizeof *c->threads)};
    atomic_init(&c->lot, 0);
    atomic_init(&c->done, 0);
    atomic_init(&c->asleep, 0);
    atomic_init(&c->over, false);
    pthread_mutex_init(&c->lock, NULL);
    pthread_cond_init(&c->called, NULL);
    while (c->threads && c->started < size - 1 &&
           pthread_create(&c->threads[c->started], NULL, help, c) == 0)
        c->started++;
    if (c->started > 0)
        return c;
    dem_crew_destroy(c);
    return NULL;
}

void dem_crew_destroy(dem_crew *c)
{
    if (!c)
        return;
    atomic_store(&c->over, true);
    pthread_mutex_lock(&c->lock);
    pthread_cond_broadcast(&c->called);
    pthread_mutex_unlock(&c->lock);
    for (int i = 0; i < c->started; i++)
        pthread_join(c->threads[i], NULL);
    pthread_mutex_destroy(&c->lock);
    pthread_cond_destroy(&c->called);
    free(c->threads);
    free(c);
}

void dem_crew_run(dem_crew *c, int parts, void (*work)(void *user, int part), void *user)
{
    if (!c) {
        for (int part = 0; part < parts; part++)
            work(user, part);
        return;
    }
    unsigned long long number = (lot_number(atomic_load(&c->lot)) + 1) & 0xffffffff;
    c->work = work;
    c->user = user;
    atomic_store(&c->done, 0);
    atomic_store(&c->lot, number << LOT_SHIFT | (unsigned long long)parts << PARTS_SHIFT);
    wake(c);
    take_parts(c);
    // others are still at theirs
    for (int i = 0; atomic_load(&c->done) < parts; i++) {
        if (i < SPINS)
            breathe();
        else
            sched_yield();
    }
}
