"""Reads a job file, checks it, and makes the job: objects of Riffler."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._core import FormatError, Mesh, Tool, Volume, machine_options, machines
from ..formats import MESHES, PARTS, VOLUMES
from . import tool_files
from .kinds import KINDS, Kind, direction
from .table import JobError, JobFile, Table

CODE = (".ngc", ".nc", ".cnc", ".tap", ".gcode", ".mpf", ".h", ".i", ".apt", ".cls", ".txt")
RAYS = 400  # number of rays along the longest side of a stock, if the file sets no pitch
ZEROS = ("corner", "bottom-centre", "top-centre", "top-corner")


@dataclass(frozen=True)
class JobTool:
    """A tool with its number and feeds (mm/min; spindle in rev/min). ``name``: for the sheet."""

    number: int
    name: str
    tool: Tool
    feed: float | None = None
    plunge: float | None = None
    spindle: float | None = None
    flutes: int | None = None


@dataclass(frozen=True)
class JobOperation:
    """One operation: its kind, its tool and the options of the planner. ``table``: its table in the file."""

    name: str
    kind: str
    tool: JobTool
    options: Mapping[str, Any]
    table: Table = field(repr=False)

    def failed(self, error: ValueError) -> JobError:
        """The planner's error as a JobError, with the line of the key that the message names."""
        message = str(error)
        key = message.split(maxsplit=1)[0].strip(":,").split("[")[0] if message else ""
        known = key in self.table.data
        return self.table.error(key, message) if known else JobError(f"{self.table.where()} ({self.name}): {message}")

    @property
    def planner(self) -> Kind:
        return KINDS[self.kind]


@dataclass(frozen=True)
class Job:
    """A job that is ready to run: see `riffler.job.read`."""

    path: Path
    name: str
    part_file: Path
    part: Mesh
    stock: Volume
    fixtures: list[Volume | Mesh]
    fixture_files: list[Path]
    machine: str
    machine_options: Mapping[str, Any]
    axis: NDArray[np.float64]
    clearance: float
    zero: NDArray[np.float64]
    tools: dict[int, JobTool]
    operations: list[JobOperation]
    program: Path
    sheet: Path
    left: Path | None  # file for the stock that is left
    notes: list[str]


def read(path: str | os.PathLike[str]) -> Job:
    """Reads a job file and all files that it names.

    Parameters
    ----------
    path : path_like
        A TOML file; docs/jobs.md lists the keys.

    Returns
    -------
    Job

    Raises
    ------
    JobError
        The job file has an error. The message names file, line, table and key, and a remedy.
    FormatError
        A file cannot be read.

    Examples
    --------
    >>> from pathlib import Path
    >>> riffler.shape.relief([[0.3, 1.0], [0.6, 0.3]], size=(20, 20), depth=10).write("hill.stl")
    >>> text = '''
    ... part = "hill.stl"
    ... [[tool]]
    ... number = 1
    ... kind = "flat"
    ... diameter = 6
    ... [[operation]]
    ... kind = "rough"
    ... tool = 1
    ... '''
    >>> _ = Path("hill.toml").write_text(text)
    >>> job = riffler.job.read("hill.toml")
    >>> job.name, job.program.name, job.operations[0].kind
    ('hill', 'hill.ngc', 'rough')
    """
    file = JobFile(Path(path))
    table, notes = file.table, []
    name = table.text("name") or file.path.stem
    part_file, part = _part(table)
    stock = _stock(table, part)
    fixtures, fixture_files = _fixtures(table)
    machine, options, axis, clearance, zero = _machine(table, stock)
    tools = _tools(table, float(max(stock.upper - stock.lower)))
    operations = _operations(table, tools)
    program = table.file_name("program", CODE, exists=False) or file.path.with_suffix(".ngc")
    sheet = table.file_name("sheet", (".html", ".htm"), exists=False) or program.with_suffix(".html")
    left = table.file_name("left", MESHES + VOLUMES, exists=False)
    table.done()
    for number in sorted(tools.keys() - {op.tool.number for op in operations}):
        notes.append(f"tool {number} ({tools[number].name}) is used by no operation")
    return Job(
        file.path, name, part_file, part, stock, fixtures, fixture_files, machine, options, axis, clearance, zero,
        tools, operations, program, sheet, left, notes,
    )  # fmt: skip


def _part(table: Table) -> tuple[Path, Mesh]:
    place = np.zeros(3)
    if isinstance(table.data.get("part"), dict):
        sub = table.sub("part")
        assert sub is not None
        path, at, scale = sub.file_name("file", PARTS), sub.vector("move", 3), sub.number("scale", above=0)
        if path is None:
            raise sub.missing("file", '"part.stl"')
        sub.done()
        where, place, scale = sub.where("file"), place if at is None else at, scale or 1.0
    else:
        path, where, scale = table.file_name("part", PARTS), table.where("part"), 1.0
        if path is None:
            raise table.missing("part", '"part.stl"')
    mesh = _mesh(path, where)
    if scale != 1 or place.any():
        mesh = Mesh(mesh.vertices * scale + place, mesh.triangles)
    return path, mesh


