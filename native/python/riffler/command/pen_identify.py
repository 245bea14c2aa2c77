"""Identify a pen: torque constants, weight, friction and directions of its motors, each with its uncertainty.

riffler pen identify --mass 40 --out mine.toml
riffler pen identify simulated --yes --seed 1          a simulated pen whose true values differ from its file
riffler pen identify simulated --yes --pens 100        a hundred of them: how often the stated intervals are right

The motors move the pen: slowly without a weight, then faster, then slowly with a known weight hung on the grip. The
command asks before each motion; Enter or Ctrl-C stops a motion. The command writes the pen's own .toml with the new
values and their standard uncertainties.
"""

from __future__ import annotations

import argparse
import re
import sys
import time
import tomllib
from collections.abc import Iterator, Sequence
from contextlib import nullcontext
from typing import Any

import numpy as np

from .. import pen
from .._core import _pen_text
from .arguments import length, output_file, whole
from .console import Console
from .devices import add_device, geometry_of, open_device
from .parser import Parser
from .pen_calibrate import say_home, still, wait_for
from .pen_diagnosis import Postures, judge
from .pen_fit import GRAVITY, JOINTS, NAMES, NORMAL, HungWeight, Identified, Sweep, identify
from .pen_sweeps import (
    FAST,
    SLOW,
    Keyboard,
    MotionStoppedError,
    MotionTrippedError,
    Path,
    base_axes,
    cut,
    drive,
    home_of,
    reversed_motors,
    sweeps,
    wiggles,
)

HELP = "measure motors, weight and friction of a pen with a known weight"

SLOW_SWEEPS, FAST_SWEEPS = 24, 160
# For the slow, the fast and the loaded motion: number of sweeps, rad/s of the fastest joint, and seeds of paths.
MOTIONS = ((SLOW_SWEEPS, SLOW, (1, 11, 21)), (FAST_SWEEPS, FAST, (2, 12, 22)), (SLOW_SWEEPS, SLOW, (3, 13, 23)))
UNITS = {
    "torque_constant": "N·mm/A",
    "coulomb": "N·mm",
    "viscous": "N·mm·s/rad",
    "gravity": "N·mm",
}
BARS = {"torque_constant": 0.02, "coulomb": 0.05, "viscous": 0.05, "gravity": 0.05}  # relative
GRAMS = 40.0  # mass of the simulated weight
HOOK_ERROR = 0.1  # mm: standard uncertainty of the place where the weight hangs, with a loop on the arm's joint


def add_arguments(parser: Parser) -> None:
    add_device(parser)
    parser.add_argument("--mass", metavar="G", help="mass of the weight, g (default: the command asks)")
    parser.add_argument("--scale", default="0.1", metavar="G", help="step of the scale, g (default 0.1)")
    parser.add_argument("--hook", metavar="MM", help="distance of the weight from the grip's middle towards the "
                        "tool's tip (default: the end of the arm)")  # fmt: skip
    parser.add_argument("--yes", action="store_true", help="ask nothing; for the simulated pen only")
    parser.add_file("--out", ".toml: the pen's file with the identified values", (".toml",))
    parser.add_argument("--force", action="store_true", help="let --out replace a file")
    parser.add_argument("--seed", metavar="N", help='for "simulated": draw true values at random around the file\'s')
    parser.add_argument("--pens", metavar="N", help='for "simulated": N random pens, from --seed on')


