"""Volume to mesh: time, defects and error of B200's mesh, sharp edges of turned boxes, against field meshers; and
error against pitch."""

from __future__ import annotations

import math
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from riffler import Mesh, Volume

from .. import _bench as core
from .. import exact, report, scenes
from ..measure import Progress, Settings, child, how_many, shares, threads, watched
from ..report import Column, Report
from ..rivals import LeftOutError, ask, program

BAD = ("open_edges", "nonmanifold_edges")
OTHER = ("nonmanifold_vertices", "degenerate", "duplicates", "folds")
MODES = {"Riffler tri-dexel": "xyz", "Riffler z": "z"}
FIELD_MESHERS = {
    "OpenVDB volumeToMesh": "",
    "VTK FlyingEdges3D": "flying_edges",
    "VTK SurfaceNets3D, of labels": "surface_nets",
    "open3d isosurfaces": "open3d",
    "scikit-image marching cubes": "scikit_image",
    "Manifold level set, a Python function": "manifold",
}
SLOW = "manifold"  # asks Python for every value: at the coarsest pitch only
FINEST = 0.1  # mm: a field of 182 M values, for two of the others
AT_FINEST = ("", "flying_edges", *MODES.values())
MIDDLES = {"quick": 20_000, "full": 1_000_000}  # of triangles, judged at most
# mm, at h = 0.25 on B200 and for edges of turned boxes
TARGETS = {"b200_max": 0.0205, "b200_mean": 2e-5, "edge_max": 0.02}


def run(settings: Settings, progress: Progress = None) -> Report:
    out = Report("mesh", {"targets": TARGETS})
    share = shares(progress)
    with tempfile.TemporaryDirectory() as folder:
        b200(out, settings, Path(folder), share(0, 0.6))
        edges(out, settings, Path(folder), share(0.6, 0.75))
    memory(out, settings)
    error(out, settings, share(0.75, 1))
    return out


# ---- B200 against others


def b200(out: Report, settings: Settings, folder: Path, progress: Progress) -> None:
    table = out.section(
        "b200",
        "B200 to a mesh",
        Column("engine", "engine"),
        Column("h mm", "pitch", report.pitch),
        Column("threads", "threads"),
        Column("wall time", "wall_s", report.micro),
        Column("processor time", "cpu_s", report.micro),
        Column("triangles", "triangles", report.mega),
        Column("triangles/s", "triangles_per_s", report.mega),
        *DEFECT_COLUMNS,
        *ERROR_COLUMNS,
        Column("peak memory", "peak_bytes", report.megabytes),
    )
    pitches, repeats = ((1.0, 0.5), 1) if settings.quick else ((1.0, 0.5, 0.25, 0.15, 0.1), 5)
    for pitch in watched(pitches, progress):
        place = exact_field(settings, pitch, folder)
        for engine, work in (MODES | FIELD_MESHERS).items():
            if (work == SLOW and pitch != pitches[0]) or (pitch == FINEST and work not in AT_FINEST):
                continue
            figures: dict[str, Any] = {}
            for count in (1,) if work == SLOW else (1, None):
                try:
                    if engine in MODES:
                        path = folder / "mesh.stl"
                        timing = child("mesh", count, pitch=pitch, directions=work, repeats=repeats, path=str(path))
                        made = Mesh.read(path) if not figures else None
                    else:
                        timing, made = field_mesh(settings, work, folder, count, 1 if work == SLOW else 3, **place)
                except LeftOutError as why:
                    table.row(engine=f"{engine}: left out, {why}", pitch=pitch)
                    break
                figures = figures or judged(settings, made, folder)
                table.row(
                    engine=engine,
                    pitch=pitch,
                    threads="all" if count is None else str(count),
                    **{k: timing[k] for k in ("wall_s", "cpu_s", "triangles", "peak_bytes")},
                    triangles_per_s=timing["triangles"] / timing["cpu_s" if count == 1 else "wall_s"],
                    **figures,
                )
                if engine in MODES:
                    out.check(not figures["bad"] + figures["others"], f"{engine}, h = {pitch:g}: {figures}")
        if pitch == 0.25:
            mine = next(row for row in table.rows if row["pitch"] == pitch and row["engine"] in MODES)
            for figure in ("max", "mean"):
                error = mine[f"{figure}_mm"]
                out.check(error < TARGETS[f"b200_{figure}"], f"h = 0.25: {figure} error of vertices {error:g} mm")
    table.notes.append(
        "Triangles/s of processor time with one thread, of wall time with all. Others mesh the exact signed distance "
        "from the same part on the same lattice, which is not in their times; labels are its sign. Defects are counted "
        "after the mesh has been written as a binary STL and read again with equal vertices welded. Errors are "
        "distances from the exact surface, at all vertices and at the middles of up to "
        f"{report.grouped(most_middles(settings))} triangles."
    )


