"""Home a pen and check its counters, its file and its limits, step by step.

riffler pen calibrate --out pen-check.toml
riffler pen calibrate simulated --yes
riffler pen calibrate simulated --yes --lose L1=60     shows what a fault looks like
riffler pen calibrate spacemouse                       finds how large the puck's bubble must be

Put the pen into its home posture, then move it everywhere it reaches. The arms measure one number more than a pose
needs: the distance between their ends, which must equal the grip's length in every posture. Exit status 1 if it does
not. The motors do not push.
"""

from __future__ import annotations

import argparse
import math
import sys
import time
from collections.abc import Iterator
from datetime import datetime
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import pen
from .arguments import length, output_file, whole
from .console import Console
from .devices import add_device, geometry_of, open_device
from .live import FRAMES, Braille, Enter, polyline, screen
from .parser import Parser
from .pen_diagnosis import Joint, Postures, Verdict, bubble_of, joints, judge

if TYPE_CHECKING:
    from rich.console import RenderableType

HELP = "home a pen and check its counters; measure the noise of a puck"

ENOUGH = 0.3  # share of its range that a joint should have moved
FEWEST = 20  # postures that a verdict needs
REST = 5.0  # s during which nothing touches a puck


def add_arguments(parser: Parser) -> None:
    add_device(parser)
    parser.add_argument("--yes", action="store_true", help="ask nothing: the pen stands in its home posture now")
    parser.add_argument("--seconds", default="20", metavar="N", help="longest time of moving (default 20)")
    parser.add_file("--out", ".toml for the measurements and the changes that the pen's file needs", (".toml",))
    parser.add_argument("--force", action="store_true", help="let --out replace a file")
    parser.add_argument(
        "--lose", action="append", default=[], metavar="JOINT=N", help='for "simulated": lost counts of a joint, L1=60'
    )


def run(arguments: argparse.Namespace, console: Console) -> int:
    out = None if arguments.out is None else output_file(arguments.out, (".toml",))
    if out is not None and out.exists() and not arguments.force:
        raise ValueError(f"--out {out.name}: already exists; use another name, or --force")
    seconds = length(arguments.seconds, "--seconds")
    if not arguments.yes and (console.json_output or not sys.stdin.isatty()):
        raise ValueError("pen calibrate asks questions: run it in a terminal and without --json, or with --yes")
    if str(arguments.device).endswith(".rjournal"):
        raise ValueError("a recording has nothing to calibrate")
    # A puck's own response, without the bubble that it gets later; pens ignore both arguments.
    with open_device(arguments.device, bubble=0.0, exponent=1.0) as device:
        losses = losses_of(arguments.lose, device)
        wait_for(device, lambda: math.isfinite(device.state().age_s) or device.limits["x"].senses == "rate")
        if device.geometry is not None:
            data, rows, title, right = calibrate_pen(device, losses, seconds, arguments.yes, console)
        elif device.limits["x"].senses == "rate":
            data, rows, title, right = calibrate_puck(device, min(seconds, REST), arguments.yes, console)
        else:
            raise ValueError(f"{device.kind} has nothing to calibrate: it has no homing and no bubble")
    if out is not None:
        with console.writing(out) as beside:
            beside.write_text(toml(data), encoding="utf-8")
        rows.append(("written", str(out)))
    console.result(data | {"out": None if out is None else str(out)}, title, rows)
    return 0 if right else 1


def losses_of(texts: list[str], device: pen.PenDevice) -> dict[int, int]:
    """``L1=60`` as channel and counts."""
    if texts and not isinstance(device, pen.SimulatedPen):
        raise ValueError('--lose is only for "simulated"')
    names = [c.name for c in geometry_of(device).channels] if texts else []
    found: dict[int, int] = {}
    for text in texts:
        name, _, counts = text.partition("=")
        if name not in names:
            raise ValueError(f"--lose {text}: JOINT=N expected, of the joints {', '.join(sorted(names))}")
        found[names.index(name)] = whole(counts, f"--lose {text}: N")
    return found


def wait_for(device: pen.PenDevice, what: Any, seconds: float = 2.0) -> None:
    end = time.monotonic() + seconds
    while not what():
        if time.monotonic() > end:
            health = device.health()
            raise pen.PenError(f"{device.kind} sends nothing: {health.problem or 'plug it in again'}")
        time.sleep(0.01)


