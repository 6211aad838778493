// What soft contacts cost and give beside the sum of all, for clumps of one grain with ever more spheres: the tables of
// tests/bench/soft.sh. Prints one line for each clump given.
//   bench_soft CASE MODE TAU CLUMP...     CASE wall|twin|twins|bounce|paths|oblique|cost, MODE sum|mean|merge|soft
#include <time.h>

#include "../soft_cases.h"
#include "sim/restitution.h"

enum { ORIENTATIONS = 24 };

static const double OVERLAP = 0.005, STIFFNESS = 1e5;

typedef struct bench {
    dem_multiple mode;
    double tau;
    const dem_clump *clump;
    size_t spheres;
} bench;

static model *new_model(const bench *b, size_t bodies, bool wall)
{
    model *m = model_new();
    double scale;
    m->laws[0].stiffness = STIFFNESS;
    m->scene.multiple = b->mode;
    m->scene.soft.tau = b->tau;
    m->scene.domain.leaving = DEM_LEAVING_IGNORE;
    uint32_t shape = model_of_clump(m, b->clump, &scale);
    for (size_t i = 0; i < bodies; i++)
        model_body(m, shape, v3(10.0 * (double)i, 0, 10))->scale = scale;
    if (wall)
        model_plane(m, v3(0, 0, 0), v3(0, 0, 1));
    return m;
}

// stiffness of a contact at OVERLAP over the law's, by orientation
typedef struct stiffnesses {
    double tangent, secant, square;  // means: of dF/dd, of F/d, of its square [-]
} stiffnesses;

// forces at overlaps 1 % below and above
static void add_forces(stiffnesses *s, const double force[2])
{
    double secant = (force[0] + force[1]) / (2 * OVERLAP * STIFFNESS);
    s->tangent += (force[1] - force[0]) / (0.02 * OVERLAP * STIFFNESS) / ORIENTATIONS;
    s->secant += secant / ORIENTATIONS;
    s->square += secant * secant / ORIENTATIONS;
}

static void print_stiffnesses(const bench *b, const stiffnesses *s)
{
    printf("%6zu  K %7.3f  F/kd %7.3f +- %5.3f\n", b->spheres, s->tangent, s->secant,
           sqrt(fmax(0, s->square - s->secant * s->secant)));
}

static void wall(const bench *b)
{
    model *m = new_model(b, 1, true);
    dem_world *w = model_world(m, 1);
    dem_random r = random_stream(1, 1);
    stiffnesses sum = {0};
    for (int i = 0; i < ORIENTATIONS; i++) {
        dem_quat q = random_quat(&r);
        double force[2];
        for (int k = 0; k < 2; k++) {
            double d = OVERLAP * (1 + 0.02 * (k - 0.5));
            soft_place(w, 0, v3(0, 0, 0), q);
            soft_place(w, 0, v3(0, 0, soft_support(w, 0, v3(0, 0, -1)) - d), q);
            soft_placed(w);
            force[k] = dem_world_bodies(w).force[0].z;
        }
        add_forces(&sum, force);
    }
    print_stiffnesses(b, &sum);
    dem_world_destroy(w);
    model_free(m);
}

static void twin(const bench *b)
{
    model *m = new_model(b, 2, false);
    dem_world *w = model_world(m, 1);
    dem_random r = random_stream(1, 2);
    stiffnesses sum = {0};
    for (int i = 0; i < ORIENTATIONS; i++) {
        dem_quat q[2] = {random_quat(&r), random_quat(&r)};
        dem_vec3 n;
        double x = soft_twin_place(w, q[0], q[1], OVERLAP, &n), force[2];
        for (int k = 0; k < 2; k++) {
            soft_place(w, 1, v3_along(v3(x, 0, 0), -0.02 * OVERLAP * (k - 0.5), n), q[1]);
            soft_placed(w);
            force[k] = v3_dot(dem_world_bodies(w).force[1], n);
        }
        add_forces(&sum, force);
    }
    print_stiffnesses(b, &sum);
    dem_world_destroy(w);
    model_free(m);
}

