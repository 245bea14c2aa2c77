"""Verification on a cluster of one and two worker processes of this machine, compared with the same without a cluster:
seconds, bytes moved, and what a slab costs more."""

from __future__ import annotations

import time
from typing import Any

from riffler import Program, VerifyReport, Volume, cluster, verify
from riffler._core import VerifyPlan

from .. import report, waves
from ..measure import Progress, Settings, threads, watched
from ..report import Column, Report

LINES = 250
NAMES = {False: "three axes", True: "five axes"}  # by whether the axis tilts


def on_workers(client: Any, program: Program, stock: Volume) -> tuple[VerifyReport, dict[str, Any]]:
    """As ``cluster.verify``, with its steps timed and its bytes counted."""
    before, mine = sum(client.run(time.process_time).values()), time.process_time()
    start = time.perf_counter()
    plan = VerifyPlan(stock)
    with cluster.Spool() as spool:
        for slab, moves, packet in plan.add(program):
            spool.add(slab, moves, packet)
        sorted_s = time.perf_counter() - start
        with cluster.Slabs(client, plan, spool, lambda share: None) as slabs:
            slabs.run()
        found = plan.finish()
        wall = time.perf_counter() - start
        bytes_per_move = spool.size / spool.total
    traffic = slabs.traffic
    return found, {
        "wall_s": wall,
        "client_cpu_s": time.process_time() - mine,
        "workers_cpu_s": sum(client.run(time.process_time).values()) - before,
        "sort_s": sorted_s,
        "slabs": traffic.slabs,
        "moves": spool.total,
        "move_bytes": bytes_per_move,
        "sent_bytes": traffic.sent / traffic.slabs,
        "received_bytes": traffic.received / traffic.slabs,
    }


def run(settings: Settings, progress: Progress = None) -> Report:
    out = Report("cluster")
    speed = out.section(
        "speed",
        "Verification without and with a cluster on this machine: wall time, workers of one thread each",
        Column("program", "program"),
        Column("rows", "rows", lambda n: f"{n:,}".replace(",", " ")),
        Column("who", "who"),
        Column("seconds", "wall_s", report.three),
        Column("rows a second", "rate", report.mega),
        Column("speed-up", "speedup", report.ratio),
        Column("processor time, client", "client_cpu_s", report.micro),
        Column("and workers", "workers_cpu_s", report.micro),
        Column("the same bytes", "same", lambda good: "yes" if good else "NO"),
    )
    cost = out.section(
        "slabs",
        "What a slab costs on a cluster",
        Column("program", "program"),
        Column("workers", "workers"),
        Column("slabs", "slabs"),
        Column("moves in them", "moves", report.mega),
        Column("bytes a move", "move_bytes", report.three),
        Column("sent a slab", "sent_bytes", lambda n: f"{n / 1e3:.0f} kB"),
        Column("received a slab", "received_bytes", lambda n: f"{n / 1e3:.0f} kB"),
        Column("moves into slabs", "sort_s", report.micro),
        Column("more than one thread, a slab", "overhead_s", report.micro),
    )
    try:
        distributed = cluster.library()
    except ValueError as error:
        for section in (speed, cost):
            section.notes.append(f"Not measured: {error}.")
        return out
    programs, alone, expected = {}, {}, {}
    for tilted, name in NAMES.items():
        rows = (4_000 if settings.quick else 200_000) if tilted else (20_000 if settings.quick else 1_000_000)
        program, stock = waves.program(rows, LINES, tilted), waves.stock(0.5 if settings.quick else 0.1)
        programs[name] = program, stock
        for count in (1, 2):
            with threads(count):
                start, before = time.perf_counter(), time.process_time()
                found = verify(program, stock)
                wall, used = time.perf_counter() - start, time.process_time() - before
            expected[name] = waves.contents(found)
            alone.setdefault(name, wall)  # with one thread
            speed.row(
                program=name, rows=len(program), who=f"no cluster, {count} thread{'s' * (count > 1)}",
                wall_s=wall, rate=len(program) / wall, speedup=alone[name] / wall, same=True, client_cpu_s=used,
            )  # fmt: skip
    for count in watched((1, 2), progress):
        with (
            threads(1),  # of the client too: what sorts moves is not to help the workers
            distributed.LocalCluster(
                n_workers=count, threads_per_worker=1, processes=True, dashboard_address=":0", host="127.0.0.1"
            ) as local,
            distributed.Client(local, set_as_default=False) as client,
        ):
            client.wait_for_workers(count, timeout=60)
            client.run(eval, cluster.VERSION_OF)  # imports riffler before the clock starts
            measured = {name: on_workers(client, *work) for name, work in programs.items()}
        for name, (found, figures) in measured.items():
            same, rows = waves.contents(found) == expected[name], len(programs[name][0])
            out.check(same, f"{name}, {count} workers: other bytes")
            wall, *used = (figures.pop(key) for key in ("wall_s", "client_cpu_s", "workers_cpu_s"))
            speed.row(
                program=name, rows=rows, who=f"{count} worker{'s' * (count > 1)}", wall_s=wall, rate=rows / wall,
                speedup=alone[name] / wall, same=same, client_cpu_s=used[0], workers_cpu_s=used[1],
            )  # fmt: skip
            more = (wall - alone[name]) / figures["slabs"] if count == 1 else None
            cost.row(program=name, workers=count, **figures, overhead_s=more)
    for section in (speed, cost):
        section.rows.sort(key=lambda row: list(programs).index(row["program"]))
    return out
