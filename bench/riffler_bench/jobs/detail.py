"""Meshes with a tolerance: time and triangles against the tolerance, the pitch and other meshers, distances judged by a
search of its own."""

from __future__ import annotations

import math
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
from riffler import Mesh

from .. import _bench as core
from .. import exact, report
from ..measure import Progress, Settings, child, shares, threads, watched
from ..report import Column, Report
from ..rivals import LeftOutError, program
from .decimate import drawn
from .mesh import DEFECT_COLUMNS, defects, exact_field

TOLERANCES = (0.05, 0.01, 0.005, 0.001, 0.0005)  # mm
TARGETS = {"ratio": 1.3, "fewer_xyz": 60, "fewer_z": 10}  # at 0.005 mm
PITCH = 0.1  # mm, of the table of tolerances
ADAPTIVITIES = (0.0, 0.01, 0.1, 1.0)  # of OpenVDB
TIMES = (
    Column("processor time", "cpu_s", report.micro),
    Column("÷ to_mesh()", "ratio", report.ratio),
    Column("triangles", "triangles"),
    Column("fewer", "fewer", lambda n: f"{n:.0f} ×"),
)
DISTANCES = (
    Column("largest distance from the full mesh mm", "there_mm", report.mm),
    Column("and back", "back_mm", report.mm),
    *DEFECT_COLUMNS,
)


def run(settings: Settings, progress: Progress = None) -> Report:
    out = Report("detail", {"targets": TARGETS})
    share = shares(progress)
    with tempfile.TemporaryDirectory() as folder:
        tolerances(out, settings, Path(folder), share(0, 0.6))
        growth(out, settings, Path(folder), share(0.6, 0.7))
        rivals(out, settings, Path(folder), share(0.7, 0.8))
        parts(out, settings, Path(folder), share(0.8, 1))
    return out


def measured(
    settings: Settings, folder: Path, scene: str, pitch: float, tolerances: list[float], **more: Any
) -> dict[str, Any]:
    more["repeats"] = 1 if settings.quick else 3
    return child("detail", scene=scene, pitch=pitch, tolerances=tolerances, folder=str(folder), **more)


def judged(folder: Path, name: str, tolerance: float, out: Report, points: int) -> dict[str, Any]:
    """Distances in both directions, at points drawn evenly and at vertices, and defects after a binary STL."""
    full, less = (Mesh(np.load(folder / f"{n}.v.npy"), np.load(folder / f"{n}.t.npy")) for n in ("full", name))
    rng = np.random.default_rng(2)
    with threads(None):
        there, back = (
            core.mesh_distances(rng.permutation(drawn(one, points))[: 2 * points], other)
            for one, other in ((less, full), (full, less))
        )
    less.write(folder / "judged.stl")
    figures = {
        "there_mm": float(there.max()),
        "back_mm": float(back.max()),
        **defects(Mesh.read(folder / "judged.stl")),
    }
    out.check(not figures["bad"] + figures["others"], f"{name}: {figures}")
    worst = max(figures["there_mm"], figures["back_mm"])
    out.check(worst <= tolerance * (1 + 1e-9), f"{name}: {worst:g} mm off, tolerance {tolerance:g}")
    return figures


def tolerances(out: Report, settings: Settings, folder: Path, progress: Progress) -> None:
    pitch = 0.5 if settings.quick else PITCH
    table = out.section(
        "tolerances",
        f"B200 at h = {pitch:g}, one thread",
        Column("directions", "directions"),
        Column("tolerance mm", "tolerance", report.pitch),
        *TIMES,
        *DISTANCES,
    )
    points = 10_000 if settings.quick else 100_000
    for directions in watched(("xyz", "z"), progress):
        wanted = list(TOLERANCES if directions == "xyz" else (0.005,))
        got = measured(
            settings,
            folder,
            "b200",
            pitch,
            wanted,
            directions=directions,
            decimated=0.005 if directions == "xyz" else 0.0,
        )
        full = got["full"]
        table.row(directions=directions, ratio=1.0, **full)
        for tolerance, figures in zip(wanted, got["rows"], strict=True):
            table.row(
                directions=directions, tolerance=tolerance, **compared(figures, full),
                **judged(folder, f"less-{tolerance:g}", tolerance, out, points),
            )  # fmt: skip
        for way, figures in got["decimated"].items():
            table.row(directions=f"{directions}, {way}", tolerance=0.005, **compared(figures, full))
    table.notes.append(
        "to_mesh() and to_mesh(tolerance) alternate in one process; medians of three. Distances are judged at points "
        "drawn evenly over both meshes and at vertices, by native/bench/mesh_distance.hpp, which shares no code with "
        "the mesher; defects are counted after a binary STL."
    )


def compared(figures: dict[str, Any], full: dict[str, Any]) -> dict[str, Any]:
    return {
        **figures,
        "ratio": figures["cpu_s"] / full["cpu_s"],
        "fewer": full["triangles"] / max(1, figures["triangles"]),
    }


