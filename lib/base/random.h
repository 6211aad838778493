/// Counter-based random numbers: the n-th number of a stream is a pure function of (seed, stream, n), so
/// results do not depend on threads or order. Mixing function: SplitMix64 (Steele, Lea & Flood 2014) in
/// two rounds.
#ifndef DEM_BASE_RANDOM_H
#define DEM_BASE_RANDOM_H

#include <math.h>
#include <stdint.h>

typedef struct dem_random {
    uint64_t key, counter;
} dem_random;

static inline uint64_t random_mix(uint64_t z)
{
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

static inline dem_random random_stream(uint64_t seed, uint64_t stream)
{
    return (dem_random){random_mix(random_mix(seed + 0x9e3779b97f4a7c15u) ^ (stream * 0xd1342543de82ef95u + 1)), 0};
}

static inline uint64_t random_bits(dem_random *r)
{
    return random_mix(random_mix(r->key + 0x9e3779b97f4a7c15u * ++r->counter) ^ r->key);
}

/// Uniform in [0, 1).
static inline double random_uniform(dem_random *r)
{
    return (double)(random_bits(r) >> 11) * 0x1p-53;
}

/// Uniform in 0..count-1; count > 0.
static inline uint64_t random_below(dem_random *r, uint64_t count)
{
    return (uint64_t)(((unsigned __int128)random_bits(r) * count) >> 64);
}

/// Standard normal (Box & Muller 1958).
static inline double random_normal(dem_random *r)
{
    double u = 1 - random_uniform(r), v = random_uniform(r);
    return sqrt(-2 * log(u)) * cos(6.283185307179586 * v);
}

#endif
