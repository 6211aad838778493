// Yade: a Python script with a function that adds one clump. Yade takes mass, centre and axes of a clump from its
// spheres, each with the density of its material, and has no way to give the centre and the axes. So the clump is made
// of its spheres, weightless, and of six small balls on the axes that have just the clump's mass and inertia; these are
// erased again, which leaves what Yade came to.
#include "out/export_text.h"

static const char MARK[] = "# ";

static void put_list(dem_buffer *out, const char *before, const double *values, size_t count, const char *behind)
{
    dem_buffer_text(out, before);
    for (size_t i = 0; i < count; i++) {
        dem_buffer_number(out, values[i], 17);
        dem_buffer_text(out, i + 1 < count ? ", " : behind);
    }
}

static void put_function(dem_buffer *out, const char *id)
{
    dem_buffer_print(
        out,
        "\n\ndef add_%s(position, orientation=Quaternion.Identity, material=-1):\n"
        "    \"\"\"Adds one clump: centre of mass, turn from the frame of the spheres, the material's label.\n"
        "    Returns its number and those of its spheres.\"\"\"\n"
        "    real = O.materials[material]\n"
        "    small = 1e-5 * min(r for _, r in %s_spheres)\n"
        "\n"
        "    def ball(centre, radius, density):\n"
        "        kind = type(real)(**{k: v for k, v in real.dict().items() if k not in ('id', 'label', 'density')})\n"
        "        kind.density = density\n"
        "        return sphere(Vector3(position) + orientation * Vector3(centre), radius, material=kind)\n"
        "\n"
        "    bodies = [ball(c, r, 0) for c, r in %s_spheres]\n"
        "    for axis in range(3):\n"
        "        second = sum(%s_inertia) / 2 - %s_inertia[axis]\n"
        "        arm = Vector3(0, 0, 0)\n"
        "        arm[axis] = math.sqrt(max(0, 3 * (second / %s_mass - small**2 / 5)))\n"
        "        heavy = %s_mass / 6 / (4 / 3 * math.pi * small**3)\n"
        "        bodies += [ball(s * arm, small, heavy) for s in (1, -1)]\n"
        "    clump, members = O.bodies.appendClumped(bodies, discretization=0)\n"
        "    for i in members[-6:]:\n"
        "        O.bodies.erase(i)\n"
        "    for i in members[:-6]:\n"
        "        own = O.bodies[i]\n"
        "        own.material = real\n"
        "        own.state.mass = 4 / 3 * math.pi * own.shape.radius**3 * real.density\n"
        "        own.state.inertia = 0.4 * own.state.mass * own.shape.radius**2 * Vector3(1, 1, 1)\n"
        "    return clump, members[:-6]\n",
        id, id, id, id, id, id, id);
}

static dem_status write_yade(const dem_clump *clump, const dem_export_options *options, dem_buffer *out,
                             dem_error *error)
{
    static const char *const use[] = {
        "tried with 2023.02; in your script:",
        "  O.materials.append(FrictMat(density=2650, young=1e8, label='grain'))",
        "  exec(open('FILE').read()); clump, members = add_NAME((0, 0, 0), Quaternion.Identity, 'grain')",
        "`yade FILE` shows one. The material's density plays no part: mass, centre and inertia are those below.",
        "O.bodies.updateClumpProperties, addToClump and releaseFromClump forget them. Yade may turn the axes of",
        "state.ori by 180 degrees against the frame below (the moments are the same), so to place the mesh keep",
        "the turn there is at the start: state.ori.conjugate() * orientation",
        "to spin a clump set state.angMom = state.ori * (inertia * w), componentwise; state.angVel is ignored",
        NULL};
    dem_clump_def def = dem_clump_view(clump);
    dem_plain_name id = dem_export_identifier(&def);
    dem_export_put_head(out, &(dem_export_head){MARK, "Yade script that defines a clump", use, "yade.py"}, &def,
                        options);
    dem_buffer_text(out, "import math\n\nfrom yade import *\n\n");
    dem_buffer_print(out, "%s_mass = ", id.text);
    put_list(out, "", &def.mass, 1, "\n");
    dem_buffer_print(out, "%s_inertia = ", id.text);
    put_list(out, "[", def.inertia, 3, "]\n");
    dem_buffer_print(out, "%s_spheres = [  # (centre), radius\n", id.text);
    for (size_t i = 0; i < def.ball_count; i++) {
        dem_vec3 c = def.balls[i].centre;
        put_list(out, "    ((", (double[]){c.x, c.y, c.z}, 3, "), ");
        put_list(out, "", &def.balls[i].radius, 1, "),\n");
    }
    dem_buffer_text(out, "]\n");
    put_function(out, id.text);
    dem_buffer_print(out,
                     "\n\nif not O.bodies and not O.materials:  # started by itself\n"
                     "    O.materials.append(FrictMat(density=2650, young=1e8, label='grain'))\n"
                     "    add_%s((0, 0, 0), Quaternion.Identity, 'grain')\n",
                     id.text);
    return out->failed ? dem_fail_memory(error) : DEM_OK;
}

extern const dem_exporter dem_export_yade;
const dem_exporter dem_export_yade = {
    .name = "yade",
    .suffix = "yade.py",
    .about = "Yade: Python script with a function that adds the clump",
    .for_engine = true,
    .write = write_yade,
};
