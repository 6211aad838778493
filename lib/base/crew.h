/// Threads that help with many short pieces of work, one lot after the other.
///
/// The caller works as well and waits for nobody but those who have begun a piece: where the others do not come,
/// because the machine has other work to do, it does all of it. A team (threads.h) would wait for them.
#ifndef DEM_BASE_CREW_H
#define DEM_BASE_CREW_H

typedef struct dem_crew dem_crew;

/// `size` threads with the caller's own. NULL for a size of 1, or where there are no threads to be had: then
/// `dem_crew_run` does everything itself.
dem_crew *dem_crew_create(int size);
void dem_crew_destroy(dem_crew *crew);

/// Calls work(user, part) for all parts 0 .. parts - 1, at most 65535, in any order; returns when all are through. Only
/// the thread that made the crew may call it, and not from within work.
void dem_crew_run(dem_crew *crew, int parts, void (*work)(void *user, int part), void *user);

#endif
