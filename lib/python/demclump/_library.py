"""The shared libraries behind the module: found, checked, made callable.

The structures are made from the table the library keeps of its own (dem_abi), so that they cannot differ from what it
was compiled with; what the module needs and does not find there is refused when it is imported.
"""
import ctypes
import logging
import os
import pathlib
import types

import numpy as np

INTERFACE = "0.1"  # of the libraries this module fits, as in libdem.so.0.1

_TOGETHER = "install module and library together"

log = logging.getLogger("demclump")


class Error(Exception):
    """What the library says when something cannot be done.

    status: its number (dem_status); file, line: where, or None.
    """

    def __init__(self, text, status=1, file=None, line=None):
        super().__init__(text)
        self.status, self.file, self.line = status, file, line


class UsageError(Error, ValueError):
    """A parameter outside its range."""


class InputError(Error, ValueError):
    """A file or a mesh that cannot be used."""


class WriteError(Error, OSError):
    """A file that could not be written."""


class Interrupted(Error):
    """The progress callback asked to stop."""


class UnavailableError(Error):
    """The library was built without what this needs."""


_ERRORS = {2: UsageError, 3: InputError, 4: WriteError, 130: Interrupted, 132: UnavailableError}

_KINDS = {
    "bool": ctypes.c_bool, "char": ctypes.c_char, "i32": ctypes.c_int32, "u32": ctypes.c_uint32,
    "i64": ctypes.c_int64, "u64": ctypes.c_uint64, "f64": ctypes.c_double, "pointer": ctypes.c_void_p,
}
_DTYPES = {"bool": "?", "i32": "i4", "u32": "u4", "i64": "i8", "u64": "u8", "f64": "f8", "pointer": "u8"}
_VECTORS = {"dem_vec3": 3, "dem_quat": 4}  # shown as arrays

# what the module reads and writes by name
_NEEDED = {
    "dem_error": "code line file text", "dem_ctx": "log progress threads", "dem_ball": "centre radius",
    "dem_mesh": "vertices triangles vertex_count triangle_count single_precision",
    "dem_repair_options": "repair keep wrap_detail", "dem_solid": "volume area centre inertia principal axes",
    "dem_pack_options": "method spheres gap max_spheres effort moments side seed",
    "dem_make_options": "pack density mass_from name source_mesh source_sha256 source_unit surface_triangles",
    "dem_clump_def": "name source_mesh source_sha256 source_unit density mass volume inertia mass_from position "
                     "orientation union_volume union_centre union_inertia balls ball_count surface fidelity shape "
                     "method parameters seed seconds version",
    "dem_body_view": "count shape scale mass position orientation velocity spin force moment coordination",
    "dem_contact": "", "dem_wall_view": "", "dem_figures": "energy", "dem_pass_time": "name seconds", "dem_scene": "",
    "dem_fidelity": "", "dem_shape": "", "dem_mesh_report": "", "dem_union": "solid", "dem_picture_options": "",
}