# ---- a pen


def calibrate_pen(
    device: pen.PenDevice, losses: dict[int, int], seconds: float, yes: bool, console: Console
) -> tuple[dict[str, Any], list[tuple[str, str]], str, bool]:
    geometry = geometry_of(device)
    home = geometry.forward([geometry.home])[0]
    simulated = isinstance(device, pen.SimulatedPen)
    if isinstance(device, pen.SimulatedPen):
        device.aim(home)  # the simulated hand moves it there
    if not yes:
        say_home(geometry)
        input("Hold it like this and press Enter. ")
    elif simulated:
        still(device)
    if not device.home():
        raise pen.PenError(f"{device.kind} cannot be homed")
    wait_for(device, lambda: device.state().homed)
    if losses and isinstance(device, pen.SimulatedPen):
        for channel, counts in losses.items():
            device.lose(channel, counts)
        time.sleep(0.25e-3 * max(losses.values()) + 0.1)  # one by one

    postures = Postures(geometry)
    move(device, postures, seconds, yes, console, tour(geometry, home) if simulated else None)
    if len(postures.kept) < FEWEST:
        raise ValueError(
            f"only {len(postures.kept)} postures were seen, {FEWEST} are needed: move the pen about for longer "
            "(--seconds), and lean it to all sides"
        )
    verdict, seen = judge(geometry, postures.counts), joints(postures)
    beyond = [joint.name for joint in seen if joint.beyond]
    data = {
        "device": device.kind,
        "about": device.about,
        "geometry": geometry.name,
        "postures": len(postures.kept),
        "fits": verdict.fits,
        "verdict": verdict.text,
        "joints": list(verdict.channels),
        "stretch": {
            "rms": round(verdict.rms, 4),
            "most": round(verdict.most, 4),
            "rms_after": round(verdict.rms_after, 4),
            "tolerance": geometry.grip_tolerance,
        },
        "channels": {"order": [joint.name for joint in seen], "home": verdict.home, "sign": verdict.sign},
        "ranges": {
            joint.name: {
                "seen": [round(joint.low, 4), round(joint.high, 4)],
                "limits": list(joint.limits),
                "beyond": joint.beyond,
                "noticed_counts": round(joint.noticed, 1) if math.isfinite(joint.noticed) else None,
            }
            for joint in seen
        },
    }
    title = f"{device.kind}, {geometry.name}: {'the pen is right' if verdict.fits else 'the pen is NOT right'}"
    return data, rows_of(verdict, seen, beyond, data), title, verdict.fits and not beyond


def rows_of(verdict: Verdict, seen: list[Joint], beyond: list[str], data: dict[str, Any]) -> list[tuple[str, str]]:
    stretch = data["stretch"]
    rows = [
        ("verdict", verdict.text),
        ("stretch", f"{stretch['most']:.3f} mm at most, {stretch['rms']:.3f} rms, in {data['postures']} postures; "
                    f"{stretch['tolerance']:g} mm allowed"),
    ]  # fmt: skip
    if not verdict.fits and verdict.channels:
        rows.append(("after", f"{stretch['rms_after']:.3f} mm rms would be left"))
    for joint in sorted(seen, key=lambda joint: joint.name):
        low, high = (math.degrees(v) for v in (joint.low, joint.high))
        limits = ", ".join(f"{math.degrees(v):.0f}°" for v in joint.limits)
        shown = f"; {joint.noticed:.0f} lost counts would show" if 0 < joint.noticed < math.inf else ""
        note = "BEYOND its limits" if joint.beyond else "" if joint.share >= ENOUGH else "move it further"
        rows.append((joint.name, f"{low:6.1f}° … {high:5.1f}° of ({limits}){shown}"
                                 + (f"; {note}" if note else "")))  # fmt: skip
    if beyond:
        rows.append(("limits", f"{', '.join(beyond)} moved beyond the limits in the file: measure low and high"))
    return rows


def still(device: pen.PenDevice, seconds: float = 5.0) -> None:
    """Waits until the grip stands still."""
    end = time.monotonic() + seconds
    time.sleep(0.3)
    while np.linalg.norm(device.state().velocity) > 3 and time.monotonic() < end:
        time.sleep(0.05)


