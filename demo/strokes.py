"""The recorded strokes of the demonstration: a hand that writes on a head.

    python -m demo.strokes out/demo/suzanne.stl demo/strokes.rjournal

A stroke is drawn as a plane curve, laid on the figure by casting rays through it, and given to a hand: the pen
follows the smoothed normal and leans a little, presses harder on down strokes, glides in and lifts off, and moves as
hands do. Speed falls with the cube root of curvature (Lacquaniti, Terzuolo and Viviani, The law relating the kinematic
and figural aspects of drawing movements, 1983) and rises from rest as in the movement of least jerk (Flash and Hogan,
The coordination of arm movements, 1985).
"""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from demo import font
from demo.surface import Surface, unit

RATE = 100.0  # Hz at which the pen is sampled
STEP = 0.1  # mm between the points that a stroke is built from
HOVER = 1.5  # mm above the surface where a stroke begins and ends
CRANIUM = np.array([0.0, 2.0, 14.0])  # mm; rays to the dome of the head start here

#: number: the tool library of the journal, sizes in mm and rad
ENGRAVER, GOUGER = 1, 2


@dataclass(frozen=True)
class Hand:
    """How a stroke is pressed and moved."""

    tool: int
    depth: float  # mm at full pressure
    thin: float = 1.0  # share of the depth on up strokes and bars
    lean: float = 0.14  # rad, the pen leans back against its motion
    glide: float = 2.0  # mm of path over which the pen comes down and lifts
    speed: float = 25.0  # mm/s where the path curves with RADIUS


RADIUS = 12.0  # mm, the curvature at which a hand moves at its stated speed
SLOWEST, FASTEST = 8.0, 45.0  # mm/s


@dataclass(frozen=True)
class Stroke:
    """Poses (n, 6), tip and unit axis in mm, at times (n,) in s from the start of the recording."""

    name: str
    tool: int
    poses: np.ndarray
    times: np.ndarray


# -- curves on the figure ---------------------------------------------------------------------------------------------


def tilted(x: np.ndarray, y: np.ndarray, tilt: float) -> np.ndarray:
    """Directions at longitude x and latitude y (rad) about the face's forward direction -y raised by `tilt`."""
    forward, side, up = np.cos(x) * np.cos(y), np.sin(x) * np.cos(y), np.sin(y)
    c, s = np.cos(tilt), np.sin(tilt)
    return np.stack([side, -(c * forward - s * up), s * forward + c * up], axis=1)


def on_dome(figure: Surface, directions: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    return figure.outermost(np.broadcast_to(CRANIUM, directions.shape).copy(), directions)


def from_front(figure: Surface, xz: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    origins = np.stack([xz[:, 0], np.full(len(xz), 100.0), xz[:, 1]], axis=1)
    return figure.outermost(origins, np.broadcast_to([0.0, -1.0, 0.0], origins.shape).copy())


def arc_length(points: np.ndarray) -> np.ndarray:
    return np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])


def resample(s: np.ndarray, rows: np.ndarray, step: float) -> np.ndarray:
    at = np.linspace(0.0, s[-1], max(2, round(s[-1] / step) + 1))
    return np.stack([np.interp(at, s, column) for column in rows.T], axis=1)


def smoothed(rows: np.ndarray, sigma: float) -> np.ndarray:
    """Gaussian mean along the first axis; odd reflection keeps the ends where they are."""
    reach = min(int(4 * sigma) + 1, len(rows) - 1)
    kernel = np.exp(-0.5 * (np.arange(-reach, reach + 1) / sigma) ** 2)
    kernel /= kernel.sum()
    before, after = 2 * rows[:1] - rows[reach:0:-1], 2 * rows[-1:] - rows[-2 : -reach - 2 : -1]
    padded = np.concatenate([before, rows, after])
    return np.stack([np.convolve(column, kernel, mode="valid") for column in padded.T], axis=1)


# -- the hand ---------------------------------------------------------------------------------------------------------


