// One impact at a time against closed forms: bounces, what restitution is asked and what comes, clumps off their
// centre, doubled spheres, the super-ball, masses a million apart. PHYSICS 1.1 to 1.3, 1.13, 6.2 to 6.4.
#include "sim/restitution.h"
#include "study/impacts.h"
#include "study/verify.h"

static const double RADIUS = 0.01;

// a body that comes down on the plane z = 0 with 1 m/s, just above it; steps of `parts` a contact time at mass `mass`
static model *falling(dem_trial *t, double stiffness, double mass, double parts)
{
    model *m = dem_trial_model(t);
    m->laws[0].stiffness = stiffness;
    m->scene.time.step = dem_linear_duration(mass, stiffness) / parts;
    model_plane(m, v3(0, 0, 0), v3(0, 0, 1));
    return m;
}

static dem_body_def *drop(model *m, uint32_t shape, double lowest)
{
    // some part of a step above the plane, so that no phase is special
    dem_body_def *b = model_body(m, shape, v3(0, 0, lowest + 0.37 * m->scene.time.step));
    b->velocity = v3(0, 0, -1);
    return b;
}

static bool touching(dem_trial *t)
{
    const dem_figures *f = dem_trial_figures(t);
    return f->contacts + f->wall_contacts > 0;
}

// steps until the first contact is over; nothing but contacts acts
static dem_motion impact_of(dem_trial *t)
{
    dem_trial_start(t);
    while (dem_trial_step(t, 1) && !touching(t))
        ;
    uint64_t steps = 0;
    while (dem_trial_step(t, 1) && touching(t) && ++steps < 1000000)
        ;
    return dem_trial_body(t, 0);
}

// ---- restitution

static void set_restitution(model *m, double e, dem_tail tail, bool hertz)
{
    m->laws[0].damping = DEM_DAMPING_RESTITUTION;
    m->laws[0].restitution = e;
    m->laws[0].tail = tail;
    if (hertz)
        m->laws[0].normal = DEM_NORMAL_HERTZ;
}

// `phase`: how far from the plane the sphere starts, in steps
static double realised(dem_trial *t, double e, dem_tail tail, bool hertz, double parts, double phase)
{
    double mass = model_ball_mass(RADIUS);
    model *m = falling(t, 1e7, mass, parts);
    set_restitution(m, e, tail, hertz);
    if (hertz)
        m->scene.time.step = dem_hertz_duration(mass, dem_hertz_stiffness(1e9 / (1 - 0.0625), RADIUS), 1) / parts;
    drop(m, model_sphere(m, RADIUS), RADIUS)->position.z = RADIUS + phase * m->scene.time.step;
    return impact_of(t).velocity.z;
}

static const double ASKED[] = {0.1, 0.3, 0.5, 0.7, 0.9};

// with many steps in the contact: of second order, but of 5/4 where the dashpot begins as the fourth root of the
// overlap; without a dashpot of third order: 1.6e-5 and 4.1e-5 at 50 steps (PHYSICS 2.1)
static void restitution_asked(dem_trial *t)
{
    for (int hertz = 0; hertz < 2; hertz++)
        for (int tail = 0; tail < 2; tail++) {
            dem_tail kind = tail ? DEM_TAIL_TENSION : DEM_TAIL_CUT;
            const char *law = hertz ? "hertz" : "linear", *end = tail ? "pulls" : "cut";
            for (int i = 0; i < 5; i++)
                dem_expect(t, realised(t, ASKED[i], kind, hertz, 3200, 0.37), ASKED[i], hertz ? 3e-5 : 1e-6, "",
                           "%s, e = %g, tail %s", law, ASKED[i], end);
            dem_expect(t, realised(t, 1, kind, hertz, 50, 0.37), 1, hertz ? 4.2e-5 : 1.7e-5, "",
                       "%s, e = 1, 50 steps, tail %s", law, end);
            dem_expect(t, realised(t, 1, kind, hertz, 1000, 0.37), 1, 1e-8, "", "%s, e = 1, 1000 steps, tail %s", law,
                       end);
        }
}

