"""Measurements in a process of their own, to measure its memory: python -m riffler_bench.children WORK ARGUMENTS.

Prints the result as one line of JSON, with the process's peak memory.
"""

from __future__ import annotations

import hashlib
import json
import statistics
import sys
import time
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
from riffler import Mesh, Tool, Verification, VerifyReport, Volume, plan, verify

from . import parts, scenes, torus, waves
from .rivals import clock


def b200(pitch: float, directions: str, mesh: bool = True) -> dict[str, Any]:
    """B200 with a ball, thrice: medians of carving and meshing, in s of wall time."""
    poses, tool = scenes.cutters()[0].path(turning=False), scenes.cutters()[0].tool
    carve, meshing, triangles = [], [], None
    for _ in range(3):
        volume = Volume.block(*scenes.BLOCK, pitch, directions)
        start = time.perf_counter()
        cut = volume.carve(tool, poses)
        carve.append(time.perf_counter() - start)
        if mesh:
            start = time.perf_counter()
            triangles = len(volume.to_mesh().triangles)
            meshing.append(time.perf_counter() - start)
    # Where every tile has been written, none is shared any more: 0.1 mm off the ends of all rays.
    skimmed, middle, upper = Volume.block(*scenes.BLOCK, pitch, directions), np.array([50.0, 30, 15]), scenes.BLOCK[1]
    for k, axis in enumerate(np.eye(3)):
        face = middle + axis * (upper[k] / 2)
        skimmed.carve(Tool.flat(400, 40), np.array([[*(face + axis), *axis], [*(face - 0.1 * axis), *axis]]))
    return {
        "carve_s": statistics.median(carve),
        "mesh_s": statistics.median(meshing) if mesh else None,
        "triangles": triangles,
        "removed": float(cut.removed.sum()),
        "rays": volume.rays,
        "skimmed_bytes": skimmed.nbytes,
        "carved_bytes": volume.nbytes,
    }


def mesh(pitch: float, directions: str, repeats: int, path: str) -> dict[str, Any]:
    """B200 with a ball, carved once and meshed again and again: medians, and the mesh as a file."""
    volume = Volume.block(*scenes.BLOCK, pitch, directions)
    volume.carve(scenes.cutters()[0].tool, scenes.cutters()[0].path(turning=False))
    made, times = clock.timed(volume.to_mesh, repeats)
    made.write(path)
    return {**times, "triangles": len(made.triangles)}


def detail(
    scene: str,
    pitch: float,
    tolerances: list[float],
    folder: str,
    directions: str = "xyz",
    rays: int = 0,
    decimated: float = 0.0,
    repeats: int = 3,
) -> dict[str, Any]:
    """A volume's meshes without and with tolerances, which alternate: medians of times. Saves the meshes in `folder`,
    named full and less-TOLERANCE. `scene`: b200, s500k or an .stl file. `rays`: along the longest side, instead of a
    pitch; a tolerance of 0 is a tenth of the pitch. `decimated`: also times `decimate` with this tolerance after each
    kind of mesh."""
    if scene == "b200":
        volume = Volume.block(*scenes.BLOCK, pitch, directions)
        volume.carve(scenes.cutters()[0].tool, scenes.cutters()[0].path(turning=False))
    elif scene == "s500k":
        volume = Volume.block([0, 0, 0], [100, 60, 20], 100 / rays, directions)
        volume.carve(Tool.flat(6, 30), scenes.s500k(20_000, True))
    else:
        part = Mesh.read(scene)
        volume = Volume.from_mesh(part, float(np.ptp(np.asarray(part.bounds), axis=0).max()) / rays, directions)
    calls: dict[str, Any] = {"full": volume.to_mesh}
    for tolerance in tolerances:
        calls[f"less-{tolerance:g}"] = lambda t=tolerance or volume.pitch / 10: volume.to_mesh(tolerance=t)
    made, rows = alternated(calls, repeats)
    for name, mesh in made.items():
        np.save(f"{folder}/{name}.v.npy", mesh.vertices)
        np.save(f"{folder}/{name}.t.npy", mesh.triangles)
    after = {}
    if decimated:
        for way, first in (("to_mesh(), decimate", None), ("to_mesh(tolerance / 2), decimate", decimated / 2)):
            start = time.process_time()
            mesh = volume.to_mesh() if first is None else volume.to_mesh(tolerance=first)
            mesh = mesh.decimate(tolerance=decimated if first is None else decimated / 2)
            after[way] = {"cpu_s": time.process_time() - start, "triangles": len(mesh.triangles)}
    full = rows.pop("full")
    return {"pitch": volume.pitch, "full": full, "rows": list(rows.values()), "decimated": after}


