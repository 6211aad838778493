// Soft contacts: restitution and stiffness of one surface do not depend on how many spheres describe it.
#include "study/trial.h"
#include "study/verify.h"

static const double STIFFNESS = 1e5, TAU = 0.0012;  // grains are of about 1 m, overlaps of 5 mm
static const size_t COUNTS[] = {10, 50, 200, 1000};

typedef struct bounce {
    double restitution;  // of the point of contact, along the normal
    double stiffness;    // by the largest force, v sqrt(m_loc k) where nothing is lost, over that of the law
} bounce;

// 1 / m_loc of the point at an arm from the centre, along z
static double inverse_mass(const dem_clump_def *def, dem_quat turn, dem_vec3 arm)
{
    dem_vec3 lever = quat_unrotate(turn, v3_cross(arm, v3(0, 0, 1)));
    return 1 / def->mass + lever.x * lever.x / def->inertia[0] + lever.y * lever.y / def->inertia[1] +
           lever.z * lever.z / def->inertia[2];
}

// the grain, turned by `turn`, comes down on a plane
static bounce drop(dem_trial *t, size_t n, double restitution, dem_quat turn, double speed)
{
    model *m = dem_trial_model(t);
    m->scene.multiple = DEM_MULTIPLE_SOFT;
    m->scene.soft.tau = TAU;
    m->laws[0].stiffness = STIFFNESS;
    m->laws[0].damping = DEM_DAMPING_RESTITUTION;
    m->laws[0].restitution = restitution;
    uint32_t shape = model_ellipsoid(m, n);
    model_plane(m, v3(0, 0, 0), v3(0, 0, 1));
    double lowest = 0;
    dem_clump_def def = {0};
    if (m->status == DEM_OK)
        def = dem_clump_view(m->clumps[shape]);
    for (size_t i = 0; i < def.ball_count; i++)
        lowest = fmax(lowest, def.balls[i].radius - quat_rotate(turn, def.balls[i].centre).z);
    dem_body_def *b = model_body(m, shape, v3(0, 0, lowest + 0.004));
    b->orientation = turn;
    b->velocity = v3(0, 0, -speed);
    m->scene.time.step = 2e-3;
    dem_trial_start(t);
    bounce r = {NAN, NAN};
    dem_vec3 arm = v3(0, 0, 0);
    double most = 0, inverse = 0;
    for (int i = 0; i < 20000 && dem_trial_step(t, 1); i++) {
        size_t count;
        const dem_contact *c = dem_trial_contacts(t, &count);
        dem_motion body = dem_trial_body(t, 0);
        if (most > 0 && !c) {
            r.restitution = (body.velocity.z + v3_cross(body.spin, arm).z) / speed;
            r.stiffness = most * most * inverse / (speed * speed) / STIFFNESS;
            break;
        }
        double force = 0;
        for (size_t k = 0; k < count; k++)
            force += c[k].normal_force;
        if (c)
            arm = v3_sub(c->point, body.position);
        if (c && !(most > 0))
            inverse = inverse_mass(&def, body.orientation, arm);
        most = fmax(most, force);
    }
    return r;
}

static void soft_counts(dem_trial *t)
{
    static const int turns[] = {16, 12, 6, 3};
    for (int i = 0; i < 4; i++) {
        double restitution = 0, stiffness = 0;
        dem_random r = random_stream(4, 1);
        for (int k = 0; k < turns[i]; k++) {
            dem_quat turn = random_quat(&r);
            restitution += drop(t, COUNTS[i], 0.8, turn, 0.05).restitution / turns[i];
            stiffness += drop(t, COUNTS[i], 1, turn, 0.05).stiffness / turns[i];
        }
        dem_expect(t, restitution, 0.8, 0.016, "", "%zu spheres: restitution, asked 0.8", COUNTS[i]);
        dem_expect(t, stiffness, 1, 0.05, "", "%zu spheres: stiffness over that of the law", COUNTS[i]);
    }
}

const dem_case dem_verify_soft[] = {
    {"soft-contacts", "one surface of 10 to 1000 spheres bounces, means over impacts", "the restitution asked", false,
     soft_counts},
    {0},
};
