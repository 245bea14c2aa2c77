"""riffler.submit: calls on a thread of their own; and how many threads calls use."""

import functools
import gc
import os
import signal
import subprocess
import sys
import tempfile
import textwrap
import threading
import time

import numpy as np
import pytest
import riffler
from riffler import plan, tasks

UP = [0.0, 0.0, 1.0]
BALL = riffler.Tool.ball(6, 40)


def blocks(*boxes):
    """A mesh of boxes (lower, upper)."""
    corners = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)], dtype=float)
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    triangles = np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])
    vertices = [np.array(low) + corners * (np.array(high) - low) for low, high in boxes]
    return riffler.Mesh(np.vstack(vertices), np.vstack([triangles + 8 * k for k in range(len(boxes))]))


STEP = blocks(([0.0, -20, -5], [30.0, 20, 0]), ([-10.0, -20, -5], [0.0, 20, 30]))


def valley(points):
    """The ball's path in the step's corner, its axes upright."""
    centres = np.column_stack([np.full(points, 3.0), np.linspace(-10, 10, points), np.full(points, 3.0)])
    contacts = np.stack([centres - [0, 0, 3], centres - [3, 0, 0]], axis=1)
    normals = np.broadcast_to([[UP, [1.0, 0, 0]]], (points, 2, 3))
    path = plan.PencilPath(3, centres, contacts, normals)
    return path.orient({0: path.axis(0, 0.0, 0.3)})


def carved():
    """A tri-dexel volume with a few grooves."""
    volume = riffler.Volume.block([0, 0, 0], [40, 30, 10], 0.5, "xyz")
    t = np.linspace(0, 1, 60)
    tips = np.column_stack([5 + 30 * t, 15 + 10 * np.sin(9 * t), 8 - 3 * t])
    volume.carve(BALL, np.column_stack([tips, np.tile(UP, (60, 1))]))
    return volume


def passes():
    tips = [[-5.0, 5, 12], [-5, 5, 7], [45, 5, 7], [45, 20, 7], [-5, 20, 6], [-5, 20, 12]]
    return riffler.Program(np.column_stack([tips, np.tile(UP, (6, 1))]), 600.0, spindle=9000.0, tools={1: BALL})


VOLUME, PATH, COLLIDER = carved(), valley(9), riffler.Collider(STEP)
SURFACE = VOLUME.to_mesh()
GRID = {"inclinations": np.linspace(-0.4, 0.4, 5), "tilts": np.linspace(-0.2, 0.8, 6)}
PART = blocks(([0.0, 0, 0], [40.0, 30, 5]))


def stock():
    return riffler.Volume.block([0, 0, 0], [40, 30, 10], 0.5)


def verification():
    return riffler.Verification(stock(), PART)


def strokes():
    journal = riffler.Journal()
    journal.set_stock([0, 0, 0], [40, 30, 10], 0.5, "xyz")
    journal.add_tool(1, BALL)
    for mode, x in (("mask", 10), ("remove", 12), ("add", 14)):
        journal.add_stroke(1, [[x, 3, 9, *UP], [x, 27, 9, *UP]], mode=mode)
    return journal


