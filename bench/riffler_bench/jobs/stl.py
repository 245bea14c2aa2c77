"""Parts to volumes: rays a second, odd rays and volume, compared with ray casters; the volume of open parts, compared
with the winding number's."""

from __future__ import annotations

import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np
from riffler import Mesh, Volume

from .. import parts, report
from ..measure import Progress, Settings, child, shares, watched
from ..report import Column, Report
from ..rivals import LeftOutError, ask

COUNTS = ("open_edges", "nonmanifold_edges", "nonmanifold_vertices", "duplicates", "degenerate")


def winding_volume(mesh: Mesh, cells: int) -> tuple[float, float]:
    """Volume of the points whose |generalized winding number| exceeds 1/2, by stratified samples, with one standard
    deviation of that estimate. Solid angles of all triangles (Van Oosterom and Strackee 1983), double precision."""
    rng = np.random.default_rng(3)
    lower, upper = np.asarray(mesh.bounds)
    size = upper - lower
    n = np.maximum(1, np.round(cells * size / size.max())).astype(int)
    grid = np.stack(np.meshgrid(*(np.arange(k) for k in n), indexing="ij"), -1).reshape(-1, 3)
    points = lower + (grid + rng.random(grid.shape)) / n * size
    corners = np.asarray(mesh.vertices)[np.asarray(mesh.triangles)]
    inside = np.zeros(len(points), bool)
    for start in range(0, len(points), 64):
        p = points[start : start + 64]
        a, b, c = (corners[None, :, k] - p[:, None] for k in range(3))
        la, lb, lc = (np.linalg.norm(x, axis=2) for x in (a, b, c))
        num = np.einsum("ijk,ijk->ij", a, np.cross(b, c))
        den = la * lb * lc + np.einsum("ijk,ijk->ij", a, b) * lc
        den += np.einsum("ijk,ijk->ij", b, c) * la + np.einsum("ijk,ijk->ij", c, a) * lb
        inside[start : start + 64] = abs(2 * np.arctan2(num, den).sum(1) / (4 * np.pi)) > 0.5
    share, box = inside.mean(), size.prod()
    # Stratified: only cells that the surface crosses vary; their number grows as cells².
    return share * box, box * np.sqrt(share * (1 - share) / len(points)) / np.sqrt(cells) * 2


def run(settings: Settings, progress: Progress = None) -> Report:
    out = Report("stl", {})
    share = shares(progress)
    rays(out, settings, share(0, 0.75))
    openings(out, settings, share(0.75, 0.8))
    files(out, settings, share(0.8, 1))
    return out


# ---- rays against others


def rays(out: Report, settings: Settings, progress: Progress) -> None:
    table = out.section(
        "rays",
        "Closed parts to rays, one thread",
        Column("part", "part"),
        Column("triangles", "triangles", report.mega),
        Column("rays", "side", lambda n: f"{n}²"),
        Column("engine", "engine"),
        Column("processor time", "cpu_s", report.micro),
        Column("÷ z", "ratio", report.ratio),
        Column("of it before the first ray", "build_s", report.micro),
        Column("rays or points a second", "rate", report.mega),
        Column("odd rays", "odd"),
        Column("volume against the mesh's", "difference", report.percent),
        Column("peak memory", "peak_bytes", report.megabytes),
    )
    made = 20_000 if settings.quick else 1_000_000
    meshes = {f"{f.__name__}, made in code": f(made) for f in (parts.organic, parts.sharp)}
    for path in model_paths(settings):
        mesh = Mesh.read(path)
        if not mesh.audit().open_edges:
            meshes[path.stem] = mesh
    with tempfile.TemporaryDirectory() as folder:
        for part, mesh in watched(list(meshes.items()), progress):
            for figures in cast(part, mesh, settings, str(Path(folder) / "part")):
                volume = figures.get("volume")
                known = {} if volume is None else {"difference": volume / mesh.volume - 1}
                table.row(part=part, triangles=len(mesh.triangles), **figures, **known)
                # Both count the same rays; what they leave between them shrinks with their distance.
                good = not known or not figures["engine"].startswith("Riffler") or abs(known["difference"]) < 0.02
                out.check(good, f"{part}, {figures['side']}²: {known}")
    table.notes.append(
        "Rays stand in the middles of square cells; the pitch is the part's larger side ÷ their number. Riffler pairs "
        "hits by direction, so a ray cannot be odd. The fast winding number is asked at points instead, as far apart "
        "as the rays. trimesh builds its tree at the first ray."
    )


def to_rays(mesh: Mesh, side: int, path: str) -> dict[str, Any]:
    save(mesh, path)
    return child("rays", path=path, side=side, repeats=3)


def save(mesh: Mesh, path: str) -> None:
    """For a child to load."""
    np.save(f"{path}.vertices.npy", np.asarray(mesh.vertices))
    np.save(f"{path}.triangles.npy", np.asarray(mesh.triangles))