def _mesh(path: Path, where: str) -> Mesh:
    try:
        mesh = Mesh.read(path)
    except FormatError as error:
        raise JobError(f"{where}: {error}") from None
    if not len(mesh.triangles):
        raise JobError(f"{where}: {path.name} has no triangles")
    return mesh


def _stock(table: Table, part: Mesh) -> Volume:
    sub = table.sub("stock") or Table(table.file, {}, ())
    kind = sub.text("kind", ("box", "cylinder", "mesh", "volume")) or "box"
    lower, upper = part.bounds
    if kind == "volume":
        path = _needed_file(sub, VOLUMES, '"left.rvol"')
        sub.done()
        return Volume.load(path)
    directions = sub.text("directions", ("z", "xyz")) or "z"
    asked = sub.number("pitch", above=0)
    if kind == "mesh":
        path = _needed_file(sub, PARTS, '"blank.stl"')
        mesh = _mesh(path, sub.where("file"))
        sub.done()
        pitch = asked or float(np.ptp(np.array(mesh.bounds), axis=0).max()) / RAYS
        return _made(sub, lambda: Volume.from_mesh(mesh, pitch, directions))
    sides, top, bottom = (sub.number(key, low=0) or 0.0 for key in ("sides", "top", "bottom"))
    low, high = lower - np.array([sides, sides, bottom]), upper + np.array([sides, sides, top])
    if kind == "box":
        given = sub.vector("lower", 3), sub.vector("upper", 3)
        low, high = (one if asked is None else asked for one, asked in zip((low, high), given, strict=True))
        if not (high > low).all():
            raise sub.error("upper", "must be above lower along x, y and z")
        sub.done()
        pitch = asked or float(max(high - low)) / RAYS
        return _made(sub, lambda: Volume.block(low, high, pitch, directions))
    centre = sub.vector("centre", 2)
    centre = 0.5 * (lower + upper)[:2] if centre is None else centre
    corners = np.array([[x, y] for x in (lower[0], upper[0]) for y in (lower[1], upper[1])])
    around = 2 * float(np.linalg.norm(corners - centre, axis=1).max() + sides)
    diameter = sub.number("diameter", above=0) or around
    sub.done()
    pitch = asked or max(diameter, float(high[2] - low[2])) / RAYS
    middle = [*centre, 0.5 * (low[2] + high[2])]
    return _made(sub, lambda: Volume.cylinder(middle, diameter / 2, float(high[2] - low[2]), pitch, directions))


def _made(sub: Table, make: Any) -> Volume:
    try:
        return make()
    except (ValueError, MemoryError) as error:
        raise JobError(f"{sub.where()}: {error or 'out of memory; take a larger pitch'}") from None


def _needed_file(sub: Table, suffixes: tuple[str, ...], example: str) -> Path:
    path = sub.file_name("file", suffixes)
    if path is None:
        raise sub.missing("file", example)
    return path


def _fixtures(table: Table) -> tuple[list[Volume | Mesh], list[Path]]:
    out: list[Volume | Mesh] = []
    paths = []
    for sub in table.subs("fixture"):
        path = _needed_file(sub, PARTS + VOLUMES, '"clamp.stl"')
        move = sub.vector("move", 3)
        volume = path.suffix.lower() in VOLUMES
        if volume and move is not None:
            raise sub.error("move", "a volume stays where it is; take a mesh")
        sub.done()
        mesh = None if volume else _mesh(path, sub.where("file"))
        if mesh is not None and move is not None:
            mesh = Mesh(mesh.vertices + move, mesh.triangles)
        out.append(Volume.load(path) if mesh is None else mesh)
        paths.append(path)
    return out, paths


def _machine(
    table: Table, stock: Volume
) -> tuple[str, dict[str, Any], NDArray[np.float64], float, NDArray[np.float64]]:
    sub = table.sub("machine") or Table(table.file, {}, ())
    name = sub.text("name", machines()) or "3-axis"
    axis = direction(sub, "axis")
    axis = np.array([0.0, 0.0, 1.0]) if axis is None else axis
    clearance = sub.number("clearance", above=0) or 5.0
    zero = np.zeros(3)
    if isinstance(sub.data.get("zero"), str):
        where = sub.text("zero", ZEROS)
        centre = 0.5 * (stock.lower + stock.upper)
        zero = stock.lower.copy()
        if where in ("bottom-centre", "top-centre"):
            zero[:2] = centre[:2]
        if where in ("top-centre", "top-corner"):
            zero[2] = stock.upper[2]
    elif (given := sub.vector("zero", 3)) is not None:
        zero = given
    options: dict[str, Any] = {}
    if (more := sub.sub("options")) is not None:
        known = {option.name for option in machine_options(name)}
        for key in known:
            more.known.append(key)
        more.done()
        options = dict(more.data)
    sub.done()
    return name, options, axis, clearance, zero