def run(arguments: argparse.Namespace, console: Console) -> int:
    out = None if arguments.out is None else output_file(arguments.out, (".toml",))
    if out is not None and out.exists() and not arguments.force:
        raise ValueError(f"--out {out.name}: already exists; use another name, or --force")
    simulated = arguments.device == "simulated"
    for option in ("seed", "pens"):
        if getattr(arguments, option) is not None and not simulated:
            raise ValueError(f'--{option} is for "simulated": the true values of other pens are not known')
    if arguments.yes and not simulated:
        raise ValueError('--yes is for "simulated": a pen moves by itself only after its user has agreed')
    if not arguments.yes and (console.json_output or not sys.stdin.isatty()):
        raise ValueError("pen identify asks questions: run it in a terminal and without --json")
    step = length(arguments.scale, "--scale")
    if arguments.pens is not None:
        if out is not None:
            raise ValueError("--out is for one pen, not for --pens")
        first = 1 if arguments.seed is None else whole(arguments.seed, "--seed")
        return many(first, whole(arguments.pens, "--pens"), step, console)
    seed = None if arguments.seed is None else whole(arguments.seed, "--seed")
    keyboard = Keyboard(not arguments.yes)
    with open_pen(arguments.device, seed) as device:
        geometry = geometry_of(device)
        hook = grip_half(geometry) if arguments.hook is None else length(arguments.hook, "--hook")
        grams = GRAMS if simulated and arguments.mass is None else ask_mass(arguments.mass, keyboard)
        weight = HungWeight(1e-3 * grams, 1e-3 * step / np.sqrt(12), hook, HOOK_ERROR)
        check_weight(geometry, weight, Motion(geometry, *MOTIONS[2]).first)
        found = identified(device, weight, keyboard, seed, console)
        truth = device.truth if isinstance(device, pen.SimulatedPen) else None
    data, rows = report(geometry, found, truth)
    data |= {"device": device.kind, "about": device.about, "mass_kg": weight.mass}
    if out is not None:
        text = rewritten(_pen_text(geometry.name), found)
        with console.writing(out) as beside:
            beside.write_text(text, encoding="utf-8")
        rows.append(("written", str(out)))
    data["out"] = None if out is None else str(out)
    console.result(data, f"{device.kind}, {geometry.name}: identified", rows)
    return 0


def open_pen(what: str | None, seed: int | None) -> pen.PenDevice:
    if what == "simulated":
        return open_device(what, seed=seed, real_time=False, gravity=0.0, friction=0.0)
    return open_device(what, gravity=0.0, friction=0.0)


def grip_half(geometry: pen.PenGeometry) -> float:
    return 0.5 * geometry.grip_length


def ask_mass(given: str | None, keyboard: Keyboard) -> float:
    text = given if given is not None else keyboard.ask("Mass of the weight that you will hang on the grip, in g: ")
    return length(text, "--mass")


def check_weight(geometry: pen.PenGeometry, weight: HungWeight, path: Path) -> None:
    """Raises ValueError for a weight that the motors cannot carry for long, that friction hides, or whose mass is not
    known well enough."""
    grams = f"--mass {1e3 * weight.mass:g}"
    amperes = holding_currents(geometry, path.poses, weight)
    peak = np.array([c.peak_current for c in geometry.channels])
    lasting = np.array([c.continuous_current for c in geometry.channels])
    used = max(float((np.abs(amperes).max(axis=0) / (0.8 * peak)).max()),
               float((np.sqrt((amperes**2).mean(axis=0)) / (0.95 * lasting)).max()))  # fmt: skip
    if used > 1:
        raise ValueError(f"{grams}: too heavy for this pen's motors, which would need {used:.1f} times the current "
                         "that they may have for long; use a lighter weight")  # fmt: skip
    dry = max(c.coulomb * c.ratio for c in geometry.channels)
    reach = float(np.linalg.norm(geometry.jacobian([geometry.home])[0][:, 2], axis=1).min())
    least = 4 * dry / (reach * GRAVITY)
    if weight.mass < least:
        raise ValueError(f"{grams}: friction hides the weight; use at least {np.ceil(1e3 * least):.0f} g")
    if weight.mass_error > 0.005 * weight.mass:
        raise ValueError(f"{grams}, --scale: the mass must be known to within half a percent; use a finer scale")


def holding_currents(geometry: pen.PenGeometry, poses: np.ndarray, weight: HungWeight) -> np.ndarray:
    """Currents (n, 6) in A that hold arms and weight at rest, according to the pen's file."""
    joints, _ = geometry.inverse(poses)
    counts = geometry.counts(joints)
    up = weight.force * base_axes(geometry)[:, 2]
    lever = -weight.hook * poses[:, 3:]
    wrenches = np.concatenate([np.broadcast_to(up, lever.shape), np.cross(lever, up)], axis=1)
    torques, _ = geometry.efforts(counts, wrenches, poses[:, :3])
    out = np.empty((len(poses), 6))
    for k, c in enumerate(geometry.channels):
        joint = JOINTS.index(c.name)
        turn = joints[:, joint]
        own = {"1": 0.0, "2": c.gravity * np.sin(turn), "3": c.gravity * np.cos(turn)}[c.name[1]]
        out[:, k] = (torques[:, joint] + own) / (c.ratio * c.torque_constant)
    return out


