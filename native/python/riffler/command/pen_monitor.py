"""Show live what a device reports: the pose of the hand, the force on it, and the state of the link.

riffler pen monitor                        the first device that opens
riffler pen monitor simulated --seconds 10
riffler pen monitor --csv pen.csv          a row for each report

Ctrl-C ends it. The command sends no force, and sets zero force at the end. Without a terminal it prints a line per
second.
"""

from __future__ import annotations

import argparse
import csv
import math
import time
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import pen
from .arguments import length, output_file
from .console import Console, number
from .devices import add_device, open_device
from .live import FRAMES, History, chart, screen, width_of_terminal
from .parser import Parser

if TYPE_CHECKING:
    from rich.console import RenderableType

HELP = "show live what a device reports"

LINK = ("reports", "superseded", "lost", "malformed", "timeouts", "writes", "read_errors", "write_errors", "silences")
# Shown as "late": ticks in which no report came in time.
LATE = "timeouts"
POLL = 1e-3  # s: pens send a report every millisecond
SHOWN = 10  # s that the charts show
COLUMNS = (
    *("time_s", "sequence", "x_mm", "y_mm", "z_mm", "axis_x", "axis_y", "axis_z", "spin_rad"),
    *("vx_mm_s", "vy_mm_s", "vz_mm_s", "wx_rad_s", "wy_rad_s", "wz_rad_s", "buttons"),
    *("fx_N", "fy_N", "fz_N", "tx_Nmm", "ty_Nmm", "tz_Nmm", "stretch_mm", "homed", "fault"),
)


def add_arguments(parser: Parser) -> None:
    add_device(parser)
    parser.add_argument("--seconds", metavar="N", help="how long (default: until Ctrl-C)")
    parser.add_file("--csv", "a row for each report, with the force of the motors", (".csv",))


def run(arguments: argparse.Namespace, console: Console) -> int:
    seconds = math.inf if arguments.seconds is None else length(arguments.seconds, "--seconds")
    path = None if arguments.csv is None else output_file(arguments.csv, (".csv",), "--csv")
    with open_device(arguments.device) as device, rows_to(path, console) as write:
        watch = Watch(device, write)
        with screen(console) as draw:
            follow(watch, seconds, draw or (None if console.json_output else print), plain=draw is None)
        data = watch.summary()
    data["csv"] = None if path is None else str(path)
    console.result(data, f"{device.kind}: {data['seconds']:.1f} s", table(data))
    return 0


def follow(watch: Watch, seconds: float, draw: Callable[[Any], None] | None, plain: bool) -> None:
    """Polls the device and draws until the time is over or until Ctrl-C, which is not an error."""
    period = 1.0 if plain else 1 / FRAMES
    start = time.monotonic()
    shown = start - period + 0.2  # not before the first reports have arrived
    try:
        while (now := time.monotonic()) - start < seconds:
            watch.poll(now)
            if draw is not None and now - shown >= period:
                shown = max(shown + period, now - period)  # a late one delays none of those after it
                watch.look(now)
                draw(watch.line() if plain else watch.picture(width_of_terminal()))
            time.sleep(POLL)
    except KeyboardInterrupt:
        pass
    watch.look(time.monotonic())
    if draw is not None and not plain:
        draw(watch.picture(width_of_terminal()))  # the picture that stays in the terminal includes every report


@contextmanager
def rows_to(path: Path | None, console: Console) -> Iterator[Callable[[list[Any]], None] | None]:
    """Yields a function that writes a row into the file. The file appears only if no error occurs."""
    if path is None:
        yield None
        return
    with console.writing(path) as beside, beside.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream)
        writer.writerow(COLUMNS)
        yield writer.writerow


