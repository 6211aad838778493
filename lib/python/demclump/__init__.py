"""dem-clump from Python: clumps of spheres from meshes of grains, and worlds of them, over the shared libraries.

    import demclump
    mesh = demclump.read_mesh("grain.obj")
    clump = demclump.pack(mesh, spheres=50, seed=1)
    print(clump.mass, clump.fidelity.iou_gap, clump.spheres)
    clump.save("grain.json")

    world = demclump.World("scene.json")
    world.step(1000)
    print(world.time, world.positions, world.figures.energy.kinetic)

SI units everywhere. What the library refuses is raised as Error (InputError, UsageError, WriteError, Interrupted,
UnavailableError) with its text; its warnings go to the logger "demclump". Needs NumPy.
The libraries are found beside the installed module, or in the folder DEM_LIBRARY_DIR.
"""
from ._library import (Error, InputError, Interrupted, UnavailableError, UsageError, WriteError, version as __version__)
from .clump import Clump, fidelity, formats, load, pack, union
from .mesh import Mesh, read_mesh
from .world import World

__all__ = ["Clump", "Error", "InputError", "Interrupted", "Mesh", "UnavailableError", "UsageError", "World",
           "WriteError", "fidelity", "formats", "load", "pack", "read_mesh", "union"]