DEFECT_COLUMNS = (Column("bad edges", "bad"), Column("other defects", "others"))
ERROR_COLUMNS = (
    Column("vertices: largest error mm", "max_mm", report.mm),
    Column("mean", "mean_mm", report.mm),
    Column("RMS", "rms_mm", report.mm),
    Column("middles of triangles: largest", "middle_max_mm", report.mm),
    Column("RMS", "middle_rms_mm", report.mm),
)


def exact_field(settings: Settings, pitch: float, folder: Path) -> dict[str, Any]:
    """Writes the field that others mesh, if any are named, and says where it lies."""
    field, origin = exact.field(pitch) if settings.rivals or settings.programs else (np.zeros((0, 0, 0)), np.zeros(3))
    field.tofile(folder / "field")
    return {"shape": list(field.shape), "pitch": pitch, "origin": origin.tolist()}


def field_mesh(
    settings: Settings, work: str, folder: Path, count: int | None, repeats: int, shape, pitch, origin
) -> tuple[dict[str, Any], Mesh]:
    """What a rival makes of the field in `folder`, with times."""
    if not work:
        place = (folder / "field", *shape, pitch, *origin)
        timing = program(settings, "riffler_openvdb_mesh", *place, how_many(count), repeats, folder / "mesh")
        vertices = np.fromfile(folder / "mesh.vertices", np.float32).reshape(-1, 3)
        quads = np.fromfile(folder / "mesh.quads", np.int32).reshape(-1, 4)[:, ::-1]
        return timing, Mesh(vertices, np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]]))
    given = {"field": str(folder / "field"), "mesh": str(folder / "mesh"), "repeats": repeats}
    timing = ask(settings, "isosurface.py", work, count, **given, shape=shape, pitch=pitch, origin=origin)
    return timing, Mesh(np.load(folder / "mesh.vertices.npy"), np.load(folder / "mesh.triangles.npy"))


def most_middles(settings: Settings) -> int:
    return MIDDLES["quick" if settings.quick else "full"]


def defects(mesh: Mesh) -> dict[str, int]:
    audit = mesh.audit()
    return {kind: sum(int(getattr(audit, name)) for name in names) for kind, names in (("bad", BAD), ("others", OTHER))}


