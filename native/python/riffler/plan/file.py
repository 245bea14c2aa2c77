"""Plans as bytes and as files: see docs/plan-file.md."""

from __future__ import annotations

import json
import math
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np

from .. import _core, files

FORMAT, VERSION = "riffler-plan", 2
PLAIN = 1  # the version of a plan without depths, which older readers read
RULES = ("", "linear", "slerp", "smooth")


@dataclass
class Plan:
    """Paths with the tool they are for, and how they came about.

    ``cl``: for every path (n, 6) cutter locations, or None. ``part``: a dict with ``name`` and ``sha256``, as by
    ``part_of``. ``tolerance``: mm. ``provenance``: a dict of strings. ``off``: numbers, from 0, of the paths that are
    not to be cut. ``depths``: by number, from 0, the paths whose poses (``poses_of``) are what is to be cut, as by
    engraving, and how far the cutter enters the part there, mm: they are never lifted, nor oriented.
    """

    paths: list
    tool: _core.Tool
    cl: list = field(default_factory=list)
    part: dict = field(default_factory=dict)
    tolerance: float | None = None
    provenance: dict = field(default_factory=dict)
    off: frozenset = frozenset()
    depths: dict = field(default_factory=dict)

    @property
    def deepest(self) -> float:
        """mm that the cutter enters the part by, as ``depths`` say of the paths that are on."""
        return max((depth for k, depth in self.depths.items() if k not in self.off), default=0.0)

    @property
    def sources(self) -> list:
        """Paths from which a strategy may start: those that are on and whose poses may be changed."""
        return [path for k, path in enumerate(self.paths) if k not in self.off and k not in self.depths]


def part_of(mesh, name: str) -> dict[str, str]:
    """What a plan keeps of its part: its name and the hash of its vertices and triangles."""
    import hashlib  # brings OpenSSL: 3 MB that only plan files need

    digest = hashlib.sha256()
    digest.update(np.ascontiguousarray(mesh.vertices, dtype="<f8").tobytes())
    digest.update(np.ascontiguousarray(mesh.triangles, dtype="<i4").tobytes())
    return {"name": str(name), "sha256": digest.hexdigest()}


class Texts:
    """The paths of the plan that ``dumps`` wrote last, as text: those that the next plan has as well, the same objects
    with the same cutter locations, are not formatted again. ``made``: how many were. Arrays must not change meanwhile.
    """

    def __init__(self) -> None:
        self.made = 0
        # Has the objects, so that their ids stay theirs.
        self._kept: dict[tuple[int, int, bool, float | None], tuple[Any, Any, bytes]] = {}

    def of(
        self, paths: list, cl: list, off: Collection[int] = (), depths: Mapping[int, float] = MappingProxyType({})
    ) -> list[bytes]:
        each = enumerate(zip(paths, cl, strict=True))
        kept, keys = {}, [(id(path), id(rows), k in off, depths.get(k)) for k, (path, rows) in each]
        for k, key in enumerate(keys):
            if key in self._kept:
                kept[key] = self._kept[key]
            elif key not in kept:
                entry = _from_path(paths[k], cl[k], k, off=key[2], depth=key[3])
                kept[key] = paths[k], cl[k], f"  {_compact(entry)}".encode()
                self.made += 1
        self._kept = kept
        return [kept[key][2] for key in keys]


def dumps(plan: Plan, texts: Texts | None = None) -> bytes:
    """The plan as the bytes that ``save`` writes. ``texts``: of the plan before, for plans that follow one another.
    ValueError for no plan."""
    cl = list(plan.cl) or [None] * len(plan.paths)
    if len(cl) != len(plan.paths):
        raise ValueError(f"cl: {len(plan.paths)} expected, one for each path, not {len(cl)}")
    if strangers := sorted(k for k in plan.off if not 0 <= k < len(plan.paths)):
        raise ValueError(f"off: there is no path {strangers[0]}: the plan has {len(plan.paths)}, from 0")
    _check_depths(plan)
    data = {
        "format": FORMAT,
        "version": VERSION if plan.depths else PLAIN,
        "units": {"length": "mm", "angle": "rad"},
        "provenance": {"riffler": _core.__version__, **{str(k): str(v) for k, v in plan.provenance.items()}},
        "part": dict(plan.part),
        "tool": plan.tool.to_dict(),
        "tolerance": plan.tolerance,
    }
    entries = (texts or Texts()).of(plan.paths, cl, plan.off, plan.depths)
    lines = [f" {_compact(name)}: {_compact(value)}" for name, value in data.items()]
    head = '{{\n{},\n "paths": [\n'.format(",\n".join(lines))
    return b"".join((head.encode(), b",\n".join(entries), b"\n ]\n}\n"))