def cast(part: str, mesh: Mesh, settings: Settings, path: str) -> list[dict[str, Any]]:
    """A row for each engine and number of rays."""
    save(mesh, path)  # for all engines
    vertices = np.asarray(mesh.vertices)
    low, high = vertices.min(0), vertices.max(0)
    sides = (64,) if settings.quick else (256, 1024, 2048)
    beside, points = (64, 32) if settings.quick else (1024, 96)
    rows = []
    for side in sides:
        figures = child("rays", path=path, side=side, repeats=3)
        rows.append({"engine": "Riffler", "side": side, "rate": figures["count"] / figures["cpu_s"], **figures})
        if side == beside:
            three = child("rays", path=path, side=side, repeats=3, directions="xyz")
            ratio, rate = three["cpu_s"] / figures["cpu_s"], three["count"] / three["cpu_s"]
            rows.append({"engine": "Riffler, xyz", "side": side, "rate": rate, "ratio": ratio, **three})
    for engine, work, side in (
        ("open3d", "open3d", beside),
        ("trimesh with Embree", "trimesh", beside),
        ("libigl fast winding number", "winding", points),
    ):
        pitch = float((high - low)[:2].max()) / side
        lower = ((low + high) / 2 - pitch * side / 2)[:2].tolist()
        bottom = float(low[2] - 0.001 * pitch)
        try:
            figures = ask(settings, "rays.py", work, 1, mesh=path, lower=lower, pitch=pitch, side=side, bottom=bottom)
        except LeftOutError as why:
            rows.append({"engine": f"{engine}: left out, {why}", "side": side})
            continue
        total = figures["cpu_s"] + figures["build_s"]
        figures |= {"cpu_s": total, "rate": figures.pop("points", side**2) / total, "side": side}
        rows.append(figures)
    return rows


# ---- parts with openings


def openings(out: Report, settings: Settings, progress: Progress) -> None:
    table = out.section(
        "open",
        "Parts with openings to rays along z, one thread",
        Column("part", "part"),
        Column("triangles", "triangles", report.mega),
        Column("open edges", "open_edges"),
        Column("rays", "side", lambda n: f"{n}²"),
        Column("processor time", "cpu_s", report.micro),
        Column("volume against the whole part's", "difference", report.percent),
        Column("peak memory", "peak_bytes", report.megabytes),
    )
    many, few, side = (20_000, 10_000, 64) if settings.quick else (1_000_000, 200_000, 1024)
    whole, coarse = parts.organic(many), parts.organic(few)
    holes = many // 600  # three open edges each
    made = {
        "organic, torn": (parts.torn(whole, holes), whole),
        "organic, coarser, torn": (parts.torn(coarse, holes), coarse),
        "organic, halved": (parts.halved(whole), None),
        "sharp, torn": (parts.torn(parts.sharp(many), holes), parts.sharp(many)),
    }
    with tempfile.TemporaryDirectory() as folder:
        path = str(Path(folder) / "part")
        for part, (mesh, closed) in watched(list(made.items()), progress):
            figures = to_rays(mesh, side, path)
            known = {}
            if closed:
                known["difference"] = figures["volume"] / to_rays(closed, side, path)["volume"] - 1
            out.check(abs(known.get("difference", 0)) < 0.001, f"{part}: {known}")
            edges = mesh.audit().open_edges
            table.row(part=part, triangles=len(mesh.triangles), open_edges=edges, side=side, **figures, **known)
    table.notes.append("The same parts as above, without some of their triangles. Target: 0.3 s.")


# ---- parts from files


def model_paths(settings: Settings) -> list[Path]:
    paths = sorted(settings.models.glob("*.stl")) if settings.models else []
    return paths[:2] if settings.quick else paths


def files(out: Report, settings: Settings, progress: Progress) -> None:
    table = out.section(
        "parts",
        "Parts from files, 256² columns, tri-dexel",
        Column("part", "part"),
        Column("triangles", "triangles"),
        Column("open edges", "open_edges"),
        Column("reference mm³", "reference_text"),
        Column("dexel volume", "volume", lambda v: f"{v:.6g}"),
        Column("difference", "difference", report.percent),
        Column("asked", "asked", lambda v: f"{100 * v:g} %"),
        Column("wall time", "seconds", report.micro),
        Column("mesh audit", "audit"),
    )
    paths = model_paths(settings)
    if not paths:
        table.notes.append("Left out: no folder with .stl files was named (--models).")
    for path in watched(paths, progress):
        figures = compare(path)
        table.row(**figures)
        out.check(figures["audit"] == "clean", f"{path.name}: {figures}")


def compare(path: Path) -> dict:
    mesh = Mesh.read(path)
    audit = mesh.audit()
    broken = audit.open_edges + audit.nonmanifold_edges > 0
    # As many evaluations for every part: the reference takes points x triangles.
    cells = round(40 * min(1.0, 5000 / len(mesh.triangles)) ** (1 / 3))
    reference, deviation = winding_volume(mesh, cells) if broken else (mesh.volume, 0.0)
    lower, upper = np.asarray(mesh.bounds)
    start = time.perf_counter()
    volume = Volume.from_mesh(mesh, (upper - lower).max() / 256, "xyz")
    seconds = time.perf_counter() - start
    out = volume.to_mesh().audit()
    difference, asked = volume.volume / reference - 1, 0.02 if broken else 0.003
    good = abs(difference) <= asked + 3 * deviation / reference and not any(getattr(out, k) for k in COUNTS)
    return {
        "part": path.stem,
        "triangles": len(mesh.triangles),
        "open_edges": int(audit.open_edges),
        "reference_text": f"{reference:.6g}" + (f" ± {deviation:.2g}" if broken else ""),
        "volume": volume.volume,
        "difference": float(difference),
        "asked": asked,
        "seconds": seconds,
        "audit": "clean" if good else "**BAD**",
    }
