"""The Python module over the shared libraries: figures against analytic ones, arrays, errors, state."""
import gc
import logging
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import demclump
import numpy as np

CUBE = ([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)],
        [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4],
         [1, 5, 7], [1, 7, 3]])
SCENE = """{ "schema": "dem-scene/1", "gravity": [0, 0, -9.81], "time": { "end": 1, "step": 1e-4 },
  "materials": { "stone": { "density": 2500 } },
  "contacts": [ { "between": ["stone", "stone"],
                  "normal": { "law": "linear", "stiffness": 2e4, "restitution": 0.3 } } ],
  "shapes": { "ball": { "sphere": { "radius": "8 mm" }, "material": "stone" },
              "pair": { "spheres": [[-0.003, 0, 0, 0.006], [0.003, 0, 0, 0.006]], "material": "stone" } },
  "bodies": [ { "file": "bodies.csv" } ],
  "walls": { "floor": { "plane": { "point": [0, 0, 0], "normal": [0, 0, 1] }, "material": "stone" } } }"""
BODIES = "shape,x,y,z,vx\nball,0,0,1,0.5\npair,0.1,0,2,0\n"


class Folder(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.path = pathlib.Path(self.folder.name)

    def write(self, name, text):
        (self.path / name).write_text(text)
        return self.path / name


class Meshes(Folder):
    def test_arrays_come_back_and_the_solid_is_exact(self):
        mesh = demclump.Mesh(*CUBE).scaled(0.002)
        solid = mesh.solid()
        np.testing.assert_allclose(solid.volume, 8e-9, rtol=1e-14)
        np.testing.assert_allclose(solid.centre, [0.001] * 3, rtol=1e-14)
        np.testing.assert_allclose(solid.inertia, np.eye(3) * 8e-9 * 4e-6 / 6, atol=1e-28)
        self.assertEqual((mesh.vertices.dtype, mesh.triangles.dtype), (np.float64, np.uint32))
        with self.assertRaises(ValueError):
            mesh.vertices[0, 0] = 3

    def test_files_are_read_in_their_unit(self):
        lines = [f"v {x} {y} {z}" for x, y, z in CUBE[0]] + [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in CUBE[1]]
        mesh = demclump.read_mesh(self.write("cube.obj", "\n".join(lines)), unit="mm")
        np.testing.assert_allclose(mesh.solid().volume, 1e-9, rtol=1e-14)
        self.assertEqual((len(mesh.source.sha256), mesh.source.unit), (64, "mm"))

    def test_what_is_no_mesh_is_refused(self):
        for vertices, triangles in (([[0, 0]], [[0, 0, 0]]), ([[0, 0, np.nan]], [[0, 0, 0]]), (CUBE[0], [[0, 1, 8]]),
                                    (CUBE[0], [[0, 1, -1]]), (CUBE[0], [[0.5, 1, 2]]), (CUBE[0], [[0, 1]])):
            with self.assertRaises(ValueError):
                demclump.Mesh(vertices, triangles)
        with self.assertRaisesRegex(demclump.InputError, "not closed"):
            demclump.Mesh(CUBE[0], CUBE[1][1:]).solid()
        with self.assertRaises(demclump.InputError) as caught:
            demclump.read_mesh(self.write("bad.obj", "v 0 0 0\nv 1 0 zero\n"))
        self.assertEqual((caught.exception.status, caught.exception.line), (3, 2))
        self.assertRegex(str(caught.exception), r"bad\.obj:2: ")
        with self.assertRaises(demclump.UsageError):
            demclump.read_mesh("x.obj", unit="parsec")

    def test_repairs_are_told_and_logged(self):
        flipped = [[a, c, b] for a, b, c in CUBE[1]]
        with self.assertLogs("demclump", logging.WARNING) as logs:
            mesh = demclump.Mesh(CUBE[0], flipped).repair()
        self.assertTrue(mesh.report.inside_out and logs.output)
        np.testing.assert_allclose(mesh.solid().volume, 1, rtol=1e-14)
        with self.assertRaises(demclump.InputError):
            demclump.Mesh(CUBE[0], CUBE[1][:4]).repair()

    def test_bodies_are_split(self):
        apart = np.array(CUBE[0]) * 0.5 + 5
        two = demclump.Mesh(np.vstack([CUBE[0], apart]), CUBE[1] + [[a + 8, b + 8, c + 8] for a, b, c in CUBE[1]])
        with self.assertRaises(demclump.InputError):
            two.repair()
        with self.assertLogs("demclump"):
            volumes = [m.solid().volume for m in two.repair(keep="all").split()]
        np.testing.assert_allclose(volumes, [1, 0.125], rtol=1e-12)


class Clumps(Folder):
    @classmethod
    def setUpClass(cls):
        cls.mesh = demclump.Mesh(*CUBE).scaled(0.01).repair()
        cls.clump = demclump.pack(cls.mesh, spheres=12, effort="fast", name="würfel", density=2000)

    def test_a_clump_has_the_mass_of_its_mesh(self):
        c = self.clump
        np.testing.assert_allclose(c.mass, 2e-3, rtol=1e-12)
        np.testing.assert_allclose(c.inertia, [2e-3 * 1e-4 / 6] * 3, rtol=1e-9)
        self.assertEqual((c.name, c.mass_from, c.made.seed, len(c)), ("würfel", "mesh", 1, len(c.spheres)))
        self.assertEqual(c.spheres.shape[1], 4)
        self.assertTrue(0 < c.fidelity.iou_gap < 0.3 and c.fidelity.pieces == 1)
        np.testing.assert_allclose(c.shape.equivalent_diameter, 0.01 * (6 / np.pi) ** (1 / 3), rtol=1e-9)
        self.assertGreater(len(c.surface.triangles), 3)

    def test_the_union_agrees_in_the_frame_of_the_mesh(self):
        solid = demclump.union(self.clump.spheres_in_mesh_frame()).solid
        np.testing.assert_allclose(solid.volume, self.clump.union.volume, rtol=1e-9)
        np.testing.assert_allclose(solid.volume, 1e-6, rtol=1e-9)  # moments are met
        np.testing.assert_allclose(solid.centre, [0.005] * 3, rtol=1e-8)
        measured = demclump.fidelity(self.mesh, self.clump.spheres_in_mesh_frame())
        np.testing.assert_allclose(measured.iou_gap, self.clump.fidelity.iou_gap, rtol=1e-3)

    def test_two_balls_lose_their_lens(self):
        result = demclump.union([[0, 0, 0, 1], [1, 0, 0, 1]])
        np.testing.assert_allclose(result.solid.volume, 9 * np.pi / 4, rtol=1e-13)
        self.assertEqual(result.pieces, 1)
        with self.assertRaises(ValueError):
            demclump.union([[0, 0, 0]])

    def test_the_same_seed_gives_the_same_clump_with_any_threads(self):
        again = demclump.pack(self.mesh, spheres=12, effort="fast", name="würfel", density=2000, threads=1)
        self.assertEqual(self.clump, again)
        other = demclump.pack(self.mesh, spheres=12, effort="fast", name="würfel", density=2000, seed=2)
        self.assertNotEqual(self.clump, other)

    def test_files_keep_everything(self):
        self.clump.save(self.path / "a.json")
        read = demclump.load(self.path / "a.json")
        self.assertEqual(read, self.clump)
        np.testing.assert_array_equal(read.spheres, self.clump.spheres)
        with self.assertRaises(demclump.WriteError):
            self.clump.save(self.path / "nowhere" / "a.json")
        self.write("b.json", "{\n \"schema\": 3 }")
        with self.assertRaises(demclump.InputError):
            demclump.load(self.path / "b.json")

    def test_exports(self):
        self.assertTrue({"json", "xyzr", "vtp", "stl"} <= set(demclump.formats()))
        self.clump.export(self.path / "a.xyzr", frame="mesh")
        np.testing.assert_allclose(np.loadtxt(self.path / "a.xyzr"), self.clump.spheres_in_mesh_frame(), rtol=1e-12)
        with self.assertRaisesRegex(demclump.UsageError, "unknown format 'cube'; use one of: json"):
            self.clump.export(self.path / "a.txt", format="cube")
        with self.assertRaisesRegex(demclump.UsageError, "does not tell the format"):
            self.clump.export(self.path / "a.nothing")

    def test_wrong_parameters_are_refused(self):
        for wrong in ({"spheres": 0}, {"gap": 2}, {"density": -1}, {"effort": "most"}, {"method": "magic"},
                      {"seed": -1}):
            with self.assertRaises(demclump.UsageError, msg=wrong):
                demclump.pack(self.mesh, **wrong)

    def test_progress_stops_and_raises(self):
        with self.assertRaises(demclump.Interrupted):
            demclump.pack(self.mesh, progress=lambda what, fraction: True)

        def press(what, fraction):
            raise KeyboardInterrupt
        with self.assertRaises(KeyboardInterrupt):
            demclump.pack(self.mesh, progress=press)

    def test_a_view_keeps_its_clump(self):
        self.clump.save(self.path / "a.json")
        read = demclump.load(self.path / "a.json")
        spheres = read.spheres
        with self.assertRaises(ValueError):
            spheres[0, 0] = 1
        del read
        gc.collect()
        np.testing.assert_array_equal(spheres, self.clump.spheres)


class Worlds(Folder):
    def setUp(self):
        super().setUp()
        self.scene = self.write("scene.json", SCENE)
        self.write("bodies.csv", BODIES)

    def test_a_free_fall_is_exact(self):
        world = demclump.World(self.scene)
        start = world.positions.copy()
        world.step(1000)
        self.assertEqual((world.steps, world.step_size), (1000, 1e-4))
        np.testing.assert_allclose(world.time, 0.1, rtol=1e-12)
        # central differences are exact for a constant force
        np.testing.assert_allclose(world.positions - start, [[0.05, 0, -0.5 * 9.81 * 0.01], [0, 0, -0.5 * 9.81 * 0.01]],
                                   atol=1e-12)
        np.testing.assert_allclose(world.velocities, [[0.5, 0, -0.981], [0, 0, -0.981]], atol=1e-12)
        np.testing.assert_allclose(world.orientations, [[1, 0, 0, 0]] * 2, atol=1e-15)
        np.testing.assert_allclose(world.masses[0], 2500 * 4 / 3 * np.pi * 0.008 ** 3, rtol=1e-12)
        self.assertEqual((world.figures.bodies, world.figures.spheres, list(world.shapes)), (2, 3, [0, 1]))
        self.assertLess(abs(world.figures.energy.error), 1e-12)

    def test_a_bounce_has_contacts_and_loads_the_floor(self):
        world = demclump.World(self.scene, {"bodies.0.file": str(self.path / "bodies.csv")})
        while not len(world.contacts):
            self.assertLess(world.time, 1)
            world.step(10)
        contact = world.contacts[0]
        self.assertEqual((contact["body"], contact["wall"], contact["other"]), (0, 0, 2 ** 32 - 1))
        self.assertGreater(contact["overlap"], 0)
        np.testing.assert_allclose(contact["normal"], [0, 0, -1], atol=1e-12)
        np.testing.assert_allclose(world.walls[0]["force"], -world.forces[0], rtol=1e-12)
        self.assertEqual(list(world.coordination), [1, 0])

    def test_any_way_of_stepping_gives_the_same_bits(self):
        whole, parts = demclump.World(self.scene), demclump.World(self.scene, threads=2)
        whole.step(5000)
        for _ in range(50):
            parts.step(100)
            parts.figures
        self.assertEqual(whole.hash, parts.hash)
        state = whole.save()
        whole.step(500)
        parts.restore(state)
        parts.step(500)
        self.assertEqual(whole.hash, parts.hash)
        with self.assertRaises(demclump.InputError):
            parts.restore(state[:100])

    def test_a_push_changes_the_momentum(self):
        world = demclump.World(self.scene, {"gravity": [0, 0, 0]})
        world.step(10)
        world.push(1, force=(0, 2, 0))
        world.step(1)
        np.testing.assert_allclose(world.velocities[1], [0, 2 / world.masses[1] * 1e-4, 0], rtol=1e-9, atol=1e-15)
        with self.assertRaises(IndexError):
            world.push(2)

    def test_views_are_read_only_and_outlive_the_name_of_their_world(self):
        world = demclump.World(self.scene)
        positions = world.positions
        with self.assertRaises(ValueError):
            positions[0] = 0
        pair = world.clump(1)
        self.assertEqual(len(pair), 2)
        del world
        gc.collect()
        np.testing.assert_allclose(positions[:, 2], [1, 2])
        np.testing.assert_allclose(pair.spheres[:, 3], [0.006, 0.006])

    def test_what_is_wrong_is_said_with_its_place(self):
        self.write("wrong.json", SCENE.replace('"gravity"', '\n "gravty"'))
        with self.assertRaisesRegex(demclump.InputError, r'wrong\.json:2: .*did you mean "gravity"'):
            demclump.World(self.path / "wrong.json")
        with self.assertRaisesRegex(demclump.InputError, "-D time.step: .*'soon' is not a time"):
            demclump.World(self.scene, {"time.step": "soon"})
        with self.assertRaises(demclump.Error) as caught:
            demclump.World(self.scene, {"time.step": 0.01, "contacts.0.normal.stiffness": 1e9}).step(10000)
        self.assertEqual(caught.exception.status, 1)
        self.assertRegex(str(caught.exception), "body [0-9]+")

    def test_explains_itself(self):
        world = demclump.World(self.scene)
        world.step(5)
        self.assertIn("step", world.explain())
        self.assertIn("contacts", world.passes)
        self.assertGreater(world.bytes_per_body, 0)


FAKE = """
#include <stddef.h>
struct row { const char *type, *field, *kind; size_t offset, size; };
static const struct row rows[] = { {"dem_error", "", "", 0, 8}, {"dem_error", "code", "u32", 4, 4} };
const char *dem_version(void) { return "%s"; }
const struct row *dem_abi(size_t *count) { *count = 2; return rows; }
"""


class Libraries(Folder):
    def import_from(self, folder):
        return subprocess.run([sys.executable, "-c", "import demclump"], capture_output=True, text=True,
                              env={**os.environ, "DEM_LIBRARY_DIR": str(folder)}).stderr

    def fake(self, source):
        self.write("fake.c", source)
        subprocess.run(["cc", "-shared", "-fPIC", str(self.path / "fake.c"), "-o", str(self.path / "libdem.so.0.1")],
                       check=True)
        return self.import_from(self.path)

    def test_another_library_is_refused(self):
        self.assertRegex(self.import_from(self.path),
                         "ImportError: cannot find libdem.so.0.1; looked for .*DEM_LIBRARY_DIR")
        self.assertRegex(self.fake("int x;"), "ImportError: .* is no libdem this module can use")
        self.assertRegex(self.fake(FAKE % "0.2.0"), "ImportError: .* is version 0.2.0, the module is for 0.1")
        self.assertRegex(self.fake(FAKE % "0.1.9"), "ImportError: libdem 0.1.9 .* has no dem_error.file; install")
        fields = ", ".join('{"dem_error", "%s", "u32", 4, 4}' % name for name in ("code", "line", "file", "text"))
        everything = FAKE.replace('{"dem_error", "code", "u32", 4, 4}', fields).replace("= 2", "= 5")
        self.assertRegex(self.fake(everything % "0.1.9"), "ImportError: libdem 0.1.9 .* has no structure dem_ctx")


class Documentation(unittest.TestCase):
    def test_everything_public_is_described(self):
        for name in demclump.__all__:
            self.assertTrue(getattr(demclump, name).__doc__, name)
        for kind in (demclump.Mesh, demclump.Clump, demclump.World):
            for name, member in vars(kind).items():
                if not name.startswith("_") and (callable(member) or isinstance(member, property)) \
                        and name not in ("spheres", "surface"):  # described with the class
                    self.assertTrue(member.__doc__, f"{kind.__name__}.{name}")


if __name__ == "__main__":
    unittest.main()