// speed at which the surfaces part over that at which they meet, along the normal of the first touch
static void bounce(const bench *b)
{
    dem_random r = random_stream(1, 3);
    double mean = 0, square = 0, overlap = 0;
    for (int i = 0; i < ORIENTATIONS; i++) {
        dem_quat q[2] = {random_quat(&r), random_quat(&r)};
        model *m = new_model(b, 2, false);
        dem_world *w = model_world(m, 1);
        dem_vec3 n;
        double x = soft_twin_place(w, q[0], q[1], -1e-6, &n);
        dem_world_destroy(w);
        m->laws[0].damping = DEM_DAMPING_RESTITUTION;
        m->laws[0].restitution = 0.8;
        for (int k = 0; k < 2; k++)
            m->bodies[k].orientation = q[k];
        m->bodies[0].position = v3(0, 0, 0);
        m->bodies[1].position = v3(x, 0, 0);
        double mass = 2500 * DEM_PI / 6 / 2, speed = OVERLAP * sqrt(STIFFNESS / mass);
        m->bodies[1].velocity = v3_scale(n, -speed);
        m->scene.time.step = DEM_PI * sqrt(mass / STIFFNESS) / 400;
        w = model_world(m, 1);
        // the point of first touch, from the deepest pair
        dem_vec3 normal;
        soft_deepest(w, &normal);
        dem_vec3 point = v3_scale(normal, 0);
        double most = 0;
        bool touched = false;
        dem_vec3 arm[2] = {{0}};
        for (int step = 0; step < 4000; step++) {
            run_steps(w, 1);
            if (step % 4)
                continue;
            measured(w);
            size_t count;
            const dem_contact *c = dem_world_contacts(w, &count);
            if (count && !touched) {
                touched = true;
                point = c[0].point;
                normal = v3_scale(c[0].normal, c[0].body == 0 ? 1 : -1);
                for (int k = 0; k < 2; k++)
                    arm[k] = v3_sub(point, dem_world_bodies(w).position[k]);
            }
            for (size_t k = 0; k < count; k++)
                most = fmax(most, c[k].overlap);
            if (touched && !count && step > 300)
                break;
        }
        dem_body_view v = dem_world_bodies(w);
        double after = v3_dot(normal, v3_sub(v3_add(v.velocity[1], v3_cross(v.spin[1], arm[1])),
                                             v3_add(v.velocity[0], v3_cross(v.spin[0], arm[0]))));
        double before = -v3_dot(normal, m->bodies[1].velocity), e = after / before;
        mean += e / ORIENTATIONS;
        square += e * e / ORIENTATIONS;
        overlap += most / ORIENTATIONS;
        dem_world_destroy(w);
        model_free(m);
    }
    printf("%6zu  e %6.4f +- %6.4f  overlap %6.4f\n", b->spheres, mean, sqrt(fmax(0, square - mean * mean)), overlap);
}

// ---- an oblique impact of an ellipsoid on a plane, beside the same of a perfect ellipsoid

static const dem_vec3 SEMI = {0.63, 0.5, 0.396850263};  // x the longest, as in the principal frame
static const double MU = 0.3, RESTITUTION = 0.8;

typedef struct flight {
    dem_vec3 x, v, spin;
    dem_quat q;
} flight;

static dem_vec3 inertia_of(double mass)
{
    double xx = SEMI.x * SEMI.x, yy = SEMI.y * SEMI.y, zz = SEMI.z * SEMI.z;
    return v3(mass * (yy + zz) / 5, mass * (xx + zz) / 5, mass * (xx + yy) / 5);
}

static dem_vec3 by_inverse(dem_quat q, dem_vec3 inertia, dem_vec3 l)
{
    dem_vec3 own = quat_unrotate(q, l);
    return quat_rotate(q, v3(own.x / inertia.x, own.y / inertia.y, own.z / inertia.z));
}

