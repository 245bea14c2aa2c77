"""The force of removed material: continuity over one straight stroke, sampled at different rates and pitches, against
its closed form; force and torque of moves that turn the tool, against an integral."""

from __future__ import annotations

import math

import numpy as np
from riffler import Tool, Volume

from .. import removal_integral, report
from ..measure import Progress, Settings, watched
from ..report import Column, Report

RATES = (100, 500, 1000, 4000)  # Hz
SPEED, WAY, DEPTH, RADIUS = 40.0, 30.0, 2.0, 3.0  # mm/s, mm
CONSTANT = removal_integral.CONSTANT  # N·s/mm³, the default of carve
CUTTERS = {
    "ball": Tool.ball(6, removal_integral.LENGTH),
    "flat": Tool.flat(6, removal_integral.LENGTH),
    "cone": Tool.profile([(0.5, 0), (4, 14)], length=removal_integral.LENGTH),
}


def run(settings: Settings, progress: Progress = None) -> Report:
    out = Report("force", {"rates": RATES, "speed": SPEED, "depth": DEPTH})
    table = out.section(
        "stroke",
        "Force of a straight stroke of 40 mm/s, 2 mm deep, Ø6, oblique to the grid",
        Column("cutter", "cutter"),
        Column("h mm", "pitch", report.pitch),
        Column("rate Hz", "rate"),
        Column("step ÷ h", "step_share", report.mm),
        Column("mean N", "mean_N", lambda f: f"{f:.4f}"),
        Column("closed form N", "exact_N", lambda f: f"{f:.4f}"),
        Column("difference", "off", report.percent),
        Column("ripple, RMS", "ripple", lambda r: f"{100 * r:.2f} %"),
        Column("largest jump between steps", "jump", lambda r: f"{100 * r:.1f} %"),
    )
    rates, pitches = ((100, 1000), (0.4, 0.2)) if settings.quick else (RATES, (0.2, 0.1, 0.05))
    cutters = {"ball Ø6": Tool.ball(6, 30), "flat Ø6": Tool.flat(6, 30)}
    cases = [(name, h, rate) for name in cutters for h in pitches for rate in rates]
    for name, pitch, rate in watched(cases, progress):
        times, force = stroke(cutters[name], pitch, rate)
        # The tool is in full engagement one radius after the entry; the rest of the stroke is steady.
        steady = force[times > 2 * RADIUS / SPEED]
        exact = CONSTANT * SPEED * section(name)
        mean = float(steady.mean())
        table.row(
            cutter=name, pitch=pitch, rate=rate, step_share=SPEED / rate / pitch, mean_N=mean, exact_N=exact,
            off=mean / exact - 1, ripple=float(steady.std() / mean), jump=float(np.abs(np.diff(steady)).max() / mean),
            times_s=times.tolist(), force_N=force.tolist(),
        )  # fmt: skip
        out.check(abs(mean / exact - 1) < 0.05, f"{name}, h = {pitch:g}, {rate} Hz: {mean} N, not {exact}")
    table.notes.append(
        "Closed form: k · section · speed. Ripple and jump are shares of the mean over the steady part, unfiltered, as "
        "the tool's force comes out of single calls."
    )
    turns(out, settings, progress)
    return out


