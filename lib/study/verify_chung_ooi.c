// The impacts of Chung & Ooi (2011), Granular Matter 13:643: closed forms, what the paper's curves say as Kratos keeps
// them (read off printed figures), and sliding throughout, which is exact with any law. PHYSICS 6.1.
#include <stdio.h>

#include "study/chung_ooi.h"
#include "study/verify.h"

// ---- tests 1, 2, 3 and 9: normal impacts

static void expect_elastic(dem_trial *t, const char *name, impact c, double force, double overlap, double duration)
{
    rebound b = dem_impact_watch(t, &c, 1, NULL);
    // the largest of the samples is below the top by (pi / (2 N))^2 / 2; nine digits are printed. Leapfrog's error of
    // the phase is of the order of N^-2, too
    double sampling = 1e-8 + pow(DEM_PI / 2 / c.steps, 2), phase = 1e-8 + 1 / c.steps / c.steps;
    dem_expect(t, b.force, force, sampling * force, "N", "%s: largest force", name);
    dem_expect(t, b.overlap, overlap, sampling * overlap, "m", "%s: largest overlap", name);
    dem_expect(t, b.duration, duration, phase * duration, "s", "%s: duration", name);
    dem_expect(t, b.velocity.z / -c.velocity.z, 1, phase, "", "%s: restitution", name);
    if (c.partner_radius > 0)
        dem_expect(t, b.partner_velocity.z / -c.partner_velocity.z, 1, phase, "", "%s: restitution of the partner",
                   name);
}

// mean distance of a curve from points of a figure, over the mean of these; times in us, forces in kN
static double off_points(const impact_curve *curve, const double (*points)[2], size_t count)
{
    double off = 0, sum = 0;
    for (size_t i = 0; i < count; i++) {
        double time = points[i][0] * 1e-6, force = 0;
        for (size_t k = 1; k < curve->count; k++)
            if (curve->time[k - 1] <= time && time <= curve->time[k])
                force = curve->force[k - 1] + (curve->force[k] - curve->force[k - 1]) * (time - curve->time[k - 1]) /
                                                  (curve->time[k] - curve->time[k - 1]);
        off += fabs(force - points[i][1] * 1e3);
        sum += fabs(points[i][1] * 1e3);
    }
    return off / sum;
}

// Kratos itself comes within 0.3 %, Hertz' exact curve within 0.9 %
static void expect_curve(dem_trial *t, impact c, const double (*points)[2], size_t count)
{
    impact_curve *curve = calloc(1, sizeof *curve);
    c.steps = 1000;
    if (curve)
        dem_impact_watch(t, &c, 1, curve);
    if (!curve)
        t->status = dem_fail_memory(&t->error);
    else
        dem_expect_most(t, off_points(curve, points, count), 0.01, "", "force over time, from the paper's figure");
    free(curve);
}

static void pairs(dem_trial *t)
{
    static const double figure[][2] = {
        {2.4402, 0.73743}, {3.8756, 1.5196}, {6.244, 3.1285},  {8.4689, 4.8045}, {10.622, 6.4358}, {12.632, 7.8883},
        {14.569, 9.0726},  {16.507, 9.9665}, {18.445, 10.525}, {19.45, 10.682},  {20.455, 10.704}, {21.459, 10.637},
        {22.321, 10.48},   {23.254, 10.235}, {25.191, 9.4749}, {27.201, 8.3575}, {29.139, 7.0391}, {31.22, 5.4525},
        {33.373, 3.8212},  {35.813, 2.0782}, {37.177, 1.2737}, {38.612, 0.55866}};
    expect_elastic(t, "glass", on_twin(0.01, GLASS, 10, 0.35, 1), 10696.8890, 2.74112703e-4, 4.03394557e-5);
    expect_elastic(t, "limestone", on_twin(0.01, LIMESTONE, 10, 0.35, 1), 7108.24128, 3.68304026e-4, 5.42010049e-5);
    expect_curve(t, on_twin(0.01, GLASS, 10, 0.35, 1), figure, sizeof figure / sizeof *figure);
}