# ---- one pen


def identified(
    device: pen.PenDevice, weight: HungWeight, keyboard: Keyboard, seed: int | None, console: Console | None
) -> Identified:
    """Makes all motions and fits the values to them; draws progress on the console."""
    geometry = geometry_of(device)
    if not any(axis.pushes for axis in geometry.capability().axes.values()):
        raise ValueError(f"{device.kind} has no motors")
    begin(device, keyboard)
    slow, fast, loaded = (Motion(geometry, number, rate, seeds) for number, rate, seeds in MOTIONS)
    say = (lambda text: None) if not keyboard.asks else print

    say(f"\nFirst the directions, in {wiggles(geometry).seconds:.0f} s: hold the grip loosely, and let the motors push "
        "it with up to 0.8 N.")  # fmt: skip
    agree(keyboard)
    pushed = drive(device, wiggles(geometry), keyboard, leads=False)
    wrong = reversed_motors(geometry, pushed.counts, pushed.currents)
    if wrong:
        raise MotionStoppedError(f"{', '.join(wrong)}: the motor turns against its encoder; swap the two wires of the "
                                 "motor, or the encoder's tracks, and start again")  # fmt: skip

    free: list[Sweep] = []
    for motion, kind, how in ((slow, "slow", "slowly"), (fast, "fast", f"at up to {FAST:g} rad/s, 300 mm/s")):
        say(f"\nNow the pen moves by itself, {how}, for {motion.seconds:.0f} s. Clear the space around its arms.")
        free += swept(device, motion, kind, keyboard, None, console)
    say(
        f"\nHang {1e3 * weight.mass:g} g by a thread on the grip, {weight.hook:g} mm from its middle towards the "
        f"tool's tip:\nthe end of arm {geometry.tip}. Then the pen moves slowly for {loaded.seconds:.0f} s."
    )
    if isinstance(device, pen.SimulatedPen):
        hang(device, weight, seed)
    pulled = swept(device, loaded, "loaded", keyboard, weight, console)
    if isinstance(device, pen.SimulatedPen):
        device.hang(0.0)
    check_encoders(geometry, [*free, *pulled])
    return identify(geometry, free, pulled, weight)


def begin(device: pen.PenDevice, keyboard: Keyboard) -> None:
    """Homes the pen."""
    geometry = geometry_of(device)
    if isinstance(device, pen.SimulatedPen):
        device.aim(home_of(device.truth))
        time.sleep(0.1)
        still(device)
    if keyboard.asks:
        say_home(geometry)
        keyboard.ask("Hold it like this and press Enter. ")
    if not device.home():
        raise pen.PenError(f"{device.kind} cannot be homed")
    wait_for(device, lambda: device.state().homed)


def agree(keyboard: Keyboard) -> None:
    answer = keyboard.ask("Enter stops the pen while it moves. May it move? Type yes: ")
    if keyboard.asks and answer.lower() not in ("y", "yes"):
        raise MotionStoppedError("not agreed; nothing moved")


class Motion:
    """A motion on the first of several paths, or on the next one if the pen sticks."""

    def __init__(self, geometry: pen.PenGeometry, number: int, rate: float, seeds: Sequence[int]) -> None:
        self._path = lambda seed: sweeps(geometry, number, rate, seed)
        self.seeds = seeds
        self.first = self._path(seeds[0])

    @property
    def seconds(self) -> float:
        return self.first.seconds

    def paths(self) -> Iterator[Path]:
        yield self.first
        yield from map(self._path, self.seeds[1:])


