// A pixel shows a few patches, one surface each, weighted by the samples that meet it; each patch is lit once, by a
// few of a fixed set of rays to a soft sun and a bright sky. The set is dealt to the pixels of a 4 x 4 block
// (interleaved sampling, Keller & Heidrich 2001), and the light of a patch is averaged over the patches about it that
// lie on the same surface: smooth shadows from few rays, without noise. The ground is lit at the points of a coarse
// lattice of the picture and its light interpolated by cubic B-splines. Pixels whose neighbours see another surface
// take more samples. The picture is drawn in tiles, so that this takes little memory.
#include "out/render.h"

#include <math.h>
#include <stdlib.h>

#ifdef _OPENMP
#include <omp.h>
#endif

#include "base/memory.h"
#include "out/stage.h"

enum {
    TILE = 128,
    BLOCK = 4,       // pixels that share the set of light rays
    BORDER_LOW = 1,  // pixels about a tile that its averages take in
    BORDER_HIGH = 2,
    EDGE = TILE + BORDER_LOW + BORDER_HIGH,
    PATCHES = 4,      // surfaces in one pixel
    SAMPLES = 16,     // of a pixel at an edge, if nothing is asked for
    FEW_SAMPLES = 5,  // if these all see the same, the edge is beside the pixel
    STEP = 4,         // pixels between points of the ground's lattice
    NODES = TILE / STEP + 3,
};

typedef struct patch {
    dem_spot spot;
    int weight;
    dem_colour light;
} patch;

typedef struct cell {
    patch patches[PATCHES];
    int count, weight;  // a weight more than the patches have is sky
    dem_veil veil;      // of all samples together; key: of the first one
} cell;

typedef struct tile {
    int left, top, width, height;  // without the border [pixels]
    cell cells[EDGE][EDGE];
    bool edges[EDGE][EDGE];
    float ground[NODES][NODES];  // from STEP to the left and above; negative: not lit yet
} tile;

static bool same_surface(const dem_stage *s, const dem_spot *a, const dem_spot *b)
{
    if (a->body != b->body)
        return false;
    if (a->body == STAGE_GROUND)
        return true;
    if (!s->scene->shapes[s->scene->bodies[a->body].shape].mesh)
        return a->primitive == b->primitive;
    return v3_dot(a->normal, b->normal) > 0.9;
}

static void add_veil(cell *p, dem_veil veil)
{
    if (p->weight == 0)
        p->veil = (dem_veil){.key = veil.key};
    p->veil.through += veil.through;
    p->veil.light.r += veil.light.r;
    p->veil.light.g += veil.light.g;
    p->veil.light.b += veil.light.b;
}

// true: it sees what the first one of the pixel sees
static bool take_sample(const dem_stage *s, double x, double y, cell *p)
{
    dem_spot seen;
    bool any = dem_stage_look(s, x, y, &seen);
    dem_veil veil = dem_stage_veil(s, x, y, any ? &seen : NULL);
    add_veil(p, veil);
    p->weight++;
    if (!any)
        return p->count == 0 && veil.key == p->veil.key;
    int k = 0;
    while (k < p->count && !same_surface(s, &p->patches[k].spot, &seen))
        k++;
    if (k == PATCHES)
        k--;
    else if (k == p->count)
        p->patches[p->count++] = (patch){.spot = seen};
    p->patches[k].weight++;
    return p->patches[0].weight == p->weight && veil.key == p->veil.key;
}

// many samples of a pixel near an edge; a few where the edge seems to miss it
static void take_more(const dem_stage *s, double left, double top, cell *p)
{
    size_t most = (size_t)(s->scene->samples > 0 ? s->scene->samples : SAMPLES) - 1;
    bool same = true;
    for (size_t i = 0; i < most && !(same && i == FEW_SAMPLES); i++) {
        double u, v;
        dem_even_point(i, &u, &v);
        same &= take_sample(s, left + u, top + v, p);
    }
}

static bool same_sight(const dem_stage *s, const cell *a, const cell *b)
{
    return a->veil.key == b->veil.key && a->count == b->count &&
           (a->count == 0 || same_surface(s, &a->patches[0].spot, &b->patches[0].spot));
}