TEMPORARY = os.path.join(tempfile.mkdtemp(), "saved.rvol")
WRITTEN = os.path.join(tempfile.mkdtemp(), "written.stl")
# name: the plain call, its arguments and keywords
CALLS = {
    "pencil": (plan.pencil, (STEP, BALL), {"passes": 3, "scallop": 0.1}),
    "cutter_locations": (plan.cutter_locations, (PATH, BALL, COLLIDER), {"clearance": 0.1}),
    "kept_locations": (plan.kept_locations, (PATH, BALL, COLLIDER), {"depth": 0.1, "clearance": 0.1}),
    "free_orientations": (plan.free_orientations, (PATH, BALL, COLLIDER), GRID | {"index": [0, 4]}),
    "least_tilt": (plan.min_tilt, (PATH, BALL, COLLIDER), GRID | {"limit": (UP, 1.0)}),
    "verify": (riffler.verify, (passes(), stock(), PART, [PART, VOLUME]), {"rest_tolerance": 0.1}),
    "run": (lambda *args, **kwargs: verification().run(*args, **kwargs), (passes(),), {}),
    "collider": (riffler.Collider.made, (STEP,), {"fixtures": [stock()], "spacing": 0.5}),
    "from_mesh": (riffler.Volume.from_mesh, (SURFACE, 0.7, "xyz"), {"lower": [0, 0, -1]}),
    "sphere": (riffler.Volume.sphere, ((1, 2, 3), 9.0, 0.2, "xyz"), {"lower": [0, 0, 0]}),
    "cylinder": (riffler.Volume.cylinder, ((1, 2, 3), 9.0, 20.0, 0.2), {"axis": (1, 2, 3)}),
    "grown": (riffler.Volume.grow, (VOLUME, [-9, -3, -1]), {}),
    "to_mesh": (riffler.Volume.to_mesh, (VOLUME,), {}),
    "parts": (riffler.Volume.parts, (VOLUME,), {"minimum": 1.0}),
    "resampled": (riffler.Volume.resample, (VOLUME, 0.4, "xyz"), {"lower": [0, 0, -1]}),
    "to_bytes": (riffler.Volume.to_bytes, (VOLUME,), {}),
    "save": (riffler.Volume.save, (VOLUME, TEMPORARY), {}),
    "replay": (riffler.Journal.replay, (strokes(),), {}),
    "decimate": (riffler.Mesh.decimate, (SURFACE,), {"triangles": 2000, "tolerance": 0.05}),
    "smooth": (riffler.Mesh.smooth, (SURFACE,), {"iterations": 5, "feature_angle": 0.7}),
    "deviation": (riffler.Mesh.deviation, (SURFACE, STEP), {"signed": True}),
    "write": (riffler.Mesh.write, (SURFACE, WRITTEN), {}),
}


def started(name, *args, **kwargs):
    call = verification().run if name == "run" else CALLS[name][0]
    return riffler.submit(call, *args, **kwargs)


def bits(thing):
    """What a result says, down to the bit."""
    if isinstance(thing, riffler.Mesh):
        return bits((thing.vertices, thing.triangles))
    if isinstance(thing, riffler.Volume):
        return thing.to_bytes()
    if isinstance(thing, plan.PencilPath):
        return bits((thing.centres, thing.contacts, thing.normals, thing.axes))
    if isinstance(thing, riffler.VerifyReport):
        return bits(
            (
                thing.to_dict(),
                thing.removed,
                thing.seconds,
                thing.volume,
                thing.stock_deviation(),
                thing.part_deviation(),
            )
        )
    if isinstance(thing, np.ndarray):
        return thing.dtype.str, thing.shape, thing.tobytes()
    if isinstance(thing, dict):
        return [(key, bits(value)) for key, value in thing.items()]
    own = bits(vars(thing)) if hasattr(thing, "__dict__") else None
    if isinstance(thing, list | tuple):
        return type(thing), [bits(one) for one in thing], own
    return own or (type(thing), repr(thing))


@functools.cache
def expected_bits(name):
    """The bits of the plain call's result; computed once."""
    call, args, kwargs = CALLS[name]
    return bits(call(*args, **kwargs))


def endless():
    """A call that takes practically for ever, in short steps."""
    return riffler.submit(SURFACE.smooth, iterations=2_000_000_000)


def threads_of_process():
    return len(os.listdir("/proc/self/task"))


# --- results and errors ----------------------------------------------------------------------------------------------


def test_every_task_is_tested_here():
    assert set(CALLS) == set(tasks.__all__)