// at whatever phase of a step the contact begins: 0.1 % of what it is from e = 0.7 on (PHYSICS 6.2), nowhere off by
// more than 0.0016
static void restitution_at_50_steps(dem_trial *t)
{
    for (int i = 0; i < 5; i++) {
        double off[2] = {0};
        for (double phase = 0.05; phase < 1; phase += 0.1)
            for (int hertz = 0; hertz < 2; hertz++)
                off[hertz] = fmax(off[hertz], fabs(realised(t, ASKED[i], DEM_TAIL_CUT, hertz, 50, phase) - ASKED[i]));
        dem_expect_most(t, off[0], i < 3 ? 1.6e-3 : 1e-3 * ASKED[i], "", "linear, e = %g: off by", ASKED[i]);
        dem_expect_most(t, off[1], 1.6e-3, "", "hertz, e = %g: off by", ASKED[i]);
    }
}

// PHYSICS 1.2: with the damping ratio of a tail that pulls, what comes where the tail is cut; the same column for the
// linear law by a damping rate c = m G, and for both as the speed when the force first is 0
static void tail_that_is_cut(dem_trial *t)
{
    static const double cut[][2] = {
        {0.1, 0.252729}, {0.3, 0.397141}, {0.5, 0.550283}, {0.7, 0.718201}, {0.9, 0.902026}};
    double mass = model_ball_mass(RADIUS), k = 1e7;
    for (int i = 0; i < 5; i++) {
        model *m = falling(t, k, mass, 2000);
        m->laws[0].damping = DEM_DAMPING_RATE;
        m->laws[0].damping_rate = 2 * dem_damping_ratio(cut[i][0]) * sqrt(k / mass);
        drop(m, model_sphere(m, RADIUS), RADIUS);
        dem_expect(t, impact_of(t).velocity.z, cut[i][1], 2e-6, "", "by a rate, e = %g", cut[i][0]);
    }
    for (int hertz = 0; hertz < 2; hertz++)
        for (int i = 0; i < 5; i++) {
            model *m = falling(t, k, mass, 4000);
            set_restitution(m, cut[i][0], DEM_TAIL_TENSION, hertz);
            drop(m, model_sphere(m, RADIUS), RADIUS);
            dem_trial_start(t);
            size_t count = 0;
            const dem_contact *c = NULL;
            while (dem_trial_step(t, 1) && (c = dem_trial_contacts(t, &count), !(count && c->normal_force < 0)))
                ;
            dem_expect(t, dem_trial_body(t, 0).velocity.z, cut[i][1], 4e-4, "", "%s, e = %g, where the force is 0",
                       hertz ? "hertz" : "linear", cut[i][0]);
        }
}

// ---- bounces

// heights and the time in the air of a ball dropped from 1 m, e = 0.7, 50 steps in a contact of 0.1 ms
static void dropped_ball(dem_trial *t)
{
    const double e = 0.7, g = 9.81, contact = 1e-4;
    double mass = model_ball_mass(RADIUS);
    model *m = falling(t, mass * DEM_PI * DEM_PI / (contact * contact), mass, 50);
    m->scene.gravity = v3(0, 0, -g);
    m->scene.output.energy = false;
    set_restitution(m, e, DEM_TAIL_CUT, false);
    model_body(m, model_sphere(m, RADIUS), v3(0, 0, 1 + RADIUS));
    double top[4] = {0}, air = 0, h = m->scene.time.step, fall = 0;
    int bounces = 0;
    bool touched = false;
    dem_trial_start(t);
    while (dem_trial_time(t) < 2.6 && dem_trial_step(t, 1)) {
        dem_motion b = dem_trial_body(t, 0);
        double z = b.position.z - RADIUS;
        bounces += touched && z > 0;
        touched = z < 0;
        air += touched ? 0 : h;
        if (bounces < 4)
            top[bounces] = fmax(top[bounces], z);
        if (bounces == 0 && !touched)  // a fall is exact at the steps
            fall = fmax(fall, fabs(b.velocity.z * b.velocity.z / (2 * g) + z - 1));
    }
    dem_expect_most(t, fall, 1e-10, "m", "first fall: v^2 / 2g + z - 1");  // 1e5 roundings
    double want = 1;
    for (int i = 1; i < 4; i++) {
        want *= e * e;
        dem_expect(t, top[i], want, 2e-3 * i * want, "m", "height after bounce %d", i);
        dem_expect(t, sqrt(top[i] / top[i - 1]), e, 1e-3 * e, "", "restitution of bounce %d", i);
    }
    // the last flights are shorter than a contact; what they leave out is below the tolerance
    dem_expect(t, air, 2.55863397, 1e-3 * 2.55863397, "s", "time in the air");
}

