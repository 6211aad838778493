/// The packer's hot loops: plain C over fixed lanes, compiled once per instruction set (kernels.cmake). Every sum is
/// kept in 16 explicit partial sums, so that all instruction sets give the same bits.
#ifndef DEM_CLUMP_PACK_KERNELS_H
#define DEM_CLUMP_PACK_KERNELS_H

#include "clump/pack_samples.h"

enum {
    DEM_LANES = 16,     ///< partial sums of a reduction
    DEM_EQUATION = 14,  ///< upper triangle of a symmetric 4x4 matrix, then a right-hand side of 4
};

/// Balls in columns, padded to full lanes by balls that are far away.
typedef struct dem_ball_columns {
    float *x, *y, *z, *r;
    size_t count, padded;
} dem_ball_columns;

/// How the distance f of a sample to the union (negative: inside it) is charged.
typedef struct dem_charge {
    bool interior;         ///< of interior samples: the square of f > 0
    bool linear;           ///< the power of |f| is 1; otherwise 1.25
    float softening;       ///< added to f^2: (epsilon / 2)^2
    float inside, outside; ///< weight of samples inside (protrusion) and outside (uncovered)
} dem_charge;

/// Partial sums of one ball's normal equations.
typedef struct dem_equation_lanes {
    float sum[DEM_EQUATION][DEM_LANES];
} dem_equation_lanes;

enum { DEM_LINE_LANES = 16 };  ///< neighbouring lines taken together

/// Lines along one axis in strips of DEM_LINE_LANES, each with the places where they enter and leave the grain.
typedef struct dem_line_field {
    int axis;
    float step, origin[2];   ///< as in dem_columns
    int32_t row_count;
    int32_t *first;          ///< [row_count] column of a row's first line
    uint32_t *strip;         ///< [row_count + 1] index of a row's first strip
    uint32_t *span;          ///< [strips + 1] index of a strip's first span
    float (*spans)[2][DEM_LINE_LANES];  ///< enter and leave; a line with fewer spans than its strip has them far away
} dem_line_field;

/// The balls that each strip of a task needs.
typedef struct dem_strip_lists {
    uint32_t *start;         ///< [strips + 1] where those of a strip stand in `list`
    uint32_t *list;          ///< of each strip by coordinate along the lines
    size_t capacity;
} dem_strip_lists;

/// One share of the rows of a field.
typedef struct dem_line_task {
    const dem_line_field *field;
    int32_t begin, end;      ///< rows
    dem_strip_lists wide, close;    ///< for large and for small moves of the balls; `close` is made from `wide`
    float uncovered, protruding;   ///< weights of what the union lacks and of what it has too much
    /// [balls] sums over the exposed ends of their intervals, with s = `protruding` for an end outside the grain and
    /// -`uncovered` for one inside, n the unit normal of the ball, w along the lines: s |n_w| r (n_u r, n_v r, n_w r, 1)
    float (*sums)[4];
    float (*from)[DEM_LINE_LANES], (*to)[DEM_LINE_LANES];  ///< [balls] work space: the ends of their intervals
    unsigned char *kept;     ///< [balls] work space
    double covered, common;  ///< length of the lines inside the union, and inside both
    bool failed;             ///< out of memory
} dem_line_task;

/// Points in full lanes.
typedef struct dem_point_columns {
    float *x, *y, *z;
    size_t count;
} dem_point_columns;

/// Work space of `gather_near` and `list_near`: [padded balls].
typedef struct dem_near_work {
    float *distance;
    uint32_t *found, *bucket;
} dem_near_work;

/// The balls near a block, as `list_near` left them, or a little later.
typedef struct dem_near_list {
    const uint32_t *list;
    const float *least;  ///< [count] no ball from here on was nearer to the block's centre
    size_t count;
    float reach;         ///< radius of the block, and what balls may have come nearer since
    float enough;        ///< it is not asked how far below this f is
} dem_near_list;