def _check_depths(plan: Plan) -> None:
    for k, depth in plan.depths.items():
        if not 0 <= k < len(plan.paths):
            raise ValueError(f"depths: there is no path {k}: the plan has {len(plan.paths)}, from 0")
        if not (math.isfinite(depth) and depth >= 0):
            raise ValueError(f"depths[{k}] must be finite and not negative, not {depth}")
        if not len(plan.paths[k].axes):
            raise ValueError(f"depths: path {k} has no axes")


def _compact(value) -> str:
    """On one line: indented, Python's encoder is two to four times as slow, and makes twice the bytes."""
    return json.dumps(value, allow_nan=False, ensure_ascii=False)


def save(path, plan: Plan) -> None:
    """Writes a plan; the file is whole or not there. ValueError for no plan, RuntimeError with the system's reason."""
    files.write(path, dumps(plan))


def _from_path(path, cl, number: int, *, off: bool, depth: float | None) -> dict[str, Any]:
    out: dict[str, Any] = {
        "radius": path.radius,
        "closed": path.closed,
        "centres": path.centres.tolist(),
        "contacts": path.contacts.tolist(),
        "normals": path.normals.tolist(),
    }
    if off:
        out["off"] = True
    if depth is not None:
        out["depth"] = float(depth)
    if len(path.axes):
        out["interpolation"] = path.interpolation
        out["keys"] = [{"index": k, "axis": list(map(float, axis))} for k, axis in path.keys.items()]
        out["axes"] = path.axes.tolist()
    if cl is not None:
        rows = np.asarray(cl, dtype=float)
        if rows.ndim != 2 or rows.shape[1] != 6 or not np.isfinite(rows).all():
            raise ValueError(f"cl[{number}] must have the shape (n, 6) and be finite")
        out["cl"] = rows.tolist()
    return out


def loads(data, name: str = "plan") -> Plan:
    """The plan of the bytes that ``dumps`` made. FormatError says ``name``, the place in it and what was expected."""
    try:
        read = json.loads(bytes(data), parse_constant=_no_constant)
    except (ValueError, RecursionError) as error:  # of encoding and of JSON alike
        raise _core.FormatError(f"{name}: {error}") from None
    try:
        return _to_plan(read)
    except _WrongPlaceError as error:
        raise _core.FormatError(f"{name}: {error}") from None


def load(path) -> Plan:
    """Reads a plan. FormatError names the file and the place in it, and what was expected there."""
    target = Path(path)
    return loads(files.read(target), target.name)


class _WrongPlaceError(ValueError):
    """What a place in the file should have been."""


def _no_constant(name: str) -> None:
    raise ValueError(f"{name} is not a number in JSON")


def _get(table: Any, key: str, place: str) -> Any:
    if not isinstance(table, dict):
        raise _WrongPlaceError(f"{place or 'the file'}: an object expected")
    if key not in table:
        raise _WrongPlaceError(f"{place + '.' if place else ''}{key}: missing")
    return table[key]


def _number(value: Any, place: str) -> float:
    try:
        if not isinstance(value, bool) and isinstance(value, int | float) and math.isfinite(value):
            return float(value)
    except OverflowError:  # of a whole number
        pass
    raise _WrongPlaceError(f"{place}: a number expected")


def _array(value: Any, shape: tuple[int, ...], place: str) -> np.ndarray:
    """``shape``: -1 for any number of rows."""
    wanted = ", ".join("n" if size < 0 else str(size) for size in shape)
    if not isinstance(value, list):
        raise _WrongPlaceError(f"{place}: an array ({wanted}) expected")
    try:
        array = np.array(value, dtype=float) if value else np.empty((0, *shape[1:]))
    except (ValueError, TypeError, OverflowError):
        raise _WrongPlaceError(f"{place}: an array ({wanted}) of numbers expected") from None
    if array.ndim != len(shape) or any(want not in (-1, size) for want, size in zip(shape, array.shape, strict=True)):
        raise _WrongPlaceError(f"{place}: the shape ({wanted}) expected, not {array.shape}")
    if not np.isfinite(array).all():
        raise _WrongPlaceError(f"{place}[{int(np.argwhere(~np.isfinite(array))[0][0])}]: not finite")
    return array