// ---- a dumbbell that hits with one end

static const double APART = 0.03;

// of the contact over that of the body
static double local_mass(double theta)
{
    double ball = model_ball_mass(RADIUS), m = 2 * ball, d = APART / 2 * cos(theta);
    double across = 0.8 * ball * RADIUS * RADIUS + ball * APART * APART / 2;
    return 1 / (1 + m * d * d / across);
}

static dem_motion struck(dem_trial *t, double theta, double stiffness, double e, dem_effective_mass mass, dem_tail tail,
                         double parts)
{
    model *m = falling(t, stiffness, local_mass(theta) * 2 * model_ball_mass(RADIUS), parts);
    set_restitution(m, e, tail, false);
    m->laws[0].effective_mass = mass;
    dem_body_def *b = drop(m, model_dumbbell(m, RADIUS, APART), RADIUS + APART / 2 * sin(theta));
    b->orientation = quat_about(v3(0, -theta, 0));
    if (theta == 0) {
        // a ledge: a bar under one of the two balls
        m->walls[0] = (dem_wall_def){.name = "bar",
                                     .kind = DEM_WALL_CYLINDER,
                                     .point = v3(-APART / 2, 0, -0.005),
                                     .normal = v3(0, 1, 0),
                                     .radius = 0.005,
                                     .outside = true};
    }
    return impact_of(t);
}

// PHYSICS 6.3: tilt [degrees], v', w', mass of the contact over that of the body
static const double STRIKES[][4] = {
    {0, -0.0265306122, 55.1020408, 0.540816327}, {15, 0.00436306702, 54.9135977, 0.557979482},
    {30, 0.0997118156, 53.9082096, 0.610951009}, {45, 0.263576159, 50.5745247, 0.701986755},
    {60, 0.484824903, 42.0233463, 0.824902724},  {75, 0.703132616, 24.9511221, 0.946184787}};

static void dumbbell(dem_trial *t)
{
    for (int i = 0; i < 6; i++) {
        const double *want = STRIKES[i], theta = want[0] * DEM_PI / 180;
        double off[3];
        dem_motion b = {0};
        for (int k = 0; k < 3; k++) {
            b = struck(t, theta, pow(100, k < 2 ? k + 2.5 : 5.5), 0.8, DEM_MASS_LOCAL, DEM_TAIL_CUT, 1000);
            off[k] = (1 + b.velocity.z) / (1 + want[1]) - 1;
        }
        dem_expect(t, b.velocity.z, want[1], 2e-3 * fabs(want[1]) + 1e-6, "m/s", "tilt %g deg: velocity", want[0]);
        dem_expect(t, b.spin.y, want[2], 2e-3 * want[2], "rad/s", "tilt %g deg: spin", want[0]);
        dem_expect(t, off[2], 0, 1e-5, "", "tilt %g deg: impulse, off by", want[0]);
        // nothing aside; the bar is round
        dem_expect_most(t, v3_norm(v3(b.spin.x * RADIUS, b.velocity.x, b.velocity.y)), i ? 1e-11 : 1e-8, "m/s",
                        "tilt %g deg: aside", want[0]);
        if (i)  // flat on a bar it never was off
            dem_expect(t, off[0] / off[1], 10, 1.2, "", "tilt %g deg: a hundred times as stiff, off by 1/", want[0]);
    }
}

// ---- the mass that the dashpot sees

static double end_restitution(dem_motion b, double theta)
{
    return b.velocity.z + APART / 2 * cos(theta) * b.spin.y;
}

