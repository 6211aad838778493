#define _GNU_SOURCE
#include "mesh/guard.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/clock.h"

enum { POLL_MS = 50 };

static void limit(int what, double soft, double hard)
{
    struct rlimit r;
    if (getrlimit(what, &r) != 0)
        return;
    if (r.rlim_max == RLIM_INFINITY || hard < (double)r.rlim_max)
        r.rlim_max = (rlim_t)hard;
    if (r.rlim_cur == RLIM_INFINITY || soft < (double)r.rlim_cur)
        r.rlim_cur = (rlim_t)soft;
    setrlimit(what, &r);
}

// address space used by this process [byte]; 0: not known
static double memory_used(void)
{
    FILE *file = fopen("/proc/self/statm", "r");
    unsigned long pages = 0;
    if (file) {
        if (fscanf(file, "%lu", &pages) != 1)
            pages = 0;
        fclose(file);
    }
    return (double)pages * (double)sysconf(_SC_PAGESIZE);
}

static void close_all_but(int kept)
{
    if (kept > STDERR_FILENO + 1)
        close_range(STDERR_FILENO + 1, (unsigned)kept - 1, 0);
    close_range((unsigned)kept + 1, ~0u, 0);
}

static void set_limits(const dem_guard_limits *limits, double memory)
{
    limit(RLIMIT_CORE, 0, 0);
    limit(RLIMIT_FSIZE, limits->file, limits->file);              // pipes are not counted
    limit(RLIMIT_CPU, ceil(limits->cpu), ceil(limits->cpu) + 1);  // SIGXCPU at the first, SIGKILL at the second
    if (DEM_GUARD_MEMORY && memory > 0)
        limit(RLIMIT_AS, memory + limits->memory, memory + limits->memory);
}

_Noreturn static void be_child(int out, const dem_guard_limits *limits, double memory, pid_t parent,
                               void (*work)(void *user, int out), void *user)
{
    static const int defaults[] = {SIGINT,  SIGTERM, SIGHUP,  SIGPIPE, SIGXCPU,
                                   SIGXFSZ, SIGABRT, SIGSEGV, SIGBUS,  SIGFPE};
    for (size_t i = 0; i < sizeof defaults / sizeof *defaults; i++)
        signal(defaults[i], SIG_DFL);
    sigset_t none;
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, NULL);
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent)
        _exit(1);
    int nothing = open("/dev/null", O_RDWR);
    for (int i = STDIN_FILENO; i <= STDERR_FILENO && nothing >= 0; i++)
        dup2(nothing, i);
    close_all_but(out);
    set_limits(limits, memory);
    work(user, out);
    _exit(0);
}

dem_status dem_guard_start(dem_guard *guard, const dem_ctx *ctx, dem_guard_limits limits,
                           void (*work)(void *user, int out), void *user, dem_error *error)
{
    *guard = (dem_guard){.ctx = ctx, .limits = limits, .begin = dem_clock(), .doing = "importing", .status = -1};
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0)
        return dem_fail(error, DEM_FAILED, "no pipe to a child process: %s; close other programs", strerror(errno));
    double memory = memory_used();  // before the fork: stdio is not safe behind it where other threads run
    pid_t parent = getpid();
    guard->child = fork();
    if (guard->child == 0)
        be_child(ends[1] > STDERR_FILENO ? ends[1] : fcntl(ends[1], F_DUPFD, STDERR_FILENO + 1), &limits, memory,
                 parent, work, user);
    close(ends[1]);
    guard->pipe = ends[0];
    if (guard->child < 0) {
        close(ends[0]);
        return dem_fail(error, DEM_FAILED, "no child process: %s; close other programs", strerror(errno));
    }
    return DEM_OK;
}

size_t dem_guard_read_some(dem_guard *guard, void *bytes, size_t size)
{
    for (;;) {
        if (dem_clock() - guard->begin > guard->limits.wall) {
            guard->late = true;
            return 0;
        }
        if (dem_progress(guard->ctx, guard->doing, 0)) {
            guard->interrupted = true;
            return 0;
        }
        struct pollfd one = {.fd = guard->pipe, .events = POLLIN};
        int ready = poll(&one, 1, POLL_MS);
        if (ready == 0 || (ready < 0 && errno == EINTR))
            continue;
        ssize_t got = read(guard->pipe, bytes, size);
        if (got < 0 && errno == EINTR)
            continue;
        return got > 0 ? (size_t)got : 0;
    }
}

bool dem_guard_read(dem_guard *guard, void *bytes, size_t size)
{
    for (char *to = bytes; size;) {
        size_t got = dem_guard_read_some(guard, to, size);
        if (got == 0)
            return false;
        to += got;
        size -= got;
    }
    return true;
}

// waits for a child whose pipe is at its end; one that lives on beyond its time is killed
static int reap(dem_guard *guard)
{
    int status = 0;
    bool killed = guard->late || guard->interrupted;
    if (killed)
        kill(guard->child, SIGKILL);
    for (;;) {
        pid_t ended = waitpid(guard->child, &status, killed ? 0 : WNOHANG);
        if (ended == guard->child || (ended < 0 && errno != EINTR))
            return status;
        if (ended == 0 && dem_clock() - guard->begin > guard->limits.wall) {
            kill(guard->child, SIGKILL);
            killed = guard->late = true;
        } else if (ended == 0) {
            poll(NULL, 0, 1);
        }
    }
}

const char *dem_guard_end(dem_guard *guard)
{
    close(guard->pipe);  // a child that still writes ends by SIGPIPE
    int status = reap(guard);
    int number = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    guard->status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    guard->interrupted |= number == SIGINT || number == SIGTERM;
    if (guard->interrupted)
        snprintf(guard->why, sizeof guard->why, "was interrupted");
    else if (guard->late || number == SIGXCPU)
        snprintf(guard->why, sizeof guard->why, "took more than %.0f s",
                 guard->late ? guard->limits.wall : guard->limits.cpu);
    else if (number == SIGABRT || number == SIGKILL)
        snprintf(guard->why, sizeof guard->why, "gave up (%s, maybe out of memory)",
                 number == SIGABRT ? "abort" : "killed");
    else if (number)
        snprintf(guard->why, sizeof guard->why, "crashed (signal %d)", number);
    else
        snprintf(guard->why, sizeof guard->why, "ended without a result");
    return guard->why;
}
