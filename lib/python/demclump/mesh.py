"""Triangle meshes of grains."""
import ctypes
import hashlib
import os
import types

import numpy as np

from . import _library as lib

_UNITS = {"m": 1.0, "dm": 1e-1, "cm": 1e-2, "mm": 1e-3, "um": 1e-6, "nm": 1e-9, "km": 1e3, "in": 0.0254, "ft": 0.3048}
_REPAIRS = ("auto", "strict", "wrap", "none")
_KEEPS = ("one", "largest", "all")


class Mesh:
    """Indexed triangles, counter-clockwise seen from outside.

    vertices: (n, 3) float64 [m]; triangles: (m, 3) uint32, indices of vertices. Both are read-only copies.
    report: what repair() found and did, None before it. source: file, sha256 and unit it was read from, or None.

    >>> mesh = Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])
    >>> round(mesh.solid().volume, 6)
    0.166667
    """

    def __init__(self, vertices, triangles):
        """Raises ValueError where an array has another shape, is not finite, or an index is out of range."""
        vertices = np.array(vertices, dtype=np.float64, order="C")
        indices = np.array(triangles, order="C")
        if vertices.ndim != 2 or vertices.shape[1] != 3:
            raise ValueError(f"vertices must have the shape (n, 3), not {vertices.shape}")
        if indices.size == 0:
            indices = indices.reshape(0, 3).astype(np.uint32)
        if indices.ndim != 2 or indices.shape[1] != 3 or indices.dtype.kind not in "iu":
            raise ValueError("triangles must be whole numbers of the shape (m, 3), "
                             f"not {indices.dtype} {indices.shape}")
        if not np.isfinite(vertices).all():
            raise ValueError(f"vertex {np.flatnonzero(~np.isfinite(vertices).all(axis=1))[0]} is not finite")
        if indices.size and (indices.min() < 0 or indices.max() >= len(vertices)):
            raise ValueError(f"a triangle has an index outside of 0 to {len(vertices) - 1}")
        self._set(vertices, indices.astype(np.uint32))

    def _set(self, vertices, triangles, single_precision=False, report=None, source=None):
        self.vertices, self.triangles = vertices, triangles
        self.vertices.flags.writeable = self.triangles.flags.writeable = False
        self.single_precision, self.report, self.source = single_precision, report, source

    @classmethod
    def _take(cls, struct, report=None, source=None, release=True):
        """From a dem_mesh, which is copied and freed."""
        mesh = cls.__new__(cls)
        mesh._set(lib.view(struct.vertices, (struct.vertex_count, 3), "f8", None).copy(),
                  lib.view(struct.triangles, (struct.triangle_count, 3), "u4", None).copy(),
                  bool(struct.single_precision), report, source)
        if release:
            lib.call("dem_mesh_free", ctypes.byref(struct))
        return mesh

    def _struct(self):
        """A dem_mesh over the arrays, for calls that only read."""
        return lib.struct.mesh(vertices=self.vertices.ctypes.data, triangles=self.triangles.ctypes.data,
                               vertex_count=len(self.vertices), triangle_count=len(self.triangles),
                               single_precision=self.single_precision)

    def __repr__(self):
        return f"<Mesh of {len(self.triangles)} triangles, {len(self.vertices)} vertices>"

    @property
    def closed(self):
        """Whether every edge is run through as often in one direction as in the other, as solid() needs."""
        a = self.triangles.astype(np.uint64)
        b = np.roll(a, -1, axis=1)
        n = np.uint64(max(len(self.vertices), 1))
        return len(a) > 0 and np.array_equal(np.sort((a * n + b).ravel()), np.sort((b * n + a).ravel()))

    def scaled(self, factor):
        """A mesh with every coordinate times `factor` [-]."""
        mesh = Mesh(self.vertices * float(factor), self.triangles)
        mesh.single_precision, mesh.source = self.single_precision, self.source
        return mesh

    def repair(self, repair="auto", keep="one", wrap_detail=0.0, threads=0):
        """Welded, checked and repaired: a new mesh, one closed, outward-oriented surface per body, with a report.

        repair: auto (mend what needs no guess), strict (refuse what needs more than welding), wrap (wrap whatever is
        there in a closed surface) or none. keep: one (several bodies are an error), largest or all. wrap_detail:
        smallest feature the wrap follows, as a part of the bounding diagonal [-]. Every repair is a warning to the
        logger "demclump". Raises InputError where it encloses no volume or the volume would be a guess.
        """
        context = lib.Context(threads, subject=self.source.file if self.source else None)
        options = lib.struct.repair_options(repair=lib.choice("repair", repair, _REPAIRS),
                                            keep=lib.choice("keep", keep, _KEEPS), wrap_detail=wrap_detail)
        report, copy = lib.struct.mesh_report(), lib.struct.mesh()
        lib.call("dem_mesh_copy", ctypes.byref(self._struct()), ctypes.byref(copy))
        try:
            lib.call("dem_mesh_repair", context(), ctypes.byref(copy), ctypes.byref(options), ctypes.byref(report),
                     context=context)
        except BaseException:
            lib.call("dem_mesh_free", ctypes.byref(copy))
            raise
        return Mesh._take(copy, lib.record(report), self.source)

    def split(self):
        """The closed bodies of a repaired mesh (keep="all"), largest first: a list of meshes."""
        bodies, count = ctypes.c_void_p(), ctypes.c_size_t()
        lib.call("dem_mesh_split", ctypes.byref(self._struct()), ctypes.byref(bodies), ctypes.byref(count))
        items = ctypes.cast(bodies, ctypes.POINTER(lib.struct.mesh))
        meshes = [Mesh._take(items[i], self.report, self.source) for i in range(count.value)]
        lib.free(bodies)
        return meshes

    def solid(self):
        """Exact mass properties at unit density of a closed mesh.

        volume [m^3], area [m^2], centre (3,) [m], inertia (3, 3) about the centre [m^5], principal (3,) ascending
        [m^5], axes: quaternion w, x, y, z from the principal frame to that of the mesh. Raises InputError if it is not
        closed.
        """
        if not self.closed:
            raise lib.InputError("the mesh is not closed, so that it has no volume; repair() it first", 3)
        return lib.record(lib.call("dem_mesh_solid", ctypes.byref(self._struct())))

    def shape(self, threads=0):
        """Size and form of a repaired mesh: equivalent_diameter, longest, intermediate, shortest [m]; elongation,
        flatness, sphericity, convexity, roundness, angularity [-]."""
        context, shape = lib.Context(threads), lib.struct.shape()
        lib.call("dem_shape_measure", context(), ctypes.byref(self._struct()), ctypes.byref(shape), context=context)
        return lib.record(shape)