static void mass_at_the_contact(dem_trial *t)
{
    for (int i = 0; i < 6; i++)
        dem_expect(t, local_mass(STRIKES[i][0] * DEM_PI / 180), STRIKES[i][3], 5e-9, "", "tilt %g deg: m_loc / m",
                   STRIKES[i][0]);
    // PHYSICS 1.13: a tail that pulls, at no tilt
    static const double asked[2][2] = {{0.8, 0.7378}, {0.5, 0.381881}};
    for (int i = 0; i < 2; i++) {
        double e = asked[i][0];
        dem_motion b = struck(t, 0, 1e9, e, DEM_MASS_BODY, DEM_TAIL_TENSION, 4000);
        dem_expect(t, end_restitution(b, 0), asked[i][1], 2e-4, "", "mass of the body, e = %g", e);
        b = struck(t, 0, 1e9, e, DEM_MASS_LOCAL, DEM_TAIL_TENSION, 1000);
        dem_expect(t, end_restitution(b, 0), e, 1e-5, "", "mass at the contact, e = %g", e);
    }
    // PHYSICS 6.3: a tail that is cut, at 30 degrees
    dem_motion b = struck(t, DEM_PI / 6, 1e9, 0.8, DEM_MASS_BODY, DEM_TAIL_CUT, 4000);
    dem_expect(t, end_restitution(b, DEM_PI / 6), 0.7542, 1e-4, "", "mass of the body, e = 0.8, tilt 30 deg, tail cut");
}

// ---- the automatic step

// whatever the stiffness: fifty steps in the shortest contact give the same restitution (PHYSICS 6.4)
static void stiff_auto_step(dem_trial *t)
{
    for (int hertz = 0; hertz < 2; hertz++)
        for (int i = 0; i < 3; i++) {
            double times = pow(100, i);
            model *m = falling(t, 1e5 * times, 1, 1);
            set_restitution(m, 0.7, DEM_TAIL_CUT, hertz);
            m->materials[0].young = 1e7 * times;
            m->scene.time.step = 0;
            m->scene.time.contact_steps = 50;
            drop(m, model_sphere(m, RADIUS), RADIUS)->position.z = RADIUS + 1e-5;
            dem_expect(t, impact_of(t).velocity.z, 0.7, 2e-3 * 0.7, "", "%s, stiffness times %g",
                       hertz ? "hertz" : "linear", times);
        }
}

// ---- several spheres in one place

// `count` balls in the place of one, with its mass
static uint32_t pile(model *m, size_t count)
{
    dem_ball balls[MODEL_CLOUD];
    for (size_t i = 0; i < count; i++)
        balls[i] = (dem_ball){{0, 0, 0}, RADIUS};
    double mass = model_ball_mass(RADIUS), i = 0.4 * mass * RADIUS * RADIUS;
    return model_clump(m, balls, count, mass, (double[]){i, i, i});
}

static dem_motion pile_impact(dem_trial *t, size_t count, dem_multiple multiple, double e, bool pair, bool rough)
{
    double mass = model_ball_mass(RADIUS) / (pair ? 2 : 1);
    double alike = multiple == DEM_MULTIPLE_SUM ? (double)(pair ? count * count : count) : 1;
    model *m = falling(t, 1e7, mass / alike, 4000);
    m->scene.multiple = multiple;
    set_restitution(m, e, DEM_TAIL_TENSION, false);
    uint32_t shape = pile(m, count);
    dem_body_def *b = drop(m, shape, RADIUS);
    if (rough) {
        m->laws[0].friction = DEM_FRICTION_LINEAR;
        m->laws[0].friction_coefficient = 0.3;
        b->velocity = v3(0.4, 0.2, -1);
        b->spin = v3(10, -20, 5);
    }
    if (pair) {
        m->scene.wall_count = 0;
        b = model_body(m, shape, v3(0, 0, -RADIUS));
        b->spin = v3(rough ? 3 : 0, 0, 0);
    }
    return impact_of(t);
}

// the damping ratio grows with the root of the number; 4000 steps, of first order where several share a mass
static void coincident_sum(dem_trial *t)
{
    static const double table[][3] = {{0.9, 2, 0.861495}, {0.9, 4, 0.809711}, {0.9, 9, 0.727957}, {0.5, 2, 0.366035},
                                      {0.5, 3, 0.282619}, {0.5, 4, 0.223095}, {0.5, 9, 0.0698621}};
    for (int i = 0; i < 7; i++)
        dem_expect(t, pile_impact(t, (size_t)table[i][1], DEM_MULTIPLE_SUM, table[i][0], false, false).velocity.z,
                   table[i][2], 2e-4, "", "%g in one place, e = %g", table[i][1], table[i][0]);
    // two such on each other: the square of the number
    dem_expect(t, 1 + 2 * pile_impact(t, 2, DEM_MULTIPLE_SUM, 0.9, true, false).velocity.z, 0.809711, 4e-5, "",
               "2 against 2, e = 0.9");
}

