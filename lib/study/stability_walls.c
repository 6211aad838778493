// Mesh walls of slivers and sharp edges.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "study/stability.h"

static const double RADIUS = 0.01;

// ---- slivers

// strips across the way, `wide` [m] each, from y = -1 to 1
static void put_strips(dem_trial *t, double wide, double length)
{
    size_t n = (size_t)(length / wide);
    dem_mesh *mesh = dem_trial_mesh(t, n + 1, n - 1);
    for (size_t i = 0; mesh && i <= n; i++)
        mesh->vertices[i] = v3((double)i * wide - 0.05, i % 2 ? 1 : -1, 0);
    for (size_t i = 0; mesh && i + 1 < n; i++) {
        uint32_t k = (uint32_t)i, odd = k % 2;
        uint32_t corner[3] = {k, k + 1 + odd, k + 2 - odd};
        memcpy(mesh->triangles + 3 * i, corner, sizeof corner);
    }
}

// a fan from a point so far that its triangles are a millionth as wide as long
static void put_fan(dem_trial *t, double wide, double far)
{
    size_t n = (size_t)(2 * wide / 1e-3);
    dem_mesh *mesh = dem_trial_mesh(t, n + 2, n);
    for (size_t i = 0; mesh && i <= n; i++)
        mesh->vertices[i] = v3(1, (double)i * 1e-3 - wide, 0);
    if (mesh)
        mesh->vertices[n + 1] = v3(-far, 0, 0);
    for (size_t i = 0; mesh && i < n; i++) {
        uint32_t corner[3] = {(uint32_t)i, (uint32_t)i + 1, (uint32_t)n + 1};
        memcpy(mesh->triangles + 3 * i, corner, sizeof corner);
    }
}

typedef enum floor_kind { PLANE, STRIPS, FINE_STRIPS, FAN } floor_kind;

// a ball that slides until it rolls, and a dumbbell beside it
static void roll(dem_trial *t, floor_kind kind)
{
    model *m = dem_trial_model(t);
    m->scene.gravity = v3(0, 0, -9.81);
    m->scene.time.step = 5e-5;
    m->laws[0].damping = DEM_DAMPING_RESTITUTION;
    m->laws[0].restitution = 0.5;
    m->laws[0].friction = DEM_FRICTION_LINEAR;
    m->laws[0].friction_coefficient = 0.3;
    if (kind == PLANE)
        model_plane(m, v3(0, 0, 0), v3(0, 0, 1));
    else if (kind == FAN)
        put_fan(t, 0.2, 1e3);
    else
        put_strips(t, kind == STRIPS ? 1e-3 : 2e-5, 0.5);
    double rests = RADIUS - model_ball_mass(RADIUS) * 9.81 / 1e4;
    model_body(m, model_sphere(m, RADIUS), v3(0, 0.01, rests))->velocity.x = 0.5;
    model_body(m, model_dumbbell(m, RADIUS, RADIUS), v3(0, 0.1, rests))->velocity.x = 0.4;
    dem_trial_start(t);
    dem_trial_step(t, 8000);
}

static void slivers(dem_trial *t)
{
    static const char *const names[] = {"", "strips 1 : 2000", "strips 1 : 1e5", "fan 1 : 1e6"};
    dem_motion want[2];
    for (int kind = PLANE; kind <= FAN; kind++) {
        roll(t, (floor_kind)kind);
        for (size_t i = 0; i < 2; i++) {
            dem_motion got = dem_trial_body(t, i);
            const char *what = i ? "dumbbell" : "sphere";
            if (kind == PLANE) {
                want[i] = got;
                continue;
            }
            // PHYSICS 5: as on the plane, to 1e-10 of speeds; places are the sum of 8000 steps
            dem_expect_most(t, v3_distance(got.position, want[i].position) / RADIUS, 1e-7, "",
                            "%s, %s: place off from a plane's, over the radius", names[kind], what);
            dem_expect_most(t, v3_distance(got.velocity, want[i].velocity), 1e-8, "m/s", "%s, %s: speed off",
                            names[kind], what);
        }
    }
}

// ---- edges

// a roof along y with its edge at z = 0, of the angle between its faces [rad]; or a groove
static void put_roof(dem_trial *t, double angle, bool groove)
{
    double deep = groove ? 1 : -1;
    double half = tan(angle / 2);
    dem_mesh *mesh = dem_trial_mesh(t, 6, 4);
    if (!mesh)
        return;
    for (int i = 0; i < 2; i++) {
        double y = i ? 1 : -1;
        mesh->vertices[3 * i] = v3(0, y, 0);
        mesh->vertices[3 * i + 1] = v3(-half, y, deep);
        mesh->vertices[3 * i + 2] = v3(half, y, deep);
    }
    static const uint32_t corners[12] = {0, 3, 1, 1, 3, 4, 0, 2, 3, 3, 2, 5};
    memcpy(mesh->triangles, corners, sizeof corners);
}

