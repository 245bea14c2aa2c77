"""Pictures of parts, paths and tools: gathered here as triangles, rendered by Blender (blender_scene.py)."""

from __future__ import annotations

import subprocess
import tempfile
from pathlib import Path

import numpy as np
import riffler

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
WAX, STEEL, SHANK, HOLDER = (0.62, 0.36, 0.19), (0.75, 0.77, 0.80), (0.45, 0.48, 0.52), (0.12, 0.14, 0.17)
FIXTURE, PATH, KEY, BETWEEN, BAD = (
    (0.28, 0.36, 0.42),
    (0.02, 0.06, 0.5),
    (0.0, 0.65, 0.8),
    (0.03, 0.12, 0.75),
    (0.8, 0.03, 0.02),
)
CLAY, PLASTER = (0.55, 0.29, 0.18), (0.60, 0.56, 0.49)
PART_COLOURS = {"cutter": STEEL, "shank": SHANK, "holder": HOLDER}


def frames(ways: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Two unit vectors across each direction."""
    helper = np.eye(3)[np.abs(ways).argmin(axis=1)]
    u = np.cross(ways, helper)
    u /= np.linalg.norm(u, axis=1)[:, None]
    return u, np.cross(ways, u)


def tube(points: np.ndarray, radius: float, closed: bool = False, sides: int = 8) -> tuple[np.ndarray, np.ndarray]:
    """A polyline as a tube of capsules' bodies: a prism for every edge, which reaches a little over its ends."""
    ends = np.concatenate([points, points[:1]]) if closed else points
    a, b = ends[:-1], ends[1:]
    length = np.linalg.norm(b - a, axis=1)
    a, b, length = a[length > 0], b[length > 0], length[length > 0]
    way = (b - a) / length[:, None]
    u, v = frames(way)
    turn = 2 * np.pi * np.arange(sides) / sides
    ring = radius * (u[:, None] * np.cos(turn)[:, None] + v[:, None] * np.sin(turn)[:, None])
    over = 0.4 * radius * way[:, None]
    vertices = np.concatenate([a[:, None] + ring - over, b[:, None] + ring + over], axis=1)
    k, j = np.arange(sides), (np.arange(sides) + 1) % sides
    one = np.concatenate([np.column_stack([k, j, j + sides]), np.column_stack([k, j + sides, k + sides])])
    triangles = (one[None] + 2 * sides * np.arange(len(a))[:, None, None]).reshape(-1, 3)
    return vertices.reshape(-1, 3), triangles


def lathe(outline: np.ndarray, pose: np.ndarray, sides: int = 48) -> tuple[np.ndarray, np.ndarray]:
    """A polyline of (radius, height) turned about the axis of a pose."""
    axis = pose[3:] / np.linalg.norm(pose[3:])
    (u,), (v,) = frames(axis[None])
    turn = 2 * np.pi * np.arange(sides) / sides
    circle = u * np.cos(turn)[:, None] + v * np.sin(turn)[:, None]
    vertices = pose[:3] + outline[:, None, :1] * circle + outline[:, None, 1:] * axis
    k, j = np.arange(sides), (np.arange(sides) + 1) % sides
    one = np.concatenate([np.column_stack([k, j, j + sides]), np.column_stack([k, j + sides, k + sides])])
    triangles = (one[None] + sides * np.arange(len(outline) - 1)[:, None, None]).reshape(-1, 3)
    return vertices.reshape(-1, 3), triangles


class Picture:
    """What is to be seen, and from where."""

    def __init__(self) -> None:
        self.things: list[dict] = []

    def add(self, vertices, triangles, colour, *, smooth: float = 0.0, alpha: float = 1.0) -> None:
        """`smooth`: edges flatter than so many degrees are shaded as round ones."""
        self.things.append(
            {
                "vertices": np.asarray(vertices, np.float32),
                "triangles": np.asarray(triangles, np.int32),
                "look": np.array([*colour, alpha, np.radians(smooth)], np.float32),
            }
        )

    def mesh(self, mesh: riffler.Mesh, colour=WAX, *, smooth: float = 25.0, alpha: float = 1.0) -> None:
        self.add(mesh.vertices, mesh.triangles, colour, smooth=smooth, alpha=alpha)

    def curve(self, points, colour=PATH, *, radius: float = 0.35, closed: bool = False) -> None:
        self.add(*tube(np.asarray(points), radius, closed), colour, smooth=60)

    def arrows(self, points, axes, colour, *, length: float = 14, radius: float = 0.3) -> None:
        for p, axis in zip(points, axes, strict=True):
            head = p + length * axis
            self.add(*tube(np.array([p, head]), radius), colour, smooth=60)
            cone = np.array([[2.6 * radius, 0], [0, 9 * radius]])
            self.add(*lathe(cone, np.concatenate([head, axis]), 16), colour, smooth=60)

    def tool(self, tool: riffler.Tool, pose, *, holder: bool = True, colour=None) -> None:
        for part, outline in tool.outline():
            if holder or part != "holder":
                self.add(*lathe(outline, np.asarray(pose)), colour or PART_COLOURS[part], smooth=35)

    def render(self, out: Path, blender: Path, *, target, direction, width: float, size=(1200, 800)) -> None:
        """Looks along −direction at the target; `width` mm of it fill the picture's width."""
        self._run(out, blender, "blender_scene.py", view=[*target, *direction, width, *size])

    def photograph(
        self, out: Path, blender: Path, *, eye, target, floor: float, width: float, size=(1000, 750), samples: int = 24
    ) -> None:
        """Stands on a table at height `floor`, in a studio's light, seen from `eye`; `width` mm at the target fill the
        picture's width."""
        self._run(out, blender, "studio.py", view=[*target, *eye, width, *size, floor, samples])

    def _run(self, out: Path, blender: Path, script: str, **more) -> None:
        out.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory() as folder:
            scene = Path(folder) / "scene.npz"
            arrays = {f"{name}_{k}": value for k, thing in enumerate(self.things) for name, value in thing.items()}
            np.savez(scene, count=len(self.things), **arrays, **{name: np.array(v, float) for name, v in more.items()})
            command = [blender, HERE / script, scene, out]
            done = subprocess.run(list(map(str, command)), capture_output=True, text=True, timeout=1200)
        if done.returncode:
            raise SystemExit(f"the picture failed ({done.returncode}):\n{done.stdout[-1500:]}\n{done.stderr[-3000:]}")
        print(out, flush=True)