// the lowest point of the surface, from the centre
static dem_vec3 lowest(dem_quat q)
{
    dem_vec3 n = quat_unrotate(q, v3(0, 0, -1)), a = v3(SEMI.x * n.x, SEMI.y * n.y, SEMI.z * n.z);
    double h = v3_norm(a);
    return quat_rotate(q, v3(SEMI.x * a.x / h, SEMI.y * a.y / h, SEMI.z * a.z / h));
}

// with steps so short that their order does not matter
static flight perfect(flight f, double mass, double step, int steps)
{
    dem_vec3 inertia = inertia_of(mass), l, spring = v3(0, 0, 0);
    dem_vec3 own = quat_unrotate(f.q, f.spin);
    l = quat_rotate(f.q, v3(own.x * inertia.x, own.y * inertia.y, own.z * inertia.z));
    double zeta = dem_damping_ratio_cut(RESTITUTION), kt = 2.0 / 7 * STIFFNESS;
    for (int i = 0; i < steps; i++) {
        dem_vec3 r = lowest(f.q), force = v3(0, 0, 0), n = v3(0, 0, 1);
        double depth = -(f.x.z + r.z);
        if (depth > 0) {
            r.z = -f.x.z;  // the contact point is the wall's
            dem_vec3 v = v3_add(f.v, v3_cross(f.spin, r)), arm = v3_cross(r, n);
            double m = 1 / (1 / mass + v3_dot(arm, by_inverse(f.q, inertia, arm)));
            double normal = fmax(0, STIFFNESS * depth - 2 * zeta * sqrt(STIFFNESS * m) * v.z);
            dem_vec3 slip = v3(-v.x, -v.y, 0);
            spring = v3_add(spring, v3_scale(v3_cross(n, spring), 0.5 * step * f.spin.z));
            spring = v3_along(spring, step, slip);
            dem_vec3 drag = v3_along(v3_scale(spring, kt), 2 * zeta * sqrt(kt * m), slip);
            double size = v3_norm(drag), held = kt * v3_norm(spring);
            // the spring keeps what it has below the cap, also while the dashpot slides: as in law/friction.h
            if (size > MU * normal) {
                drag = v3_scale(drag, MU * normal / size);
                if (held > MU * normal)
                    spring = v3_scale(drag, 1 / kt);
            }
            force = v3_add(v3(0, 0, normal), drag);
        } else
            spring = v3(0, 0, 0);
        f.v = v3_along(f.v, step / mass, force);
        l = v3_along(l, step, v3_cross(r, force));
        f.x = v3_along(f.x, step, f.v);
        f.spin = by_inverse(f.q, inertia, l);
        f.q = quat_unit(quat_multiply(quat_about(v3_scale(f.spin, step)), f.q));
        f.spin = by_inverse(f.q, inertia, l);
    }
    return f;
}

static void oblique(const bench *b)
{
    model *m = new_model(b, 1, true);
    m->laws[0].damping = DEM_DAMPING_RESTITUTION;
    m->laws[0].restitution = RESTITUTION;
    m->laws[0].friction = DEM_FRICTION_LINEAR;
    m->laws[0].friction_coefficient = MU;
    double mass = 2500 * 4 * DEM_PI / 3 * SEMI.x * SEMI.y * SEMI.z, t = DEM_PI * sqrt(mass / STIFFNESS);
    m->scene.time.step = t / 2000;  // what the order of the step is to the error is below .001
    m->materials[0].density = 2500;
    dem_world *w = model_world(m, 1);
    dem_random r = random_stream(1, 4);
    double error = 0, speed = OVERLAP * sqrt(STIFFNESS / mass) * sqrt(2);
    for (int i = 0; i < ORIENTATIONS; i++) {
        flight start = {.q = random_quat(&r), .v = v3(speed * sqrt(0.5), 0, -speed * sqrt(0.5))};
        start.x = v3(0, 0, -lowest(start.q).z + 0.2 * OVERLAP);
        flight want = perfect(start, mass, t / 10000, 40000);
        soft_place(w, 0, start.x, start.q);
        soft_placed(w);
        soft_throw(w, 0, start.v);
        run_steps(w, 8000);
        measured(w);
        dem_body_view v = dem_world_bodies(w);
        error += (v3_distance(v.velocity[0], want.v) + 0.5 * v3_distance(v.spin[0], want.spin)) / speed / ORIENTATIONS;
    }
    printf("%6zu  rebound error %6.4f\n", b->spheres, error);
    dem_world_destroy(w);
    model_free(m);
}

