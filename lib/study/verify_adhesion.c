// Adhesion of soft spheres: the curve and the landmarks of Johnson, Kendall & Roberts (1971), the work of a cycle, what
// becomes of spheres that meet; Derjaguin, Muller & Toporov (1975). PHYSICS 1.4, 1.5.
#include "study/trial.h"
#include "study/verify.h"

static const double W = 0.05, R = 1e-4, MODULUS = 1e7;  // w [J/m^2], R* [m], E* [Pa]

// PHYSICS 1.4, for these
static const double PULL_OFF = 2.35619449e-5, PARTING = -2.18343959e-7, AT_PULL_OFF = -1.04968827e-7,
                    FORCELESS = 2.6450487e-7;

// two spheres whose R* is R, `overlap` deep, that come together with `speed` along x; heavy ones do not feel each other
static model *soft_pair(dem_trial *t, dem_normal_law law, double density, double overlap, double speed)
{
    model *m = dem_trial_model(t);
    m->materials[0] = (dem_material){"soft", density, 2 * MODULUS * (1 - 0.3 * 0.3), 0.3};
    m->laws[0] = dem_pair_law_defaults();
    m->laws[0].normal = law;
    m->laws[0].work_of_adhesion = W;
    uint32_t ball = model_sphere(m, 2 * R);
    model_body(m, ball, v3(0, 0, 0))->velocity = v3(speed / 2, 0, 0);
    model_body(m, ball, v3(4 * R - overlap, 0, 0))->velocity = v3(-speed / 2, 0, 0);
    return m;
}

// the contact radius at an overlap, by bisection above where the surfaces part
static double radius_at(double overlap)
{
    double low = cbrt(DEM_PI * W * R * R / (8 * MODULUS)), high = 100 * low;
    for (int i = 0; i < 100; i++) {
        double a = (low + high) / 2;
        *(a * a / R - sqrt(2 * DEM_PI * W * a / MODULUS) < overlap ? &low : &high) = a;
    }
    return low;
}

static double jkr_force(double overlap)
{
    double a = radius_at(overlap);
    return 4 * MODULUS * a * a * a / (3 * R) - sqrt(8 * DEM_PI * W * MODULUS * a * a * a);
}

typedef struct sweep {
    double work;             // of the force over the way [J]
    double least, at_least;  // the smallest force and where
    double first, last;      // overlaps of the first and of the last contact
    double forceless;        // overlap where the force changes its sign
    double off;              // largest distance from the curve [N]
    double first_force;
} sweep;

// moves two heavy spheres at a steady speed, slowly against nothing, and reads the force of their contact
static sweep sweep_of(dem_trial *t, dem_normal_law law, double from, double speed, double way)
{
    sweep s = {.least = INFINITY, .first = NAN, .last = NAN, .forceless = NAN};
    double before = 0, overlap = from, done = 0;
    model *m = soft_pair(t, law, 1e18, from, speed);
    m->scene.time.step = 2e-11 / fabs(speed);
    dem_trial_start(t);
    while (done < way && dem_trial_step(t, 1)) {
        size_t count;
        const dem_contact *c = dem_trial_contacts(t, &count);
        double gap = dem_trial_body(t, 1).position.x - dem_trial_body(t, 0).position.x - 4 * R;
        double force = c ? c->normal_force : 0;
        done += fabs(-gap - overlap);
        s.work += (before + force) / 2 * (-gap - overlap);
        if (c) {
            s.first_force = isnan(s.first) ? force : s.first_force;
            s.first = isnan(s.first) ? -gap : s.first;
            s.last = -gap;
            s.off = fmax(s.off, fabs(force - jkr_force(-gap)));
            if (before > 0 && force <= 0 && speed < 0)
                s.forceless = overlap + (-gap - overlap) * before / (before - force);
        }
        if (force < s.least) {
            s.least = force;
            s.at_least = -gap;
        }
        before = force;
        overlap = -gap;
    }
    return s;
}

static void jkr_pull_off(dem_trial *t)
{
    sweep apart = sweep_of(t, DEM_NORMAL_JKR, 4e-7, -1e-3, 4e-7 + 2.5e-7),
          together = sweep_of(t, DEM_NORMAL_JKR, -2.5e-7, 1e-3, 4e-7);
    // of a step: 2e-11 m of 1e-7 m; the least is flat
    dem_expect(t, -apart.least, PULL_OFF, 1e-6 * PULL_OFF, "N", "pull-off force, 3/2 pi w R*");
    dem_expect(t, apart.at_least, AT_PULL_OFF, 5e-10, "m", "overlap there");
    dem_expect(t, apart.last, PARTING, 3e-11, "m", "overlap at parting");
    dem_expect(t, apart.forceless, FORCELESS, 1e-12, "m", "overlap without force");
    dem_expect(t, together.first, 0, 3e-11, "m", "overlap where they attach");
    dem_expect(t, together.first_force / PULL_OFF, -8.0 / 9, 1e-3, "", "force there over the pull-off force");
}