def alternated(calls: dict[str, Any], repeats: int) -> tuple[dict[str, Mesh], dict[str, dict[str, Any]]]:
    """The meshes, and medians of the processor time of calls in turn."""
    made: dict[str, Mesh] = {}
    times: dict[str, list[float]] = {name: [] for name in calls}
    for _ in range(repeats):
        for name, call in calls.items():
            start = time.process_time()
            made[name] = call()
            times[name].append(time.process_time() - start)
    return made, {
        name: {"cpu_s": statistics.median(times[name]), "triangles": len(made[name].triangles)} for name in calls
    }


def rays(path: str, side: int, repeats: int, directions: str = "z") -> dict[str, Any]:
    """A part to rays, side² of them along z: median times, their number, and the volume."""
    part = Mesh(np.load(f"{path}.vertices.npy"), np.load(f"{path}.triangles.npy"))
    low, high = np.asarray(part.bounds)
    pitch = (high - low)[:2].max() / side
    middle, half = (low + high) / 2, np.array([pitch * side / 2, pitch * side / 2, (high - low)[2] / 2 + pitch])
    box = {"lower": middle - half, "upper": middle + half}
    volume, times = clock.timed(lambda: Volume.from_mesh(part, pitch, directions, **box), repeats)
    return {**times, "volume": volume.volume, "count": volume.rays}


def decimate(path: str, wanted: int, repeats: int) -> dict[str, Any]:
    """A part to `wanted` triangles: median times; saves the result next to it."""
    part = Mesh(np.load(f"{path}.vertices.npy"), np.load(f"{path}.triangles.npy"))
    less, times = clock.timed(lambda: part.decimate(triangles=wanted), repeats)
    np.save(f"{path}.out.vertices.npy", less.vertices)
    np.save(f"{path}.out.triangles.npy", less.triangles)
    return {**times, "triangles": len(less.triangles)}


def pencil(path: str, diameter: float, tolerance: float) -> dict[str, Any]:
    """Pencil curves of a part: times, what was found, and the counters."""
    part = Mesh(np.load(f"{path}.vertices.npy"), np.load(f"{path}.triangles.npy"))
    tool = Tool.ball(diameter, 5 * diameter)
    found, times = clock.timed(lambda: plan.pencil(part, tool, tolerance=tolerance), 1)
    whole = hashlib.sha256(b"".join(np.ascontiguousarray(p.centres).tobytes() for p in found)).hexdigest()
    return {**times, "paths": len(found), "digest": whole, **asdict(found.stats)}


def drop(path: str, points: str, tool: dict[str, Any], result: str) -> dict[str, Any]:
    """A tool dropped on a part at many places (x, y): median times, the tree's building in them; heights as a file."""
    part = Mesh(np.load(f"{path}.vertices.npy"), np.load(f"{path}.triangles.npy"))
    where = np.pad(np.load(points), [(0, 0), (0, 1)])
    (heights, _), times = clock.timed(lambda: plan.drop(where, Tool.from_dict(tool), part), 3)
    np.save(result, heights)
    return times


def streamed(moves: int, calls: int) -> dict[str, Any]:
    """The ramping path again and again, each time 0.8 mm deeper, a call each: memory is that of one."""
    volume, poses, tool = Volume.block(*scenes.S500K_BLOCK, 0.5), scenes.s500k(moves, True), Tool.flat(6, 30)
    before, removed = volume.volume, 0.0
    wall, cpu = time.perf_counter(), time.process_time()
    for _ in range(calls):
        removed += float(volume.carve(tool, poses).removed.sum())
        poses[:, 2] -= 0.8
    wall, cpu = time.perf_counter() - wall, time.process_time() - cpu
    return {"wall_s": wall, "cpu_s": cpu, "removed": removed, "lost": before - volume.volume, "rays": volume.rays}