static void smooth(dem_trial *t)
{
    model *m = dem_trial_model(t);
    m->scene.time.step = 0;
    m->laws[0].stiffness = 1e4;
}

static void wedge(dem_trial *t)
{
    static const double angles[] = {90, 10, 1, 0.1};
    for (size_t i = 0; i < 4; i++)
        for (int clump = 0; clump < 2; clump++) {
            const char *what = clump ? "clump" : "sphere";
            smooth(t);
            model *m = t->model;
            put_roof(t, angles[i] * DEM_PI / 180, false);
            // exactly above the edge, and a clump a little beside it
            uint32_t shape = clump ? model_cloud(m, 20, 3 * RADIUS, 3) : model_sphere(m, RADIUS);
            dem_body_def *b = model_body(m, shape, v3(clump ? 0.3 * RADIUS : 0, 0, 3 * RADIUS));
            b->velocity.z = -1;
            dem_trial_start(t);
            dem_trial_step(t, 3000);
            dem_motion end = dem_trial_body(t, 0);
            const dem_figures *f = dem_trial_figures(t);
            dem_expect_most(t, fabs(f->energy.error), 1e-2, "", "%g deg, %s: energy off by", angles[i], what);
            // as deep as one contact takes to stop 1 m/s
            double mass = clump ? 2500 * 0.25 * pow(3 * RADIUS, 3) : model_ball_mass(RADIUS),
                   least = clump ? 0.15 * 3 * RADIUS : RADIUS;
            dem_expect_most(t, f->largest_overlap_ratio, 1.01 * sqrt(mass / 1e4) / least, "",
                            "%g deg, %s: largest overlap over radius", angles[i], what);
            if (!clump) {
                dem_expect(t, end.velocity.z, 1, 5e-3, "m/s", "%g deg: speed upwards", angles[i]);
                dem_expect_most(t, fabs(end.velocity.x), 1e-12, "m/s", "%g deg: speed aside", angles[i]);
            }
        }
}

// thrown into a sharp groove: wedged in, it presses its way out again
static void groove(dem_trial *t)
{
    static const double angles[] = {60, 10, 1};
    for (size_t i = 0; i < 3; i++)
        for (int clump = 0; clump < 2; clump++) {
            const char *what = clump ? "clump" : "sphere";
            double half = angles[i] * DEM_PI / 360, touch = RADIUS / sin(half);
            smooth(t);
            model *m = t->model;
            put_roof(t, 2 * half, true);
            if (touch > 0.9) {  // smaller grains for the sharpest
                t->model->laws[0].stiffness = 1e2;
                touch *= 0.5;
            }
            double r = touch * sin(half);
            uint32_t shape = clump ? model_cloud(m, 20, 2 * r, 3) : model_sphere(m, r);
            dem_body_def *b = model_body(m, shape, v3(0, 0, touch + 2 * r));
            b->velocity = v3(0.01, 0, -1);
            dem_trial_start(t);
            dem_trial_step(t, 4000);
            const dem_figures *f = dem_trial_figures(t);
            dem_motion end = dem_trial_body(t, 0);
            dem_expect_most(t, fabs(f->energy.error), 1e-2, "", "%g deg, %s: energy off by", angles[i], what);
            dem_expect_least(t, end.position.z, 0, "m", "%g deg, %s: height", angles[i], what);
            // as deep as one contact takes to stop 1 m/s
            double mass = clump ? 2500 * 0.25 * pow(2 * r, 3) : model_ball_mass(r);
            dem_expect_most(t, f->largest_overlap_ratio,
                            1.01 * sqrt(mass / m->laws[0].stiffness) / (clump ? 0.3 * r : r), "",
                            "%g deg, %s: largest overlap over radius", angles[i], what);
        }
}

const dem_case dem_stability_walls[] = {
    {"wall-slivers", "a floor of triangles up to 1 : 1e6", "the same on a plane", false, slivers},
    {"wall-wedge", "edges of 90 to 0.1 degrees", "energy; symmetry", false, wedge},
    {"wall-groove", "grooves of 60 to 1 degrees", "energy", false, groove},
    {0},
};