def pressure(hand: Hand, downward: np.ndarray, s: np.ndarray) -> np.ndarray:
    """Depth of the tip (mm) along the stroke: full on down strokes, `thin` on the others, gliding in and out."""
    share = hand.thin + (1.0 - hand.thin) * np.clip(downward, 0.0, 1.0)
    share = smoothed(share[:, None], 1.2 / STEP)[:, 0]
    edge = np.minimum(np.minimum(s, s[-1] - s) / min(hand.glide, s[-1] / 6), 1.0)
    ramp = edge**3 * (10.0 - 15.0 * edge + 6.0 * edge**2)
    return ramp * (hand.depth * share + HOVER) - HOVER


def speeds(hand: Hand, points: np.ndarray, s: np.ndarray) -> np.ndarray:
    """mm/s along the stroke."""
    tangents = unit(np.gradient(points, s, axis=0))
    bend = np.linalg.norm(np.gradient(tangents, s, axis=0), axis=1)
    speed = np.clip(hand.speed * (np.maximum(bend, 1e-6) * RADIUS) ** (-1 / 3), SLOWEST, FASTEST)
    speed = smoothed(speed[:, None], 1.5 / STEP)[:, 0]
    ramp = np.minimum(np.minimum(s, s[-1] - s) / 5.0 + 0.01, 1.0) ** (2 / 3)  # least jerk: v ~ s^(2/3) near rest
    return speed * ramp


def draw(name: str, hand: Hand, curve: tuple[np.ndarray, np.ndarray], start: float) -> Stroke:
    """The hand follows a curve on the figure, (points, normals), from time `start` (s) on."""
    points, normals = curve
    if np.isnan(points).any():
        raise ValueError(f"stroke {name}: row {int(np.isnan(points).any(axis=1).argmax())} misses the figure")
    s = arc_length(points)
    points, normals = resample(s, points, STEP), resample(s, normals, STEP)
    points, normals = smoothed(points, 0.5 / STEP), unit(smoothed(normals, 3.0 / STEP))
    s = arc_length(points)
    tangents = unit(smoothed(np.gradient(points, s, axis=0), 3.0 / STEP))
    axes = unit(normals + np.tan(hand.lean) * tangents)
    depth = pressure(hand, -unit(np.gradient(points, s, axis=0))[:, 2], s)
    tips = points - depth[:, None] * axes

    speed = speeds(hand, points, s)
    clock = np.concatenate([[0.0], np.cumsum(np.diff(s) * 0.5 * (1 / speed[1:] + 1 / speed[:-1]))])
    ticks = np.append(np.arange(0.0, clock[-1] - 0.5 / RATE, 1.0 / RATE), clock[-1])
    tips = np.stack([np.interp(ticks, clock, column) for column in tips.T], axis=1)
    axes = unit(np.stack([np.interp(ticks, clock, column) for column in axes.T], axis=1))
    return Stroke(name, hand.tool, np.concatenate([tips, axes], axis=1).round(7), (start + ticks).round(6))


# -- what is drawn ----------------------------------------------------------------------------------------------------

WRITING = Hand(tool=ENGRAVER, depth=1.7, thin=0.62, glide=1.6, speed=22.0)
CARVING = Hand(tool=GOUGER, depth=1.3, thin=1.0, glide=5.0, lean=0.2, speed=34.0)
RING = Hand(tool=ENGRAVER, depth=1.2, glide=1.5, speed=22.0)
FINE = Hand(tool=ENGRAVER, depth=1.5, thin=0.8, glide=5.0, speed=26.0)


def word(figure: Surface) -> list[tuple[str, Hand, tuple[np.ndarray, np.ndarray]]]:
    """The name across the forehead, on a great circle raised over the brows, its ends lifted a little."""
    height, tilt, bend = 0.43, np.radians(49.5), 0.16
    parts = []
    for name, xy in font.write(["R", "I", "F", "F", "L", "E", "R~"]):
        x, y = height * xy[:, 0], height * (xy[:, 1] - 0.5)
        parts.append((f"word {name}", WRITING, on_dome(figure, tilted(x, y + bend * x**2, tilt))))
    return parts


