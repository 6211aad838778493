"""Worlds: many clumps as rigid bodies, taken through time."""
import ctypes
import json
import operator
import os
import time
import weakref

from . import _library as lib
from .clump import Clump


class World:
    """The bodies and walls of a scene (dem-scene/1), stepped forward.

    >>> world = World("sand.json", {"time.step": 1e-6})
    >>> world.step(1000)
    >>> world.positions.mean(axis=0), world.figures.energy.kinetic

    Arrays of bodies are in the order they were placed, n long, brought to the time of the positions. They are read-only
    views of the library's memory: after the next step, looking at any of them changes all. Copy what you want to keep.
    """

    _COLUMNS = {  # name: column, type, width, what
        "shapes": ("shape", "u4", 0, "(n,) index of each body's shape in the scene"),
        "scales": ("scale", "f8", 0, "(n,) scale of the shape [-]"),
        "masses": ("mass", "f8", 0, "(n,) [kg]"),
        "positions": ("position", "f8", 3, "(n, 3) centres of mass, inside a periodic domain [m]"),
        "orientations": ("orientation", "f8", 4, "(n, 4) quaternions w, x, y, z, principal frame -> space"),
        "velocities": ("velocity", "f8", 3, "(n, 3) [m/s]"),
        "spins": ("spin", "f8", 3, "(n, 3) angular velocities, axes of space [rad/s]"),
        "forces": ("force", "f8", 3, "(n, 3) of contacts and walls [N]"),
        "moments": ("moment", "f8", 3, "(n, 3) about the centres of mass [N m]"),
        "coordination": ("coordination", "u4", 0, "(n,) number of bodies and walls touched"),
    }

    def __init__(self, scene, overrides=None, threads=0, progress=None):
        """scene: path of a scene file. overrides: {"path.to.key": value}. threads: 0 for all cores.
        progress(what, fraction) is called while bodies are placed; True stops. Raises InputError with file and line."""
        self._context = lib.Context(threads, progress, os.fspath(scene))
        read, handle = lib.struct.scene(), ctypes.c_void_p()
        texts = [f"{key}={value if isinstance(value, str) else json.dumps(value)}".encode()
                 for key, value in (overrides or {}).items()]
        lib.call("dem_scene_read", self._context(), lib.path_bytes(scene),
                 (ctypes.c_char_p * (len(texts) + 1))(*texts, None), ctypes.byref(read), context=self._context)
        try:
            lib.call("dem_world_create", self._context(), ctypes.byref(read), ctypes.byref(handle),
                     context=self._context)
        finally:
            lib.call("dem_scene_release", ctypes.byref(read))
        self._handle, self._measured, self._burst = handle.value, None, 1
        # the context goes after the world, which talks through it
        weakref.finalize(self, _destroy, self._handle, self._context)

    def __repr__(self):
        return f"<World of {self._bodies().count} bodies at {self.time:.6g} s, step {self.steps}>"

    def step(self, steps=1):
        """Steps forward; Ctrl-C stops between steps. Raises Error naming body and step where the state runs away."""
        left = operator.index(steps)
        if left < 0:
            raise lib.UsageError(f"steps must be at least 0, not {left}", 2)
        while left:
            burst = min(left, self._burst)  # about a tenth of a second, so that Python can look up
            begin = time.monotonic()
            self._measured = None
            lib.call("dem_world_step", self._handle, burst, context=self._context)
            left -= burst
            took = time.monotonic() - begin
            if took < 0.05:
                self._burst *= 2
            elif took > 0.2 and self._burst > 1:
                self._burst //= 2

    @property
    def time(self):
        """[s]"""
        return lib.call("dem_world_time", self._handle)

    @property
    def steps(self):
        """Since the scene's start."""
        return lib.call("dem_world_steps", self._handle)

    @property
    def step_size(self):
        """Of the next step [s]."""
        return lib.call("dem_world_step_size", self._handle)

    @property
    def critical_step(self):
        """The largest stable step for the contacts as they are listed now [s]; inf: no contact."""
        return lib.call("dem_world_critical_step", self._handle)

    def push(self, body, force=(0, 0, 0), moment=(0, 0, 0)):
        """Adds a force through the centre of mass [N] and a moment [N m] to what acts on a body, in the next step only.
        """
        body, count = operator.index(body), self._bodies().count
        if not 0 <= body < count:
            raise IndexError(f"body {body} of {count}")
        lib.call("dem_world_push", self._handle, body, lib.vec3(force), lib.vec3(moment))

    def _measure(self):
        if self._measured is None:
            lib.call("dem_world_measure", self._handle)
            self._measured = True

    def _bodies(self):
        return lib.call("dem_world_bodies", self._handle)

    def _column(self, column, dtype, width):
        self._measure()
        bodies = self._bodies()
        shape = (bodies.count, width) if width else (bodies.count,)
        return lib.view(getattr(bodies, column), shape, dtype, self)

    @property
    def figures(self):
        """time [s], step, bodies, spheres, contacts, wall_contacts, coordination, overlap_ratio,
        largest_overlap_ratio, fastest [m/s], centre (3,) [m], highest [m], and energy: kinetic, rotational, potential,
        elastic, friction, viscous, local, drag, work, start [J], error [-] (nan: no ledger kept)."""
        self._measure()
        return lib.record(lib.call("dem_world_figures", self._handle).contents)

    def _list(self, function, name):
        self._measure()
        count = ctypes.c_size_t()
        return lib.array_of(name, lib.call(function, self._handle, ctypes.byref(count)), count.value)

    @property
    def contacts(self):
        """A copy, one record per touching pair of spheres: body, other, sphere, other_sphere, wall (2^32 - 1: none),
        point, normal, overlap [m], normal_force [N], friction_force [N]."""
        return self._list("dem_world_contacts", "dem_contact")

    @property
    def walls(self):
        """A copy, one record per wall: position [m], orientation, force [N], moment [N m], contacts."""
        return self._list("dem_world_walls", "dem_wall_view")

    def clump(self, shape):
        """The clump of a shape, by its index in the scene."""
        shapes = self.shapes
        if not 0 <= shape <= (int(shapes.max()) if len(shapes) else -1):
            raise IndexError(f"shape {shape}")
        return Clump(lib.call("dem_world_clump", self._handle, shape), owner=self)

    def save(self):
        """The whole state as bytes, from which restore() continues bit for bit."""
        data, size = ctypes.c_void_p(), ctypes.c_size_t()
        lib.call("dem_world_save", self._handle, ctypes.byref(data), ctypes.byref(size))
        state = ctypes.string_at(data, size.value)
        lib.free(data)
        return state

    def restore(self, state):
        """Puts a world of the same scene into a saved state. Raises InputError where it is broken or of another scene;
        the world is then of no further use."""
        self._measured = None
        lib.call("dem_world_restore", self._handle, state, len(state))

    @property
    def hash(self):
        """Of the state: equal for equal bits."""
        return lib.call("dem_world_hash", self._handle)

    def explain(self):
        """What the scene pays for, as text: columns with bytes per body and contact, passes, kernels, step."""
        text = ctypes.c_void_p()
        lib.call("dem_world_explain", self._handle, ctypes.byref(text))
        explained = lib.text_at(text.value)
        lib.free(text)
        return explained

    @property
    def passes(self):
        """{pass: seconds spent in it so far}"""
        count = ctypes.c_size_t()
        passes = lib.call("dem_world_passes", self._handle, ctypes.byref(count))
        return {lib.text_at(passes[i].name): passes[i].seconds for i in range(count.value)}

    @property
    def bytes_per_body(self):
        """Memory the state takes, by body [B]."""
        return lib.call("dem_world_bytes_per_body", self._handle)


def _destroy(handle, context):
    lib.call("dem_world_destroy", handle)
    del context


def _property(column, dtype, width, text):
    return property(lambda world: world._column(column, dtype, width), doc=text)


for _name, _row in World._COLUMNS.items():
    setattr(World, _name, _property(*_row))