@pytest.mark.parametrize("name", CALLS)
def test_a_task_gives_what_the_call_gives(name):
    call, args, kwargs = CALLS[name]
    expected = call(*args, **kwargs)
    task = started(name, *args, **kwargs)
    assert isinstance(task, riffler.Future)
    found = task.result()
    assert task.done() and task.progress() == 1 and "done" in repr(task)
    assert type(found) is type(expected) and bits(found) == bits(expected)
    assert task.result() is found
    task.cancel()
    assert task.result() is found and task.progress() == 1


@pytest.mark.parametrize("name", CALLS)
def test_the_plain_call_still_takes_a_progress_callback(name):
    call, args, kwargs = CALLS[name]
    shares = []
    call(*args, **kwargs, progress=shares.append)
    assert shares and min(shares) >= 0 and max(shares) <= 1
    with pytest.raises(riffler.Cancelled):
        call(*args, **kwargs, progress=lambda share: False)


def test_both_forms_report_bad_arguments_alike():
    nothing = riffler.Mesh([], [])
    flat = riffler.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    bad = {
        "pencil": [(nothing, BALL), (None, BALL)],
        "cutter_locations": [(plan.PencilPath(3, [UP], [[UP, UP]], [[UP, UP]]), BALL, COLLIDER), (None, BALL, None)],
        "free_orientations": [(PATH, BALL, COLLIDER, 9), (PATH, BALL, COLLIDER, -1), (PATH, BALL, None, 0)],
        "least_tilt": [(PATH, BALL, None), (PATH, None, COLLIDER)],
        "verify": [(passes(), stock(), flat, [flat]), (7, stock()), (None, stock()), (passes(), stock(), VOLUME)],
        "run": [(None,)],
        "from_mesh": [(flat, 1.0), (None, 1.0), (STEP, -1.0)],
        "decimate": [(STEP,), (None,)],
        "smooth": [(None,)],
        "deviation": [(STEP, nothing), (STEP, None)],
        "write": [(STEP, "part.step"), (STEP, "/nowhere/at/all.stl"), (STEP, None)],
    }
    for name, several in bad.items():
        for args in several:
            more = {} if name != "free_orientations" else {"index": args[-1]}
            given = args[:-1] if more else args
            with pytest.raises((ValueError, TypeError, RuntimeError)) as expected:
                CALLS[name][0](*given, **more)
            with pytest.raises(expected.type) as found:
                started(name, *given, **more).result()
            if expected.type is not TypeError:
                assert str(found.value) == str(expected.value)


def test_an_error_is_raised_at_every_request():
    task = riffler.submit(riffler.plan.pencil, riffler.Mesh([], []), BALL)
    for _ in range(2):
        with pytest.raises(ValueError, match="triangle"):
            task.result()
    assert task.done() and task.progress() < 1


def test_a_given_progress_is_called_on_a_python_thread():
    shares = []
    future = riffler.submit(VOLUME.to_mesh, progress=shares.append)
    assert bits(future.result()) == bits(SURFACE) and shares and future.progress() == 1
    with pytest.raises(riffler.Cancelled):
        riffler.submit(VOLUME.to_mesh, progress=lambda share: False).result()


def test_calls_that_run_python_or_change_their_object_are_futures_too():
    report = riffler.submit(riffler.verify, iter([passes()]), stock()).result()
    assert bits(report) == bits(riffler.verify(iter([passes()]), stock()))
    volume = stock()
    cut = riffler.submit(volume.carve, BALL, [[0, 0, 5, *UP], [40, 30, 5, *UP]]).result()
    assert cut.removed.sum() == pytest.approx(stock().volume - volume.volume)
    future = riffler.submit(SURFACE.audit)
    assert future.result() == SURFACE.audit() and future.exception() is None


def test_a_python_call_is_cancelled_by_its_progress():
    def slow(progress):
        while progress(0.5) is not False:
            time.sleep(0.001)
        raise riffler.Cancelled("stopped")

    future = riffler.submit(slow)
    assert future.running() and future.cancel()
    assert isinstance(future.exception(30), riffler.Cancelled) and future.cancelled() and not future.cancel()


