"""The same work with 1, 2 and 4 threads, each in a process of its own: the files must have the same bytes. And how much
two cores gain."""

from __future__ import annotations

import hashlib
import tempfile
from pathlib import Path

from .. import report
from ..measure import Progress, Settings, child, cores, shares, watched
from ..report import Column, Report

TARGET = 1.7  # times one core
MANY = 16  # threads that show what the calling thread does alone
WORKS = (
    "level, z", "level, xyz", "ramping, z", "ramping, xyz", "three axes, z", "three axes, xyz", "five axes, z",
    "five axes, xyz", "from_mesh, z", "from_mesh, xyz", "to_mesh()", "to_mesh(0.005)", "decimate",
)  # fmt: skip
FILES = ("forces.bin", "volume.rvol", "mesh.stl", "again.rvol")


def run(settings: Settings, progress: Progress = None) -> Report:
    out = Report("threads", {"target": TARGET})
    share = shares(progress)
    same_bytes(out, settings, share(0, 0.2))
    two_cores(out, settings, share(0.2, 1))
    return out


def same_bytes(out: Report, settings: Settings, progress: Progress) -> None:
    table = out.section(
        "bytes",
        "The same bytes for any number of threads (SHA-256, first 12 digits)",
        Column("threads", "threads"),
        *(Column(name, name) for name in FILES),
    )
    for count in watched((1, 2) if settings.quick else (1, 2, 4), progress):
        with tempfile.TemporaryDirectory() as folder:
            child("files", count, folder=folder)
            digests = {name: hashlib.sha256((Path(folder) / name).read_bytes()).hexdigest()[:12] for name in FILES}
        table.row(threads=count, **digests)
        out.check(all(table.rows[0][name] == digests[name] for name in FILES), f"{count} threads: other bytes")


def two_cores(out: Report, settings: Settings, progress: Progress) -> None:
    table = out.section(
        "cores",
        "Two cores against one",
        Column("job", "job"),
        Column("processor time, 1 thread", "cpu_s", report.micro),
        Column("2 threads", "two_cpu_s", report.micro),
        Column("calling thread alone, at most", "alone", lambda share: f"{100 * share:.0f} %"),
        Column("two cores allow", "allowed", report.ratio),
        Column("wall time, 1 thread ÷ 2", "ratio", report.ratio),
        Column("cores free", "cores", report.three),
    )
    for work in watched(WORKS[:1] if settings.quick else WORKS, progress):
        one, many = (child("on_cores", count, job=work, quick=settings.quick) for count in (1, MANY))
        free = cores()
        two = child("on_cores", 2, job=work, quick=settings.quick)
        # The calling thread has what runs in it alone, and a share of the rest.
        alone = max(0.0, (MANY * many["caller_s"] - many["cpu_s"]) / (MANY - 1)) / many["cpu_s"]
        table.row(
            job=work, cpu_s=one["cpu_s"], two_cpu_s=two["cpu_s"], alone=alone,
            allowed=2 / (1 + alone), ratio=one["wall_s"] / two["wall_s"],
            cores=free,
        )  # fmt: skip
    table.notes.append(
        f"Level and ramping: S500k; three and five axes: verification of 200 000 rows at h = 0.2 mm; from_mesh: a part "
        f"of 1 000 000 triangles at 1024 rays; meshes of B200 at h = 0.1 mm. Alone: from the calling thread's "
        f"processor time with {MANY} threads, of which it has at least a {MANY}th; holds on a busy machine, too. The "
        f"ratio of wall times is right only with two cores free (cores free: what two threads of hashing got just "
        f"then). Target: {TARGET} × one core."
    )