# result and arguments; the error behind the last is left out where the result is a status
_DEM = {
    "dem_mesh_read": "status dem_ctx* text dem_mesh*",
    "dem_mesh_free": "none dem_mesh*",
    "dem_mesh_copy": "status dem_mesh* dem_mesh*",
    "dem_mesh_solid": "dem_solid dem_mesh*",
    "dem_clump_read": "status text handle*",
    "dem_clump_write": "status handle text",
    "dem_clump_export": "status dem_ctx* handle dem_mesh* text bool text",
    "dem_export_format": "text size",
    "dem_clump_destroy": "none handle",
    "dem_clump_hash": "u64 handle",
    "dem_clump_view": "dem_clump_def handle",
    "dem_balls_union": "status handle size dem_union*",
    "dem_scene_read": "status dem_ctx* text texts dem_scene*",
    "dem_scene_release": "none dem_scene*",
    "dem_world_create": "status dem_ctx* dem_scene* handle*",
    "dem_world_destroy": "none handle",
    "dem_world_step": "status handle u64",
    "dem_world_time": "f64 handle",
    "dem_world_steps": "u64 handle",
    "dem_world_step_size": "f64 handle",
    "dem_world_critical_step": "f64 handle",
    "dem_world_push": "none handle size dem_vec3 dem_vec3",
    "dem_world_measure": "status handle",
    "dem_world_figures": "dem_figures* handle",
    "dem_world_bodies": "dem_body_view handle",
    "dem_world_contacts": "handle handle size*",
    "dem_world_walls": "handle handle size*",
    "dem_world_clump": "handle handle u32",
    "dem_world_save": "status handle handle* size*",
    "dem_world_restore": "status handle text size",
    "dem_world_hash": "u64 handle",
    "dem_world_explain": "status handle handle*",
    "dem_world_passes": "dem_pass_time* handle size*",
    "dem_world_bytes_per_body": "f64 handle",
}
_SHAPE = {
    "dem_mesh_import": "status dem_ctx* text dem_mesh*",
    "dem_mesh_repair": "status dem_ctx* dem_mesh* dem_repair_options* dem_mesh_report*",
    "dem_mesh_split": "status dem_mesh* handle* size*",
    "dem_shape_measure": "status dem_ctx* dem_mesh* dem_shape*",
    "dem_fidelity_measure": "status dem_ctx* dem_mesh* handle size size dem_fidelity*",
    "dem_make_defaults": "dem_make_options",
    "dem_clump_make": "status dem_ctx* dem_mesh* dem_make_options* handle* handle",
}


def _folders():
    here = pathlib.Path(__file__).resolve().parent
    if os.environ.get("DEM_LIBRARY_DIR"):
        yield pathlib.Path(os.environ["DEM_LIBRARY_DIR"])
        return
    try:
        from . import _place  # written when installed
        yield (here / _place.LIBDIR).resolve()
    except ImportError:
        yield here.parents[2] / "build"  # in the source tree


def _load(name):
    file, tried = f"{name}.so.{INTERFACE}", []
    for folder in _folders():
        tried.append(str(folder / file))
        if (folder / file).exists():
            return ctypes.CDLL(str(folder / file))
    if not os.environ.get("DEM_LIBRARY_DIR"):
        try:
            return ctypes.CDLL(file)
        except OSError:
            tried.append("the system's libraries")
    raise ImportError(f"cannot find {file}; looked for {', '.join(tried)}; name its folder in DEM_LIBRARY_DIR")


class _Row(ctypes.Structure):
    _fields_ = [("type", ctypes.c_char_p), ("field", ctypes.c_char_p), ("kind", ctypes.c_char_p),
                ("offset", ctypes.c_size_t), ("size", ctypes.c_size_t)]


def _rows(dem):
    """{structure: (size, [(field, kind, offset, size)])} as the library tells it."""
    try:
        dem.dem_version.restype = ctypes.c_char_p
        version = dem.dem_version().decode()
        dem.dem_abi.restype = ctypes.POINTER(_Row)
    except AttributeError as missing:
        raise ImportError(f"{dem._name} is no libdem this module can use: {missing}") from None
    if version.split(".")[:2] != INTERFACE.split("."):
        raise ImportError(f"{dem._name} is version {version}, the module is for {INTERFACE}; {_TOGETHER}")
    count = ctypes.c_size_t()
    rows = dem.dem_abi(ctypes.byref(count))
    structures = {}
    for i in range(count.value):
        kind, name, field = rows[i].kind.decode(), rows[i].type.decode(), rows[i].field.decode()
        if field:
            structures[name][1].append((field, kind, rows[i].offset, rows[i].size))
        else:
            structures[name] = (rows[i].size, [])
    return version, structures