def test_a_late_result_is_a_timeout():
    future = endless()
    for ask in (future.result, future.exception):
        with pytest.raises(TimeoutError, match=r"has not ended after 0.05 s"):
            ask(timeout=0.05)
    future.cancel()


def test_callbacks_get_the_future_once_it_is_done(caplog):
    seen, later = [], threading.Event()
    future = riffler.submit(SURFACE.deviation, STEP)
    future.add_done_callback(lambda _: 1 / 0)
    future.add_done_callback(lambda found: (seen.append(found), later.set()))
    assert later.wait(30) and seen == [future]
    future.add_done_callback(seen.append)
    assert len(seen) == 2 or later.wait(0.2)
    assert "ZeroDivisionError" in caplog.text


def test_wrong_arguments_of_a_native_call_are_raised_at_once():
    with pytest.raises(TypeError, match=r"Mesh.decimate: there is no argument tolerence; did you mean tolerance\?"):
        riffler.submit(SURFACE.decimate, tolerence=1)
    with pytest.raises(TypeError):
        riffler._core.Task()


@pytest.mark.parametrize("name", CALLS)
def test_the_older_functions_warn_and_give_tasks(name):
    riffler.deprecated.forget()
    _, args, kwargs = CALLS[name]
    call = getattr(tasks, name)
    with pytest.warns(DeprecationWarning, match=rf"tasks.{name} is deprecated, use riffler.submit\(riffler\."):
        task = call(verification(), *args, **kwargs) if name == "run" else call(*args, **kwargs)
    assert isinstance(task, riffler._core.Task) and bits(task.result()) == expected_bits(name)
    assert task.done and task.share == 1


@pytest.mark.filterwarnings("ignore:riffler. tasks:DeprecationWarning")
def test_a_report_of_a_mesh_is_filled_with_the_result():
    open_box = riffler.Mesh(PART.vertices, PART.triangles[1:])
    expected, found = {}, {}
    riffler.deprecated.forget()
    with pytest.warns(DeprecationWarning, match="Volume.from_mesh_with_report"):
        riffler.Volume.from_mesh(open_box, 1.0, report=expected)
    task = tasks.from_mesh(open_box, 1.0, report=found)
    while not task.done:
        time.sleep(0.001)
    assert found == {}
    task.result()
    assert found == expected and found["open_edges"] == 3


def test_a_conversion_that_failed_is_not_made_again():
    task = VOLUME.to_bytes(progress=riffler._core.Task)
    assert riffler._core.then(task, lambda found: 1 / 0) is task
    with pytest.raises(ZeroDivisionError):
        task.result()
    with pytest.raises(RuntimeError, match="lost"):
        task.result()


# --- what is taken when a task is made -------------------------------------------------------------------------------


def test_a_volume_may_be_carved_while_a_task_reads_it():
    volume = carved()
    before = bits(volume.to_mesh())
    running = [riffler.submit(riffler.Volume.to_mesh, volume) for _ in range(4)]
    volume.carve(BALL, [[0, 0, 5, *UP], [40, 30, 5, *UP]])
    running.append(riffler.submit(riffler.Volume.to_mesh, volume))
    after = bits(volume.to_mesh())
    del volume
    assert [bits(task.result()) for task in running] == 4 * [before] + [after]
    assert before != after


def test_a_task_keeps_its_arguments_alive():
    path, collider, tool = valley(9), riffler.Collider(STEP), riffler.Tool.ball(6, 40)
    task = riffler.submit(riffler.plan.free_orientations, path, tool, collider, index=[0, 4], **GRID)
    del path, collider, tool
    gc.collect()
    assert bits(task.result()) == bits(plan.free_orientations(PATH, BALL, COLLIDER, index=[0, 4], **GRID))


