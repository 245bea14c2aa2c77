"""Makes the journals of this folder again: inputs that must not change, so run it to add a scene, not to mend a hash.

PYTHONPATH=native/python python native/tests/scenes/make_scenes.py

Others are sessions in which the stress run once found something, written by riffler_stress --journal:
- long-fillet (fillet, seed 11, session 529): a move of 14 m left one ray short;
- shank-below (taper-ball, seed 3, session 10): a piece whose neighbour stays below the stock lost its lower end;
- disc-far (disc, seed 101, session 5632): a force that was not a number.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import riffler

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[2]
UP = np.array([0.0, 0.0, 1.0])


def poses(tips: np.ndarray, axes: np.ndarray = UP) -> np.ndarray:
    """Tips and axes as rows; one axis may stand for all."""
    axes = np.broadcast_to(axes, tips.shape)
    return np.hstack([tips, axes / np.linalg.norm(axes, axis=1, keepdims=True)])


class Scene:
    """A journal being written."""

    def __init__(self, name: str, lower, upper, pitch: float, directions: str = "xyz", snapshot: str = ""):
        self.journal = riffler.Journal()
        self.path = HERE / f"{name}.rjournal"
        self.journal.set_stock(lower, upper, pitch, directions, snapshot=snapshot)
        self.tools = 0

    def stroke(self, tool: riffler.Tool, rows: np.ndarray, tolerance: float = 0.01) -> None:
        self.tools += 1
        self.journal.add_tool(self.tools, tool)
        self.journal.add_stroke(self.tools, rows, tolerance=tolerance)

    def write(self) -> None:
        self.journal.save(self.path)
        print(f"{self.path.name}: {self.path.stat().st_size} bytes")


def straight() -> Scene:
    """Ramps, level moves and plunges, with every named cutter."""
    scene = Scene("straight", (0, 0, 0), (36, 22, 10), 0.25)
    a = np.linspace(0, 1, 41)[:, None]
    wave = np.hstack([4 + 28 * a, 11 + 7 * np.sin(9 * a), 8 - 3 * a])
    scene.stroke(riffler.Tool.ball(6, 30), poses(wave))
    scene.stroke(riffler.Tool.flat(4, 30), poses(wave + np.array([0, 2, -1]), np.array([0.2, -0.1, 1])))
    scene.stroke(riffler.Tool.fillet(5, 1, 30), poses(np.array([[8, 4, 12], [8, 4, 6], [28, 4, 5.5], [28, 18, 5.5]])))
    scene.stroke(riffler.Tool.taper(0.5, 0.3, 6, 30), poses(np.array([[5, 18, 9], [31, 17, 4]]), np.array([0, 0.4, 1])))
    scene.stroke(riffler.Tool.cone_end(1.0, 1, 0.4, 6, 30), poses(np.array([[18, 20, 9], [18, 2, 6], [18, 2, 12]])))
    return scene


def five_axis() -> Scene:
    """The axis swings along the path."""
    scene = Scene("five-axis", (0, 0, 0), (36, 22, 10), 0.3)
    a = np.linspace(0, 1, 31)[:, None]
    tips = np.hstack([4 + 28 * a, 11 + 5 * np.sin(9 * a), 7 - 2 * a])
    axes = np.hstack([0.5 * np.sin(6 * a), 0.4 * np.cos(6 * a), np.ones_like(a)])
    for k, tool in enumerate([riffler.Tool.ball(5, 30), riffler.Tool.fillet(6, 1, 30), riffler.Tool.flat(3, 30)]):
        scene.stroke(tool, poses(tips + np.array([0, 3 * k - 3, -k]), axes), (0.01, 0.001, 0.05)[k])
    return scene


def great_turns() -> Scene:
    """Turns of 1° to 179° about the tip, about a ball's centre and about a point high above."""
    scene = Scene("great-turns", (0, 0, 0), (30, 30, 14), 0.5)
    cutters = [riffler.Tool.ball(6, 40), riffler.Tool.cone_end(1.0, 1, 0.4, 6, 40), riffler.Tool.taper(1, 0.4, 8, 40)]
    for k, (tool, height) in enumerate(zip(cutters, (3.0, 0.0, 50.0), strict=True)):
        angles = np.radians([-89.5, -30, -29, 10, 89.5] if height < 50 else [-12, 0, 1, 12])
        axes = np.stack([np.sin(angles), np.full_like(angles, 0.1 * k), np.cos(angles)], axis=1)
        axes /= np.linalg.norm(axes, axis=1, keepdims=True)
        pivot = np.array([10 + 5 * k, 8 + 7 * k, 6 + height])
        scene.stroke(tool, poses(pivot - height * axes, axes), 0.01)
    return scene