static void on_planes(dem_trial *t)
{
    static const double figure[][2] = {
        {32.808, 0.51885}, {84.846, 2.2123}, {129.14, 4.0641}, {169.57, 5.8935}, {209.05, 7.6099}, {246.61, 9.1004},
        {283.23, 10.229},  {318.92, 10.997}, {337.26, 11.222}, {355.61, 11.357}, {373, 11.357},    {391.37, 11.243},
        {409.74, 11.017},  {427.16, 10.722}, {445.55, 10.281}, {463.95, 9.7496}, {501.73, 8.4604}, {539.54, 6.8548},
        {579.3, 5.091},    {621, 3.2367},    {644.26, 2.3321}, {668.49, 1.4048}, {694.64, 0.61315}};
    expect_elastic(t, "alloy", on_plane(0.1, ALLOY, 0.2, 0, 1), 11369.8583, 4.97171752e-5, 7.31656641e-4);
    expect_elastic(t, "magnesium", on_plane(0.1, MAGNESIUM, 0.2, 0, 1), 7232.68103, 5.21232883e-5, 7.67065906e-4);
    expect_curve(t, on_plane(0.1, ALLOY, 0.2, 0, 1), figure, sizeof figure / sizeof *figure);
}

static void expect_restitutions(dem_trial *t, bool twin)
{
    const dem_material materials[] = {OXIDE, IRON};
    for (int i = 0; i < 2; i++)
        for (int k = 0; k <= 5; k++)
            for (int tail = 0; tail < 2; tail++) {
                double e = k / 5.0;
                impact c = (twin ? on_twin : on_plane)(0.0025, materials[i], 3.9, 0, e);
                c.law.tail = tail ? DEM_TAIL_TENSION : DEM_TAIL_CUT;
                if (k == 0 && tail)
                    continue;
                // dashpots see velocities half a step old: an error of the order of zeta / N. And nothing that cannot
                // pull stops a body: of what shall not bounce at all a hundredth is left
                dem_expect(t, dem_impact_run(t, &c).velocity.z / 3.9, e > 0 ? e : 0.01, e > 0 ? 2 / STEPS : 1e-3, "",
                           "%s, e = %g, tail %s", materials[i].name, e, tail ? "pulls" : "cut");
            }
}

static void damped_on_plane(dem_trial *t)
{
    expect_restitutions(t, false);
}
static void damped_pair(dem_trial *t)
{
    expect_restitutions(t, true);
}

// ---- test 4

// with a modulus so high that the overlap does not count, as the reference has it
static void oblique_on_plane(dem_trial *t)
{
    static const double quoted[][3] = {{15, 0.63485, -368.58}, {30, 0.68474, -614.753}, {60, 0.89483, -355.212}};
    // angle [deg], kept, spin [rad/s], angle after [deg] of the paper's figures
    static const double figure[][4] = {
        {5, 0.94811, -19.266, 3.7613},   {10, 0.68699, -213, -1.5559},    {15, 0.62438, -377.83, -5.5438},
        {20, 0.61614, -510.55, -7.5378}, {25, 0.63427, -599.39, -7.5378}, {30, 0.68369, -616.51, -3.5498},
        {35, 0.73723, -582.26, 3.429},   {40, 0.78089, -544.8, 11.571},   {50, 0.84514, -457.03, 29.35},
        {60, 0.89292, -357.49, 47.795},  {70, 0.93163, -246.18, 64.577},  {80, 0.96623, -126.3, 78.701},
        {85, 0.9827, -63.15, 84.517}};
    for (int i = 0; i < 3; i++) {
        impact c = oblique(quoted[i][0], STIFF);
        rebound b = dem_impact_run(t, &c);
        oblique_figures o = oblique_of(&c, &b);
        dem_expect(t, o.kept, quoted[i][1], 1e-3, "", "%g deg: v_t kept", quoted[i][0]);
        dem_expect(t, o.spin, quoted[i][2], 1e-3 * 614.753, "rad/s", "%g deg: spin", quoted[i][0]);
    }
    double off[3] = {0}, sum[3] = {0};
    for (size_t i = 0; i < sizeof figure / sizeof *figure; i++) {
        impact c = oblique(figure[i][0], 1);
        rebound b = dem_impact_run(t, &c);
        oblique_figures o = oblique_of(&c, &b);
        const double got[3] = {o.kept, o.spin, o.angle_deg};
        for (int k = 0; k < 3; k++) {
            off[k] += fabs(got[k] - figure[i][1 + k]);
            sum[k] += fabs(figure[i][1 + k]);
        }
    }
    // what Kratos asks of itself
    dem_expect_most(t, off[0] / sum[0], 0.016, "", "v_t kept, from the paper's figure");
    dem_expect_most(t, off[1] / sum[1], 0.022, "", "spin, from the paper's figure");
    dem_expect_most(t, off[2] / sum[2], 0.025, "", "angle of rebound, from the paper's figure");
}

// ---- test 5

