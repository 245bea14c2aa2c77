"""Plans as bytes and as files: see docs/plan-file.md."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Collection, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import _core, files
from ..hints import hinted
from .model import Plan
from .parsing import FORMAT, PLAIN, VERSION, WrongPlaceError, to_plan

if TYPE_CHECKING:
    from typing_extensions import Buffer  # typeshed's own; collections.abc has it from Python 3.12 on


class Texts:
    """A cache for ``dumps`` of successive plans. Arrays of the plans must not change meanwhile.

    Paths that the next plan shares, the same objects with the same cutter locations, are not formatted again.

    Attributes
    ----------
    made : int
        Number of formatted paths.

    Examples
    --------
    >>> texts = riffler.plan.Texts()
    >>> data = riffler.plan.dumps(riffler.plan.Plan([], riffler.Tool.ball(diameter=4, length=20)), texts=texts)
    >>> texts.made
    0
    """

    def __init__(self) -> None:
        self.made = 0
        # Keeps the objects alive, so that no other object gets their ids.
        self._kept: dict[tuple[int, int, bool, float | None], tuple[Any, Any, bytes]] = {}

    def _of(
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


@hinted("plan.dumps")
def dumps(plan: Plan, *, texts: Texts | None = None) -> bytes:
    """The plan as the bytes that ``save`` writes.

    Parameters
    ----------
    plan : Plan
        The plan.
    texts : Texts, optional
        A cache, for successive plans.

    Returns
    -------
    bytes

    Raises
    ------
    ValueError
        Naming the fault, if it is not a plan.

    Examples
    --------
    >>> plan = riffler.plan.Plan([], riffler.Tool.ball(diameter=4, length=20))
    >>> riffler.plan.loads(riffler.plan.dumps(plan)).tool == plan.tool
    True
    """
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
    entries = (texts or Texts())._of(plan.paths, cl, plan.off, plan.depths)
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
    """JSON on one line: with indentation Python's encoder is two to four times as slow and writes twice the bytes."""
    return json.dumps(value, allow_nan=False, ensure_ascii=False)


@hinted("plan.save")
def save(path: str | os.PathLike[str], plan: Plan) -> None:
    """Writes a plan: the whole file or none.

    Parameters
    ----------
    path : path_like
        The .json file.
    plan : Plan
        The plan.

    Raises
    ------
    ValueError
        Naming the fault, if it is not a plan.
    RuntimeError
        With the system's reason.

    Examples
    --------
    >>> riffler.plan.save("a.json", riffler.plan.Plan([], riffler.Tool.ball(diameter=4, length=20)))
    >>> riffler.plan.load("a.json").paths
    []
    """
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


@hinted("plan.loads")
def loads(data: Buffer, *, name: str = "plan") -> Plan:
    """A plan from the bytes of ``dumps``.

    Parameters
    ----------
    data : bytes
        The bytes.
    name : str
        Name of the file, for messages.

    Returns
    -------
    Plan

    Raises
    ------
    FormatError
        Naming ``name``, the place in it and what was expected.

    Examples
    --------
    >>> plan = riffler.plan.Plan([], riffler.Tool.ball(diameter=4, length=20))
    >>> riffler.plan.loads(riffler.plan.dumps(plan)).paths
    []
    """
    try:
        read = json.loads(bytes(data), parse_constant=_no_constant)
    except (ValueError, RecursionError) as error:  # of encoding and of JSON alike
        raise _core.FormatError(f"{name}: {error}") from None
    try:
        return to_plan(read)
    except WrongPlaceError as error:
        raise _core.FormatError(f"{name}: {error}") from None


@hinted("plan.load")
def load(path: str | os.PathLike[str]) -> Plan:
    """Reads a plan.

    Parameters
    ----------
    path : path_like
        The .json file.

    Returns
    -------
    Plan

    Raises
    ------
    FormatError
        Naming the file and the place in it, and what was expected there.

    Examples
    --------
    >>> riffler.plan.save("a.json", riffler.plan.Plan([], riffler.Tool.ball(diameter=4, length=20)))
    >>> riffler.plan.load("a.json").tool.diameter
    4.0
    """
    target = Path(path)
    return loads(files.read(target), name=target.name)


def _no_constant(name: str) -> None:
    raise ValueError(f"{name} is not a number in JSON")