def _tools(table: Table, reach: float) -> dict[int, JobTool]:
    presets: dict[int, tool_files.Preset] = {}
    for sub in table.subs("tool_table"):
        path = _needed_file(sub, tool_files.FORMATS, '"tool.tbl"')
        unit = sub.text("unit", ("mm", "inch")) or "mm"
        sub.done()
        try:
            found = tool_files.read(path, unit)
        except ValueError as error:
            raise JobError(f"{sub.where('file')}: {error}") from None
        for preset in found:
            presets.setdefault(preset.number, preset)
    wanted = {sub.data["tool"] for sub in table.subs("operation") if isinstance(sub.data.get("tool"), int)}
    out: dict[int, JobTool] = {}
    for sub in table.subs("tool"):
        number = sub.whole("number", 1)
        if number is None:
            raise sub.missing("number", "1")
        if number in out:
            raise sub.error("number", f"tool {number} is there twice; give each tool a number of its own")
        out[number] = _tool(sub, number, presets.get(number), reach)
    for number, preset in sorted(presets.items()):
        if number in wanted and number not in out:
            where = table.where("tool_table")
            if preset.problem:
                raise JobError(
                    f"{where}: tool {number} of {preset.where}: {preset.problem}; "
                    f"add [[tool]] with number = {number} and kind"
                )
            out[number] = _tool(Table(table.file, {}, ("tool_table",)), number, preset, reach)
    return out


def _tool(sub: Table, number: int, preset: tool_files.Preset | None, reach: float) -> JobTool:
    data = dict(preset.sizes) if preset else {}
    sizes = Table(sub.file, {**data, **sub.data}, sub.path)
    sizes.known = sub.known
    kind = sizes.text("kind", TOOL_KINDS)
    if kind is None:
        raise sub.missing("kind", '"flat"')
    diameter = sizes.number("diameter", above=0)
    if diameter is None:
        raise sub.missing("diameter", "6")
    length = sizes.number("length", above=0) or max(5 * diameter, reach)
    more: dict[str, float] = {}
    for key, angle in TOOL_KINDS[kind].items():
        value = sizes.number(key, above=0)
        if value is None:
            raise sub.missing(key, "118" if key == "point" else "15" if angle else "1")
        more[key] = math.radians(value) if angle else value
    try:
        tool = _formed(kind, diameter, length, more)
        for what in ("shank", "holder"):
            cones = sizes.rows(what, 4)
            if cones is not None and len(cones):
                tool = tool.with_shank(cones) if what == "shank" else tool.with_holder(cones)
    except ValueError as error:
        if isinstance(error, JobError):
            raise
        raise JobError(f"{sub.where()}: {error}{f' ({preset.where})' if preset else ''}") from None
    name = sizes.text("name") or (preset.name if preset and preset.name else f"{kind} Ø{diameter:g}")
    feeds = {
        key: sizes.number(key, above=0) or (getattr(preset, key) if preset else None) for key in ("feed", "plunge")
    }
    spindle = sizes.number("spindle") or (preset.spindle if preset else None)
    flutes = sizes.whole("flutes", 1) or (preset.flutes if preset else None)
    sizes.done()
    return JobTool(number, name, tool, feeds["feed"], feeds["plunge"], spindle, flutes)


# For each kind of tool: its sizes other than diameter and length, and whether each is an angle.
TOOL_KINDS: dict[str, dict[str, bool]] = {
    "ball": {},
    "flat": {},
    "fillet": {"corner_radius": False},
    "taper": {"tip_radius": False, "half_angle": True},
    "drill": {"point": True},
}


def _formed(kind: str, diameter: float, length: float, more: Mapping[str, float]) -> Tool:
    if kind == "drill":
        if more["point"] >= math.pi:
            raise ValueError("point must be less than 180°; a tool with a flat end is of the kind flat")
        return Tool.profile([(diameter / 2, diameter / 2 / math.tan(more["point"] / 2))], length)
    return Tool.from_dict({"kind": kind, "diameter": diameter, "length": length, **more})


def _operations(table: Table, tools: Mapping[int, JobTool]) -> list[JobOperation]:
    out = []
    for sub in table.subs("operation"):
        kind = sub.text("kind", KINDS)
        if kind is None:
            raise sub.missing("kind", '"rough"')
        number = sub.whole("tool", 0)
        if number is None:
            raise sub.missing("tool", str(min(tools, default=1)))
        if number not in tools:
            known = f"known are {', '.join(map(str, sorted(tools)))}" if tools else "there is none"
            raise sub.error("tool", f"no tool {number}; {known}; add [[tool]] with number = {number}")
        name = sub.text("name") or f"{kind} with tool {number}"
        tool = tools[number]
        options = KINDS[kind].read(sub)
        for key in KINDS[kind].feeds:
            value = sub.number(key) if key == "spindle" else sub.number(key, above=0)
            value = value if value is not None else getattr(tool, key)
            if value is not None:
                options[key] = value
        sub.done()
        out.append(JobOperation(name, kind, tool, options, sub))
    if not out:
        raise JobError(f"{table.file.path.name}: no operation; add a line [[operation]] with kind and tool")
    return out