static void coincident_as_one(dem_trial *t)
{
    static const size_t counts[] = {2, 9, 40};
    for (int pair = 0; pair < 2; pair++) {
        dem_motion one = pile_impact(t, 1, DEM_MULTIPLE_SUM, 0.6, pair, true);
        for (int multiple = DEM_MULTIPLE_MEAN; multiple <= DEM_MULTIPLE_MERGE; multiple++)
            for (int i = 0; i < 3 - pair; i++) {
                dem_motion b = pile_impact(t, counts[i], (dem_multiple)multiple, 0.6, pair, true);
                const char *name = multiple == DEM_MULTIPLE_MEAN ? "mean" : "merge",
                           *where = pair ? "on as many" : "on a plane";
                dem_expect_most(t, v3_distance(b.velocity, one.velocity), 1e-12, "m/s", "%s, %zu %s: velocity", name,
                                counts[i], where);
                dem_expect_most(t, v3_distance(b.spin, one.spin), 1e-10, "rad/s", "%s, %zu %s: spin", name, counts[i],
                                where);
            }
    }
}

// ---- the super-ball

// without a cap and damping the contact point's slip turns by the phase of the tangential spring (PHYSICS 1.1). The
// spring still pulls when the contact ends, somewhere within a step: 2e4 steps, of first order. Soft enough for that,
// stiff enough for an overlap of 3e-6 of the radius, which the arm of the force loses.
static void super_ball(dem_trial *t)
{
    static const double table[][2] = {
        {2. / 7, -1}, {0.5, -0.528177}, {2. / 3, 0.0863653}, {1, 0.918786}, {0.1, -0.283839}};
    for (int i = 0; i < 5; i++) {
        model *m = falling(t, 1e9, model_ball_mass(RADIUS), 20000);
        m->laws[0].friction = DEM_FRICTION_LINEAR;
        m->laws[0].friction_coefficient = 1e9;
        m->laws[0].stiffness_ratio = table[i][0];
        dem_body_def *b = drop(m, model_sphere(m, RADIUS), RADIUS);
        b->velocity = v3(3e-4, 0, -0.01);
        b->spin = v3(0, 0.01, 0);
        dem_motion r = impact_of(t);
        double before = 3e-4 - 0.01 * RADIUS, after = r.velocity.x - RADIUS * r.spin.y;
        dem_expect(t, after / before, table[i][1], 2e-4, "", "k_t / k_n = %.4g: slip kept", table[i][0]);
        dem_expect(t, r.velocity.z, 0.01, 1e-9, "m/s", "k_t / k_n = %.4g: rebound", table[i][0]);
    }
}

// ---- a million to one

static void mass_ratio(dem_trial *t)
{
    model *m = dem_trial_model(t);
    m->laws[0].stiffness = 1e7;
    model_sphere(m, 1);
    model_sphere(m, 0.01);
    m->scene.time.step = dem_linear_duration(model_ball_mass(0.01), 1e7) / 8000;
    model_body(m, 0, v3(0, 0, 0));
    model_body(m, 1, v3(1.01 + 1e-7, 0, 0))->velocity = v3(-1, 0, 0);
    dem_trial_start(t);
    dem_trial_step(t, 12000);
    dem_expect(t, (double)dem_trial_figures(t)->contacts, 0, 0, "", "contacts left");
    dem_expect(t, dem_trial_body(t, 1).velocity.x, 0.999998000002, 1e-9, "m/s", "light ball after the impact");
    dem_expect(t, dem_trial_body(t, 0).velocity.x, -1.999998e-6, 2e-15, "m/s", "heavy ball after the impact");
}

