"""The same work with 1, 2 and 4 threads, each in a process of its own: the files must have the same bytes."""

from __future__ import annotations

import hashlib
import tempfile
from pathlib import Path

from ..measure import Progress, Settings, child, watched
from ..report import Column, Report

FILES = ("forces.bin", "volume.rvol", "mesh.stl", "again.rvol")


def run(settings: Settings, progress: Progress = None) -> Report:
    out = Report("threads")
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
    return out
