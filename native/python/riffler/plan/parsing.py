"""Makes a plan from the data of its file, with the place of errors."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from .. import _core
from .model import Plan

FORMAT, VERSION = "riffler-plan", 2
PLAIN = 1  # version of plans without depths, which older readers understand
RULES = ("", "linear", "slerp", "smooth")


class WrongPlaceError(ValueError):
    """An error at a place in the file, with what was expected."""


def _get(table: Any, key: str, place: str) -> Any:
    if not isinstance(table, dict):
        raise WrongPlaceError(f"{place or 'the file'}: an object expected")
    if key not in table:
        raise WrongPlaceError(f"{place + '.' if place else ''}{key}: missing")
    return table[key]


def _number(value: Any, place: str) -> float:
    try:
        if not isinstance(value, bool) and isinstance(value, int | float) and math.isfinite(value):
            return float(value)
    except OverflowError:  # of a whole number
        pass
    raise WrongPlaceError(f"{place}: a number expected")


def _array(value: Any, shape: tuple[int, ...], place: str) -> np.ndarray:
    """The value as an array of that shape; -1 stands for any number of rows."""
    wanted = ", ".join("n" if size < 0 else str(size) for size in shape)
    if not isinstance(value, list):
        raise WrongPlaceError(f"{place}: an array ({wanted}) expected")
    try:
        array = np.array(value, dtype=float) if value else np.empty((0, *shape[1:]))
    except (ValueError, TypeError, OverflowError):
        raise WrongPlaceError(f"{place}: an array ({wanted}) of numbers expected") from None
    if array.ndim != len(shape) or any(want not in (-1, size) for want, size in zip(shape, array.shape, strict=True)):
        raise WrongPlaceError(f"{place}: the shape ({wanted}) expected, not {array.shape}")
    if not np.isfinite(array).all():
        raise WrongPlaceError(f"{place}[{int(np.argwhere(~np.isfinite(array))[0][0])}]: not finite")
    return array


def to_plan(data: Any) -> Plan:
    if _get(data, "format", "") != FORMAT:
        raise WrongPlaceError(f'format: "{FORMAT}" expected')
    version = _get(data, "version", "")
    if isinstance(version, bool) or version not in (PLAIN, VERSION):
        newer = ": a newer Riffler wrote it" if isinstance(version, int) and version > VERSION else ""
        raise WrongPlaceError(f"version: {PLAIN} or {VERSION} expected, not {version!r}{newer}")
    if _get(data, "units", "") != {"length": "mm", "angle": "rad"}:
        raise WrongPlaceError('units: {"length": "mm", "angle": "rad"} expected')
    try:
        tool = _core.Tool.from_dict(_get(data, "tool", ""))
    except (ValueError, TypeError) as error:
        raise WrongPlaceError(f"tool: {str(error).splitlines()[0]}") from None
    tolerance = _get(data, "tolerance", "")
    for name in ("part", "provenance"):
        if not isinstance(_get(data, name, ""), dict):
            raise WrongPlaceError(f"{name}: an object expected")
    paths = _get(data, "paths", "")
    if not isinstance(paths, list):
        raise WrongPlaceError("paths: a list expected")
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
    """The path, its cutter locations, whether it is off, and its depth. `depths`: whether the version has depths."""
    centres = _array(_get(entry, "centres", place), (-1, 3), f"{place}.centres")
    n = len(centres)
    closed = _get(entry, "closed", place)
    if not isinstance(closed, bool):
        raise WrongPlaceError(f"{place}.closed: true or false expected")
    off = entry.get("off", False)
    if not isinstance(off, bool):
        raise WrongPlaceError(f"{place}.off: true or false expected")
    try:
        path = _core.PencilPath(
            _number(_get(entry, "radius", place), f"{place}.radius"),
            centres,
            _array(_get(entry, "contacts", place), (n, 2, 3), f"{place}.contacts"),
            _array(_get(entry, "normals", place), (n, 2, 3), f"{place}.normals"),
            closed=closed,
        )
    except WrongPlaceError:
        raise
    except ValueError as error:
        raise WrongPlaceError(f"{place}: {error}") from None
    if "axes" in entry:
        path = _with_axes(path, entry, place)
    cl = _array(entry["cl"], (-1, 6), f"{place}.cl") if "cl" in entry else None
    return path, cl, off, _depth(entry, path, place) if depths and "depth" in entry else None


def _depth(entry: dict, path, place: str) -> float:
    depth = _number(entry["depth"], f"{place}.depth")
    if depth < 0 or not len(path.axes):
        raise WrongPlaceError(f"{place}.depth: {'not negative' if depth < 0 else 'axes of the same path'} expected")
    return depth


def _with_axes(path, entry: dict, place: str):
    rule = _get(entry, "interpolation", place)
    if rule not in RULES:
        raise WrongPlaceError(f"{place}.interpolation: {', '.join(filter(None, RULES))} expected, not {rule!r}")
    rows = _get(entry, "keys", place)
    if not isinstance(rows, list):
        raise WrongPlaceError(f"{place}.keys: a list expected")
    keys = {}
    for k, row in enumerate(rows):
        index = _get(row, "index", f"{place}.keys[{k}]")
        if isinstance(index, bool) or not isinstance(index, int):
            raise WrongPlaceError(f"{place}.keys[{k}].index: a whole number expected")
        keys[index] = _array(_get(row, "axis", f"{place}.keys[{k}]"), (3,), f"{place}.keys[{k}].axis")
    axes = _array(entry["axes"], (len(path), 3), f"{place}.axes")
    try:
        return path.with_axes(axes, keys=keys, interpolation=rule)
    except ValueError as error:
        raise WrongPlaceError(f"{place}: {error}") from None