def circlet(figure: Surface) -> list[tuple[str, Hand, tuple[np.ndarray, np.ndarray]]]:
    """Two strands braided round the head, high over the word and low behind the ears, and a whorl at its middle."""
    pole = np.radians(121.0)  # from the face's forward direction, so leaning to the back of the head
    parts = []
    turn = np.pi + np.linspace(0.0, 2 * np.pi * 1.015, 2400)  # begins behind
    for strand, phase in (("a", 0.0), ("b", np.pi)):
        wave = 0.085 * np.sin(9 * turn + phase)
        parts.append((f"circlet {strand}", CARVING, on_dome(figure, about_pole(turn, np.radians(48.0) + wave, pole))))
    turn = np.linspace(0.0, 2 * np.pi * 3.5, 2400)
    parts.append(("whorl", CARVING, on_dome(figure, about_pole(turn, np.radians(3.0 + 31.0 * turn / turn[-1]), pole))))
    return parts


def about_pole(turn: np.ndarray, away: np.ndarray, pole: float) -> np.ndarray:
    """Directions `away` (rad) from a pole that stands at `pole` (rad) over the face's forward direction."""
    x, y, z = np.sin(away) * np.sin(turn), -np.sin(away) * np.cos(turn), np.cos(away)
    lean = pole - np.pi / 2
    c, s = np.cos(lean), np.sin(lean)
    return np.stack([x, c * y + s * z, -s * y + c * z], axis=1)


def face(figure: Surface) -> list[tuple[str, Hand, tuple[np.ndarray, np.ndarray]]]:
    """Mirrored on both sides: the brow, the rim of the ear, three whiskers."""
    parts = []
    for side, sign in (("left", -1.0), ("right", 1.0)):
        mirror = np.array([sign, 1.0])
        for name, hand, path in FACE:
            parts.append((f"{name} {side}", hand, from_front(figure, font.curve(path) * mirror)))
    return parts


#: x and z in mm, for the right side
IRIS = (
    "M14.5 14.3 C15.9 14.3 17 13.2 17 11.8 C17 10.4 15.9 9.3 14.5 9.3 "
    "C13.1 9.3 12 10.4 12 11.8 C12 13.2 13.1 14.3 14.5 14.3 C15.2 14.3 15.7 14.1 16.2 13.7"
)
FACE = (
    ("brow", CARVING, "M4 20.5 C6.5 26.5 9.5 30.6 14 30.3 C20 29.6 26 24.5 34.5 18.5"),
    ("eye", RING, IRIS),
    ("ear", CARVING, "M42 16 C46 18.6 52 19.2 55 15.5 C58 11.5 56.3 6 52.8 2.8 C49.5 .2 45 -1 40.5 -1"),
    ("whisker 1", FINE, "M4 -19.5 C6.5 -18.2 9 -18 11.6 -19.6"),
    ("whisker 2", FINE, "M4 -24 C6.5 -22.5 9.5 -22.3 12.4 -24.2"),
    ("whisker 3", FINE, "M4 -28.5 C6.5 -26.8 9.5 -26.6 13 -28.8"),
)


def record(figure: Surface) -> list[Stroke]:
    """Every stroke in order, with pauses in which the hand moves to the next."""
    strokes: list[Stroke] = []
    clock = 0.0
    for name, hand, curve in word(figure) + face(figure) + circlet(figure):
        if strokes:
            way = np.linalg.norm(curve[0][0] - strokes[-1].poses[-1, :3])
            clock = strokes[-1].times[-1] + 0.15 + way / 150.0
        strokes.append(draw(name, hand, curve, round(clock, 2)))
    return strokes


def journal(strokes: list[Stroke]):
    """The recording in the project's own format."""
    import riffler

    log = riffler.Journal()
    for number, tool in tools().items():
        log.add_tool(number, tool)
    for stroke in strokes:
        log.add_stroke(tool=stroke.tool, poses=stroke.poses, times=stroke.times, tolerance=0.01, name=stroke.name)
    return log


def tools() -> dict:
    """The journal's tool library."""
    import riffler

    return {
        ENGRAVER: riffler.Tool.taper(tip_radius=0.4, half_angle=np.radians(32.0), diameter=5.0, length=8.0),
        GOUGER: riffler.Tool.ball(diameter=4.0, length=8.0),
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("figure", type=Path, help="the STL that demo/suzanne.py writes")
    parser.add_argument("out", type=Path)
    options = parser.parse_args()
    strokes = record(Surface.read(options.figure))
    journal(strokes).save(options.out)
    print(f"{options.out}: {len(strokes)} strokes, {sum(len(s.poses) for s in strokes)} poses")


if __name__ == "__main__":
    main()
