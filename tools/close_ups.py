"""Close-ups of Riffler's meshes next to OpenVDB's at the same pitch: docs/images/close-ups/*.jpg.

    tools/close_ups.py --models FOLDER [--programs build/bench/native/bench] [--blender .envs/bpy-4.5/bin/python]

A carved bunny, a part with sharp edges, an engraved plate. OpenVDB meshes the signed distance from a mesh that Riffler
made of the same volume at a third of the pitch, or from the part itself.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from riffler import Mesh, Tool, Volume
from riffler_bench import _bench as bench

from shell import ROOT, StepError, main

sys.path.insert(0, str(ROOT))
from demo import font

FINER, BAND, ROOM = 3, 3.0, 6
UP = np.array([0.0, 0, 1])


@dataclass
class View:
    """Where the camera looks, from where, and how wide, mm."""

    target: tuple[float, float, float]
    direction: tuple[float, float, float]
    width: float


def part(path: Path, size: float) -> Mesh:
    """A model as large as asked for, its box's corner at the origin."""
    if not path.exists():
        raise StepError(f"{path} is not there: name a folder with it (--models)")
    mesh = Mesh.read(path)
    lower, upper = np.asarray(mesh.bounds)
    return Mesh((np.asarray(mesh.vertices) - lower) * (size / (upper - lower).max()), mesh.triangles)


def around(mesh: Mesh) -> dict[str, list[float]]:
    lower, upper = np.asarray(mesh.bounds)
    return {"lower": list(lower - 2), "upper": list(upper + 2)}


def bunny(models: Path, pitch: float) -> Volume:
    """Grooves round the body: slices of the part, entered by a ball."""
    mesh = part(models / "stanford-bunny.stl", 100)
    volume = Volume.from_mesh(mesh, pitch, "xyz", **around(mesh))
    ball = Tool.ball(3, 40)
    vertices = np.asarray(mesh.vertices)
    axis = int(np.argmax(vertices.max(0) - vertices.min(0)))
    top = vertices[:, 2].max()
    for share in np.linspace(0.25, 0.6, 6):
        near = abs(vertices[:, axis] - share * vertices[:, axis].max()) < 1.0
        ring = vertices[near]
        other = 1 if axis == 0 else 0
        columns = np.arange(ring[:, other].min() + 2, ring[:, other].max() - 2, 1.0)
        heights = [ring[abs(ring[:, other] - c) < 2.0][:, 2].max(initial=0) for c in columns]
        tips = np.zeros((len(columns), 3))
        tips[:, axis], tips[:, other], tips[:, 2] = share * vertices[:, axis].max(), columns, np.array(heights) - 0.9
        tips = tips[(tips[:, 2] > 0.3 * top)]
        if len(tips) > 1:
            volume.carve(ball, np.hstack([tips, np.tile(UP, (len(tips), 1))]))
    return volume


def fandisk(models: Path, pitch: float) -> Volume:
    mesh = part(models / "fandisk.stl", 100)
    return Volume.from_mesh(mesh, pitch, "xyz", **around(mesh))


def plate(_: Path, pitch: float) -> Volume:
    """The demonstration's word, engraved with a pointed cutter into a bevelled plate."""
    volume = Volume.block([0, 0, 0], [64, 24, 4], pitch, "xyz")
    point = Tool.cone_end(0.5, 1.2, 0.5, 3, 20)
    for _, stroke in font.write(["R", "I", "F", "F", "L", "E", "R"]):
        xy = stroke * 11.0 + np.array([32.0, 6.5])
        tips = np.column_stack([xy, np.full(len(xy), 3.3)])
        volume.carve(point, np.hstack([tips, np.tile(UP, (len(tips), 1))]))
    return volume


SCENES = {
    "bunny": (bunny, 0.4, View((52, 40, 58), (-0.35, -0.8, 0.75), 40)),
    "fandisk": (fandisk, 1.2, View((60, 30, 40), (0.9, -0.75, 0.6), 60)),
    "plate": (plate, 0.25, View((20, 12, 4), (0.2, -0.7, 0.9), 22)),
}


