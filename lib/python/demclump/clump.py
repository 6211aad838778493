"""Clumps: rigid bodies of glued spheres that stand for one grain."""
import ctypes
import json
import os
import pathlib
import types
import weakref

import numpy as np

from . import _library as lib
from .mesh import Mesh, read_mesh

_EFFORTS = ("fast", "default", "best")
_MOMENTS = ("free", "volume", "exact")
_SIDES = ("both", "inscribed", "outer")
_SOURCES = ("mesh", "union", "given")
_FRAMES = ("principal", "mesh")


class Clump:
    """One clump; immutable. Made by pack() and load(); lengths in metres, its own frame: centre of mass at 0,
    principal axes I1 <= I2 <= I3.

    name, density [kg/m^3], mass [kg], volume [m^3] that the mass stands for, inertia (3,) principal [kg m^2],
    mass_from (mesh, union or given);
    spheres (n, 4): x, y, z, r [m];
    to_mesh: position (3,) [m] and orientation (4,) w, x, y, z from this frame to that of the mesh;
    union: volume [m^3], centre (3,) [m], inertia (3,) [kg m^2] of the union of the spheres, exact;
    fidelity: iou_gap, volume_error, distance_mean, distance_max, protrusion, centre_offset, inertia_error,
    normal_deviation_deg, overlap_ratio, pieces (lengths over the equivalent diameter [-]; nan: not measured);
    shape: sizes [m] and descriptors [-]; surface: a reduced Mesh of the grain in this frame, or None;
    source: mesh, sha256, unit; made: method, parameters, seed, seconds, version.
    """

    def __init__(self, handle, owner=None):
        """Not for users: `handle` is a dem_clump, owned by `owner` or, without one, by this."""
        self._handle, self._owner = handle, owner
        if owner is None:
            weakref.finalize(self, lib.call, "dem_clump_destroy", handle)
        v = self._view = lib.call("dem_clump_view", handle)
        self.name, self.density, self.mass, self.volume = lib.text_at(v.name), v.density, v.mass, v.volume
        self.inertia, self.mass_from = lib.record(v.inertia), _SOURCES[v.mass_from]
        self.to_mesh = types.SimpleNamespace(position=lib.record(v.position), orientation=lib.record(v.orientation))
        self.union = types.SimpleNamespace(volume=v.union_volume, centre=lib.record(v.union_centre),
                                           inertia=lib.record(v.union_inertia))
        self.fidelity, self.shape = lib.record(v.fidelity), lib.record(v.shape)
        self.source = types.SimpleNamespace(mesh=lib.text_at(v.source_mesh), sha256=lib.text_at(v.source_sha256),
                                            unit=lib.text_at(v.source_unit))
        self.made = types.SimpleNamespace(method=lib.text_at(v.method), seed=v.seed, seconds=v.seconds,
                                          parameters=json.loads(lib.text_at(v.parameters) or "{}"),
                                          version=lib.text_at(v.version))

    def __repr__(self):
        return f"<Clump {self.name!r} of {len(self)} spheres, {self.mass:.6g} kg>"

    def __len__(self):
        return self._view.ball_count

    def __eq__(self, other):
        return hash(self) == hash(other) if isinstance(other, Clump) else NotImplemented

    def __hash__(self):
        """Of everything but the seconds it took: equal for two makings that came to the same clump."""
        return lib.call("dem_clump_hash", self._handle)

    @property
    def spheres(self):
        return lib.view(self._view.balls, (self._view.ball_count, 4), "f8", self)

    @property
    def surface(self):
        return Mesh._take(self._view.surface, release=False) if self._view.surface.triangle_count else None

    def spheres_in_mesh_frame(self):
        """(n, 4): x, y, z, r in the frame of the mesh [m]."""
        spheres = self.spheres
        w, *q = self.to_mesh.orientation
        q, c = np.array(q), spheres[:, :3]
        turn = 2 * np.cross(q, c)
        moved = c + w * turn + np.cross(q, turn) + self.to_mesh.position
        return np.column_stack([moved, spheres[:, 3]])

    def save(self, path):
        """Writes the clump file (dem-clump/1, JSON), read back without loss by load(). Raises WriteError."""
        lib.call("dem_clump_write", self._handle, lib.path_bytes(path))

    def export(self, path, format=None, mesh=None, frame="principal", threads=0):
        """Writes the clump in the format of another program, by its name (see formats()) or that of the file.

        mesh: the one it was made from, for pictures. frame: of formats that are only spheres, principal or mesh.
        Raises UsageError for a format there is not, UnavailableError, WriteError.
        """
        context = lib.Context(threads)
        lib.call("dem_clump_export", context(), self._handle, ctypes.byref(mesh._struct()) if mesh else None,
                 lib.text_or_none(format), lib.choice("frame", frame, _FRAMES) == 1, lib.path_bytes(path),
                 context=context)