// weights 1e6 apart on one vertical: nothing creeps, nothing leaves the vertical
static void heavy_on_light(dem_trial *t)
{
    model *m = dem_trial_model(t);
    const double k = 1e9, g = 9.81;
    double heavy = model_ball_mass(1), light = model_ball_mass(0.01);
    m->laws[0].stiffness = k;
    m->laws[0].friction = DEM_FRICTION_LINEAR;
    m->laws[0].friction_coefficient = 0.5;
    set_restitution(m, 0.5, DEM_TAIL_CUT, false);
    m->scene.gravity = v3(0, 0, -g);
    m->scene.time.step = 5e-7;
    model_sphere(m, 1);
    model_sphere(m, 0.01);
    model_plane(m, v3(0, 0, 0), v3(0, 0, 1));
    double low = 0.01 - (heavy + light) * g / k;
    model_body(m, 1, v3(0, 0, low));
    model_body(m, 0, v3(0, 0, low + 1.01 - heavy * g / k));
    dem_trial_start(t);
    dem_vec3 x = dem_trial_body(t, 1).position;
    dem_trial_step(t, 200000);  // three periods of the heavy one
    // what is left of its weight is a rounding of its position: 1e-16 m times k
    dem_expect_most(t, v3_distance(dem_trial_body(t, 1).position, x), 1e-15, "m", "way of the light ball");
    dem_expect_most(t, v3_norm(dem_trial_body(t, 1).velocity), 1e-11, "m/s", "its speed");
    dem_vec3 top = dem_trial_body(t, 0).position;
    dem_expect(t, hypot(top.x, top.y), 0, 0, "m", "the heavy ball beside the vertical");
}

// three balls at the corners of a triangle fly to its middle: it stays a triangle
static void three_at_once(dem_trial *t)
{
    model *m = dem_trial_model(t);
    uint32_t ball = model_sphere(m, RADIUS);
    for (int i = 0; i < 3; i++) {
        dem_vec3 out = v3(cos(2 * DEM_PI * i / 3), sin(2 * DEM_PI * i / 3), 0);
        dem_body_def *b = model_body(m, ball, v3_scale(out, 1.2 * RADIUS));
        b->velocity = v3_scale(out, -1);
        b->spin = v3(0, 0, 20);
    }
    m->laws[0].friction = DEM_FRICTION_LINEAR;
    m->laws[0].friction_coefficient = 0.4;
    dem_trial_start(t);
    dem_trial_step(t, 2000);
    double off = 0;
    dem_motion first = dem_trial_body(t, 0);
    for (int i = 1; i < 3; i++) {
        dem_motion b = dem_trial_body(t, (size_t)i);
        dem_quat turn = quat_about(v3(0, 0, 2 * DEM_PI * i / 3));
        off = fmax(off, v3_distance(b.velocity, quat_rotate(turn, first.velocity)));
        off = fmax(off, v3_distance(b.position, quat_rotate(turn, first.position)));
    }
    dem_expect_most(t, off, 1e-13, "m, m/s", "off the threefold symmetry");
    dem_expect_least(t, first.velocity.x, 0.5, "m/s", "speed outwards");
}

const dem_case dem_verify_impacts[] = {
    {"restitution-asked", "the restitution asked is the one that comes", "oscillator with a dashpot", false,
     restitution_asked},
    {"restitution-50-steps", "fifty steps in a contact are enough for it", "leapfrog's error", false,
     restitution_at_50_steps},
    {"restitution-tail", "a tail that is cut bounces higher", "Schwager & Poeschel 2007", false, tail_that_is_cut},
    {"drop", "heights and times of a ball dropped from 1 m, e = 0.7", "free fall", false, dropped_ball},
    {"dumbbell", "a dumbbell that hits with one end, at six tilts", "rigid impact", false, dumbbell},
    {"local-mass", "the mass that a contact's dashpot sees", "rigid impact", false, mass_at_the_contact},
    {"stiff-auto-step", "stiffness times 1e4 with an automatic step", "the restitution asked", false, stiff_auto_step},
    {"coincident-sum", "spheres in one place add up", "damping ratio by the root of their number", false,
     coincident_sum},
    {"coincident-mean-merge", "averaged or merged, spheres in one place are one sphere", "one sphere", false,
     coincident_as_one},
    {"super-ball", "slip turned by the tangential spring", "oscillator of 2/7 of the mass", false, super_ball},
    {"mass-ratio", "masses a million apart, head on", "momentum and energy", false, mass_ratio},
    {"heavy-on-light", "a heavy ball rests on a light one", "statics", false, heavy_on_light},
    {"three-balls", "three balls that meet in the middle", "symmetry", false, three_at_once},
    {0},
};
