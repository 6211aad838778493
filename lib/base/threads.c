#include "base/threads.h"

#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>
#include <stdlib.h>

#include "base/memory.h"

// how long to wait awake: some 20 us with the processor, then some turns for others
enum { SPINS = 2000, YIELDS = 50 };

// a place where all threads meet; `round` counts the meetings
typedef struct meeting {
    _Alignas(64) atomic_int missing;
    _Alignas(64) atomic_uint round;
    atomic_int asleep;
    pthread_mutex_t lock;
    pthread_cond_t called;
} meeting;

struct dem_team {
    int size;
    pthread_t *threads;
    int started;
    meeting start, inside, end;
    void (*work)(void *user, int part);  // NULL: go home
    void *user;
};

typedef struct member {
    dem_team *team;
    int part;
} member;

static inline void breathe(void)
{
#if defined(__x86_64__)
    __builtin_ia32_pause();
#endif
}

static void open_meeting(meeting *m, int size)
{
    atomic_init(&m->missing, size);
    atomic_init(&m->round, 0);
    atomic_init(&m->asleep, 0);
    pthread_mutex_init(&m->lock, NULL);
    pthread_cond_init(&m->called, NULL);
}

static void close_meeting(meeting *m)
{
    pthread_mutex_destroy(&m->lock);
    pthread_cond_destroy(&m->called);
}

static void sleep_until(meeting *m, unsigned round)
{
    pthread_mutex_lock(&m->lock);
    atomic_fetch_add(&m->asleep, 1);
    while (atomic_load(&m->round) == round)
        pthread_cond_wait(&m->called, &m->lock);
    atomic_fetch_sub(&m->asleep, 1);
    pthread_mutex_unlock(&m->lock);
}

static void meet(meeting *m, int size)
{
    unsigned round = atomic_load(&m->round);
    if (atomic_fetch_sub(&m->missing, 1) == 1) {
        // the last one opens the next round
        atomic_store(&m->missing, size);
        atomic_fetch_add(&m->round, 1);
        if (atomic_load(&m->asleep)) {
            pthread_mutex_lock(&m->lock);
            pthread_cond_broadcast(&m->called);
            pthread_mutex_unlock(&m->lock);
        }
        return;
    }
    for (int i = 0; i < SPINS; i++) {
        if (atomic_load_explicit(&m->round, memory_order_acquire) != round)
            return;
        breathe();
    }
    for (int i = 0; i < YIELDS; i++) {
        if (atomic_load(&m->round) != round)
            return;
        sched_yield();
    }
    sleep_until(m, round);
}

static void *live(void *user)
{
    member own = *(member *)user;
    free(user);
    for (;;) {
        meet(&own.team->start, own.team->size);
        if (!own.team->work)
            return NULL;
        own.team->work(own.team->user, own.part);
        meet(&own.team->end, own.team->size);
    }
}

// those that were started wait at the start for all others: if one is missing, they are told to go home
dem_team *dem_team_create(int size)
{
    dem_team *t = aligned_alloc(64, (sizeof *t + 63) / 64 * 64);
    if (!t)
        return NULL;
    *t = (dem_team){.size = size};
    open_meeting(&t->start, size);
    open_meeting(&t->inside, size);
    open_meeting(&t->end, size);
    t->threads = dem_alloc((size_t)size, sizeof *t->threads);
    bool good = t->threads;
    for (int part = 1; good && part < size; part++) {
        member *m = malloc(sizeof *m);
        good = m;
        if (!m)
            break;
        *m = (member){t, part};
        if (pthread_create(&t->threads[part], NULL, live, m) != 0) {
            free(m);
            good = false;
            break;
        }
        t->started++;
    }
    if (good)
        return t;
    dem_team_destroy(t);
    return NULL;
}

void dem_team_destroy(dem_team *t)
{
    if (!t)
        return;
    t->work = NULL;
    // the places of members that could not be started are taken here
    if (t->threads) {
        atomic_fetch_sub(&t->start.missing, t->size - 1 - t->started);
        if (t->started)
            meet(&t->start, t->size);
        for (int part = 1; part <= t->started; part++)
            pthread_join(t->threads[part], NULL);
    }
    close_meeting(&t->start);
    close_meeting(&t->inside);
    close_meeting(&t->end);
    free(t->threads);
    free(t);
}

int dem_team_size(const dem_team *t)
{
    return t->size;
}

void dem_team_run(dem_team *t, void (*work)(void *user, int part), void *user)
{
    if (t->size == 1) {
        work(user, 0);
        return;
    }
    t->work = work;
    t->user = user;
    meet(&t->start, t->size);
    work(user, 0);
    meet(&t->end, t->size);
}

void dem_team_meet(dem_team *t)
{
    if (t->size > 1)
        meet(&t->inside, t->size);
}