static slip_figures slipping(dem_trial *t, dem_material material, double psi1, double times)
{
    impact c = tangential(material, psi1, times, true);
    rebound b = dem_impact_run(t, &c);
    return slip_figures_of(&c, &b);
}

static void tangential_on_plane(dem_trial *t)
{
    const dem_material materials[] = {STEEL, POLYETHYLENE};
    for (int i = 0; i < 2; i++) {
        for (double psi1 = 7; psi1 <= 20; psi1 += 6.5) {
            slip_figures f = slipping(t, materials[i], psi1, STIFF);
            // the overlap is 1e-6 to 1e-5 of the radius; leapfrog's error is that of the rebound
            dem_expect(t, f.psi2, psi1 - 7, 4e-5, "", "%s, psi1 = %g: psi2", materials[i].name, psi1);
            dem_expect(t, f.spin, -5, 4e-5, "", "%s, psi1 = %g: R w / (mu v_n)", materials[i].name, psi1);
        }
        slip_figures f = slipping(t, materials[i], 6, STIFF);
        dem_expect(t, f.psi2, -0.99, 0.01, "", "%s, psi1 = 6: psi2", materials[i].name);
    }
    // read off figures: half a percent of their height
    static const double psi[][2] = {{6, -1.0133}, {9.9879, 3.0133}, {12.961, 6.0133}};
    static const double spin[][2] = {{6.0058, -5.0062}, {10.012, -5.0041}, {20, -4.9905}};
    for (int i = 0; i < 3; i++) {
        dem_expect(t, slipping(t, STEEL, psi[i][0], 1).psi2, psi[i][1], 0.07, "", "figure, psi1 = %g: psi2", psi[i][0]);
        dem_expect(t, slipping(t, STEEL, spin[i][0], 1).spin, spin[i][1], 0.07, "", "figure, psi1 = %g: R w / (mu v_n)",
                   spin[i][0]);
    }
}

// ---- tests 6 to 8

static double beta_of(dem_trial *t, impact c)
{
    rebound b = dem_impact_run(t, &c);
    return spin_figures_of(&c, &b).beta;
}

static const double SLIDING_DEG[] = {65, 70, 75, 80, 85};
enum { SLIDING = 5 };

// 3.5 mu (1 + e) v_n / v_t
static double slide_of(double angle_deg)
{
    return 3.5 * 0.4 * 1.5 / tan(angle_deg * DEM_PI / 180);
}

static void spinning_on_plane(dem_trial *t)
{
    const dem_material materials[] = {ALLOY_6, NYLON};
    static const double figure[2][SLIDING] = {{-0.0277090, -0.2428, -0.44472, -0.63347, -0.82003},
                                              {-0.025514, -0.2428, -0.44252, -0.63786, -0.82442}};
    for (int i = 0; i < 2; i++)
        for (int k = 0; k < SLIDING; k++) {
            double angle = SLIDING_DEG[k];
            const char *name = materials[i].name;
            // leapfrog's error of the restitution, and overlap / R
            dem_expect(t, beta_of(t, spinning(stiffer(materials[i], STIFF), angle)), slide_of(angle) - 1, 2 / STEPS, "",
                       "%s, %g deg: beta = X - 1", name, angle);
            dem_expect(t, beta_of(t, spinning(materials[i], angle)), figure[i][k], 0.03, "", "%s, %g deg: figure", name,
                       angle);
        }
}

static void spinning_against_each_other(dem_trial *t)
{
    double worst[3] = {0};
    for (int i = 1; i <= 17; i++) {
        impact c = on_twin(0.1, ALLOY_6, 0.2, 0.4, 0.5);
        double spin = 2 * tan(i * 5 * DEM_PI / 180);  // 0.175 to 22.86 rad/s
        c.spin = v3(0, spin, 0);
        c.partner_spin = v3(0, -spin, 0);
        c.steps = 1000;
        rebound b = dem_impact_run(t, &c);
        worst[0] = fmax(worst[0], fmax(fabs(b.spin.y - spin), fabs(b.partner_spin.y + spin)));
        worst[1] = fmax(worst[1], fmax(fabs(b.velocity.x), fabs(b.partner_velocity.x)));
        worst[2] = fmax(worst[2], fabs(b.velocity.z / 0.2 - 0.5));
    }
    // the surfaces roll on each other: nothing but rounding
    dem_expect_most(t, worst[0], 1e-10, "rad/s", "largest change of 17 spins");
    dem_expect_most(t, worst[1], 1e-12, "m/s", "largest speed aside");
    dem_expect_most(t, worst[2], 10 / 1000.0, "", "restitution, off by");
}