def s500k(moves: int, ramping: bool, directions: str = "z") -> dict[str, Any]:
    volume = Volume.block(*scenes.S500K_BLOCK, 0.5, directions)
    poses, tool = scenes.s500k(moves, ramping), Tool.flat(6, 30)
    before = volume.volume
    wall, cpu = time.perf_counter(), time.process_time()
    cut = volume.carve(tool, poses)
    wall, cpu = time.perf_counter() - wall, time.process_time() - cpu
    removed = float(cut.removed.sum())
    return {"wall_s": wall, "cpu_s": cpu, "removed": removed, "lost": before - volume.volume, "rays": volume.rays}


def on_cores(job: str, quick: bool) -> dict[str, Any]:
    """A job of `jobs.threads`: its wall time, and the processor time of all threads and of the calling one."""
    call = prepared(job, quick)
    wall, cpu, own = time.perf_counter(), time.process_time(), time.thread_time()
    call()
    return {
        "wall_s": time.perf_counter() - wall,
        "cpu_s": time.process_time() - cpu,
        "caller_s": time.thread_time() - own,
    }


def prepared(job: str, quick: bool) -> Any:
    kind, _, directions = job.partition(", ")
    if kind in ("level", "ramping"):
        moves, volume = 20_000 if quick else 500_000, Volume.block(*scenes.S500K_BLOCK, 0.5, directions)
        poses, tool = scenes.s500k(moves, kind == "ramping"), Tool.flat(6, 30)
        return lambda: volume.carve(tool, poses)
    if kind in ("three axes", "five axes"):
        rows = 3_000 if quick else 200_000
        program = waves.program(rows, round(rows**0.5), kind == "five axes")
        stock = waves.stock(0.2, directions)
        return lambda: verify(program, stock)
    if kind == "from_mesh":
        part = parts.organic(20_000 if quick else 1_000_000)
        pitch = float(np.ptp(np.asarray(part.bounds), axis=0).max()) / (64 if quick else 1024)
        return lambda: Volume.from_mesh(part, pitch, directions)
    volume = Volume.block(*scenes.BLOCK, 0.5 if quick else 0.1, "xyz")
    volume.carve(scenes.cutters()[0].tool, scenes.cutters()[0].path(turning=False))
    if kind == "decimate":
        mesh = volume.to_mesh(tolerance=0.0025)
        return lambda: mesh.decimate(tolerance=0.0025)
    return {"to_mesh()": volume.to_mesh, "to_mesh(0.005)": lambda: volume.to_mesh(tolerance=0.005)}[kind]


def verified(
    rows: int, lines: int, tilted: bool, pitch: float, repeats: int = 1, cells: int = 0, tops: str = ""
) -> dict[str, Any]:
    """The waves verified, against a part of cells² squares if there are any: median times, what was found, and the
    memory before and at the peak; the tops of the rays as a file."""
    program, stock = waves.program(rows, lines, tilted), waves.stock(pitch)
    part = waves.part(cells) if cells else None
    rest = waves.REST if cells else None
    before = clock.peak_bytes()
    found, times = clock.timed(lambda: verify(program, stock, part, rest_tolerance=rest), repeats)
    out = {
        **times,
        "before_bytes": before,
        "verify_bytes": clock.peak_bytes(),
        "removed": float(found.removed.sum()),
        "passed": found.passed,
        "probes": found.stats["probes"],
    }
    if part:
        start = time.perf_counter()
        distance = found.stock_deviation()[1]
        out |= {"map_s": time.perf_counter() - start, "lowest_mm": float(distance.min())}
        out["triangles"] = len(part.triangles)
    if tops:
        np.save(tops, waves.tops(found.volume))
    return out