typedef struct dem_pack_kernels {
    /// Copies the balls that are nearest or second nearest to some place in the bound while none moves by more than
    /// half of `slack`, in their order, to `some`, which has room for all; ids[k] is where some[k] comes from.
    void (*gather_near)(const dem_ball_columns *balls, const dem_block_bound *bound, float slack,
                        const dem_near_work *work, dem_ball_columns *some, uint32_t *ids);
    /// Lists these balls roughly by their distances; `list` and `least` have room for all, padded. Returns their
    /// number.
    size_t (*list_near)(const dem_ball_columns *balls, const dem_block_bound *bound, float slack,
                        const dem_near_work *work, uint32_t *list, float *least);
    /// Nearest of the listed balls for each sample: f and owner.
    void (*nearest)(const dem_sample_block *block, const dem_ball_columns *balls, const dem_near_list *near, float *f,
                    int32_t *owner);
    /// The same and the second-nearest distance, for which `enough` is meant here.
    void (*nearest_two)(const dem_sample_block *block, const dem_ball_columns *balls, const dem_near_list *near,
                        float *f, int32_t *owner, float *second);
    /// The owners of a block's samples, each once; room for DEM_BLOCK. Returns their number.
    size_t (*owners_of)(const int32_t *owner, uint32_t *owners);
    /// What each sample is charged, and the sum.
    void (*charges)(const dem_sample_block *block, const float *f, const dem_charge *charge, float *charges);
    float (*energy)(const dem_sample_block *block, const float *f, const dem_charge *charge);
    /// f with one more ball; false: it is nearest for no sample.
    bool (*with_ball)(const dem_sample_block *block, const float ball[4], const float *f, float *with);
    /// Adds the samples' Gauss-Newton terms to the equations of their owners, slot[owner].
    void (*equations)(const dem_sample_block *block, const dem_ball_columns *balls, const float *f,
                      const int32_t *owner, const dem_charge *charge, const uint32_t *owners, size_t owner_count,
                      dem_equation_lanes *const *slots);
    /// For a growing tree: lowers reach[i], the gap of ball i to the nearest ball of the tree, where ball `joined` is
    /// nearer. Balls of the tree have reach[i] <= -1e9. Returns the ball of the least other one, or -1.
    int32_t (*approach)(const dem_ball_columns *balls, uint32_t joined, float *reach, int32_t *nearest);
    /// The deepest of some points (full lanes) in the ball that touches p (unit normal n), and the radius of the ball
    /// through both. Depth is r^2 - distance^2 from the centre. False: none is deeper than `least`.
    bool (*deepest)(const dem_point_columns *points, const float p[3], const float n[3], float two_r, float least,
                    float *radius);
    /// By how many points the symmetric difference of grain and covered set shrinks with this ball; marks its points in
    /// `cover` unless NULL.
    int64_t (*lattice_gain)(const dem_lattice *lattice, dem_ball ball, uint64_t *cover);
    const struct dem_line_kernels *lines;
} dem_pack_kernels;

typedef struct dem_line_kernels {
    /// Adds to `sums` if the gradient is wanted; sets `covered` and `common`.
    void (*measure)(const dem_ball_columns *balls, dem_line_task *task, const dem_strip_lists *lists, bool gradient);
    /// Leaves out of lists the balls that stay hidden while no ball changes by more than `slack`: the shift of its
    /// centre and the change of its radius taken together. `to` has room for all; it may be `from`.
    void (*cull)(const dem_ball_columns *balls, dem_line_task *task, const dem_strip_lists *from, dem_strip_lists *to,
                 float slack);
} dem_line_kernels;

/// The best set this machine can run, or the named one (NULL: none such, or not usable here).
const dem_pack_kernels *dem_pack_kernels_choose(const char *name);

extern const dem_line_kernels dem_line_kernels_plain, dem_line_kernels_v3, dem_line_kernels_v4;
extern const dem_pack_kernels dem_pack_kernels_plain, dem_pack_kernels_v3, dem_pack_kernels_v4;

#endif