def read_mesh(path, unit="m"):
    """Reads STL, OBJ, PLY or OFF, and with libdemshape what assimp knows (glTF, 3MF, ...), as the file has it.

    unit: length unit of the file, a name ("mm") or the length of one [m]. Raises InputError with file and line.

    >>> mesh = read_mesh("grain.obj", unit="mm").repair()
    """
    length = _UNITS.get(unit, unit)
    if not isinstance(length, (int, float)) or not 0 < length < float("inf"):
        raise lib.UsageError(f"unit must be a positive length in metres or one of {', '.join(_UNITS)}, not {unit!r}", 2)
    context, struct = lib.Context(subject=os.fspath(path)), lib.struct.mesh()
    reader = "dem_mesh_import" if lib.has_shape_library() else "dem_mesh_read"
    lib.call(reader, context(), lib.path_bytes(path), ctypes.byref(struct), context=context)
    mesh = Mesh._take(struct)
    if length != 1:
        mesh = mesh.scaled(length)
    mesh.source = types.SimpleNamespace(file=os.fsdecode(path), sha256=_sha256(path), unit=str(unit))
    return mesh


def _sha256(path):
    try:
        with open(path, "rb") as file:
            return hashlib.sha256(file.read()).hexdigest()
    except OSError:
        return None