def growth(out: Report, settings: Settings, folder: Path, progress: Progress) -> None:
    table = out.section(
        "growth",
        "B200 in three directions with a tolerance of 0.005 mm against pitch, one thread",
        Column("h mm", "pitch", report.pitch),
        Column("triangles of to_mesh()", "full", report.mega),
        Column("exponent", "full_order", lambda x: f"{x:.2f}"),
        *TIMES,
        Column("exponent", "order", lambda x: f"{x:.2f}"),
    )
    before: dict[str, Any] = {}
    for pitch in watched((1.0, 0.5) if settings.quick else (0.4, 0.25, 0.15, 0.1), progress):
        got = measured(settings, folder, "b200", pitch, [0.005], directions="xyz")
        row = {"pitch": pitch, "full": got["full"]["triangles"], **compared(got["rows"][0], got["full"])}
        if before:
            finer = math.log(before["pitch"] / pitch)
            row["full_order"] = math.log(row["full"] / before["full"]) / finer
            row["order"] = math.log(row["triangles"] / before["triangles"]) / finer
        before = table.row(**row)
    table.notes.append("Exponent: the power of 1/h with which the number grew since the row above.")


def rivals(out: Report, settings: Settings, folder: Path, progress: Progress) -> None:
    pitch = 1.0 if settings.quick else 0.25
    table = out.section(
        "rivals",
        f"B200 at h = {pitch:g} with few triangles, one thread",
        Column("engine", "engine"),
        Column("processor time", "cpu_s", report.micro),
        Column("triangles", "triangles"),
        Column("vertices: largest error mm", "max_mm", report.mm),
        Column("middles of triangles: largest", "middle_max_mm", report.mm),
    )
    got = measured(settings, folder, "b200", pitch, [0.01, 0.005], directions="xyz", decimated=0.005)
    table.row(engine="Riffler, to_mesh()", **got["full"], **errors(load(folder, "full")))
    for tolerance, figures in zip((0.01, 0.005), got["rows"], strict=True):
        table.row(engine=f"Riffler, to_mesh({tolerance:g})", **figures, **errors(load(folder, f"less-{tolerance:g}")))
    for way, figures in got["decimated"].items():
        table.row(engine=f"Riffler, {way}", **figures)
    field = exact_field(settings, pitch, folder)
    for adaptivity in watched(ADAPTIVITIES, progress):
        engine = f"OpenVDB volumeToMesh, adaptivity {adaptivity:g}"
        place = (folder / "field", *field["shape"], pitch, *field["origin"])
        try:
            timing = program(settings, "riffler_openvdb_mesh", *place, 1, 3, folder / "mesh", adaptivity)
        except LeftOutError as why:
            table.row(engine=f"{engine}: left out, {why}")
            continue
        vertices = np.fromfile(folder / "mesh.vertices", np.float32).reshape(-1, 3)
        quads = np.fromfile(folder / "mesh.quads", np.int32).reshape(-1, 4)
        triangles = np.fromfile(folder / "mesh.triangles", np.int32).reshape(-1, 3)
        mesh = Mesh(vertices, np.concatenate([triangles, quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])[:, ::-1])
        table.row(engine=engine, **{k: timing[k] for k in ("cpu_s", "triangles")}, **errors(mesh))
    table.notes.append(
        "Errors are distances from the exact part. OpenVDB meshes the exact signed distance and bounds no error; "
        "Riffler's tolerance is a bound of the distance from its own full mesh."
    )


def load(folder: Path, name: str) -> Mesh:
    return Mesh(np.load(folder / f"{name}.v.npy"), np.load(folder / f"{name}.t.npy"))


def errors(mesh: Mesh) -> dict[str, float]:
    corners = np.asarray(mesh.vertices)[np.asarray(mesh.triangles)]
    return {
        "max_mm": float(exact.from_surface(np.asarray(mesh.vertices)).max()),
        "middle_max_mm": float(exact.from_surface(corners.mean(1)).max()),
    }


def parts(out: Report, settings: Settings, folder: Path, progress: Progress) -> None:
    table = out.section(
        "parts",
        "Other shapes in three directions, 400 rays along the longest side, tolerance a tenth of the pitch, one thread",
        Column("part", "part"),
        Column("h mm", "pitch", report.pitch),
        Column("triangles of to_mesh()", "full", report.mega),
        *TIMES,
        *DISTANCES,
    )
    models = sorted(settings.models.glob("*.stl")) if settings.models else []
    scenes = ["s500k", *map(str, models)]
    for scene in watched(scenes, progress):
        rays = 100 if settings.quick else 400
        got = measured(settings, folder, scene, 0.0, [0.0], directions="xyz", rays=rays)
        name = "S500k, first 20 000 moves" if scene == "s500k" else Path(scene).stem
        pitch = got["pitch"]
        figures = compared(got["rows"][0], got["full"])
        figures |= judged(folder, "less-0", pitch / 10, out, 10_000 if settings.quick else 100_000)
        table.row(part=name, pitch=pitch, full=got["full"]["triangles"], **figures)
    if not models:
        table.notes.append("Left out: no folder with .stl files was named (--models).")
