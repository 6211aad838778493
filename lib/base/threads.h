/// A team of threads that works step after step: made once, waits briefly awake and then asleep.
///
/// OpenMP's threads would do, but between two short steps they spin for milliseconds, which on a machine with other
/// work to do costs more than they save.
#ifndef DEM_BASE_THREADS_H
#define DEM_BASE_THREADS_H

#include <stdbool.h>

typedef struct dem_team dem_team;

/// `size` threads with the caller's own. NULL: out of memory or threads.
dem_team *dem_team_create(int size);
void dem_team_destroy(dem_team *team);
int dem_team_size(const dem_team *team);

/// Calls work(user, part) for all parts 0 .. size - 1 at once, part 0 in the calling thread; returns when all are
/// through. Only the thread that made the team may call it, and not from within work.
void dem_team_run(dem_team *team, void (*work)(void *user, int part), void *user);

/// The same for work in `parts` that is 1 or the team's size: one part is done without the team, which may be NULL then.
static inline void dem_team_share(dem_team *team, int parts, void (*work)(void *user, int part), void *user)
{
    if (parts > 1)
        dem_team_run(team, work, user);
    else
        work(user, 0);
}

/// Inside of work: waits until every part has come here. What parts wrote before is seen by all behind.
void dem_team_meet(dem_team *team);

#endif