static void jkr_curve(dem_trial *t)
{
    static const double table[][2] = {// PHYSICS' jkr_curve: overlap, force over the pull-off force
                                      {-2.14516104e-07, -0.678160575}, {-1.60796659e-07, -0.950803987},
                                      {-2.54281872e-08, -0.933155424}, {1.16191701e-07, -0.582886308},
                                      {2.93993454e-07, 0.137019435},   {3.75082891e-07, 0.545600853}};
    for (size_t i = 0; i < sizeof table / sizeof *table; i++)
        dem_expect(t, jkr_force(table[i][0]) / PULL_OFF, table[i][1], 1e-7, "", "closed form at %g m", table[i][0]);
    sweep apart = sweep_of(t, DEM_NORMAL_JKR, 4e-7, -1e-3, 4e-7 + 2.1e-7);
    dem_expect_most(t, apart.off / PULL_OFF, 1e-7, "",
                    "largest distance of the contact from it, over the pull-off force");
}

static double cycle_work(void)
{
    return 7.09219597 * cbrt(pow(W, 5) * pow(R, 4) / (MODULUS * MODULUS));
}

static void jkr_work(dem_trial *t)
{
    sweep together = sweep_of(t, DEM_NORMAL_JKR, -1e-8, 1e-3, 2.1e-7),
          apart = sweep_of(t, DEM_NORMAL_JKR, 2e-7, -1e-3, 4.5e-7);
    double unit = cbrt(pow(W, 5) * pow(R, 4) / (MODULUS * MODULUS));
    dem_expect(t, (together.work + apart.work) / unit, 7.09219597, 5e-3, "",
               "work of a cycle, over (w^5 R*^4 / E*^2)^(1/3)");
}

// slower than sqrt(2 W / m*) they stick
static void jkr_sticking(dem_trial *t)
{
    double mass = 2500 * 4 * DEM_PI / 3 * 8 * R * R * R, critical = sqrt(2 * cycle_work() / (mass / 2));
    for (int fast = 0; fast < 2; fast++) {
        double v = critical * (fast ? 1.5 : 0.9);
        model *m = soft_pair(t, DEM_NORMAL_JKR, 2500, -1e-8, v);
        m->scene.time.step = 2e-8;
        dem_trial_start(t);
        dem_trial_step(t, 12000);
        double apart = dem_trial_body(t, 1).velocity.x - dem_trial_body(t, 0).velocity.x;
        if (fast)
            dem_expect(t, apart / critical, sqrt(1.5 * 1.5 - 1), 0.01 * sqrt(1.25), "",
                       "1.5 times the sticking speed: over it after");
        else
            dem_expect(t, (double)dem_trial_figures(t)->contacts, 1, 0, "",
                       "0.9 times the sticking speed: contacts left");
    }
}

static void dmt(dem_trial *t)
{
    sweep together = sweep_of(t, DEM_NORMAL_DMT, -1e-9, 1e-3, 3e-7),
          apart = sweep_of(t, DEM_NORMAL_DMT, 3e-7, -1e-3, 3.1e-7);
    double pull = 2 * DEM_PI * W * R, work = 8.0 / 15 * MODULUS * sqrt(R) * pow(3e-7, 2.5) - pull * 3e-7;
    dem_expect(t, -apart.least, pull, 1e-4 * pull, "N",
               "pull-off force, 2 pi w R*");  // Hertz' part of a step's overlap
    dem_expect(t, -together.first_force, pull, 1e-4 * pull, "N", "force where they meet");
    dem_expect(t, apart.last, 0, 3e-11, "m", "overlap at parting");
    dem_expect(t, apart.work, -work, 2e-3 * fabs(work), "J",
               "work on the way apart, 8/15 E* sqrt(R*) d^2.5 - 2 pi w R* d");
}

const dem_case dem_verify_adhesion[] = {
    {"jkr-pull-off", "pull-off force, parting, attaching", "Johnson, Kendall & Roberts 1971", false, jkr_pull_off},
    {"jkr-curve", "the force over the overlap", "Johnson, Kendall & Roberts 1971", false, jkr_curve},
    {"jkr-work", "work lost in a cycle of attaching and parting", "Thornton & Ning 1998", false, jkr_work},
    {"jkr-sticking", "spheres stick below a speed and lose the work above", "Thornton & Ning 1998", false,
     jkr_sticking},
    {"dmt", "pull-off force and work", "Derjaguin, Muller & Toporov 1975", false, dmt},
    {0},
};