def test_arrays_may_be_written_once_the_task_is_made():
    inclinations, tilts = GRID["inclinations"].copy(), GRID["tilts"].copy()
    task = riffler.submit(riffler.plan.min_tilt, PATH, BALL, COLLIDER, inclinations=inclinations, tilts=tilts)
    inclinations[:], tilts[:] = 7, 7
    assert bits(task.result()) == bits(plan.min_tilt(PATH, BALL, COLLIDER, **GRID))


def test_tasks_run_at_the_same_time_as_others_and_as_plain_calls():
    names = [*CALLS] * 2
    running = [started(name, *CALLS[name][1], **CALLS[name][2]) for name in names]
    for name, task in zip(names, running, strict=True):
        call, args, kwargs = CALLS[name]
        assert bits(task.result()) == bits(call(*args, **kwargs)), name


def test_a_verification_in_use_refuses_calls():
    shared = verification()
    many = np.array([[20 + 19 * np.sin(k), 15 + 14 * np.cos(1.7 * k), 7] for k in range(200_000)])
    program = riffler.Program(np.column_stack([many, np.tile(UP, (len(many), 1))]), 600.0, spindle=1.0, tools={1: BALL})
    first = riffler.submit(riffler.Verification.run, shared, program)
    while first.progress() == 0:
        time.sleep(0.001)
    with pytest.raises(RuntimeError, match="in use by another thread"):
        shared.run(passes())
    first.cancel()
    with pytest.raises(riffler.Cancelled):
        first.result()
    assert bits(shared.run(passes())) == bits(verification().run(passes()))


# --- cancelling, waiting, dropping -----------------------------------------------------------------------------------


def test_a_cancelled_task_raises_cancelled():
    task = endless()
    assert not task.done() and "%" in repr(task)
    task.cancel()
    for _ in range(2):
        with pytest.raises(riffler.Cancelled):
            task.result()
    assert task.done() and task.progress() < 1


def test_the_share_grows_and_waiting_does_not_block_python():
    task, raised = endless(), []

    def wait():
        try:
            task.result()
        except riffler.Cancelled as error:
            raised.append(error)

    waiting = threading.Thread(target=wait)
    waiting.start()
    shares = [task.progress()]
    while len(set(shares)) < 3:  # this thread runs although the other one waits in the core
        shares.append(task.progress())
    assert sorted(shares) == shares and shares[0] >= 0 and shares[-1] < 1
    assert waiting.is_alive()
    task.cancel()
    waiting.join()
    assert len(raised) == 1


def test_a_signal_ends_the_waiting_but_not_the_task():
    class StopError(Exception):
        pass

    def handler(*_):
        raise StopError

    task, before = endless(), signal.signal(signal.SIGALRM, handler)
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.05)
        with pytest.raises(StopError):
            task.result()
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
    assert not task.done()
    task.cancel()
    with pytest.raises(riffler.Cancelled):
        task.result()


def test_a_dropped_task_leaves_no_thread():
    before = threads_of_process()
    task = endless()
    assert threads_of_process() > before
    del task
    assert threads_of_process() == before


def test_many_tasks_cancelled_or_dropped_at_any_time():
    """A hundred, or a thousand where RIFFLER_LONG is set (`make stress`)."""
    rng, before = np.random.default_rng(7), threads_of_process()
    names = list(CALLS)
    held, ended = [], {"cancelled": 0, "found": 0}
    for _ in range(1000 if os.environ.get("RIFFLER_LONG") else 100):
        name = names[rng.integers(len(names))]
        task = started(name, *CALLS[name][1], **CALLS[name][2])
        if rng.random() < 0.7:
            time.sleep(rng.choice([0, 0.0005, 0.003]))
        if rng.random() < 0.6:
            task.cancel()
            if rng.random() < 0.5:
                held.append((name, task))
        if len(held) > 3:
            name, task = held.pop(rng.integers(len(held)))
            try:
                assert bits(task.result()) == expected_bits(name)
                ended["found"] += 1
            except riffler.Cancelled:
                ended["cancelled"] += 1
    assert ended["cancelled"] > 0
    del task
    held.clear()
    assert threads_of_process() == before


