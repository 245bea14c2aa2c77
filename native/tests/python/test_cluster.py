"""Verification on a Dask cluster of two worker processes: the report is the single machine's, byte for byte."""

import os
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest
import riffler
from commands import in_shell, result, riffle
from riffler import _core, cluster
from verify_reference import state

distributed = pytest.importorskip("distributed", reason="no clusters: distributed is not installed")


@pytest.fixture(scope="module")
def workers():
    """Two processes of one thread each; Dask restarts one that dies."""
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=":0", host="127.0.0.1"
    ) as local, distributed.Client(local, set_as_default=False) as client:  # fmt: skip
        client.wait_for_workers(2, timeout=60)
        yield client


def tool():
    return riffler.Tool.ball(6, 6).with_shank([(6, 2.5, 8, 2.5)]).with_holder([(8, 5, 30, 9)])


def program(rows, tilted):
    """Over and in a block, with rapids and feed moves under a spindle that stands; too deep for the holder at times."""
    t = np.linspace(0, 1, rows)
    tips = np.column_stack([15 + 14 * np.sin(37 * t), 10 + 9 * np.cos(53 * t), -1 - 7.5 * t])
    axes = np.column_stack([0.5 * np.sin(11 * t), 0.4 * np.cos(17 * t), np.ones(rows)]) if tilted else [[0.0, 0, 1]]
    poses = np.hstack([tips, np.broadcast_to(axes / np.linalg.norm(axes, axis=1)[:, None], (rows, 3))])
    k = np.arange(rows)
    return riffler.Program(
        poses, 1000.0, rapid=k % 17 == 5, spindle=np.where(k % 31, 8000.0, 0.0), line=k + 1, tools={1: tool()}
    )


def scene(tilted, rows=200):
    """Program, stock, part with gouges and rest material, and a fixture that is hit."""
    stock = riffler.Volume.block([0, 0, -10], [30, 20, 0], 0.3 if tilted else 0.15, "xyz" if tilted else "z")
    part = riffler.Volume.block([2, 2, -9], [28, 18, -7.5], 0.5, "xyz").to_mesh()
    fixture = riffler.Volume.block([12, 16, -3], [18, 26, 4], 0.2, "z")
    return program(rows, tilted), stock, part, [fixture]


@pytest.fixture(scope="module", params=[False, True], ids=["three axes", "five axes"])
def judged(request):
    """A scene and the single machine's report of it."""
    given = scene(request.param)
    report = riffler.verify(*given, rest_tolerance=0.5)
    assert {"rapid", "holder", "fixture", "gouge", "rest", "spindle"} <= {f.kind for f in report.findings}
    return given, report


def cut_up(whole, lengths):
    """The program in chunks; each begins with the row at which the one before ended."""
    begin, n = 0, len(whole)
    while begin < n - 1:
        end = min(n, begin + lengths[begin % len(lengths)] + 1)
        rows = slice(begin, end)
        yield riffler.Program(
            whole.poses[rows], whole.feed[rows], rapid=whole.rapid[rows], spindle=whole.spindle[rows],
            line=whole.line[rows], tool=whole.tool[rows], tools=whole.tools,
        )  # fmt: skip
        begin = end - 1


def tasks_left(client):
    """Tasks of riffler that the scheduler still knows; cancelling takes it a moment."""
    for _ in range(100):
        left = client.run_on_scheduler(
            lambda dask_scheduler: [key for key in dask_scheduler.tasks if str(key).startswith("riffler")]
        )
        if not left:
            return []
        time.sleep(0.05)
    return left


def test_two_workers_give_the_report_of_a_single_machine(workers, judged):
    given, alone = judged
    shares = []
    report = cluster.verify(*given, rest_tolerance=0.5, scheduler=workers, progress=shares.append)
    assert state(report) == state(alone)
    assert report.stats.moves == alone.stats.moves
    assert shares == sorted(shares) and shares[-1] == 1 and len(set(shares)) > 5
    assert tasks_left(workers) == []


def test_chunks_of_any_length_and_slabs_in_pieces_give_the_same_report(workers, judged, monkeypatch):
    given, alone = judged
    monkeypatch.setattr(cluster, "MOVES", 40)
    chunks = cut_up(given[0], [1, 60, 7, 113])
    report = cluster.verify(chunks, *given[1:], rest_tolerance=0.5, scheduler=workers)
    assert state(report) == state(alone)