def swept(
    device: pen.PenDevice, motion: Motion, kind: str, keyboard: Keyboard, weight: HungWeight | None,
    console: Console | None,
) -> list[Sweep]:  # fmt: skip
    """Asks, then makes one motion. If the motion stops itself, makes it again on another path."""
    why: MotionTrippedError | None = None
    for path in motion.paths():
        if why is not None and keyboard.asks:
            print(f"\nThe motion stopped itself: {why} It begins again on another path.")
        try:
            return swept_once(device, path, kind, keyboard, weight, console)
        except MotionTrippedError as error:
            why = error
    raise MotionStoppedError(
        f"{why} That happened on {len(motion.seeds)} paths: does a joint stick, or something touch the arms?"
    )


def swept_once(
    device: pen.PenDevice, path: Path, kind: str, keyboard: Keyboard, weight: HungWeight | None, console: Console | None
) -> list[Sweep]:
    if isinstance(device, pen.SimulatedPen):
        device.aim(home_of(device.truth))
        time.sleep(0.1)
    if keyboard.asks:
        print("Hold the grip in its home posture; let go when it holds itself, after about a second.")
    agree(keyboard)
    with nullcontext() if console is None else console.step(f"{kind} sweeps") as draw:
        show = (lambda at: None) if draw is None else (lambda at: draw(min(1.0, at / path.seconds)))
        record = drive(device, path, keyboard, weight=weight, shown=show)
    return cut(path, record, kind)


def hang(device: pen.SimulatedPen, weight: HungWeight, seed: int | None) -> None:
    """Hangs the simulated weight; its mass and place deviate from the measured ones by their uncertainties."""
    off = np.random.default_rng(seed).normal(size=2) if seed is not None else np.zeros(2)
    device.hang(weight.mass * (1 + off[0] * weight.relative_error), weight.hook + off[1] * weight.hook_error)
    time.sleep(0.05)


def check_encoders(geometry: pen.PenGeometry, recorded: list[Sweep]) -> None:
    """Raises MotionStoppedError if a reversed encoder or lost counts make the grip's length wrong."""
    postures = Postures(geometry)
    for sweep in recorded:
        for counts in sweep.counts[::50]:
            postures.add(counts, 0.0)
    verdict = judge(geometry, postures.counts)
    if not verdict.fits:
        raise MotionStoppedError(f"{verdict.text}. Run riffler pen calibrate first")


# ---- report and file


def report(
    geometry: pen.PenGeometry, found: Identified, truth: pen.PenGeometry | None
) -> tuple[dict[str, Any], list[tuple[str, str]]]:
    names = [c.name for c in geometry.channels]
    data: dict[str, Any] = {
        "geometry": geometry.name,
        "channels": names,
        "rows": found.rows,
        "residual": round(found.residual, 5),
        "identified": {name: {"value": listed(found.values[name]), "uncertainty": listed(found.uncertainty[name])}
                       for name in NAMES},
    }  # fmt: skip
    rows = []
    for name in NAMES:
        cells = [
            f"{joint} {value:.4g} ± {error:.1g}" + (f" ({true:.4g})" if truth is not None else "")
            for joint, value, error, true in zip(names, found.values[name], found.uncertainty[name],
                                                 truth_of(truth or geometry, name), strict=True)
            if not (name == "gravity" and joint[1] == "1")
        ]  # fmt: skip
        rows.append((f"{name}", f"{UNITS[name]}: " + ", ".join(cells)))
    rows.append(("residual", f"{found.residual:.3g} N·mm at the motor, {found.rows} equations"))
    if truth is not None:
        inside = covered(found, truth)
        data["truth"] = {name: listed(truth_of(truth, name)) for name in NAMES}
        data["inside"] = sum(int(ok.sum()) for ok in inside.values())
        data["of"] = sum(len(ok) for ok in inside.values())
        rows.append(("truth", f"in brackets; {data['inside']} of {data['of']} are within ± {NORMAL:g} uncertainties"))
    return data, rows


def listed(values: np.ndarray) -> list[float]:
    return [float(f"{v:.6g}") for v in values]


def truth_of(geometry: pen.PenGeometry, name: str) -> np.ndarray:
    return np.array([getattr(c, name) for c in geometry.channels])


def real(truth: pen.PenGeometry, name: str) -> np.ndarray:
    """Which channels have the value: joints 1 have no moment of weight."""
    return np.array([name != "gravity" or c.name[1] != "1" for c in truth.channels])