def field(volume: Volume, truth: Mesh) -> np.ndarray:
    """Signed distance from a mesh at the lattice's points, cut off outside the band that a level set keeps."""
    counts, spans = volume.intervals("z")
    n = (*counts.shape, round((volume.upper[2] - volume.lower[2]) / volume.pitch))
    z = volume.lower[2] + (np.arange(n[2]) + 0.5) * volume.pitch
    inside = np.zeros((counts.size, n[2]), bool)
    rays = np.repeat(np.arange(counts.size), counts.ravel())
    for ray, (near, far) in zip(rays, spans, strict=True):
        inside[ray, (z > near) & (z < far)] = True
    # Room outside, so that the level set closes around the part.
    inside = np.pad(inside.reshape(n), ROOM)
    n = inside.shape
    close = np.zeros(n, bool)
    for axis in range(3):
        change = np.diff(inside, axis=axis)
        index = [slice(None)] * 3
        for place in (slice(None, -1), slice(1, None)):
            index[axis] = place
            close[tuple(index)] |= change
    for _ in range(int(BAND)):
        grown = close.copy()
        for axis in range(3):
            grown |= np.roll(close, 1, axis) | np.roll(close, -1, axis)
        close = grown
    out = np.full(n, BAND * volume.pitch, np.float32)
    points = volume.lower + (np.argwhere(close) - ROOM + 0.5) * volume.pitch
    out[close] = np.minimum(bench.mesh_distances(points, truth), BAND * volume.pitch)
    return np.where(inside, -out, out).astype(np.float32)


def openvdb(programs: Path, volume: Volume, truth: Mesh, folder: Path) -> Mesh:
    program = programs / "riffler_openvdb_mesh"
    if not program.exists():
        raise StepError(f"{program} is not there: `make bench` builds it where OpenVDB is installed")
    values = field(volume, truth)
    values.tofile(folder / "field")
    origin = np.asarray(volume.lower) + (0.5 - ROOM) * volume.pitch
    arguments = [folder / "field", *values.shape, volume.pitch, *origin, 1, 1, folder / "mesh"]
    subprocess.run([program, *map(str, arguments)], check=True, stdout=subprocess.DEVNULL)
    vertices = np.fromfile(folder / "mesh.vertices", np.float32).reshape(-1, 3)
    quads = np.fromfile(folder / "mesh.quads", np.int32).reshape(-1, 4)[:, ::-1]
    return Mesh(vertices, np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]]))


def render(blender: Path, jobs: list[dict]) -> None:
    if not blender.exists():
        raise StepError(f"{blender} is not there: `make demo` makes it")
    script = ROOT / "tools" / "close_up_scene.py"
    subprocess.run([blender, script, json.dumps(jobs)], check=True, stdout=subprocess.DEVNULL)


def compose(name: str, pictures: dict[str, Path], out: Path) -> None:
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import image, pyplot

    figure, axes = pyplot.subplots(1, len(pictures), figsize=(6 * len(pictures), 6.3), layout="constrained")
    for axis, (title, path) in zip(axes, pictures.items(), strict=True):
        axis.imshow(image.imread(path))
        axis.set_title(title)
        axis.axis("off")
    figure.savefig(out / f"{name}.jpg", dpi=90, pil_kwargs={"quality": 88})
    pyplot.close(figure)


def entry() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--models", type=Path, required=True)
    parser.add_argument("--programs", type=Path, default=ROOT / "build/bench/native/bench")
    parser.add_argument("--blender", type=Path, default=ROOT / ".envs/bpy-4.5/bin/python")
    parser.add_argument("--out", type=Path, default=ROOT / "docs/images/close-ups")
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for scene, (make, pitch, view) in SCENES.items():
            volume, truth = make(options.models, pitch), make(options.models, pitch / FINER).to_mesh()
            meshes = {
                f"OpenVDB, h = {pitch:g} mm": openvdb(options.programs, volume, truth, folder),
                f"Riffler, h = {pitch:g} mm": volume.to_mesh(),
                f"The part, h = {pitch / FINER:.2g} mm": truth,
            }
            jobs, pictures = [], {}
            for number, (title, mesh) in enumerate(meshes.items()):
                stem = f"{folder}/{number}"
                mesh.write(f"{stem}.stl")
                pictures[title] = Path(f"{stem}.png")
                jobs.append(
                    {"mesh": f"{stem}.stl", "picture": f"{stem}.png", "target": view.target,
                     "direction": view.direction, "width": view.width}
                )  # fmt: skip
            render(options.blender, jobs)
            compose(scene, pictures, options.out)
            print(f"{options.out / scene}.jpg", flush=True)


if __name__ == "__main__":
    main(entry)