def _to_plan(data: Any) -> Plan:
    if _get(data, "format", "") != FORMAT:
        raise _WrongPlaceError(f'format: "{FORMAT}" expected')
    version = _get(data, "version", "")
    if isinstance(version, bool) or version not in (PLAIN, VERSION):
        newer = ": a newer Riffler wrote it" if isinstance(version, int) and version > VERSION else ""
        raise _WrongPlaceError(f"version: {PLAIN} or {VERSION} expected, not {version!r}{newer}")
    if _get(data, "units", "") != {"length": "mm", "angle": "rad"}:
        raise _WrongPlaceError('units: {"length": "mm", "angle": "rad"} expected')
    try:
        tool = _core.Tool.from_dict(_get(data, "tool", ""))
    except (ValueError, TypeError) as error:
        raise _WrongPlaceError(f"tool: {str(error).splitlines()[0]}") from None
    tolerance = _get(data, "tolerance", "")
    for name in ("part", "provenance"):
        if not isinstance(_get(data, name, ""), dict):
            raise _WrongPlaceError(f"{name}: an object expected")
    paths = _get(data, "paths", "")
    if not isinstance(paths, list):
        raise _WrongPlaceError("paths: a list expected")
    read = [_to_path(entry, f"paths[{k}]", version > PLAIN) for k, entry in enumerate(paths)]
    return Plan(
        paths=[path for path, *_ in read],
        tool=tool,
        cl=[cl for _, cl, *_ in read],
        part=data["part"],
        tolerance=None if tolerance is None else _number(tolerance, "tolerance"),
        provenance=data["provenance"],
        off=frozenset(k for k, (_, _, off, _) in enumerate(read) if off),
        depths={k: depth for k, (*_, depth) in enumerate(read) if depth is not None},
    )


def _to_path(entry: Any, place: str, depths: bool) -> tuple[Any, np.ndarray | None, bool, float | None]:
    """The path, its cutter locations, whether it is off, and its depth. `depths`: of a version that has them."""
    centres = _array(_get(entry, "centres", place), (-1, 3), f"{place}.centres")
    n = len(centres)
    closed = _get(entry, "closed", place)
    if not isinstance(closed, bool):
        raise _WrongPlaceError(f"{place}.closed: true or false expected")
    off = entry.get("off", False)
    if not isinstance(off, bool):
        raise _WrongPlaceError(f"{place}.off: true or false expected")
    try:
        path = _core.PencilPath(
            _number(_get(entry, "radius", place), f"{place}.radius"),
            centres,
            _array(_get(entry, "contacts", place), (n, 2, 3), f"{place}.contacts"),
            _array(_get(entry, "normals", place), (n, 2, 3), f"{place}.normals"),
            closed,
        )
    except _WrongPlaceError:
        raise
    except ValueError as error:
        raise _WrongPlaceError(f"{place}: {error}") from None
    if "axes" in entry:
        path = _with_axes(path, entry, place)
    cl = _array(entry["cl"], (-1, 6), f"{place}.cl") if "cl" in entry else None
    return path, cl, off, _depth(entry, path, place) if depths and "depth" in entry else None


def _depth(entry: dict, path, place: str) -> float:
    depth = _number(entry["depth"], f"{place}.depth")
    if depth < 0 or not len(path.axes):
        raise _WrongPlaceError(f"{place}.depth: {'not negative' if depth < 0 else 'axes beside it'} expected")
    return depth


def _with_axes(path, entry: dict, place: str):
    rule = _get(entry, "interpolation", place)
    if rule not in RULES:
        raise _WrongPlaceError(f"{place}.interpolation: {', '.join(filter(None, RULES))} expected, not {rule!r}")
    rows = _get(entry, "keys", place)
    if not isinstance(rows, list):
        raise _WrongPlaceError(f"{place}.keys: a list expected")
    keys = {}
    for k, row in enumerate(rows):
        index = _get(row, "index", f"{place}.keys[{k}]")
        if isinstance(index, bool) or not isinstance(index, int):
            raise _WrongPlaceError(f"{place}.keys[{k}].index: a whole number expected")
        keys[index] = _array(_get(row, "axis", f"{place}.keys[{k}]"), (3,), f"{place}.keys[{k}].axis")
    axes = _array(entry["axes"], (len(path), 3), f"{place}.axes")
    try:
        return path.with_axes(axes, keys, rule)
    except ValueError as error:
        raise _WrongPlaceError(f"{place}: {error}") from None