def test_a_killed_worker_costs_only_its_current_slabs(workers):
    given = scene(True, 300)
    alone = riffler.verify(*given)
    before = set(workers.run(os.getpid).values())
    killed = []

    def kill_one(share):
        if share > 0.3 and not killed:
            killed.append(min(before))
            os.kill(killed[0], signal.SIGKILL)

    report = cluster.verify(*given, scheduler=workers, progress=kill_one)
    assert killed and state(report) == state(alone)
    workers.wait_for_workers(2, timeout=60)
    assert killed[0] not in workers.run(os.getpid).values()


def stop_by_raising(share):
    if share > 0.2:
        raise ZeroDivisionError


@pytest.mark.parametrize(
    ("progress", "error"),
    [(lambda share: share < 0.2, riffler.Cancelled), (stop_by_raising, ZeroDivisionError)],
    ids=["returns False", "raises"],
)
def test_cancelling_leaves_nothing_on_the_cluster(workers, progress, error):
    with pytest.raises(error):
        cluster.verify(*scene(True, 300), scheduler=workers, progress=progress)
    assert tasks_left(workers) == []
    given = scene(False, 50)
    assert state(cluster.verify(*given, scheduler=workers)) == state(riffler.verify(*given))


def test_ctrl_c_leaves_nothing_on_the_cluster(workers):
    def interrupt(share):
        if share > 0.2:
            signal.raise_signal(signal.SIGINT)

    # A shell's background jobs are started with the signal ignored.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        with pytest.raises(KeyboardInterrupt):
            cluster.verify(*scene(True, 300), scheduler=workers, progress=interrupt)
    finally:
        signal.signal(signal.SIGINT, before)
    assert tasks_left(workers) == []


def test_an_address_without_a_scheduler_is_reported_within_seconds(monkeypatch):
    monkeypatch.setattr(cluster, "PATIENCE", 1.0)
    start = time.perf_counter()
    with pytest.raises(ConnectionError, match=r"answers at tcp://127\.0\.0\.1:9 \(start one: dask scheduler"):
        cluster.verify(*scene(False, 50), scheduler="tcp://127.0.0.1:9")
    assert time.perf_counter() - start < 60
    with pytest.raises(ConnectionError, match="no Dask scheduler answers at nowhere://"):
        cluster.verify(*scene(False, 50), scheduler="nowhere://")
    with pytest.raises(ValueError, match="scheduler must be an address"):
        cluster.verify(*scene(False, 50), scheduler=8786)


def test_workers_without_riffler_or_with_another_one_are_named(monkeypatch, workers):
    monkeypatch.setattr(cluster, "__version__", "99.0")
    with pytest.raises(RuntimeError, match=r"tcp://127.0.0.1:\d+ has riffler .*, this is 99.0: install the same"):
        cluster.verify(*scene(False, 50), scheduler=workers)
    monkeypatch.undo()
    monkeypatch.setattr(cluster, "PATIENCE", 20.0)
    code = "import sys; sys.modules['riffler'] = None; from distributed.cli.dask_worker import main; main()"
    with distributed.LocalCluster(n_workers=0, dashboard_address=":0", host="127.0.0.1") as empty:
        options = ["--nthreads", "1", "--no-nanny", "--no-dashboard", "--host", "127.0.0.1"]
        other = subprocess.Popen(
            [sys.executable, "-c", code, empty.scheduler_address, *options], stderr=subprocess.DEVNULL
        )
        try:
            with pytest.raises(RuntimeError, match=r"tcp://127.0.0.1:\d+ has no riffler"):
                cluster.verify(*scene(False, 50), scheduler=empty.scheduler_address)
        finally:
            other.terminate()
            other.wait()
        monkeypatch.setattr(cluster, "PATIENCE", 1.0)
        with (
            pytest.raises(ConnectionError, match="has no workers"),
            distributed.Client(empty, set_as_default=False) as client,
        ):
            # The scheduler may still know the one that has just left.
            while client.nthreads():
                time.sleep(0.05)
            cluster.verify(*scene(False, 50), scheduler=client)


def test_a_worker_that_joins_with_another_version_is_named():
    context = cluster.Context("99.0", b"")
    seen = []

    def as_on_a_worker():
        with pytest.raises(Exception, match=r"No worker found|99\.0"):
            cluster.simulate(context, b"", [])
        seen.append(True)

    thread = threading.Thread(target=as_on_a_worker)
    thread.start()
    thread.join()
    assert seen


