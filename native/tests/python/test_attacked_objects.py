"""Objects that several threads, forked processes and wrong hands come to: an error or the right answer, no crash."""

import multiprocessing
import os
import subprocess
import sys
import textwrap
import threading
import time

import numpy as np
import pytest
import riffler
from riffler import _core, plan

UP = [0.0, 0.0, 1.0]
BALL = riffler.Tool.ball(6, 40)
TIPS = [[-5.0, 5, 12], [-5, 5, 7], [25, 5, 7], [25, 20, 7], [-5, 20, 6], [-5, 20, 12]]
PASSES = riffler.Program(np.column_stack([TIPS, np.tile(UP, (6, 1))]), 600.0, spindle=9000.0, tools={1: BALL})


def block(directions="z", pitch=0.5):
    return riffler.Volume.block([0, 0, 0], [20, 30, 10], pitch, directions)


def script(text, seconds=60):
    """Runs a script in a process of its own, which may crash; its output."""
    done = subprocess.run(
        [sys.executable, "-c", textwrap.dedent(text)], capture_output=True, text=True, timeout=seconds, check=False
    )
    assert done.returncode == 0, f"{done.returncode}: {done.stderr[-2000:]}"
    return done.stdout


def at_once(count, work):
    """What `count` threads got that called `work` at the same time: results, or the errors themselves."""
    barrier, got = threading.Barrier(count), [None] * count

    def one(k):
        barrier.wait()
        try:
            got[k] = work()
        except Exception as error:  # all kinds are looked at
            got[k] = error

    threads = [threading.Thread(target=one, args=(k,)) for k in range(count)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return got


def test_maps_of_a_report_are_computed_once_for_all_callers():
    part = block().to_mesh()
    report = riffler.verify(PASSES, block("xyz", 0.4), part)
    maps = at_once(4, report.part_deviation)
    assert all(found is maps[0] for found in maps) and maps[0].shape == (len(part.vertices),)
    deviations = at_once(4, report.stock_deviation)
    assert all(found is deviations[0] for found in deviations)
    again = riffler.verify(PASSES, block("xyz", 0.4), part)
    assert np.array_equal(again.part_deviation(), maps[0])


def test_a_stream_is_for_one_thread_at_a_time(tmp_path):
    path = tmp_path / "long.ngc"
    lines = [f"G1 X{k % 97} Y{k % 89} F100" for k in range(200_000)]
    path.write_text("G21 G90\n" + "\n".join(lines) + "\nM2\n")
    stream = riffler.Program.stream(path, rows=50_000)
    chunks = []

    def read():
        while (chunk := next(stream, None)) is not None:
            chunks.append(chunk)

    errors = [error for error in at_once(4, read) if error is not None]
    assert all(isinstance(e, RuntimeError) and "another thread" in str(e) for e in errors)
    rows = sorted(len(chunk) for chunk in chunks)
    assert rows[1:] == [50_000] * 4 and sum(rows) == 200_000 + 4  # each begins with the last row before


def test_objects_that_release_the_lock_are_guarded(tmp_path):
    journal = riffler.JournalWriter(tmp_path / "j.rjournal")
    journal.set_stock([0, 0, 0], [1, 1, 1], 0.5)

    def note():
        for k in range(30):
            journal.add_note(f"{k}", "x")
            journal.sync()

    for error in at_once(4, note):
        assert error is None or (isinstance(error, RuntimeError) and "another thread" in str(error))
    journal.close()
    assert riffler.Journal.load(tmp_path / "j.rjournal").cut_at is None


def test_none_in_a_list_of_objects_is_a_type_error():
    script("""
        import riffler
        for call in (
            lambda: riffler.Program.joined([None]),
            lambda: riffler.Journal.strokes.fget(None),
            lambda: riffler.Volume.add(None, None),
            lambda: riffler.Collider(riffler.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]), fixtures=[None]),
            lambda: riffler.Session(None, riffler.Tool.ball(6, 30)),
        ):
            try:
                call()
            except (TypeError, ValueError):
                continue
            raise SystemExit("None was taken")
    """)


def test_an_object_without_init_is_a_type_error():
    out = script("""
        import riffler
        from riffler import _core
        from riffler_bench import _bench
        found = 0
        for module in (_core, _bench):
            for cls in vars(module).values():
                if not isinstance(cls, type) or issubclass(cls, BaseException):
                    continue
                thing = cls.__new__(cls)
                found += 1
                for name in dir(cls):
                    if name in ("__class__", "__new__", "__init__", "__setstate__", "__subclasshook__"):
                        continue
                    try:
                        value = getattr(thing, name)
                        if name in ("__repr__", "__str__", "__len__", "__copy__", "__hash__", "__next__"):
                            value()
                    except (TypeError, ValueError):  # of holders that are empty
                        pass
        print(found)
    """)
    assert int(out) > 20


@pytest.mark.parametrize(
    "work",
    [
        "volume.to_mesh()",
        "volume.copy().carve(ball, poses, progress=lambda share: None)",
        "session.frame()",
        "list(riffler.Program.stream(nc, rows=1000))",
    ],
)
def test_daemon_threads_live_on_until_python_ends(work, tmp_path):
    (tmp_path / "p.ngc").write_text("G21 G90\n" + "G1 X1 F100\nG1 X2\n" * 20_000 + "M2\n")
    for delay in (0.05, 0.2):
        script(f"""
            import threading, time
            import numpy as np
            import riffler
            nc = {str(tmp_path / "p.ngc")!r}
            ball = riffler.Tool.ball(6, 30)
            volume = riffler.Volume.block([0, 0, 0], [60, 60, 20], 0.3, "xyz")
            t = np.linspace(0, 60, 4000)
            poses = np.column_stack([t, 30 + 20 * np.sin(t), 18 + 0 * t, 0 * t, 0 * t, 1 + 0 * t])
            session = riffler.Session(volume.copy(), ball)
            session.start()
            def forever():
                while True:
                    try:
                        {work}
                    except RuntimeError:
                        pass  # in use by the other thread
            for _ in range(2):
                threading.Thread(target=forever, daemon=True).start()
            time.sleep({delay})
        """)


def in_child(work, seconds=20):
    """Whether `work` returns True in a forked process, which then ends as a Python program does."""
    read, write = os.pipe()
    child = os.fork()
    if child == 0:
        os.close(read)
        try:
            os.write(write, repr(work()).encode())
        except BaseException as error:  # the child must not run on as a second pytest
            os.write(write, repr(error).encode())
        finally:
            os._exit(0)
    os.close(write)
    end = time.monotonic() + seconds
    while os.waitpid(child, os.WNOHANG) == (0, 0):
        if time.monotonic() > end:
            os.kill(child, 9)
            os.waitpid(child, 0)
            pytest.fail("the forked process does not end")
        time.sleep(0.01)
    with os.fdopen(read) as pipe:
        return pipe.read()


@pytest.mark.filterwarnings("ignore:.*fork.*:DeprecationWarning")
def test_a_task_is_lost_in_a_forked_process():
    volume = riffler.Volume.block([0, 0, 0], [60, 60, 20], 0.2, "xyz")
    task = riffler.submit(riffler.Volume.to_mesh, volume)

    def ask():
        try:
            task.result()
        except RuntimeError as error:
            return (
                task.done(),
                "forked" in str(error),
                len(riffler.Volume.block([0] * 3, [1] * 3, 0.5).to_mesh().triangles),
            )

    assert in_child(ask).startswith("(True, True, ")
    assert len(task.result().triangles) > 1000


@pytest.mark.filterwarnings("ignore:.*fork.*:DeprecationWarning")
def test_a_forked_process_ends_while_sessions_tasks_and_pens_run(tmp_path):
    out = script(
        f"""
        import os, time
        import riffler
        from riffler import pen, tasks
        volume = riffler.Volume.block([0, 0, 0], [60, 60, 20], 0.3, "xyz")
        device = pen.open("simulated")
        session = riffler.Session(volume.copy(), riffler.Tool.ball(6, 30), device)
        session.journal({str(tmp_path / "s.rjournal")!r})
        session.start()
        task = riffler.submit(riffler.Volume.to_mesh, volume)
        child = os.fork()
        if child == 0:
            for call in (session.frame, session.stop):
                try:
                    call()
                except RuntimeError as error:
                    assert "forked" in str(error), error
                else:
                    raise SystemExit("a session without its thread went on")
            raise SystemExit(0)  # as any Python program ends
        end = time.monotonic() + 30
        while (done := os.waitpid(child, os.WNOHANG)) == (0, 0) and time.monotonic() < end:
            time.sleep(0.02)
        if done == (0, 0):
            os.kill(child, 9)
        session.stop()
        device.stop()
        print(done[1], task.result() is not None)
        """
    )
    assert out.split()[0] == "0", out
    assert riffler.Journal.load(tmp_path / "s.rjournal").cut_at is None


def test_worker_processes_that_fork_use_the_library_while_a_task_runs():
    task = riffler.submit(riffler.Volume.to_mesh, riffler.Volume.block([0, 0, 0], [60, 60, 20], 0.25, "xyz"))
    with multiprocessing.get_context("fork").Pool(2) as pool:
        assert pool.map(_carved, [1.0, 2.0]) == [_carved(1.0), _carved(2.0)]
    assert task.result()


def _carved(depth):
    volume = block()
    return float(volume.carve(BALL, [[-5, 15, 10 - depth, *UP], [25, 15, 10 - depth, *UP]]).removed.sum())


def test_a_session_whose_volume_was_carved_elsewhere_stops_and_keeps_its_ticks():
    volume = block()
    session = riffler.Session(volume, BALL)
    session.start()
    time.sleep(0.05)
    session.frame()
    time.sleep(0.05)
    volume.carve(BALL, [[-5, 15, 9, *UP], [25, 15, 9, *UP]])
    left = volume.volume
    with pytest.raises(RuntimeError, match="changed by something else"):
        session.stop()
    assert not session.running
    last = session.stop()
    assert len(last) > 10 and volume.volume == left
    assert len(session.stop()) == 0


@pytest.mark.parametrize(
    "call",
    [
        lambda: riffler.Program.from_cl([[[0, 0, 0, *UP]]], None, feed=100, occupied=3),
        lambda: riffler.Program.from_cl([[[0, 0, 0, *UP]]], None, feed=100, occupied=[[0, 0, 0]]),
        lambda: riffler.Program([[0, 0, 0, *UP]], 1.0, provenance={"a": "\ud800"}),
        lambda: riffler.Tool.from_dict({"kind": "\ud800", "diameter": 1, "length": 2}),
        lambda: riffler.Session(block(), BALL, dead_man_mask="x"),
        lambda: riffler.Session(block(), BALL, clutch_mask=2**40),
        lambda: riffler.Session(block(), BALL, undo=-1),
        lambda: riffler.Session(block(), BALL, material=3),
        lambda: block().carve(BALL, [["a"] * 6] * 2),
    ],
)
def test_arguments_that_cannot_be_converted_are_value_errors(call):
    with pytest.raises((ValueError, TypeError)) as caught:
        call()
    assert "C++" not in str(caught.value)


def test_messages_name_files_whose_names_are_not_utf8(tmp_path):
    name = os.fsencode(tmp_path) + b"/caf\xe9"
    for end, read in ((b".stl", riffler.Mesh.read), (b".rvol", riffler.Volume.load), (b".ngc", riffler.Program.read)):
        path = name + end
        with open(path, "wb") as file:
            file.write(b"G1 X1 Y\nno such file")
        with pytest.raises(riffler.FormatError, match=r"caf\\xe9"):
            read(os.fsdecode(path))


def test_loading_a_plan_from_nothing_or_a_folder_is_a_format_error(tmp_path):
    for path in (tmp_path / "none.json", tmp_path):
        with pytest.raises(riffler.FormatError, match=path.name):
            plan.load(path)


def test_translated_errors_keep_their_kinds():
    with pytest.raises(IndexError):
        riffler.Mesher(block()).patch(10**6)
    with pytest.raises(StopIteration):
        next(iter([]))
    assert issubclass(_core.FormatError, ValueError) and issubclass(_core.Cancelled, RuntimeError)