def _structure(name, size, fields, known):
    """The structure of a table; refused where ctypes lays it out in another way."""
    members = []
    for field, kind, _, bytes_ in fields:
        if kind not in known:
            raise ImportError(f"{name}.{field} of libdem is a '{kind}', which this module does not know; update it")
        element = known[kind]
        count = bytes_ // ctypes.sizeof(element)
        members.append((field, element if count == 1 else element * count))
    if not fields:
        members = [("bytes", ctypes.c_uint64 * ((size + 7) // 8))]
    made = type(name, (ctypes.Structure,), {"_fields_": members})
    fits = ctypes.sizeof(made) == size and all(getattr(made, f).offset == at for f, _, at, _ in fields)
    if not fits:
        raise ImportError(f"{name} of libdem has another layout than Python's ctypes gives it; update the module")
    return made


def _structures(dem):
    version, tables = _rows(dem)
    for name, fields in _NEEDED.items():
        if name not in tables:
            raise ImportError(f"libdem {version} ({dem._name}) has no structure {name}; {_TOGETHER}")
        missing = set(fields.split()) - {row[0] for row in tables[name][1]}
        if missing:
            raise ImportError(f"libdem {version} ({dem._name}) has no {name}.{min(missing)}; {_TOGETHER}")
    known = dict(_KINDS)
    for name, (size, fields) in tables.items():
        known[name] = _structure(name, size, fields, known)
    return version, known, tables


_dem = _load("libdem")
version, _known, _tables = _structures(_dem)
struct = types.SimpleNamespace(**{name[4:]: made for name, made in _known.items() if name.startswith("dem_")})

_PLAIN = dict(_known, status=ctypes.c_uint32, none=None, text=ctypes.c_char_p, handle=ctypes.c_void_p,
              size=ctypes.c_size_t, texts=ctypes.POINTER(ctypes.c_char_p))


def _declare(library, prototypes):
    for name, prototype in prototypes.items():
        function = getattr(library, name, None)
        if function is None:
            raise ImportError(f"{library._name} has no {name}; {_TOGETHER}")
        made = [ctypes.POINTER(_PLAIN[word[:-1]]) if word.endswith("*") else _PLAIN[word]
                for word in prototype.split()]
        if prototype.startswith("status"):
            made.append(ctypes.POINTER(struct.error))
        function.restype, function.argtypes = made[0], made[1:]


_declare(_dem, _DEM)
_shape = None


def has_shape_library():
    """Whether libdemshape is there, which makes clumps (libdem alone runs them)."""
    try:
        _shape_library()
    except UnavailableError:
        return False
    return True


def _shape_library():
    global _shape
    if _shape is None:
        try:
            _shape = _load("libdemshape")
        except (ImportError, OSError) as why:
            raise UnavailableError(f"making clumps needs libdemshape: {why}", 132) from None
        _declare(_shape, _SHAPE)
    return _shape


def call(name, *arguments, context=None):
    """Calls a function of the libraries; a status that is not DEM_OK is raised with the library's text."""
    library, prototypes = (_dem, _DEM) if name in _DEM else (_shape_library(), _SHAPE)
    if not prototypes[name].startswith("status"):
        return getattr(library, name)(*arguments)
    error = struct.error()
    status = getattr(library, name)(*arguments, ctypes.byref(error))
    if context is not None and context.raised is not None:
        raised, context.raised = context.raised, None
        raise raised
    if status != 0:
        raise _exception(status, error)
    return None


def _exception(status, error):
    text, file, line = error.text.decode("utf-8", "replace"), os.fsdecode(error.file), error.line
    if status == 131:
        return MemoryError(text)
    if file:
        text = f"{file}:{line}: {text}" if line else f"{file}: {text}"
    return _ERRORS.get(status, Error)(text, status, file or None, line or None)


_LOG = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_uint32, ctypes.c_char_p, ctypes.c_char_p)
_PROGRESS = ctypes.CFUNCTYPE(ctypes.c_bool, ctypes.c_void_p, ctypes.c_char_p, ctypes.c_double)
_LEVELS = (logging.WARNING, logging.INFO, logging.DEBUG)


class Context:
    """How a call talks to its caller: warnings go to logging ("demclump"), progress to a function, Ctrl-C stops.

    Keep it as long as the library holds on to it.
    """

    def __init__(self, threads=0, progress=None, subject=None):
        self.raised, self._progress, self._subject = None, progress, subject
        self._callbacks = _LOG(self._say), _PROGRESS(self._tell)
        self.struct = struct.ctx(threads=threads)
        self.struct.log, self.struct.progress = (ctypes.cast(c, ctypes.c_void_p).value for c in self._callbacks)

    def __call__(self):
        return ctypes.byref(self.struct)

    def _say(self, _, level, subject, text):
        subject = subject.decode("utf-8", "replace") if subject else self._subject
        text = text.decode("utf-8", "replace")
        log.log(_LEVELS[min(level, 2)], "%s", f"{subject}: {text}" if subject else text)

    def _tell(self, _, what, fraction):
        try:
            return bool(self._progress and self._progress(what.decode("utf-8", "replace"), fraction))
        except BaseException as raised:  # Ctrl-C too: raised again behind the call
            self.raised = raised
            return True


class _Memory:
    """Memory of the library as NumPy sees it; keeps its owner alive."""

    def __init__(self, address, shape, dtype, owner):
        self.owner = owner
        self.__array_interface__ = {"data": (address, True), "shape": shape, "typestr": dtype.str, "version": 3,
                                    **({"descr": dtype.descr} if dtype.names else {})}


def view(address, shape, dtype, owner):
    """A read-only array over memory that belongs to `owner`."""
    if not address or 0 in shape:
        return np.zeros(shape, dtype)
    return np.asarray(_Memory(address, shape, np.dtype(dtype), owner))


def dtype_of(name):
    """The NumPy type of a structure: vectors and quaternions as arrays, structures in it nested."""
    size, fields = _tables[name]
    formats = []
    for _, kind, _, bytes_ in fields:
        if kind in _VECTORS:
            formats.append(("f8", (_VECTORS[kind],)))
        elif kind in _DTYPES:
            element = np.dtype(_DTYPES[kind])
            count = bytes_ // element.itemsize
            formats.append((element, (count,)) if count > 1 else element)
        else:
            formats.append(dtype_of(kind))
    return np.dtype({"names": [f[0] for f in fields], "formats": formats, "offsets": [f[2] for f in fields],
                     "itemsize": size})


def array_of(name, address, count):
    """A copy of an array of structures."""
    dtype = dtype_of(name)
    if not address or not count:
        return np.zeros(0, dtype)
    return np.frombuffer(ctypes.string_at(address, count * dtype.itemsize), dtype).copy()


def record(value):
    """A structure as a plain object: numbers, arrays for vectors (3,), quaternions (4,), tensors (3, 3)."""
    if isinstance(value, (struct.vec3, struct.quat)):
        return np.array([getattr(value, name) for name, _ in value._fields_])
    if isinstance(value, struct.sym3):
        v = value
        return np.array([[v.xx, v.xy, v.xz], [v.xy, v.yy, v.yz], [v.xz, v.yz, v.zz]])
    if isinstance(value, ctypes.Array):
        return np.array(value)
    if isinstance(value, ctypes.Structure):
        return types.SimpleNamespace(**{name: record(getattr(value, name)) for name, _ in value._fields_})
    return value


def vec3(values):
    x, y, z = (float(v) for v in values)
    return struct.vec3(x, y, z)


def path_bytes(path):
    return os.fsencode(path)


def text_or_none(text):
    return None if text is None else str(text).encode()


def text_at(address):
    return ctypes.string_at(address).decode("utf-8", "replace") if address else ""


def choice(what, value, names):
    """The place of a name in the library's list of choices."""
    if value not in names:
        raise UsageError(f"{what} must be one of {', '.join(names)}, not {value!r}", 2)
    return names.index(value)


free = ctypes.CDLL(None).free
free.argtypes, free.restype = [ctypes.c_void_p], None
