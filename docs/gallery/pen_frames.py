"""The pen's frames and angles, drawn from its kinematics: from the side in each arm's plane, from above, and in space.

python docs/gallery/pen_frames.py
"""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from riffler.pen import PenGeometry

OUT = Path(__file__).parents[1] / "images" / "pen-frames.png"
POSE = (215.0, 22.0, -95.0, 0.25, -0.3, 1.0)  # not at home, so that no angle is 0
COLOURS = {"R": "tab:red", "L": "tab:blue"}


@dataclass
class Arm:
    """Points of one arm, mm, in the arms' frame."""

    shoulder: np.ndarray
    elbow: np.ndarray
    end: np.ndarray
    angles: np.ndarray


def arms(pen: PenGeometry, counts: np.ndarray) -> dict[str, Arm]:
    ends, jacobians, joints = pen.ends([counts])[0], pen.jacobian([counts])[0], pen.joints([counts])[0]
    out = {}
    for k, name in enumerate("RL"):
        first, angles = jacobians[k][:, 0], joints[3 * k : 3 * k + 3]
        level = np.array([np.cos(angles[0]), np.sin(angles[0]), 0])
        # Joint 1 moves the end on a circle about the upright, joint 3 on one about the elbow: both centres follow.
        shoulder = ends[k] - np.array([first[1], -first[0], 0])
        third = jacobians[k][:, 2]
        elbow = ends[k] - level * third[2] + np.array([0, 0, third @ level])
        out[name] = Arm(np.array([*shoulder[:2], 0]), elbow, ends[k], angles)
    return out


def arc(axis, centre, radius, start, end, text) -> None:
    angles = np.linspace(start, end, 40)
    axis.plot(centre[0] + radius * np.cos(angles), centre[1] + radius * np.sin(angles), "k-", lw=0.9)
    middle = angles[20]
    axis.annotate(text, (centre[0] + (radius + 9) * np.cos(middle), centre[1] + (radius + 9) * np.sin(middle)),
                  ha="center", va="center")  # fmt: skip


def side(axis, name: str, arm: Arm) -> None:
    """In the arm's own plane: how far out, and up."""
    points = [arm.shoulder, arm.elbow, arm.end]
    out = [np.hypot(*(p - arm.shoulder)[:2]) for p in points]
    up = [p[2] for p in points]
    axis.plot(out, up, "o-", color=COLOURS[name], lw=3)
    axis.plot([0, 0], [0, -80], "k:", lw=1)
    axis.plot([out[1], out[1] + 90], [up[1]] * 2, "k:", lw=1)
    arc(axis, (0, 0), 60, -np.pi / 2, -np.pi / 2 + arm.angles[1], "θ2")
    arc(axis, (out[1], up[1]), 70, 0, arm.angles[2], "θ3")
    axis.annotate("L1", ((out[0] + out[1]) / 2 + 6, (up[0] + up[1]) / 2))
    axis.annotate("L2", ((out[1] + out[2]) / 2, (up[1] + up[2]) / 2 + 6))
    axis.annotate(f"G_{name}", (out[2] - 8, up[2] + 8))
    axis.set(aspect="equal", xlabel="outwards, mm", ylabel="z, mm", title=f"Arm {name} in its plane")


def above(axis, both: dict[str, Arm]) -> None:
    for name, arm in both.items():
        points = np.array([arm.shoulder, arm.elbow, arm.end])
        axis.plot(points[:, 0], points[:, 1], "o-", color=COLOURS[name], lw=3)
        axis.plot([0, 70], [arm.shoulder[1]] * 2, "k:", lw=1)
        arc(axis, arm.shoulder, 55, 0, arm.angles[0], "θ1")
        axis.annotate(f"G_{name}", arm.end[:2] + np.array([3, -12 if name == "R" else 4]))
    axis.annotate("", (0, 80), (0, 0), arrowprops={"arrowstyle": "<->"})
    axis.annotate("L0", (4, 36))
    axis.annotate("", (45, 0), (0, 0), arrowprops={"arrowstyle": "->"})
    axis.annotate("x", (47, -3))
    axis.set(aspect="equal", xlabel="x, mm", ylabel="y, mm", title="From above")
    axis.margins(x=0.12)  # the ends' names are within


def space(axis, both: dict[str, Arm], pose: np.ndarray) -> None:
    for name, arm in both.items():
        points = np.array([arm.shoulder, arm.elbow, arm.end])
        axis.plot(*points.T, "o-", color=COLOURS[name], lw=3)
        axis.text(*(arm.shoulder + np.array([0, 0, 12])), f"arm {name}")
    grip = np.array([both["L"].end, both["R"].end])
    axis.plot(*grip.T, "-", color="black", lw=4)
    pivot, along = pose[:3], pose[3:]
    axis.quiver(*pivot, *(90 * along), color="black", arrow_length_ratio=0.15)
    axis.text(*(pivot + 95 * along), "pose's axis  ", ha="right")
    axis.text(*(pivot + np.array([10, 0, -14])), "r_G")
    for direction, letter in zip(50 * np.eye(3), "xyz", strict=True):
        axis.quiver(0, 0, 0, *direction, color="gray")
        axis.text(*(1.15 * direction), letter, color="gray")
    axis.set(title="Base frame, grip and pose", xlabel="x", ylabel="y", zlabel="z")
    axis.set(xticks=(0, 100, 200), yticks=(-50, 0, 50), zticks=(-150, -100, -50, 0))
    axis.set_aspect("equal")
    axis.view_init(22, -52)


def draw(both: dict[str, Arm], pose: np.ndarray) -> None:
    import matplotlib as mpl

    mpl.use("Agg")
    import matplotlib.pyplot as plt

    figure = plt.figure(figsize=(10, 8.4), dpi=100)
    side(figure.add_subplot(2, 2, 1), "R", both["R"])
    side(figure.add_subplot(2, 2, 2), "L", both["L"])
    above(figure.add_subplot(2, 2, 3), both)
    space(figure.add_subplot(2, 2, 4, projection="3d"), both, pose)
    figure.tight_layout()
    OUT.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(OUT)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--fast", action="store_true", help="without the picture")
    fast = parser.parse_args().fast
    pen = PenGeometry.load("riffler")
    wanted = np.array(POSE)
    wanted[3:] /= np.linalg.norm(wanted[3:])
    joints, reach = pen.inverse([wanted])
    assert reach == [("reached", "reached")], reach
    counts = pen.counts(joints)[0]
    both, pose = arms(pen, counts), pen.forward([counts])[0]
    lengths = [np.linalg.norm(a.elbow - a.shoulder) for a in both.values()]
    print(f"arms of {lengths[0]:.1f} and {lengths[1]:.1f} mm; "
          f"the pose is {np.linalg.norm(pose[:3] - wanted[:3]):.4f} mm from the one asked for")  # fmt: skip
    if not fast:
        draw(both, pose)


if __name__ == "__main__":
    main()