def turns(out: Report, settings: Settings, progress: Progress) -> None:
    """Moves that turn the tool, cut in so many parts, against the integral over points and times."""
    table = out.section(
        "turning",
        "Force and torque of moves that turn the tool by 20 to 54 degrees",
        Column("cutter", "cutter"),
        Column("move", "move"),
        Column("rays", "directions"),
        Column("h mm", "pitch", report.pitch),
        Column("steps", "parts"),
        Column("force N", "force_N", lambda f: f"{f:.3f}"),
        Column("force off", "force_off", share),
        Column("torque N·mm", "torque_Nmm", lambda f: f"{f:.2f}"),
        Column("torque off", "torque_off", share),
        Column("volume off", "volume_off", share),
    )
    cutters = ("ball",) if settings.quick else tuple(removal_integral.RADII)
    moves = list(removal_integral.MOVES)[: 1 if settings.quick else None]
    ways = ((1, "xyz"),) if settings.quick else ((1, "z"), (16, "z"), (16, "xyz"))
    spacing, times = (0.4, 60) if settings.quick else (0.25, 160)
    pitch = 0.4 if settings.quick else 0.2
    for name, label in watched([(name, move) for name in cutters for move in moves], progress):
        move = removal_integral.MOVES[label]
        removed, pushes, twists = removal_integral.integral(removal_integral.RADII[name], move, spacing, times)
        for parts, directions in ways:
            got = turning(name, move, pitch, parts, directions)
            pairs = zip(got, (removed, pushes, twists), strict=True)
            off = [float(np.linalg.norm(a - b) / np.linalg.norm(b)) for a, b in pairs]
            table.row(
                cutter=name, move=label, directions=directions, pitch=pitch, parts=parts,
                force_N=float(np.linalg.norm(pushes)), force_off=off[1], torque_Nmm=float(np.linalg.norm(twists)),
                torque_off=off[2], volume_off=off[0],
            )  # fmt: skip
            out.check(max(off) < (0.15 if parts == 1 else 0.05), f"{name}, {label}, {parts} steps, {directions}: {off}")
    table.notes.append(
        f"Length of the difference ÷ length of the integral, over points {spacing:g} mm apart and {times} times; the "
        "torque is about the last tip. A step takes one direction for all that a ray loses in it."
    )


def turning(
    name: str, move: removal_integral.Move, pitch: float, parts: int, directions: str
) -> tuple[float, np.ndarray, np.ndarray]:
    """(removed mm³, force N, torque N·mm about the last tip) by Volume.carve, in so many steps of equal duration."""
    volume = Volume.block(*removal_integral.BOX, pitch, directions=directions)
    share = np.linspace(0, 1, parts + 1)[:, None]
    angle = np.arccos(move.from_axis @ move.to_axis)
    axes = (np.sin((1 - share) * angle) * move.from_axis + np.sin(share * angle) * move.to_axis) / np.sin(angle)
    poses = np.hstack([(1 - share) * move.from_tip + share * move.to_tip, axes])
    volume.carve(CUTTERS[name], poses[[0, 0]])
    cut = volume.carve(CUTTERS[name], poses, dt=removal_integral.DT / parts, removal_constant=CONSTANT)
    felt = cut.force / parts  # of a part of the time
    twists = cut.torque / parts + np.cross(poses[1:, :3] - move.to_tip, felt)
    return float(cut.removed.sum()), felt.sum(0), twists.sum(0)


def share(value: float) -> str:
    return f"{100 * value:.2f} %"


def section(name: str) -> float:
    """Area of the groove across the stroke, mm²."""
    if name.startswith("flat"):
        return 2 * RADIUS * DEPTH
    r, d = RADIUS, DEPTH
    return r * r * math.acos((r - d) / r) - (r - d) * math.sqrt(2 * r * d - d * d)


def stroke(tool: Tool, pitch: float, rate: int) -> tuple[np.ndarray, np.ndarray]:
    """Times (n,) and forces (n,) against the motion, one call a step; the entry is part of it."""
    direction = np.array([math.cos(0.4), math.sin(0.4), 0.0])
    dt = 1 / rate
    count = round(WAY / SPEED * rate)
    tips = np.array([6.0, 6.0, 10 - DEPTH]) + direction * (SPEED * dt * np.arange(count + 1))[:, None]
    poses = np.concatenate([tips, np.tile([0.0, 0, 1], (count + 1, 1))], 1)
    volume = Volume.block([0, 0, 0], [40, 24, 10], pitch)
    volume.carve(tool, np.array([[6.0, 6, 20, 0, 0, 1], poses[0]]))  # the plunge to the stroke's beginning is not felt
    force = [-(volume.carve(tool, poses[k : k + 2], dt=dt).force[0] @ direction) for k in range(count)]
    return dt * np.arange(1, count + 1), np.array(force)