class Watch:
    """Everything observed of a device: samples, extremes, state of the link."""

    def __init__(self, device: pen.PenDevice, write: Callable[[list[Any]], None] | None = None) -> None:
        self.device, self.write = device, write
        self.pushes = any(axis.pushes for axis in device.limits.values())
        self.start = time.monotonic()
        self.state = device.state()
        self.sequence = 0
        self.history = {"position": History(SHOWN), "force": History(SHOWN)}
        self.charted = self.start
        self.first: np.ndarray | None = None
        self.links: deque[tuple[float, pen.PenHealth]] = deque()  # of the last second
        self.seen = 0
        self.most = {"stretch_mm": 0.0, "speed_mm_s": 0.0, "force_N": 0.0, "age_s": 0.0}
        self.causes: list[str] = []
        self.look(self.start)

    def poll(self, now: float) -> None:
        """Takes the newest sample if it was not taken before."""
        state = self.device.state()
        if state.sequence == self.sequence and state.age_s > 0 and self.sequence:
            return
        self.state = state
        if not math.isfinite(state.age_s):
            return
        measured = now - state.age_s - self.start
        if state.sequence != self.sequence:
            self.sequence = state.sequence
            self.seen += 1
            force, torque = state.applied
            if self.write is not None:
                self.write(
                    [f"{measured:.6f}", state.sequence, *rounded(state.pose), f"{state.spin:.6g}",
                     *rounded(state.velocity), *rounded(state.turning), state.buttons, *rounded(force),
                     *rounded(torque), f"{state.stretch:.6g}", int(state.homed), state.fault]
                )  # fmt: skip
            for name, value in (
                ("stretch_mm", abs(state.stretch)),
                ("speed_mm_s", float(np.linalg.norm(state.velocity))),
                ("force_N", float(np.linalg.norm(force))),
            ):
                self.most[name] = max(self.most[name], value)
        self.most["age_s"] = max(self.most["age_s"], state.age_s)
        if now - self.charted >= 0.01:
            self.charted = now
            if self.first is None:
                self.first = state.pose[:3]
            self.history["position"].add(now, *(state.pose[:3] - self.first))
            self.history["force"].add(now, *state.applied[0])

    def look(self, now: float) -> None:
        """Reads the state of the link, which costs more than a sample."""
        self.health = self.device.health()
        self.links.append((now, self.health))
        while len(self.links) > 2 and self.links[1][0] < now - 1:
            self.links.popleft()
        cause = self.health.cause if self.pushes else None
        if cause is not None and (not self.causes or self.causes[-1] != cause):
            self.causes.append(cause)

    def rates(self) -> dict[str, float]:
        """Counts per second, over the last second."""
        (before, first), (now, last) = self.links[0], self.links[-1]
        passed = now - before
        return {key: (getattr(last, key) - getattr(first, key)) / passed if passed > 0 else 0.0 for key in LINK}

    def line(self) -> str:
        """One line, for logs and pipes."""
        state, health = self.state, self.health
        rates = self.rates()
        place = " ".join(f"{v:8.2f}" for v in state.pose[:3])
        force = f"  {np.linalg.norm(state.applied[0]):5.2f} N" if self.pushes else ""
        return (
            f"{time.monotonic() - self.start:7.1f} s  {place} mm  {np.linalg.norm(state.velocity):6.1f} mm/s{force}"
            f"  buttons {buttons(state.buttons)}  {self.states()}  {rates['reports']:.0f}/s, lost {health.lost}, "
            f"malformed {health.malformed}, late {getattr(health, LATE)}"
            + (f"  {self.trouble()}" if self.trouble() else "")
        )

    def states(self) -> str:
        """State of the link, and of the force if the device has motors."""
        return self.health.state + (f", force {self.health.force_state}" if self.pushes else "")

    def picture(self, width: int) -> RenderableType:
        from rich.console import Group
        from rich.table import Table
        from rich.text import Text

        table = Table(show_header=False, box=None, padding=(0, 1))
        table.add_column(style="cyan", no_wrap=True)
        table.add_column(overflow="fold")
        for name, value in self.rows():
            table.add_row(Text(name), Text(value))
        charts = [chart("position from the start  mm", "xyz", self.history["position"], width, 7, least=1)]
        if self.pushes:
            charts.append(chart("force felt  N", "xyz", self.history["force"], width, 5, least=0.2, zero=True))
        end = Text("Ctrl-C ends it", style="dim")
        return Group(Text(f"{self.device.kind}  {self.device.about}", style="bold"), table, *charts, end)

    def rows(self) -> list[tuple[str, str]]:
        state, health, rates = self.state, self.health, self.rates()
        wanted, (force, torque) = health.force, state.applied
        link = [f"{health.reports} reports, {rates['reports']:.0f}/s"]
        for key, name in (("lost", "lost"), ("malformed", "malformed"), (LATE, "late"), ("superseded", "overtaken")):
            link.append(f"{name} {getattr(health, key)}" + (f" ({rates[key]:.0f}/s)" if rates[key] else ""))
        rows = [
            ("point", f"{vector(state.pose[:3])} mm"),
            ("axis", f"{vector(state.pose[3:])}   spin {math.degrees(state.spin):.1f}°"),
            ("speed", f"{np.linalg.norm(state.velocity):.1f} mm/s, {np.linalg.norm(state.turning):.2f} rad/s"),
            ("buttons", buttons(state.buttons)),
            *(
                [
                    ("force", f"asked {vector(wanted)} N, felt {vector(force)} N"),
                    ("torque", f"asked {vector(health.torque)} N·mm, felt {vector(torque)} N·mm"),
                ]
                if self.pushes
                else []
            ),
            ("state", f"{self.states()}, {'homed' if state.homed else 'not homed'}"),
            ("cause", self.trouble() or "none"),
            ("link", ", ".join(link)),
            ("thread", self.device.priority.text),
            ("age", f"{1e3 * state.age_s:.1f} ms, at most {1e3 * self.most['age_s']:.1f} ms"),
        ]
        if self.device.geometry is not None:
            tolerance = self.device.geometry.grip_tolerance
            rows.append(("stretch", f"{state.stretch:+.3f} mm, at most {self.most['stretch_mm']:.3f} mm, "
                                    f"{tolerance:g} mm allowed"))  # fmt: skip
        return rows

    def trouble(self) -> str:
        """The fault and its remedy; empty if there is no fault."""
        state, health = self.state, self.health
        if health.problem:
            return health.problem
        if state.fault:
            return f"the device reports fault {state.fault}: switch it off and on again (docs/device.md lists faults)"
        if not state.homed and self.device.geometry is not None:
            return "not homed: riffler pen calibrate"
        return (health.cause or "") if self.pushes else ""

    def summary(self) -> dict[str, Any]:
        seconds = time.monotonic() - self.start
        health = self.health
        counts = {key: getattr(health, key) for key in LINK}
        return {
            "device": self.device.kind,
            "about": self.device.about,
            "seconds": round(seconds, 3),
            "seen": self.seen,
            "reports_per_s": round(health.reports / seconds, 1),
            "link": counts | {"connections": health.connections, "attempts": health.attempts},
            "state": health.state,
            "problem": health.problem,
            "force_state": health.force_state if self.pushes else None,
            "causes": self.causes,
            "homed": self.state.homed,
            "fault": self.state.fault,
            "pose": [round(float(v), 6) for v in self.state.pose],
            "most": {key: round(value, 6) for key, value in self.most.items()},
        }


