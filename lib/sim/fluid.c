#include "sim/fluid.h"

#include "sim/bodies.h"

enum { MOST_ROUNDS = 200 };  // of Newton's; a square from far away takes one for each factor of 2

// the drag and its slope
static double drag_of(const dem_drag_def *f, double d, double speed, double *slope)
{
    double stokes = 3 * DEM_PI * d, rough = f->density * d * 0.44 * DEM_PI / 8 * d;
    // mu Re^0.687 without a division by a viscosity that may be 0
    double more = 0.15 * pow(f->density * speed * d, 0.687) * pow(f->viscosity, 0.313);
    double smooth = stokes * speed * (f->viscosity + more), fast = rough * speed * speed;
    *slope = smooth >= fast ? stokes * (f->viscosity + 1.687 * more) : 2 * rough * speed;
    return smooth >= fast ? smooth : fast;
}

double dem_fluid_drag(const dem_drag_def *drag, double diameter, double speed)
{
    double slope;
    return drag_of(drag, diameter, speed, &slope);
}

dem_vec3 dem_fluid_impulse(const dem_world *w, size_t row, dem_vec3 ahead, double kick)
{
    const dem_drag_def *f = &w->damping.drag;
    double inverse = w->bodies.inertia[DEM_ROW * row];
    double d = w->templates.items[w->bodies.shape[row]].equivalent_diameter * body_scale(&w->bodies, row);
    dem_vec3 past = v3_sub(ahead, f->velocity);
    double from = v3_norm(past), speed = from, drag = 0, slope;
    // s + kick D(s) / m = s0: D is convex, so that Newton comes down to the root without passing it
    for (int i = 0; i < MOST_ROUNDS && speed > 0; i++) {
        drag = drag_of(f, d, speed, &slope);
        double next = speed - (speed + kick * inverse * drag - from) / (1 + kick * inverse * slope);
        bool done = !(next < speed * (1 - 1e-14));
        speed = larger(next, 0);
        if (done)
            break;
    }
    // whichever of the two is not a difference of nearly equal numbers
    double impulse = speed < from / 2 ? (from - speed) / inverse : kick * drag;
    return v3_scale(past, from > 0 ? -impulse / from : 0);
}

void dem_fluid_push(dem_world *w, size_t begin, size_t end, double kick)
{
    const dem_bodies *b = &w->bodies;
    for (size_t row = begin; row < end && row < b->count; row++) {
        double *p = b->momentum + DEM_ROW * row, *note = b->fluid + 4 * row;
        const double *inertia = b->inertia + DEM_ROW * row, *motion = body_pose(b, row) + 8;
        if (body_absent(b, row) || (body_hold(b, row) & DEM_HOLD_VELOCITY))
            continue;
        dem_vec3 momentum = v3_along(v3(p[0], p[1], p[2]), kick * inertia[5], w->gravity);
        dem_vec3 ahead = unlocked_velocity(v3_scale(momentum, inertia[0]), body_hold(b, row));
        dem_vec3 impulse = dem_fluid_impulse(w, row, ahead, kick);
        for (int k = 0; k < 3; k++) {
            note[k] = v3_get(impulse, k);
            p[k] += note[k];
        }
        note[3] = note[0] * motion[0] + note[1] * motion[1] + note[2] * motion[2];
    }
}

void dem_fluid_tally(dem_world *w, size_t begin, size_t end)
{
    const dem_bodies *b = &w->bodies;
    for (size_t row = begin; row < end && row < b->count; row++) {
        const double *note = b->fluid + 4 * row, *motion = body_pose(b, row) + 8;
        double now = note[0] * motion[0] + note[1] * motion[1] + note[2] * motion[2];
        w->motion_tallies[row / DEM_SEGMENT].drag[row % DEM_BLOCK_LANES] -= (note[3] + now) / 2;
    }
}