// ---- twins that meet obliquely with friction, beside the same of the last clump given with soft contacts, the
// finest

typedef struct rebound {
    dem_vec3 v, spin;  // of the second twin
} rebound;

static rebound finest[ORIENTATIONS];
static double places[ORIENTATIONS];
static dem_vec3 normals[ORIENTATIONS];

static rebound meet(dem_world *w, const dem_quat q[2], int i, double speed, int steps)
{
    dem_vec3 across = v3_normal_to(normals[i]);
    soft_place(w, 0, v3(0, 0, 0), q[0]);
    soft_place(w, 1, v3_along(v3(places[i], 0, 0), 0.5 * OVERLAP, normals[i]), q[1]);
    soft_throw(w, 0, v3(0, 0, 0));
    soft_throw(w, 1, v3_along(v3_scale(normals[i], -speed), 0.6 * speed, across));
    soft_placed(w);
    run_steps(w, steps);
    measured(w);
    dem_body_view v = dem_world_bodies(w);
    return (rebound){v.velocity[1], v.spin[1]};
}

static void twins(const bench *b, bool last)
{
    model *m = new_model(b, 2, false);
    m->laws[0].damping = DEM_DAMPING_RESTITUTION;
    m->laws[0].restitution = RESTITUTION;
    m->laws[0].friction = DEM_FRICTION_LINEAR;
    m->laws[0].friction_coefficient = MU;
    double mass = 2500 * DEM_PI / 6 / 2, t = DEM_PI * sqrt(mass / STIFFNESS), speed = OVERLAP * sqrt(STIFFNESS / mass);
    m->scene.time.step = t / 1000;
    dem_world *w = model_world(m, 1);
    dem_random r = random_stream(1, 6);
    double error = 0;
    for (int i = 0; i < ORIENTATIONS; i++) {
        dem_quat q[2] = {random_quat(&r), random_quat(&r)};
        if (last)
            places[i] = soft_twin_place(w, q[0], q[1], -1e-6, &normals[i]);
        rebound got = meet(w, q, i, speed, 4000);
        if (last)
            finest[i] = got;
        error += (v3_distance(got.v, finest[i].v) + 0.5 * v3_distance(got.spin, finest[i].spin)) / speed / ORIENTATIONS;
    }
    if (!last)
        printf("%6zu  rebound differs from the finest by %6.4f\n", b->spheres, error);
    dem_world_destroy(w);
    model_free(m);
}

// ---- paths

static void paths(const bench *b)
{
    enum { STEPS = 2000, PATHS = 6 };
    model *m = new_model(b, 2, false);
    dem_world *w = model_world(m, 1);
    dem_random r = random_stream(1, 5);
    double work = 0, jump = 0;
    for (int path = 0; path < PATHS; path++) {
        dem_quat q[2] = {random_quat(&r), random_quat(&r)};
        path_figures p = soft_closed_path(w, q[0], q[1], OVERLAP, STEPS);
        work = fmax(work, fabs(p.work) / p.stored);
        jump = fmax(jump, p.jump / p.force);
    }
    printf("%6zu  work / stored %8.1e  largest jump / largest force %7.4f\n", b->spheres, work, jump);
    dem_world_destroy(w);
    model_free(m);
}

// ---- cost: a bed of grains under gravity, microseconds for a body and step in the pass of contacts

