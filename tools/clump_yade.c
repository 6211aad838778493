// Yade: the clump is added by the exported function, turned somehow, set moving, and moved by one step.
#include <string.h>

#include "clump_engine.h"
#include "out/export_text.h"

// what is the same for every clump; `add` is the exported function
static const char script[] =
    "from yade import *\n"
    "exec(open('clump.yade.py').read())\n"
    "\n"
    "def move(motion, add, speed, rate):\n"
    "    O.reset()\n"
    "    O.materials.append(FrictMat(density=1000, label='grain'))\n"
    "    turn = Quaternion(Vector3(1, 2, 3).normalized(), 0.7)\n"
    "    clump, members = add(Vector3(0, 0, 0), turn, 'grain')\n"
    "    state = O.bodies[clump].state\n"
    "    if motion == 0:\n"
    "        state.vel = Vector3(speed, 0, 0)\n"
    "    else:\n"
    "        axis = Vector3(0, 0, 0)\n"
    "        axis[motion - 1] = rate\n"
    "        own = state.ori.conjugate() * (turn * axis)\n"
    "        state.angMom = state.ori * Vector3(*[state.inertia[k] * own[k] for k in range(3)])\n"
    "    O.engines = [ForceResetter(), NewtonIntegrator(damping=0, gravity=(0, 0, 0))]\n"
    "    O.dt = " ENGINE_STEP "\n"
    "    O.step()\n"
    "    O.step()\n"
    "    energy = utils.kineticEnergy()\n"
    "    print('\\n" ENGINE_MARK " %d' % motion)\n"
    "    print('%d %d %.17g %.17g' % (O.iter, len(members), *((energy, 0) if motion == 0 else (0, energy))))\n"
    "    print('" ENGINE_END "')\n"
    "    with open('motion%d.dump' % motion, 'w') as dump:\n"
    "        dump.write('ITEM: ATOMS id x y z vx vy vz\\n')\n"
    "        for i, member in enumerate(members):\n"
    "            s = O.bodies[member].state\n"
    "            dump.write('%d %.17g %.17g %.17g %.17g %.17g %.17g\\n' % (i + 1, *s.pos, *s.vel))\n"
    "\n"
    "for motion in range(4):\n";

static dem_status write_script(const engine_question *q, dem_error *error)
{
    dem_plain_name id = dem_export_identifier(&q->def);
    dem_buffer deck = {0};
    DEM_TRY(engine_export(q, "yade", "clump.yade.py", error));
    dem_buffer_text(&deck, script);
    dem_buffer_print(&deck, "    move(motion, add_%s, ", id.text);
    dem_buffer_number(&deck, engine_reach(q), 17);
    dem_buffer_text(&deck, ", 1)\n");
    return engine_write(q, "motion.py", &deck, error);
}

static dem_status ask_yade(const engine_question *q, engine_answer *answer, dem_error *error)
{
    static const char *const arguments[] = {"-n", "-x", "-j1", "motion.py", NULL};
    DEM_TRY(write_script(q, error));
    return engine_move(q, &engine_yade, answer, arguments, error);
}

const engine engine_yade = {
    .name = "yade",
    .title = "Yade",
    .package = "yade",
    .programs = {"yade", "yadedaily", NULL},
    .banner = "Welcome to Yade ",
    .ask = ask_yade,
};