// one sample in the middle of every pixel, many where a neighbour sees another surface
static void take_samples(const dem_stage *s, tile *t)
{
    int width = t->width + BORDER_LOW + BORDER_HIGH, height = t->height + BORDER_LOW + BORDER_HIGH;
    double left = t->left - BORDER_LOW, top = t->top - BORDER_LOW;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            t->cells[y][x].count = t->cells[y][x].weight = 0;
            take_sample(s, left + x + 0.5, top + y + 0.5, &t->cells[y][x]);
        }
    for (int y = 1; y < height - 1; y++)
        for (int x = 1; x < width - 1; x++) {
            t->edges[y][x] = false;
            for (int k = 0; k < 9; k++)
                t->edges[y][x] |= !same_sight(s, &t->cells[y][x], &t->cells[y - 1 + k / 3][x - 1 + k % 3]);
        }
    for (int y = 1; y < height - 1; y++)
        for (int x = 1; x < width - 1; x++)
            if (t->edges[y][x])
                take_more(s, left + x, top + y, &t->cells[y][x]);
}

static void light_patches(const dem_stage *s, tile *t)
{
    // neighbours take parts of the set that lie far apart in it
    static const unsigned char parts[BLOCK][BLOCK] = {{0, 8, 2, 10}, {12, 4, 14, 6}, {3, 11, 1, 9}, {15, 7, 13, 5}};
    for (int y = 0; y < t->height + BORDER_LOW + BORDER_HIGH; y++)
        for (int x = 0; x < t->width + BORDER_LOW + BORDER_HIGH; x++)
            for (int k = 0; k < t->cells[y][x].count; k++) {
                patch *p = &t->cells[y][x].patches[k];
                if (p->spot.body != STAGE_GROUND)
                    p->light = dem_stage_light(s, &p->spot, parts[y % BLOCK][x % BLOCK]);
            }
}

// the light on a surface, averaged over the block of pixels about it
static dem_colour average_light(const dem_stage *s, const tile *t, int x, int y, const dem_spot *spot)
{
    dem_colour sum = {0};
    float count = 0;
    for (int i = y - BORDER_LOW; i <= y + BORDER_HIGH; i++)
        for (int j = x - BORDER_LOW; j <= x + BORDER_HIGH; j++)
            for (int k = 0; k < t->cells[i][j].count; k++) {
                const patch *p = &t->cells[i][j].patches[k];
                if (!same_surface(s, spot, &p->spot))
                    continue;
                sum = (dem_colour){sum.r + p->light.r, sum.g + p->light.g, sum.b + p->light.b};
                count++;
            }
    return (dem_colour){sum.r / count, sum.g / count, sum.b / count};
}

static dem_colour albedo(const dem_stage *s, const dem_spot *p)
{
    const dem_render_body *body = &s->scene->bodies[p->body];
    const dem_render_shape *shape = &s->scene->shapes[body->shape];
    return shape->part_colours ? shape->part_colours[p->primitive] : body->colour;
}

static void spline_weights(float t, float weights[4])
{
    float u = 1 - t;
    weights[0] = u * u * u / 6;
    weights[1] = (4 + 3 * t * t * (t - 2)) / 6;
    weights[2] = (4 + 3 * u * u * (u - 2)) / 6;
    weights[3] = t * t * t / 6;
}

// cubic B-spline through the lattice at the middle of a pixel, (x, y) in the tile
static float ground_light(const dem_stage *s, tile *t, int x, int y)
{
    float u[4], v[4], sum = 0;
    spline_weights(((float)(x % STEP) + 0.5f) / STEP, u);
    spline_weights(((float)(y % STEP) + 0.5f) / STEP, v);
    for (int k = 0; k < 4; k++)
        for (int l = 0; l < 4; l++) {
            int i = y / STEP + k, j = x / STEP + l;
            if (t->ground[i][j] < 0)
                t->ground[i][j] = dem_stage_ground(s, t->left + (j - 1) * STEP, t->top + (i - 1) * STEP);
            sum += v[k] * u[l] * t->ground[i][j];
        }
    return sum;
}

