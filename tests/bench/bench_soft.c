// What soft contacts cost and give beside the sum of all, for clumps of one grain with ever more spheres: the tables of
// tests/bench/soft.sh. Prints one line for each clump given.
//   bench_soft CASE MODE TAU CLUMP...     CASE wall|twin|bounce|paths|oblique|cost, MODE sum|mean|merge|soft
#include <time.h>

#include "../soft_cases.h"

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

static void wall(const bench *b)
{
    model *m = new_model(b, 1, true);
    dem_world *w = model_world(m, 1);
    dem_random r = random_stream(1, 1);
    double tangent = 0, secant = 0, square = 0;
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
        double t = (force[1] - force[0]) / (0.02 * OVERLAP * STIFFNESS),
               s = (force[0] + force[1]) / (2 * OVERLAP * STIFFNESS);
        tangent += t / ORIENTATIONS;
        secant += s / ORIENTATIONS;
        square += s * s / ORIENTATIONS;
    }
    printf("%6zu  K %7.3f  F/kd %7.3f +- %5.3f\n", b->spheres, tangent, secant,
           sqrt(fmax(0, square - secant * secant)));
    dem_world_destroy(w);
    model_free(m);
}

static void twin(const bench *b)
{
    model *m = new_model(b, 2, false);
    dem_world *w = model_world(m, 1);
    dem_random r = random_stream(1, 2);
    double tangent = 0, secant = 0, square = 0;
    for (int i = 0; i < ORIENTATIONS; i++) {
        dem_quat q[2] = {random_quat(&r), random_quat(&r)};
        dem_vec3 n;
        double x = soft_twin_place(w, q[0], q[1], OVERLAP, &n), force[2];
        for (int k = 0; k < 2; k++) {
            soft_place(w, 1, v3_along(v3(x, 0, 0), -0.02 * OVERLAP * (k - 0.5), n), q[1]);
            soft_placed(w);
            force[k] = v3_dot(dem_world_bodies(w).force[1], n);
        }
        double t = (force[1] - force[0]) / (0.02 * OVERLAP * STIFFNESS),
               s = (force[0] + force[1]) / (2 * OVERLAP * STIFFNESS);
        tangent += t / ORIENTATIONS;
        secant += s / ORIENTATIONS;
        square += s * s / ORIENTATIONS;
    }
    printf("%6zu  K %7.3f  F/kd %7.3f +- %5.3f\n", b->spheres, tangent, secant,
           sqrt(fmax(0, square - secant * secant)));
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

int main(int argc, char **argv)
{
    static const char *const modes[] = {"sum", "mean", "merge", "soft"};
    static const struct {
        const char *name;
        void (*run)(const bench *);
    } cases[] = {{"wall", wall}, {"twin", twin}, {"bounce", bounce}};
    if (argc < 5)
        return fprintf(stderr, "Usage: bench_soft CASE MODE TAU CLUMP...\n"), 2;
    bench b = {.tau = atof(argv[3])};
    for (int i = 0; i < 4; i++)
        if (strcmp(argv[2], modes[i]) == 0)
            b.mode = (dem_multiple)i;
    for (int k = 4; k < argc; k++) {
        dem_clump *clump;
        dem_error error;
        if (dem_clump_read(argv[k], &clump, &error) != DEM_OK)
            return fprintf(stderr, "%s\n", error.text), 3;
        b.clump = clump;
        b.spheres = dem_clump_view(clump).ball_count;
        for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
            if (strcmp(argv[1], cases[i].name) == 0)
                cases[i].run(&b);
        dem_clump_destroy(clump);
    }
    return 0;
}