def test_bad_arguments_are_named_as_on_a_single_machine(workers):
    whole, stock, part, _ = scene(False, 50)
    for arguments, names in (
        ((3, stock), "program must be"),
        (([whole, 3], stock), "program must be"),
        (([whole, whole], stock), "a chunk must begin"),
        ((whole, stock, 3), "part_mesh"),
    ):
        with pytest.raises((TypeError, ValueError), match=names):
            cluster.verify(*arguments, scheduler=workers)
    with pytest.raises(ValueError, match="rest_tolerance"):
        cluster.verify(whole, stock, rest_tolerance=0.1, scheduler=workers)
    with pytest.raises(ValueError, match="tool 7"):
        cluster.verify(riffler.Program(whole.poses, 1000.0, tool=7), stock, part, scheduler=workers)
    assert cluster.verify([], stock, part, scheduler=workers).passed == riffler.verify([], stock, part).passed


# --- packets -------------------------------------------------------------------------------------------------------


def packets(rows=40):
    whole, stock, part, fixtures = scene(True, rows)
    plan = _core.VerifyPlan(stock, part, fixtures)
    moves = {}
    for slab, _, packet in plan.add(whole):
        moves.setdefault(slab, []).append(packet)
    return plan, moves, (whole, stock, part, fixtures)


def test_slabs_in_any_order_give_the_report_of_a_single_machine():
    plan, moves, given = packets()
    worker = _core.SlabWorker(plan.context())
    order = np.random.default_rng(5).permutation(sorted(moves))
    for slab in order:
        plan.accept(slab, worker.run(plan.task(slab), moves[slab]), True)
    assert state(plan.finish()) == state(riffler.verify(*given))


def test_a_slab_gives_the_same_bytes_every_time():
    plan, moves, _ = packets()
    one, other = _core.SlabWorker(plan.context()), _core.SlabWorker(plan.context())
    for slab, given in moves.items():
        assert one.run(plan.task(slab), given) == other.run(plan.task(slab), given) == one.run(plan.task(slab), given)


def test_damaged_packets_are_refused_and_change_nothing():
    plan, moves, given = packets(60)
    context = plan.context()
    worker = _core.SlabWorker(context)
    slab = min(moves)
    task = plan.task(slab)
    result = worker.run(task, moves[slab])
    rng = np.random.default_rng(3)
    for what, good, use in (
        ("the context", context, _core.SlabWorker),
        ("a slab", task, lambda b: worker.run(b, moves[slab])),
        ("a slab's moves", moves[slab][0], lambda b: worker.run(task, [b])),
        ("a slab's result", result, lambda b: plan.accept(slab, b, True)),
    ):
        bad = [b"", good[:3], good[:-1], good + b"\0", context if good is not context else task]
        for at in rng.integers(0, len(good), 40):
            bad.append(good[:at] + bytes([good[at] ^ (1 << int(rng.integers(8)))]) + good[at + 1 :])
        for packet in bad:
            with pytest.raises(riffler.FormatError, match=f"^{what}"):
                use(packet)
    with pytest.raises(ValueError, match=r"no moves|finished"):
        plan.task(10**6)
    with pytest.raises(RuntimeError, match=f"slab {slab} is missing"):
        plan.finish()
    for k in moves:
        plan.accept(k, worker.run(plan.task(k), moves[k]), True)
    with pytest.raises(ValueError, match="finished"):
        plan.accept(slab, result, True)
    assert state(plan.finish()) == state(riffler.verify(*given))


def test_the_command_gives_the_same_report_with_a_scheduler(tmp_path, workers):
    code = ["G21 G90 G94", "T1 M6", "M3 S8000", "G0 X-10 Y10 Z25", "G1 Z17 F500", "X50", "X20 Y15", "G0 X5", "M30"]
    (tmp_path / "p.ngc").write_text("\n".join(code) + "\n")
    block = ["--stock", "40x30x20", "--pitch", "0.5", "--tool", "ball:6:30"]
    words = ["nc", "verify", "p.ngc", *block, "--out", "left.rvol"]
    left, said = [], []
    for more in ([], ["--scheduler", workers.scheduler.address]):
        said.append(result(*words, *more, cwd=tmp_path, status=1, run=in_shell))
        left.append((tmp_path / "left.rvol").read_bytes())
        assert [f["kind"] for f in said[-1]["findings"]] == ["rapid"]
        said[-1] = {k: v for k, v in said[-1].items() if k not in ("seconds", "stats")}
    assert said[0] == said[1] and left[0] == left[1]
    missing = riffle(*words, "--scheduler", "nowhere:1", cwd=tmp_path)
    assert missing.returncode == 2 and "Dask scheduler" in missing.stderr