def table(data: dict[str, Any]) -> list[tuple[str, str]]:
    link, most, force = data["link"], data["most"], data["force_state"]
    rows = [
        ("reports", f"{number(link['reports'])}, {data['reports_per_s']:.0f}/s; {number(data['seen'])} seen here"),
        ("lost", f"{number(link['lost'])}; malformed {number(link['malformed'])}, late {number(link[LATE])}"),
        (
            "at most",
            f"{most['speed_mm_s']:.1f} mm/s"
            + (f", {most['force_N']:.2f} N" if force else "")
            + (f", stretch {most['stretch_mm']:.3f} mm" if most["stretch_mm"] else ""),
        ),
        (
            "state",
            data["state"] + (f", force {force}" if force else "") + f", {'homed' if data['homed'] else 'not homed'}",
        ),
        *(("cause", cause) for cause in data["causes"]),
    ]
    if data["problem"]:
        rows.append(("problem", data["problem"]))
    if data["csv"] is not None:
        rows.append(("written", data["csv"]))
    return rows


def vector(values: Any) -> str:
    return " ".join(f"{v:8.3f}" for v in values)


def rounded(values: Any) -> list[str]:
    return [f"{v:.6g}" for v in values]


def buttons(bits: int) -> str:
    """The numbers of the buttons that are held."""
    return " ".join(str(k + 1) for k in range(32) if bits >> k & 1) or "none"