EXITS = {
    "a global": "task = endless()",
    "never collected": "import gc; gc.disable(); ring = [endless()]; ring.append(ring); del ring",
    "by sys.exit": "task = endless(); sys.exit(0)",
    "from a function": "def f():\n    held = endless()\n    sys.exit(0)\nf()",
    "in a thread's hands": "t = threading.Thread(target=lambda held: time.sleep(0.2), args=[endless()]); t.start()",
    "many": "tasks_ = [endless() for _ in range(8)]; tasks_[3].cancel()",
    "with a result not asked for": "task = riffler.submit(test_tasks.VOLUME.to_bytes); time.sleep(0.2)",
    "started late": "import atexit; atexit.register(lambda: globals().update(late=endless()))",
}


@pytest.mark.parametrize("name", EXITS)
def test_python_ends_while_tasks_run(name):
    script = "import sys, threading, time\nimport riffler, test_tasks\nfrom test_tasks import endless\n" + EXITS[name]
    path = os.pathsep.join([os.path.dirname(__file__), *sys.path])
    done = subprocess.run(
        [sys.executable, "-c", textwrap.dedent(script)],
        env=os.environ | {"PYTHONPATH": path},
        capture_output=True,
        text=True,
        timeout=120,
    )
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


# --- how many threads ------------------------------------------------------------------------------------------------


@pytest.fixture
def free_choice(monkeypatch):
    monkeypatch.delenv("RIFFLER_THREADS", raising=False)
    riffler.set_threads(None)
    yield monkeypatch
    riffler.set_threads(None)


def test_set_threads_comes_before_the_environment(free_choice):
    assert riffler.threads() == len(os.sched_getaffinity(0))
    free_choice.setenv("RIFFLER_THREADS", "3")
    assert riffler.threads() == 3
    riffler.set_threads(5)
    assert riffler.threads() == 5
    free_choice.delenv("RIFFLER_THREADS")
    assert riffler.threads() == 5
    riffler.set_threads(None)
    assert riffler.threads() == len(os.sched_getaffinity(0))


def test_a_meaningless_number_of_threads_changes_nothing(free_choice):
    riffler.set_threads(2)
    for bad in (0, -1, 257):
        with pytest.raises(ValueError, match=f"threads must be 1 to 256, not {bad}"):
            riffler.set_threads(bad)
    for bad in (1.5, "2"):
        with pytest.raises(TypeError):
            riffler.set_threads(bad)
    assert riffler.threads() == 2


@pytest.mark.parametrize("count", [1, 2, 5])
def test_any_number_of_threads_gives_the_same_bytes(free_choice, count):
    expected = [expected_bits(name) for name in CALLS]
    riffler.set_threads(count)
    found = [started(name, *args, **kwargs).result() for name, (_, args, kwargs) in CALLS.items()]
    assert [bits(one) for one in found] == expected


def test_one_thread_is_one_thread(free_choice):
    angles = np.linspace(-1.0, 1.0, 51)
    wide = {"inclinations": angles, "tilts": angles}
    riffler.set_threads(1)
    before = threads_of_process()
    task = riffler.submit(riffler.plan.free_orientations, valley(300), BALL, COLLIDER, index=range(300), **wide)
    while task.progress() == 0:
        assert threads_of_process() <= before + 1
    del task
    riffler.set_threads(4)
    task, most = riffler.submit(plan.free_orientations, valley(300), BALL, COLLIDER, index=range(300), **wide), 0
    while most < before + 4 and not task.done():
        most = max(most, threads_of_process())
    assert most == before + 4  # the task's own and three more
    del task