def degenerate() -> Scene:
    """Far from the origin: walls on rays, moves of no length and of 1e-12 mm, angles of 1e-9, a thin disc edge-on."""
    far = np.array([1e5, -1e5, 1e5])
    scene = Scene("degenerate", far, far + np.array([20, 18, 12]), 0.5)
    on_rays = np.array([[5.25, 6.25, 6], [12.25, 6.25, 6], [12.25, 6.25, 6], [12.25, 11.25, 6]])
    scene.stroke(riffler.Tool.flat(6, 30), poses(far + on_rays))
    tiny = np.array([[15, 5, 7], [15 + 1e-12, 5, 7], [15, 5, 7]])
    scene.stroke(riffler.Tool.ball(5, 30), poses(far + tiny, np.array([0.3, 0.1, 1])))
    nearly = np.array([[0, 0, 1], [1e-9, 0, 1], [1e-9, 1e-6, 1]])
    ways = np.array([[4, 15, 6], [8, 15, 6], [12, 14, 6]])
    scene.stroke(riffler.Tool.fillet(4, 1, 30), poses(far + ways, nearly))
    edge_on = np.array([[1, 0.02, -0.2], [1, 0.02, 0.25], [0.02, 1, 0.25]])
    ways = np.array([[9, 9, 9], [10, 9.5, 9.5], [9, 9, 9]])
    scene.stroke(riffler.Tool.flat(9, 0.3), poses(far + ways, edge_on), 0.005)
    return scene


def pen() -> Scene:
    """Some strokes of the demonstration's recording."""
    recording = riffler.Journal.load(ROOT / "demo" / "strokes.rjournal")
    chosen = recording.strokes[:3]
    rows = [np.asarray(stroke.poses)[:120] for stroke in chosen]
    tips = np.vstack(rows)[:, :3]
    lower, upper = np.floor(tips.min(axis=0) - 3), np.ceil(tips.max(axis=0) + 3)
    scene = Scene("pen", lower, upper, 0.3)
    for stroke, part in zip(chosen, rows, strict=True):
        scene.stroke(riffler.Tool.from_dict(recording.tools[stroke.tool]), part, stroke.tolerance)
    return scene


def snapshot() -> Scene:
    """A stock that is not a block, along z only."""
    stock = riffler.Volume.block((0, 0, 0), (24, 20, 12), 0.25, "z")
    stock.carve(riffler.Tool.flat(5, 2), poses(np.array([[4.0, 5, 5], [20, 15, 7]])))
    stock.save(HERE / "snapshot.rvol")
    scene = Scene("snapshot", (0, 0, 0), (24, 20, 12), 0.25, "z", "snapshot.rvol")
    a = np.linspace(0, 1, 21)[:, None]
    axes = np.hstack([0.3 * np.cos(9 * a), 0.3 * np.sin(9 * a), np.ones_like(a)])
    scene.stroke(riffler.Tool.ball(4, 30), poses(np.hstack([3 + 18 * a, 10 + 0 * a, 8 - 5 * a]), axes))
    return scene


if __name__ == "__main__":
    for make in (straight, five_axis, great_turns, degenerate, pen, snapshot):
        make().write()