def verified_both(rows: int, lines: int, tilted: bool, pitch: float, turns: int) -> dict[str, Any]:
    """The waves verified with rays in one direction and in three, in turn: median processor times and their ratio."""
    program = waves.program(rows, lines, tilted)
    seconds, reports = {"z": [], "xyz": []}, {}
    for _ in range(turns):
        for directions, times in seconds.items():
            stock = waves.stock(pitch, directions)
            reports[directions], took = clock.timed(lambda stock=stock: verify(program, stock), 1)
            times.append(took["cpu_s"])
    z, xyz = (statistics.median(times) for times in seconds.values())
    ratio = statistics.median(b / a for a, b in zip(*seconds.values(), strict=True))
    same = bool(np.array_equal(reports["z"].removed, reports["xyz"].removed))
    return {"z_s": z, "xyz_s": xyz, "ratio": ratio, "same": same, "passed": reports["xyz"].passed}


def verified_stream(rows: int, lines: int, pitch: float, chunk: int) -> dict[str, Any]:
    """The waves on three axes, verified while they are made, `chunk` rows at a time; 0: made whole, then verified."""
    stock, before = waves.stock(pitch), clock.peak_bytes()

    def work() -> VerifyReport:
        return verify(waves.chunks(rows, lines, False, chunk) if chunk else waves.program(rows, lines, False), stock)

    found, times = clock.timed(work, 1)
    peak = clock.peak_bytes()  # before `found.removed`, a copy
    lost = stock.volume - found.volume.volume
    off = abs(float(found.removed.sum()) - lost) / lost
    return {**times, "before_bytes": before, "verify_bytes": peak, "passed": found.passed, "off": off}


def edited(rows: int, lines: int, pitch: float) -> dict[str, Any]:
    """The waves verified, and again after one row was moved up by 0.1 mm: the first, one in the middle, the last."""
    poses, stock = waves.poses(rows, lines, False), waves.stock(pitch)
    kept = Verification(stock)
    program = waves.as_program(poses)
    whole, times = clock.timed(lambda: kept.run(program), 1)
    out = {"whole_s": times["cpu_s"], "whole_bytes": clock.peak_bytes(), **whole.stats}
    edits = []
    for name, row in {"the first row": 0, "a row in the middle": rows // 2, "the last row": rows - 1}.items():
        poses[row, 2] += 0.1
        program = waves.as_program(poses)
        found, times = clock.timed(lambda program=program: kept.run(program), 1)
        same = waves.contents(found) == waves.contents(verify(program, stock))
        edits.append({"edit": name, **times, **found.stats, "same": same})
    return {**out, "edits": edits}


def files(folder: str) -> dict[str, Any]:
    """Writes what must not depend on the number of threads: forces, a volume, its mesh, a volume of that mesh."""
    poses = scenes.upright(scenes.cutters()[0].path(turning=False)[:, :3])
    k = np.arange(len(poses))
    axes = np.stack([0.3 * np.sin(0.05 * k), 0.2 * np.cos(0.03 * k), np.ones(len(k))], 1)
    poses[:, 3:] = axes / np.linalg.norm(axes, axis=1)[:, None]
    volume = Volume.block(*scenes.BLOCK, 0.4, "xyz")
    cut = volume.carve(Tool.fillet(8, 1, 30), poses, tolerance=0.01, dt=0.001)
    mesh = volume.to_mesh()
    out = Path(folder)
    np.concatenate([cut.removed[:, None], cut.force, cut.torque], 1).tofile(out / "forces.bin")
    volume.save(out / "volume.rvol")
    mesh.write(out / "mesh.stl")
    Volume.from_mesh(mesh, 0.5, "xyz").save(out / "again.rvol")
    return {}


WORK = {
    "b200": b200,
    "mesh": mesh,
    "detail": detail,
    "rays": rays,
    "decimate": decimate,
    "pencil": pencil,
    "drop": drop,
    "surfaces": torus.measured,
    "s500k": s500k,
    "streamed": streamed,
    "on_cores": on_cores,
    "verified": verified,
    "verified_both": verified_both,
    "verified_stream": verified_stream,
    "edited": edited,
    "files": files,
}

if __name__ == "__main__":
    result = WORK[sys.argv[1]](**json.loads(sys.argv[2]))
    result["peak_bytes"] = clock.peak_bytes()
    print(json.dumps(result))