// (x, y) in the tile
static void finish_pixel(const dem_stage *s, tile *t, int x, int y, uint8_t *rgb)
{
    const cell *c = &t->cells[y + BORDER_LOW][x + BORDER_LOW];
    const dem_colour white = {1, 1, 1}, back = s->scene->background ? *s->scene->background : white;
    float sum[3] = {0}, sky = (float)c->weight;
    for (int k = 0; k < c->count; k++) {
        const patch *p = &c->patches[k];
        dem_colour colour = back, light;
        if (p->spot.body == STAGE_GROUND) {
            float bright = ground_light(s, t, x, y);
            light = (dem_colour){bright, bright, bright};
        } else {
            colour = albedo(s, &p->spot);
            light = average_light(s, t, x + BORDER_LOW, y + BORDER_LOW, &p->spot);
        }
        float w = (float)p->weight;
        sum[0] += w * colour.r * light.r;
        sum[1] += w * colour.g * light.g;
        sum[2] += w * colour.b * light.b;
        sky -= w;
    }
    const float veil[3] = {c->veil.light.r, c->veil.light.g, c->veil.light.b}, all = (float)c->weight;
    const float behind[3] = {back.r, back.g, back.b};
    for (int k = 0; k < 3; k++)
        rgb[k] = dem_colour_srgb(((sum[k] + sky * behind[k]) / all * c->veil.through + veil[k]) / all);
}

static void render_tile(const dem_stage *s, tile *t, dem_image *image)
{
    for (int i = 0; i < NODES; i++)
        for (int j = 0; j < NODES; j++)
            t->ground[i][j] = -1;
    take_samples(s, t);
    light_patches(s, t);
    for (int y = 0; y < t->height; y++)
        for (int x = 0; x < t->width; x++) {
            size_t at = (size_t)(t->top + y) * (size_t)image->width + (size_t)(t->left + x);
            finish_pixel(s, t, x, y, image->pixels + 3 * at);
        }
}

static dem_status render_tiles(const dem_ctx *ctx, const dem_stage *s, dem_image *image, dem_error *error)
{
    int across = (image->width + TILE - 1) / TILE, count = across * ((image->height + TILE - 1) / TILE), done = 0;
    int threads = dem_threads(ctx) < count ? dem_threads(ctx) : count;
    tile *tiles = dem_alloc((size_t)threads, sizeof *tiles);
    if (!tiles)
        return dem_fail_memory(error);
    bool stop = false;
#pragma omp parallel for schedule(dynamic) num_threads(threads)
    for (int i = 0; i < count; i++) {
        int thread = 0, so_far;
        bool stopped;
#ifdef _OPENMP
        thread = omp_get_thread_num();
#endif
#pragma omp atomic read
        stopped = stop;
        if (stopped)
            continue;
        tile *t = &tiles[thread];
        t->left = i % across * TILE;
        t->top = i / across * TILE;
        t->width = image->width - t->left < TILE ? image->width - t->left : TILE;
        t->height = image->height - t->top < TILE ? image->height - t->top : TILE;
        render_tile(s, t, image);
#pragma omp atomic capture
        so_far = ++done;
        // only the calling thread reports
        if (thread == 0 && dem_progress(ctx, "drawing", (double)so_far / count)) {
#pragma omp atomic write
            stop = true;
        }
    }
    free(tiles);
    return stop ? dem_fail(error, DEM_INTERRUPTED, "interrupted while drawing") : DEM_OK;
}

dem_status dem_render(const dem_ctx *ctx, const dem_render_scene *scene, const dem_view *view, dem_image *image,
                      dem_error *error)
{
    dem_stage stage;
    *image = (dem_image){0};
    DEM_TRY(dem_stage_init(&stage, scene, view, error));
    dem_status status = dem_image_create(view->width, view->height, image, error);
    if (status == DEM_OK)
        status = render_tiles(ctx, &stage, image, error);
    if (status != DEM_OK)
        dem_image_free(image);
    dem_stage_release(&stage);
    return status;
}