def move(
    device: pen.PenDevice, postures: Postures, seconds: float, yes: bool, console: Console,
    hand: Iterator[np.ndarray] | None,
) -> None:  # fmt: skip
    """Collects postures until the time is over or the user presses Enter; `hand` gives poses for a simulated one."""
    ended = None if yes else Enter()
    start = time.monotonic()
    shown = turned = -math.inf
    with screen(console) as draw:
        while (now := time.monotonic()) - start < seconds and not (ended and ended.pressed.is_set()):
            state = device.state()
            problem = device.health().problem
            if problem:
                raise pen.PenError(problem)
            if state.fault:
                raise pen.PenError(f"the pen reports fault {state.fault}: switch it off and on, then calibrate again")
            if not state.homed:
                raise pen.PenError("the pen lost its power, and its counts with it: calibrate again")
            postures.add(state.counts, state.stretch)
            if hand is not None and isinstance(device, pen.SimulatedPen) and now - turned > 0.3:
                turned = now
                device.aim(next(hand))
            if draw is not None and now - shown > 1 / FRAMES:
                shown = now
                draw(progress(postures, state.stretch, seconds - (now - start), yes))
            time.sleep(0.005)


def tour(geometry: pen.PenGeometry, home: np.ndarray) -> Iterator[np.ndarray]:
    """Endless poses all over the pen's working box, leaning to all sides, in the frame of the shipped pen's arms. The
    sequence is always the same."""
    random = np.random.default_rng(8)
    lower, upper = np.array(geometry.limits.lower), np.array(geometry.limits.upper)
    while True:
        axis = home[3:] + np.append(random.normal(size=2) * 0.35, 0.0)
        pose = np.concatenate([random.uniform(lower, upper), axis / np.linalg.norm(axis)])
        if geometry.inverse([pose])[1][0] == ("reached", "reached"):
            yield pose


def progress(postures: Postures, stretch: float, left: float, yes: bool) -> RenderableType:
    from rich.text import Text

    tolerance = postures.geometry.grip_tolerance
    most = max((abs(s) for s in postures.stretch), default=0.0)
    out = Text("Move the pen everywhere it reaches, and lean it to all sides.\n", style="bold")
    out.append(f"stretch {stretch:+7.3f} mm, at most {most:.3f} mm, {tolerance:g} mm allowed\n",
               style="not bold red" if most > tolerance else "not bold green")  # fmt: skip
    for joint, low, high in zip(postures.geometry.channels, postures.low, postures.high, strict=True):
        out.append(f"{joint.name}  {bar(low, high, joint.low, joint.high)}\n", style="not bold")
    end = "" if yes else "; Enter ends it"
    out.append(f"{len(postures.kept)} postures, {left:.0f} s left{end}", style="not bold dim")
    return out


def bar(low: float, high: float, first: float, last: float, width: int = 40) -> str:
    """A bar for the range from first to last, filled where the joint has been."""
    if not low <= high:
        return "·" * width
    a, b = ((v - first) / (last - first) * width for v in (low, high))
    return "".join("█" if k + 1 > a and k < b else "·" for k in range(width))


def say_home(geometry: pen.PenGeometry) -> None:
    """Prints the home posture as a drawing from the side, and in words."""
    x, y, z, *_ = geometry.forward([geometry.home])[0]
    print(f"Home posture of {geometry.name}, from the side, hand on the right:\n")
    print("\n".join(side_view(geometry)))
    print(
        f"\nThe grip's middle is {x:.1f} mm in front of the shoulders, {-z:.1f} mm below them, {y:.1f} mm to the side."
    )
    for channel, angle in zip(geometry.channels, np.degrees(home_angles(geometry)), strict=True):
        print(f"  {channel.name} {angle:7.2f}°  {MEANING[channel.name[1]]}")


MEANING = {
    "1": "turn of the arm about its upright axis",
    "2": "upper arm, forwards from hanging straight down",
    "3": "fore arm, upwards from level",
}


def home_angles(geometry: pen.PenGeometry) -> list[float]:
    return [c.sign * c.home / c.steps * 2 * math.pi for c in geometry.channels]