def formats():
    """The names of the formats a clump can be exported to."""
    names = []
    while (name := lib.call("dem_export_format", len(names))) is not None:
        names.append(name.decode())
    return names


def load(path):
    """Reads a clump file (dem-clump/1). Raises InputError with file and line."""
    handle = ctypes.c_void_p()
    lib.call("dem_clump_read", lib.path_bytes(path), ctypes.byref(handle))
    return Clump(handle.value)


def pack(mesh, spheres=50, *, gap=None, max_spheres=None, seed=1, effort="default", moments="exact", side="both",
         method=None, density=2650.0, mass_from="mesh", name=None, repair="auto", keep="one", threads=0,
         progress=None):
    """Packs spheres into a mesh and measures the result: a Clump. The same for a seed and any number of threads.

    mesh: a Mesh (repaired first if repair() was not called) or the path of a file in metres.
    spheres: at most so many; or gap: the fewest spheres, up to max_spheres, whose IoU gap is at most this fraction.
    effort: fast, default or best. moments: what the union of the spheres shall have exactly of the grain: exact
    (volume, centre, inertia), volume or free. side: both, inscribed or outer. method: a packer's name.
    density [kg/m^3]. mass_from: mesh or union. threads: 0 for all cores. progress(what, fraction): called from time to
    time; True stops.
    Raises InputError where the mesh cannot be used, UsageError for a parameter outside its range, Interrupted.

    >>> clump = pack(read_mesh("grain.obj"), spheres=100)
    >>> clump.spheres.shape, clump.fidelity.iou_gap
    """
    if not isinstance(mesh, Mesh):
        mesh = read_mesh(mesh)
    if mesh.report is None:
        mesh = mesh.repair(repair, keep, threads=threads)
    context, handle, o = lib.Context(threads, progress), ctypes.c_void_p(), lib.call("dem_make_defaults")
    if spheres < 1 or seed < 0 or (gap is not None and not 0 < gap < 1):
        raise lib.UsageError("spheres must be at least 1, seed at least 0 and gap between 0 and 1, "
                             f"not {spheres}, {seed} and {gap}", 2)
    # the options hold pointers: these texts must live until the call is through
    texts = {"method": method, "name": name}
    if mesh.source:
        texts["name"] = name if name is not None else pathlib.Path(mesh.source.file).stem
        texts.update(source_mesh=os.path.basename(mesh.source.file), source_sha256=mesh.source.sha256,
                     source_unit=mesh.source.unit)
    held = {key: ctypes.c_char_p(text.encode()) for key, text in texts.items() if text is not None}
    for key, text in held.items():
        setattr(o.pack if key == "method" else o, key, ctypes.cast(text, ctypes.c_void_p))
    o.pack.spheres, o.pack.gap, o.pack.seed = spheres, gap or 0, seed
    if max_spheres is not None:
        o.pack.max_spheres = max_spheres
    o.pack.effort, o.pack.moments = lib.choice("effort", effort, _EFFORTS), lib.choice("moments", moments, _MOMENTS)
    o.pack.side = lib.choice("side", side, _SIDES)
    o.density, o.mass_from = density, lib.choice("mass_from", mass_from, _SOURCES[:2])
    lib.call("dem_clump_make", context(), ctypes.byref(mesh._struct()), ctypes.byref(o), ctypes.byref(handle), None,
             context=context)
    return Clump(handle.value)


def _balls(spheres):
    balls = np.ascontiguousarray(spheres, dtype=np.float64)
    if balls.ndim != 2 or balls.shape[1] != 4 or not len(balls):
        raise ValueError(f"spheres must have the shape (n, 4): x, y, z, r; not {balls.shape}")
    return balls


def union(spheres):
    """Exact mass properties at unit density of the union of spheres (n, 4): x, y, z, r [m].

    solid: as Mesh.solid(); pieces: connected ones; redundant: spheres without exposed surface.
    """
    balls, result = _balls(spheres), lib.struct.union()
    lib.call("dem_balls_union", balls.ctypes.data, len(balls), ctypes.byref(result))
    return lib.record(result)


def fidelity(mesh, spheres, samples=0, threads=0):
    """Measures any union of spheres (n, 4) [m], in the frame of a repaired mesh, against it: as Clump.fidelity."""
    context, balls, result = lib.Context(threads), _balls(spheres), lib.struct.fidelity()
    lib.call("dem_fidelity_measure", context(), ctypes.byref(mesh._struct()), balls.ctypes.data, len(balls), samples,
             ctypes.byref(result), context=context)
    return lib.record(result)