static void spinning_on_larger(dem_trial *t)
{
    static const double figure[SLIDING] = {-0.017323, -0.2378, -0.43937, -0.62625, -0.81522};
    for (int heavy = 0; heavy < 2; heavy++)
        for (int k = 0; k < SLIDING; k++) {
            double angle = SLIDING_DEG[k];
            impact c = spinning_on_sphere(angle, heavy ? 1000 : 1, STIFF);
            double share = reduced_mass(&c) / (2700 * 4 * DEM_PI / 3 * 1e-3);
            dem_expect(t, beta_of(t, c), slide_of(angle) * share - 1, 2 / STEPS, "", "partner %s, %g deg: beta",
                       heavy ? "1000 times as heavy" : "alike", angle);
            if (!heavy)
                dem_expect(t, beta_of(t, spinning_on_sphere(angle, 1, 1)), figure[k], 0.03, "", "%g deg: figure",
                           angle);
        }
}

// ---- sliding throughout

// Whatever the normal law: the friction impulse is mu times the normal one, (1 + e) m v_n with the realised e.
static void sliding_throughout(dem_trial *t)
{
    for (int variant = 0; variant < 8; variant++) {
        impact c = on_plane(0.01, stiffer(GLASS, STIFF), 1, 0.25, variant & 1 ? 0.6 : 1);
        if (variant & 2) {
            c.law.normal = DEM_NORMAL_LINEAR;
            c.law.stiffness = 1e14;
            c.law.friction = DEM_FRICTION_LINEAR;
        }
        if (variant & 4) {
            c.partner_radius = 0.02;
            c.partner = LIMESTONE;
            c.partner.young *= STIFF;
        }
        c.velocity.x = 5;  // more than 3.5 mu (1 + e) v_n
        c.spin = v3(0, 20, 3);
        c.steps = 1000;
        rebound b = dem_impact_run(t, &c);
        char name[80];
        snprintf(name, sizeof name, "%s, %s, e = %s", variant & 2 ? "linear" : "hertz", variant & 4 ? "pair" : "plane",
                 variant & 1 ? "0.6" : "1");
        // e is what the sphere itself has got. A pair's normal turns a little while the surfaces pass each other.
        double normal = b.velocity.z + 1, share = 2 * overlap_share(&c);
        double turned = c.partner_radius > 0 ? 5 * b.duration / (c.radius + c.partner_radius) : 0;
        dem_expect(t, b.velocity.x, 5 - 0.25 * normal, 1e-9 + turned, "m/s", "%s: v_t", name);
        dem_expect(t, c.radius * (b.spin.y - 20), 2.5 * 0.25 * normal, share + turned, "m/s", "%s: R dw", name);
        dem_expect(t, b.spin.z, 3, 1e-9 + 3 * turned, "rad/s", "%s: spin about the normal", name);
        if (c.partner_radius > 0) {
            double heavier = c.partner.density * 8 / c.material.density;
            dem_expect(t, heavier * b.partner_velocity.x, 0.25 * normal, turned, "m/s", "%s: v_t of the partner", name);
            dem_expect(t, heavier * c.partner_radius * b.partner_spin.y, 2.5 * 0.25 * normal, share + turned, "m/s",
                       "%s: R dw of the partner", name);
        }
    }
}

#define PAPER "Chung & Ooi 2011, test "
const dem_case dem_verify_chung_ooi[] = {
    {"chung-ooi-1", "two equal spheres, normal, elastic", PAPER "1", false, pairs},
    {"chung-ooi-2", "a sphere on a rigid plane, normal, elastic", PAPER "2", false, on_planes},
    {"chung-ooi-3", "a sphere on a rigid plane, restitution 0 to 1", PAPER "3", false, damped_on_plane},
    {"chung-ooi-4", "oblique impacts at angles of 5 to 85 degrees", PAPER "4", false, oblique_on_plane},
    {"chung-ooi-5", "oblique impacts of one normal speed", PAPER "5", false, tangential_on_plane},
    {"chung-ooi-6", "a spinning sphere on a plane", PAPER "6", false, spinning_on_plane},
    {"chung-ooi-7", "two spheres with opposite spins that do not slip", PAPER "7", false, spinning_against_each_other},
    {"chung-ooi-8", "a spinning sphere on a larger one at rest", PAPER "8", false, spinning_on_larger},
    {"chung-ooi-9", "two equal spheres, restitution 0 to 1", "Kratos, benchmark 9", false, damped_pair},
    {"full-slip", "friction impulse of contacts that slide throughout", "momentum balance", false, sliding_throughout},
    {0},
};
