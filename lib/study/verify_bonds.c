// Parallel bonds: beams of bonded spheres, and the strength of one bond. PHYSICS 1.7.
#include "study/trial.h"
#include "study/verify.h"

static const double YOUNG = 1e9, POISSON = 0.25, RADIUS = 0.005, LENGTH = 0.1;

static dem_bond_def beam_bond(size_t n)
{
    dem_bond_def bond = dem_bond_defaults();
    bond.young = YOUNG;
    bond.shear_ratio = 1 / (2 * (1 + POISSON));
    bond.gap = 1e-6;
    bond.contact = DEM_BOND_INSTEAD;
    bond.radius_multiplier = RADIUS / (LENGTH / (double)n / 2);
    return bond;
}

// n + 1 spheres along x, the first held, the last pushed until all is at rest
static dem_motion loaded_beam(dem_trial *t, size_t n, dem_vec3 force, dem_vec3 moment)
{
    model *m = dem_trial_model(t);
    dem_bond_def bond = beam_bond(n);
    double pitch = LENGTH / (double)n;
    uint32_t sphere = model_sphere(m, pitch / 2);
    for (size_t i = 0; i <= n; i++)
        model_body(m, sphere, v3(pitch * (double)i, 0, 0));
    m->scene.bonds = &bond;
    m->scene.bond_count = 1;
    m->bodies[0].hold = DEM_HOLD_VELOCITY | DEM_HOLD_SPIN;
    m->scene.damping.local = 0.6;
    m->scene.time.step = 0;
    bool going = dem_trial_start(t);
    for (int i = 0; going && i < (n > 10 ? 60000 : 25000); i++) {
        dem_world_push(t->world, n, force, moment);
        going = dem_trial_step(t, 1);
    }
    return dem_trial_body(t, n);
}

// PL^3/(3EI) (1 - 1/(4n^2)) + PL/(GA); geometry is of second order in d/L = 7e-4
static void cantilever(dem_trial *t)
{
    static const double tips[2] = {6.80546537e-5, 6.81819776e-5};
    for (int i = 0; i < 2; i++) {
        size_t n = i ? 20 : 10;
        dem_motion end = loaded_beam(t, n, v3(0, 0, -0.1), v3(0, 0, 0));
        dem_expect(t, -end.position.z, tips[i], 2e-6 * tips[i], "m", "%zu bonds: deflection", n);
        dem_expect(t, 2 * asin(end.orientation.y), 1.01859164e-3, 3e-9, "rad", "%zu bonds: rotation of the end", n);
    }
}

static void torsion(dem_trial *t)
{
    double area = DEM_PI * RADIUS * RADIUS, polar = area * RADIUS * RADIUS / 2, shear = YOUNG / 2.5;
    double twist = 0.02 * LENGTH / (shear * polar), stretch = 5 * LENGTH / (YOUNG * area);
    dem_motion end = loaded_beam(t, 10, v3(0, 0, 0), v3(0.02, 0, 0));
    dem_expect(t, 2 * asin(end.orientation.x), twist, 1e-9 * twist, "rad", "twist, M L / (G J)");
    end = loaded_beam(t, 10, v3(5, 0, 0), v3(0, 0, 0));
    dem_expect(t, end.position.x - LENGTH, stretch, 1e-9 * stretch, "m", "stretch, P L / (E A)");
}

// two spheres that are drawn apart, slowly: the bond breaks at its strength
static void strength(dem_trial *t)
{
    static const char *const ways[] = {"tension", "shear"};
    for (int way = 0; way < 2; way++) {
        model *m = dem_trial_model(t);
        dem_bond_def bond = beam_bond(1);
        bond.radius_multiplier = 1;
        bond.tensile_strength = way ? 1e9 : 1e5;
        bond.shear_strength = way ? 1e5 : 1e9;
        bond.moment_contribution = 0;
        uint32_t sphere = model_sphere(m, LENGTH / 2);
        for (int i = 0; i < 2; i++)
            model_body(m, sphere, v3(LENGTH * i, 0, 0))->hold = DEM_HOLD_VELOCITY;
        m->materials[0].density = 1e15;  // too heavy to be turned
        m->bodies[1].velocity = way ? v3(0, 1e-3, 0) : v3(1e-3, 0, 0);
        m->scene.bonds = &bond;
        m->scene.bond_count = 1;
        dem_trial_start(t);
        double area = DEM_PI * LENGTH * LENGTH / 4, most = 0;
        size_t count = 0;
        bool intact = true;
        while (intact && dem_trial_time(t) < 0.05 && dem_trial_step(t, 1)) {
            dem_trial_figures(t);
            const dem_bond_view *b = dem_world_bonds(t->world, &count);
            intact = count == 1 && b->state == DEM_BOND_INTACT;
            most = intact ? fmax(most, v3_norm(b->force)) : most;
        }
        // the stress grows by 1e2 or 4e1 Pa a step
        dem_expect(t, most / area, 1e5, 2e2, "Pa", "%s: largest force over the area", ways[way]);
        dem_expect(t, dem_trial_time(t), 1e5 * LENGTH / (way ? YOUNG / 2.5 : YOUNG) / 1e-3, 3e-5, "s", "%s: breaks at",
                   ways[way]);
    }
}

const dem_case dem_verify_bonds[] = {
    {"bond-cantilever", "a cantilever of bonded spheres", "Timoshenko's beam of n springs", false, cantilever},
    {"bond-torsion", "a rod of bonded spheres, twisted and stretched", "M L / (G J), P L / (E A)", false, torsion},
    {"bond-strength", "a bond pulled and sheared until it breaks", "strength times area", false, strength},
    {0},
};
