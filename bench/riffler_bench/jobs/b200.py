"""B200: 200 straight ramping moves through a block, every named cutter, compared with the yardstick and with rivals."""

from __future__ import annotations

from riffler import Volume

from .. import errors, report, scenes
from ..measure import Progress, Settings, Yardstick, child, watched
from ..report import Column, Report
from ..rivals.b200 import rivals, short

TARGET = 3.0  # times the yardstick, for any named cutter, force included
KINDS = {"plain": ("z", None), "force": ("z", 0.001), "tri": ("xyz", None)}


def run(settings: Settings, progress: Progress = None) -> Report:
    pitches = (0.5,) if settings.quick else (0.5, 0.25, 0.1)
    out = Report("b200", {"pitches": pitches, "target_ratio": TARGET})
    carve(out, settings, pitches, progress)
    others(out, settings)
    return out


def carve(out: Report, settings: Settings, pitches: tuple[float, ...], progress: Progress) -> None:
    heads = {"plain": "z", "force": "z, with force", "tri": "tri-dexel"}
    columns = [
        Column("h mm", "pitch", report.pitch),
        Column("cutter", "cutter"),
        Column("loop", "loop_s", report.micro),
    ]
    for kind, head in heads.items():
        columns += [Column(head, f"{kind}_s", report.micro), Column("÷ loop", f"{kind}_ratio", report.ratio)]
    columns += [Column("tri-dexel ÷ z", "three_ratio", report.ratio)]
    columns += [Column("largest error mm", "max_mm", report.mm), Column("wrong points", "wrong")]
    table = out.section("carve", "B200, processor time of one move, median", *columns)
    cases = [(pitch, cutter) for pitch in pitches for cutter in scenes.cutters()]
    for pitch, cutter in watched(cases, progress):
        yardstick, poses, figures = Yardstick(pitch, settings.quick), cutter.path(turning=False), {}
        for kind, (directions, dt) in KINDS.items():
            block = Volume.block(*scenes.BLOCK, pitch, directions)
            timing, volume = yardstick.beside(block.copy, lambda v, c=cutter, p=poses, dt=dt: v.carve(c.tool, p, dt=dt))
            figures[f"{kind}_s"] = timing.seconds / scenes.MOVES
            figures[f"{kind}_ratio"] = timing.ratio
            figures["loop_s"] = timing.loop / scenes.MOVES
        figures["three_ratio"] = figures["tri_ratio"] / figures["plain_ratio"]
        # Straight moves are exact: the tolerance only says how finely the comparison looks.
        error = errors.measured(volume, cutter.tool, poses, 1e-4, 50 if settings.quick else 400)
        table.row(pitch=pitch, cutter=cutter.name, **figures, **error)
        out.check(error["max_mm"] <= 1e-6 and not error["wrong"], f"{cutter.name}, h = {pitch:g}: {error}")
    table.notes.append(
        "Loop: the yardstick, B200's ball on a plain height map. Target: at most 3 × the loop for any cutter in z, "
        "force included; tri-dexel at most 4 × z. "
        "Errors are those of the tri-dexel volume; below 1e-9 mm they are those of the comparison."
    )


def others(out: Report, settings: Settings) -> None:
    table = out.section(
        "rivals",
        "B200 against others, wall time",
        Column("engine", "engine"),
        Column("one move, median", "us_per_move", lambda us: report.micro(us / 1e6)),
        Column("triangles", "triangles", report.mega),
        Column("triangles/s", "triangles_per_s", report.mega),
        Column("removed less than exact", "removed_short", report.percent),
        Column("peak memory", "peak_bytes", report.megabytes),
        Column("", "note"),
    )
    cases = [(0.5, "z", 1)] if settings.quick else [(0.25, "z", 1), (0.15, "z", 1), (0.25, "xyz", 1), (0.15, "xyz", 1),
                                                   (0.15, "xyz", None)]  # fmt: skip
    for pitch, directions, threads in cases:
        r = child("b200", threads, pitch=pitch, directions=directions)
        left = 180000 - r["removed"]
        table.row(
            engine=f"Riffler {directions}, h = {pitch:g}, {'1 thread' if threads == 1 else 'all threads'}",
            us_per_move=1e6 * r["carve_s"] / scenes.MOVES,
            triangles=r["triangles"],
            triangles_per_s=r["triangles"] / r["mesh_s"],
            removed_short=short(left, 180000 - scenes.B200_REMOVED),
            peak_bytes=r["peak_bytes"],
        )
    for figures in rivals(settings):
        if "mesh_s" in figures:
            figures["triangles_per_s"] = figures["triangles"] / figures["mesh_s"]
        table.row(**figures)
    table.notes.append(
        "Each engine is compared with its own exact limit: swept balls that reach out of the block (2 944.75 mm³), "
        "bare capsules (2 908.57) or static balls (2 873.2); of OpenVDB it is what its own block lost. Riffler's "
        "memory is a whole process with Python and numpy."
    )