def covered(found: Identified, truth: pen.PenGeometry) -> dict[str, np.ndarray]:
    return {name: found.covers(name, truth_of(truth, name))[real(truth, name)] for name in NAMES}


def rewritten(text: str, found: Identified) -> str:
    """The pen's file with the identified values, and their standard uncertainties in a separate table."""
    before = tomllib.loads(text)
    text = without_table(text, "uncertainty")
    lists = {name: (found.values[name], f"{UNITS[name]}, identified") for name in NAMES}
    if "converter" in before:  # one step is a current, so the steps per N·mm depend on the torque constant
        stronger = found.values["torque_constant"] / np.array(before["channels"]["torque_constant"])
        lists["slope"] = np.array(before["converter"]["slope"]) / stronger, "steps per N·mm at the motor"
    for name, (values, comment) in lists.items():
        text, count = re.subn(
            rf"^({name}\s*=\s*)\[[^\]]*\].*$", rf"\g<1>{numbers(values, 5)}   # {comment}", text, flags=re.M
        )
        if count != 1:
            raise ValueError(f"the pen's file must have the list {name} exactly once")
    lines = [f"{name} = {numbers(found.uncertainty[name], 3)}   # {UNITS[name]}" for name in NAMES]
    return "\n".join(
        [text.rstrip("\n"), "", "[uncertainty]   # standard uncertainties, by riffler pen identify", *lines, ""]
    )


def without_table(text: str, name: str) -> str:
    """TOML without one of its tables."""
    kept, inside = [], False
    for line in text.split("\n"):
        if line.startswith("["):
            inside = line.startswith(f"[{name}]")
        if not inside:
            kept.append(line)
    return "\n".join(kept)


def numbers(values: np.ndarray, digits: int) -> str:
    return "[" + ", ".join(f"{v:.{digits}g}" if v else "0.0" for v in values) + "]"


# ---- many simulated pens


def many(first: int, pens: int, step: float, console: Console) -> int:
    """Identifies simulated pens with the seeds from ``first`` on, and counts how often the intervals hold the truth."""
    inside = dict.fromkeys(NAMES, 0)
    total = dict.fromkeys(NAMES, 0)
    worst = dict.fromkeys(NAMES, 0.0)
    beyond = dict.fromkeys(NAMES, 0)
    stopped: dict[str, str] = {}
    with console.step(f"{pens} pens") as draw:
        for seed in range(first, first + pens):
            with open_pen("simulated", seed) as device:
                assert isinstance(device, pen.SimulatedPen)
                weight = HungWeight(1e-3 * GRAMS, 1e-3 * step / np.sqrt(12), grip_half(device.truth), HOOK_ERROR)
                truth = device.truth
                try:
                    found = identified(device, weight, Keyboard(False), seed, None)
                except MotionStoppedError as error:
                    stopped[str(seed)] = str(error)
                    continue
            for name in NAMES:
                mine, true = real(truth, name), truth_of(truth, name)
                off = np.abs(found.values[name] / np.where(mine, true, 1.0) - 1)[mine]
                inside[name] += int(found.covers(name, true)[mine].sum())
                total[name] += int(mine.sum())
                worst[name] = max(worst[name], float(off.max()))
                beyond[name] += int((off > BARS[name]).sum())
            if draw is not None:
                draw((seed - first + 1) / pens)
    if len(stopped) == pens:
        raise MotionStoppedError(next(iter(stopped.values())))
    rows = [
        (name, f"{inside[name]} of {total[name]} within the 95 % interval ({100 * inside[name] / total[name]:.1f} %); "
               f"off by {100 * worst[name]:.2f} % at most, {beyond[name]} by more than {100 * BARS[name]:g} %")
        for name in NAMES
    ]  # fmt: skip
    share = sum(inside.values()) / sum(total.values())
    rows.append(("all", f"{100 * share:.1f} % of the true values are within the stated interval"))
    rows += [("stopped", f"seed {seed}: {why}") for seed, why in stopped.items()]
    data = {"pens": pens, "inside": inside, "of": total, "worst": worst, "beyond": beyond, "share": round(share, 4),
            "stopped": stopped}  # fmt: skip
    console.result(data, f"{pens} simulated pens", rows)
    return 1 if stopped else 0