static void cost(const bench *b)
{
    enum { SIDE = 6, COUNT = SIDE * SIDE * SIDE };
    model *m = new_model(b, 0, true);
    double scale;
    m->scene.shape_count = 0;
    uint32_t shape = model_of_clump(m, b->clump, &scale);
    m->laws[0].damping = DEM_DAMPING_RESTITUTION;
    m->laws[0].restitution = 0.3;
    m->laws[0].friction = DEM_FRICTION_LINEAR;
    m->laws[0].friction_coefficient = 0.3;
    m->laws[0].stiffness = 1e7;
    model_lattice(m, COUNT, 1.05, 0.2, 1);
    for (size_t i = 0; i < COUNT; i++) {
        m->bodies[i].shape = shape;
        m->bodies[i].scale = scale;
    }
    for (int k = 0; k < 2; k++) {
        dem_vec3 n = v3(k == 0, k == 1, 0);
        model_plane(m, v3(0, 0, 0), n);
        model_plane(m, v3_scale(n, 1.05 * SIDE), v3_scale(n, -1));
    }
    m->scene.gravity = v3(0, 0, -9.81);
    m->scene.time.step = 2e-4;
    dem_world *w = model_world(m, 1);
    run_steps(w, 8000);
    size_t count, contacts = measured(w)->contacts;
    double best[2] = {INFINITY, INFINITY};
    for (int i = 0; i < 5; i++) {
        dem_world_reset_clocks(w);
        run_steps(w, 200);
        const dem_pass_time *t = dem_world_passes(w, &count);
        best[0] = fmin(best[0], t[DEM_PASS_PAIRS].seconds);
        best[1] = fmin(best[1], t[DEM_PASS_REFRESH].seconds + t[DEM_PASS_LISTS].seconds);
    }
    size_t listed = 0;
    for (size_t i = 0; i < w->segment_count; i++)
        listed += w->contacts.segments[i].end - w->contacts.segments[i].begin;
    printf("%6zu  pairs %7.3f us a body and step, lists %7.3f us; %5.2f contacts and %6.1f listed pairs a body\n",
           b->spheres, 1e6 * best[0] / 200 / COUNT, 1e6 * best[1] / 200 / COUNT, (double)contacts / COUNT,
           (double)listed / COUNT);
    dem_world_destroy(w);
    model_free(m);
}

static dem_clump *read_clump(bench *b, const char *file)
{
    dem_clump *clump;
    dem_error error;
    if (dem_clump_read(file, &clump, &error) != DEM_OK) {
        fprintf(stderr, "%s\n", error.text);
        exit(3);
    }
    b->clump = clump;
    b->spheres = dem_clump_view(clump).ball_count;
    return clump;
}

int main(int argc, char **argv)
{
    static const char *const modes[] = {"sum", "mean", "merge", "soft"};
    static const struct {
        const char *name;
        void (*run)(const bench *);
    } cases[] = {{"wall", wall},       {"twin", twin},   {"bounce", bounce},
                 {"oblique", oblique}, {"paths", paths}, {"cost", cost}};
    if (argc < 5)
        return fprintf(stderr, "Usage: bench_soft CASE MODE TAU CLUMP...\n"), 2;
    bench b = {.tau = atof(argv[3])};
    for (int i = 0; i < 4; i++)
        if (strcmp(argv[2], modes[i]) == 0)
            b.mode = (dem_multiple)i;
    bool beside = strcmp(argv[1], "twins") == 0;
    if (beside) {
        dem_multiple mode = b.mode;
        dem_clump *clump = read_clump(&b, argv[argc - 1]);
        b.mode = DEM_MULTIPLE_SOFT;
        twins(&b, true);
        b.mode = mode;
        dem_clump_destroy(clump);
    }
    for (int k = 4; k < argc; k++) {
        dem_clump *clump = read_clump(&b, argv[k]);
        if (beside)
            twins(&b, false);
        for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
            if (strcmp(argv[1], cases[i].name) == 0)
                cases[i].run(&b);
        dem_clump_destroy(clump);
    }
    return 0;
}
