"""Orientations set by the simulated pen next to a clamp: the hand leans the tool outwards along the nose of the
mouse-like part, feels jaws and clamp, and sets keys with the pen's button. The program is judged by LinuxCNC's
interpreter and verified.

python docs/gallery/by_feel.py
"""

from __future__ import annotations

import tempfile
import time
from pathlib import Path

import numpy as np
import parts
import riffler
from common import TOOL, draw_orientations, options
from picture import FIXTURE, Picture
from riffler import plan
from riffler_bench import nc_judge

VIEW = {"target": (34, -2, 16), "direction": (0.12, -0.72, 0.62), "width": 105}
SHOWN = (45, -5, 3)  # mm: where the tool is drawn, next to the clamp
TABLE = {"rot_point": (0, 0, -40), "offset": (0, 0, 0)}
KEYS = 17
STEP = 0.02  # s, of the hand
SPEED = 18.0  # mm/s, of the hand along the path; it waits where it feels more than it likes
WIDEST = np.radians(38)  # that the hand leans outwards where it feels nothing
TORQUE, FORCE = 20.0, 0.6  # N·mm and N at which it stops leaning; it yields where it feels more


def nose(path) -> np.ndarray:
    """The rows of the outer valley around the nose, in order."""
    rows = np.arange(len(path))
    behind = int(np.argmin(path.centres[:, 0]))
    turned = np.roll(rows, -behind)
    return turned[path.centres[turned, 0] > 8]


def led(path, felt) -> tuple[plan.PencilPath, np.ndarray]:
    """The path with the keys that the pen's button set, and (n, 3) with a row for each step of the hand: the point, and
    how far hand and tool lean, in degrees."""
    outwards = np.array([n.sum(0) for n in path.normals]) * [1, 1, 0]
    outwards /= np.linalg.norm(outwards, axis=1)[:, None]
    places = np.linspace(2, len(path) - 3, KEYS).round()
    with riffler.pen.open("simulated") as pen:
        time.sleep(0.2)  # it homes itself
        home, lean, travelled, rows = pen.state().pose, 0.0, -0.5 * SPEED, []  # half a second to lean before it goes
        session = riffler.OrientSession(path, TOOL, felt, pen, axis=home[3:], ramp=0.2)
        with session:
            while travelled < len(path) + 0.5 * SPEED:
                point = int(np.clip(round(travelled), 0, len(path) - 1))
                axis = np.cos(lean) * home[3:] + np.sin(lean) * outwards[point]
                at = home[:3] + path.centres[point] - path.centres[0]
                pen.aim([*at, *axis], buttons=int(np.abs(point - places).min() < 0.5))
                time.sleep(STEP)
                frame = session.frame()
                felt_share = max(np.linalg.norm(frame.torque) / TORQUE, np.linalg.norm(frame.force) / FORCE)
                lean = float(np.clip(lean + STEP * np.clip(1 - felt_share, -2, 1), 0, WIDEST))
                travelled += SPEED * STEP if felt_share < 2 else 0.0
                rows.append((frame.station, np.degrees(lean), np.degrees(np.arccos(frame.tool[5]))))
        return session.path, np.array(rows)


def judged(program, code: Path) -> str:
    """How far LinuxCNC's interpreter takes the tool from the program's rows."""
    if nc_judge.interpreter() is None:
        return "left out: no LinuxCNC here"
    _, joints = nc_judge.interpreted(code)
    off = nc_judge.between(joints, program.poses, nc_judge.tilting_table("A", **TABLE), ~program.rapid)
    if off["at_mm"] > 2e-3:
        raise SystemExit(f"LinuxCNC takes the tool {off['at_mm']:.3f} mm from its rows")
    return f"within {off['at_mm']:.4f} mm of the rows"


def main() -> None:
    given = options(__doc__)
    part, fixtures = parts.mouse(160 if given.fast else 480), parts.vise()
    path = max(plan.pencil(part, TOOL), key=lambda p: p.length).divided(1.0)
    rows = nose(path)
    path = plan.PencilPath(path.radius, path.centres[rows], path.contacts[rows], path.normals[rows])
    oriented, leans = led(path, riffler.Collider(part, fixtures=parts.vise(1.0)))
    collider = riffler.Collider(part, fixtures=fixtures)
    cl, report = plan.cutter_locations(oriented, TOOL, collider, tolerance=0.02)
    moved = leans[60:]
    print(
        f"{len(oriented.keys)} keys on {path.length:.0f} mm; the tool leans {moved[:, 2].min():.0f} to "
        f"{moved[:, 2].max():.0f}°; lifted at {len(report.lifted)} of {len(path)} points"
    )
    program = riffler.Program.from_cl([cl], tools=[TOOL], feed=600, spindle=12000, collider=collider)
    with tempfile.TemporaryDirectory() as folder:
        code = Path(folder) / "by_feel.ngc"
        program.write(code, post="linuxcnc-xyzac", options=TABLE, collider=collider)
        print("by LinuxCNC:", judged(program, code))
    stock = riffler.Volume.from_mesh(part, 1.0 if given.fast else 0.4, "xyz")
    found = riffler.verify(program, stock, part_mesh=part, fixtures=fixtures)
    print("verified:", found.passed)
    missing = KEYS - len(oriented.keys)  # a press that a busy computer did not see
    if not found.passed or missing > (3 if given.fast else 0) or (len(report.lifted) and not given.fast):
        raise SystemExit("the keys do not make a program that is free")
    if not given.fast:
        show(given, part, fixtures, oriented, cl)


def show(given, part, fixtures, oriented, cl) -> None:
    picture = Picture()
    picture.mesh(part)
    for fixture in fixtures:
        picture.mesh(fixture.to_mesh(), FIXTURE)
    draw_orientations(picture, oriented, oriented.keys, every=3)
    ends = cl[:, :3] + 0.5 * TOOL.diameter * cl[:, 3:]
    picture.tool(TOOL, cl[np.linalg.norm(ends - SHOWN, axis=1).argmin()])
    picture.render(given.out / "by-feel.jpg", given.blender, **VIEW)


main()