def side_view(geometry: pen.PenGeometry, columns: int = 36, rows: int = 16) -> list[str]:
    """Draws both arms, each in its own plane (shoulder, elbow, end), and the grip between the ends.

    The derivative of an end by θ2 is the upper arm turned by a right angle (2.7), so it gives the place of the elbow.
    """
    ends, slopes = geometry.ends([geometry.home])[0], geometry.jacobian([geometry.home])[0]
    arms = []
    for end, slope in zip(ends, slopes, strict=True):
        out = np.array([slope[1, 0], -slope[0, 0]])  # from the upright axis to the end: ∂r/∂θ1 turned back
        forward = out / np.linalg.norm(out)
        elbow = np.array([slope[2, 1], -(slope[:2, 1] @ forward)])  # ∂r/∂θ2 turned back
        arms.append(np.array([[0.0, 0.0], elbow, [np.linalg.norm(out), end[2]]]))
    points = np.vstack(arms)
    lower, upper = points.min(axis=0) - 12, points.max(axis=0) + 12
    canvas = Braille(columns, rows)
    scale = min((canvas.width - 1) / (upper[0] - lower[0]), (canvas.height - 1) / (upper[1] - lower[1]))
    for arm in arms:
        polyline(canvas, (arm - lower) * scale)
    polyline(canvas, (np.array([arms[0][2], arms[1][2]]) - lower) * scale)
    lines = canvas.lines()
    for name, arm in zip("RL", arms, strict=True):
        x, y = (arm[2] - lower) * scale
        row, column = rows - 1 - round(y) // 4, round(x) // 2 + 2
        lines[row] = f"{lines[row][:column]}{name}{lines[row][column + 1 :]}"
    return lines


# ---- a puck


def calibrate_puck(
    device: pen.PenDevice, seconds: float, yes: bool, console: Console
) -> tuple[dict[str, Any], list[tuple[str, str]], str, bool]:
    """Measures a puck at rest, untouched: the bubble has to be larger than its noise."""
    if not yes:
        input("Let go of the puck, and press Enter. ")
    full = device.limits["x"].high, device.limits["a"].high
    shares, end = [], time.monotonic() + seconds
    while time.monotonic() < end:
        state = device.state()
        shares.append((np.linalg.norm(state.velocity) / full[0], np.linalg.norm(state.turning) / full[1]))
        time.sleep(0.005)
    moved, turned = np.max(shares, axis=0)
    bubble = bubble_of(np.ravel(shares))
    right = bubble <= 0.3
    data = {
        "device": device.kind,
        "about": device.about,
        "fits": right,
        "noise": {"moving": round(float(moved), 4), "turning": round(float(turned), 4)},
        "bubble": bubble,
    }
    rows = [
        ("noise", f"{100 * moved:.1f} % of full deflection moving, {100 * turned:.1f} % turning, in {seconds:g} s"),
        ("bubble", f'{bubble:g}: riffler.pen.open("{device.kind}", bubble={bubble:g})'),
    ]
    if not right:
        rows.append(("verdict", "the puck was touched, or its zero has drifted: plug it in again without touching it"))
    return data, rows, f"{device.kind}: {'at rest' if right else 'NOT at rest'}", right


# ---- the report


def toml(data: dict[str, Any]) -> str:
    """The report as TOML, for people and programs. [channels] has the values that belong in the pen's file."""
    lines = [f"# riffler pen calibrate, {datetime.now().astimezone().isoformat(timespec='seconds')}"]
    if "channels" in data:
        lines.append("# [channels] has the pen file's keys, with the values that explain the measurements; rad and mm.")
    tables: list[tuple[str, dict[str, Any]]] = []
    for key, value in data.items():
        if isinstance(value, dict) and all(isinstance(v, dict) for v in value.values()):
            tables += [(f"{key}.{name}", inner) for name, inner in value.items()]
        elif isinstance(value, dict):
            tables.append((key, value))
        else:
            lines.append(f"{key} = {value_text(value)}")
    for name, table in tables:
        lines += ["", f"[{name}]", *(f"{k} = {value_text(v)}" for k, v in table.items() if v is not None)]
    return "\n".join(lines) + "\n"


def value_text(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        # TOML's basic strings have the same escapes as JSON's, except for U+007F.
        import json

        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, list | tuple):
        return "[" + ", ".join(map(value_text, value)) + "]"
    return str(value)