def judged(settings: Settings, mesh: Mesh, folder: Path) -> dict[str, Any]:
    """Defects of the mesh that comes back from a binary STL, and its distance from B200's exact surface."""
    mesh.write(folder / "judged.stl")
    mesh = Mesh.read(folder / "judged.stl")
    vertices = np.asarray(mesh.vertices)
    off = exact.from_surface(vertices)
    triangles = np.asarray(mesh.triangles)
    middle = exact.from_surface(vertices[triangles[:: -(-len(triangles) // most_middles(settings))]].mean(1))
    return {
        **defects(mesh),
        **spread("", off),
        **spread("middle_", middle),
    }


def spread(name: str, values: np.ndarray) -> dict[str, float]:
    figures = {"max": values.max(), "mean": values.mean(), "rms": np.sqrt(np.mean(values**2))}
    return {f"{name}{figure}_mm": float(value) for figure, value in figures.items()}


# ---- sharp edges


def edges(out: Report, settings: Settings, folder: Path, progress: Progress) -> None:
    table = out.section(
        "edges",
        "True edges and corners of boxes turned at random, h = 0.25: how far the mesh stays away from them",
        Column("engine", "engine"),
        *(
            Column(f"{what}: {which} {unit}", f"{what}_{which}_{unit}", report.mm)
            for what in ("edges", "corners")
            for which in ("mean", "largest")
            for unit in ("mm", "cells")
        ),
        *DEFECT_COLUMNS,
    )
    pitch, boxes = 0.25, 1 if settings.quick else 4
    found: dict[str, list[tuple[np.ndarray, np.ndarray, int, int]]] = {}
    for box in watched([TurnedBox(seed) for seed in range(boxes)], progress):
        for engine, mesh in box_meshes(box, pitch, settings, folder):
            if isinstance(mesh, LeftOutError):
                if box.seed == 0:
                    table.row(engine=f"{engine}: left out, {mesh}")
                continue
            mesh.write(folder / "box.stl")
            mesh = Mesh.read(folder / "box.stl")
            counts = defects(mesh).values()
            with threads(None):
                off = (core.mesh_distances(points, mesh) for points in (box.edges(), box.corners()))
                found.setdefault(engine, []).append((*off, *counts))
    for engine, results in found.items():
        figures: dict[str, Any] = {"bad": sum(r[2] for r in results), "others": sum(r[3] for r in results)}
        for what, values in (("edges", [r[0] for r in results]), ("corners", [r[1] for r in results])):
            for which, value in (
                ("mean", np.mean(np.concatenate(values))),
                ("largest", np.max(np.concatenate(values))),
            ):
                figures[f"{what}_{which}_mm"], figures[f"{what}_{which}_cells"] = value, value / pitch
        table.row(engine=engine, **figures)
        if engine in MODES:
            out.check(not figures["bad"] + figures["others"], f"{engine}, turned boxes: {figures}")
        if engine == "Riffler tri-dexel":
            worst = figures["edges_largest_mm"]
            out.check(worst < TARGETS["edge_max"], f"turned boxes: an edge is {worst:g} mm off")
    table.rows.sort(key=lambda row: list(MODES | FIELD_MESHERS).index(row["engine"].partition(":")[0]))
    table.notes.append(
        f"{boxes} boxes of 8.6 × 7.4 × 10.2 mm; points on their edges 0.05 mm apart, those within 0.6 mm of a corner "
        "left out. Riffler's volumes are made from the box's mesh, others mesh its exact signed distance."
    )


class TurnedBox:
    """A box in a cube of 20 mm, turned and shifted at random."""

    HALF = np.array([4.3, 3.7, 5.1])

    def __init__(self, seed: int) -> None:
        rng = np.random.default_rng(seed)
        self.seed = seed
        self.turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
        self.turn[:, 0] *= np.sign(np.linalg.det(self.turn))
        self.centre = 10 + rng.uniform(-0.3, 0.3, 3)

    def mesh(self) -> Mesh:
        box = scenes.box_mesh(-self.HALF, self.HALF)
        return Mesh(np.asarray(box.vertices) @ self.turn.T + self.centre, box.triangles)

    def distance(self, points: np.ndarray) -> np.ndarray:
        """Exact signed distance."""
        off = abs((points - self.centre) @ self.turn) - self.HALF
        return np.linalg.norm(np.maximum(off, 0), axis=1) + np.minimum(off.max(1), 0)

    def corners(self) -> np.ndarray:
        signs = np.array([[i, j, k] for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)])
        return (signs * self.HALF) @ self.turn.T + self.centre

    def edges(self) -> np.ndarray:
        out = []
        for axis in range(3):
            along = np.arange(-self.HALF[axis] + 0.6, self.HALF[axis] - 0.6, 0.05)
            for side in range(4):
                points = np.empty((len(along), 3))
                points[:, axis] = along
                points[:, (axis + 1) % 3] = (1 if side & 1 else -1) * self.HALF[(axis + 1) % 3]
                points[:, (axis + 2) % 3] = (1 if side & 2 else -1) * self.HALF[(axis + 2) % 3]
                out.append(points)
        return np.concatenate(out) @ self.turn.T + self.centre


def box_meshes(
    box: TurnedBox, pitch: float, settings: Settings, folder: Path
) -> Iterator[tuple[str, Mesh | LeftOutError]]:
    for engine, directions in MODES.items():
        yield engine, Volume.from_mesh(box.mesh(), pitch, directions, lower=[0, 0, 0], upper=[20, 20, 20]).to_mesh()
    at = pitch * (np.arange(round(20 / pitch)) + 0.5)
    points = np.stack(np.meshgrid(at, at, at, indexing="ij"), -1).reshape(-1, 3)
    box.distance(points).astype(np.float32).tofile(folder / "field")
    place = {"shape": [len(at)] * 3, "pitch": pitch, "origin": [pitch / 2] * 3}
    for engine, work in FIELD_MESHERS.items():
        try:
            yield engine, field_mesh(settings, work, folder, 1, 1, **place)[1]
        except LeftOutError as why:
            yield engine, why


# ---- memory


def memory(out: Report, settings: Settings) -> None:
    pitch = 0.5 if settings.quick else 0.15
    table = out.section(
        "memory",
        f"B200 at h = {pitch:g}, carved and meshed, one thread: peak memory of the whole process",
        Column("process", "process"),
        Column("directions", "directions"),
        Column("carve", "carve_s", report.micro),
        Column("mesh", "mesh_s", report.micro),
        Column("peak memory", "peak_bytes", report.megabytes),
    )
    for directions in ("z", "xyz"):
        for process in ("C++ program", "Python with numpy"):
            try:
                if process == "C++ program":
                    with threads(1):
                        figures = program(settings, "riffler_b200", pitch, directions)
                else:
                    figures = child("b200", pitch=pitch, directions=directions)
            except LeftOutError as why:
                table.row(process=f"{process}: left out, {why}", directions=directions)
                continue
            table.row(process=process, directions=directions, **figures)
    table.notes.append("The Python process carves and meshes three times over. Target: below 100 MB.")


# ---- error against pitch


def error(out: Report, settings: Settings, progress: Progress) -> None:
    table = out.section(
        "error",
        "B200's mesh against pitch, one thread",
        Column("directions", "directions"),
        Column("h mm", "pitch", report.pitch),
        Column("wall time", "wall_s", report.micro),
        Column("triangles", "triangles", report.mega),
        *ERROR_COLUMNS,
        Column("order: vertices, largest", "max_order", order),
        Column("RMS", "rms_order", order),
        Column("middles, RMS", "middle_rms_order", order),
    )
    known = {(row["engine"], row["pitch"]): row for row in out.sections[0].rows if row.get("threads") == "1"}
    pitches = (*dict.fromkeys(row["pitch"] for row in known.values()), *(() if settings.quick else (0.05,)))
    for engine, directions in MODES.items():
        before: dict[str, Any] = {}
        for pitch in watched(pitches, progress if directions == "z" else None):
            row = known.get((engine, pitch)) or alone(settings, directions, pitch)
            orders = {}
            for name in ("max", "rms", "middle_rms") if before else ():
                fall = math.log(before[f"{name}_mm"] / row[f"{name}_mm"])
                orders[f"{name}_order"] = fall / math.log(before["pitch"] / pitch)
            figures = {name: value for name, value in row.items() if name.endswith("_mm")}
            times = {name: row[name] for name in ("wall_s", "cpu_s", "triangles")}
            before = table.row(directions=directions, pitch=pitch, **times, **figures, **orders)
    table.notes.append(
        "Order: the power of h with which an error fell since the row above. In one direction walls stand half a pitch "
        "from their rays, so slopes steeper than 45° are steps: their error falls with h and no faster."
    )


def alone(settings: Settings, directions: str, pitch: float) -> dict[str, Any]:
    with tempfile.TemporaryDirectory() as folder:
        timing = child("mesh", pitch=pitch, directions=directions, repeats=1, path=f"{folder}/mesh.stl")
        return timing | judged(settings, Mesh.read(f"{folder}/mesh.stl"), Path(folder))


def order(value: float) -> str:
    return f"{value:.1f}"
