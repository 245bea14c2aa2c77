"""Numbers that no call can mean: refused by name, or a finite answer; and long calls that hear a Ctrl-C."""

import math
import subprocess
import sys
import textwrap
import time

import numpy as np
import pytest
import riffler
from riffler import plan

UP = [0.0, 0.0, 1.0]
BALL = riffler.Tool.ball(6, 40)
MOVE = [[2.0, 5, 8, *UP], [8.0, 5, 8, *UP]]


def block(directions="z"):
    return riffler.Volume.block([0, 0, 0], [10, 10, 10], 0.5, directions)


def path():
    centres = np.array([[0.0, 0, 3], [1, 0, 3], [2, 0, 3]])
    contacts = np.stack([centres - [0, 0, 3], centres - [3, 0, 0]], axis=1)
    return plan.PencilPath(3, centres, contacts, np.broadcast_to([[UP, [1.0, 0, 0]]], (3, 2, 3)))


PROGRAM = riffler.Program(np.array(MOVE), 600.0, spindle=1000.0, tools={1: BALL})
NEVER = [math.nan, math.inf, -math.inf]
CALLS = {
    "path_axis": (lambda x: path().axis(0, x, 0.0), NEVER),
    "path_axis_tilt": (lambda x: path().axis(0, 0.0, x), [*NEVER, 1e300]),
    "path_radius": (lambda x: plan.PencilPath(x, path().centres, path().contacts, path().normals), NEVER),
    "divided": (lambda x: path().divided(x), [*NEVER, 0.0, 5e-324, 1e-12]),
    "carve_dt": (lambda x: block().carve(BALL, MOVE, dt=x), [*NEVER, 0.0, 5e-324, 1e300]),
    "carve_tolerance": (lambda x: block().carve(BALL, MOVE, tolerance=x), [*NEVER, 0.0, 5e-324, 1e-12, 1e-22]),
    "carve_constant": (lambda x: block().carve(BALL, MOVE, removal_constant=x), [*NEVER, -1.0, 1e308]),
    "verify_rapid": (lambda x: riffler.verify(PROGRAM, block(), rapid_feed=x), [*NEVER, 0.0, 5e-324, 1e300]),
    "verify_tolerance": (lambda x: riffler.verify(PROGRAM, block(), tolerance=x), [*NEVER, 0.0, 1e-12]),
    "program_feed": (lambda x: riffler.Program(np.array(MOVE), x), [*NEVER, 0.0]),
    "verify_feed": (lambda x: riffler.verify(fed(x), block()), [5e-324, 1e-300]),
    "scale_feeds": (lambda x: PROGRAM.scale_feeds(x), [*NEVER, 0.0]),
    "soften": (lambda x: block("xyz").smooth([5, 5, 10], x), [*NEVER, 0.0]),
    "soften_strength": (lambda x: block("xyz").smooth([5, 5, 10], 2, strength=x), [*NEVER, 1.5, -1]),
    "parts": (lambda x: block().parts(minimum=x), NEVER),
    "pencil_tolerance": (lambda x: plan.pencil(CORNER, BALL, tolerance=x), [*NEVER, 0.0, 1e-9]),
    "pencil_stepover": (lambda x: plan.pencil(CORNER, BALL, passes=2, stepover=x), [*NEVER, 0.0, 1e300]),
    "pencil_ball": (lambda x: plan.pencil(CORNER, riffler.Tool.ball(x, 2 * x), passes=2), [1e6, 1e-9]),
    "locations": (lambda x: located(tolerance=x), [*NEVER, 0.0, 1e-9]),
    "locations_lift": (lambda x: located(max_lift=x), NEVER),
    "margins": (lambda x: BALL.with_margins(shank=x), [*NEVER, -1]),
    "outline": (lambda x: BALL.outline(tolerance=x), [*NEVER, 0.0]),
    "smooth": (lambda x: CORNER.smooth(iterations=2, tolerance=x), [math.nan, -1.0]),
    "decimate": (lambda x: CORNER.decimate(tolerance=x), [math.nan, math.inf, -1.0]),
    "collider": (lambda x: riffler.Collider(CORNER, spacing=x), [*NEVER, 0.0, -1]),
    "collider_stiffness": (lambda x: riffler.Collider(CORNER, stiffness=x), [*NEVER, -1]),
    "material": (lambda x: riffler.Material(stiffness=x), [*NEVER, -1]),
    "session_scale": (lambda x: riffler.Session(block(), BALL, scale=x), [*NEVER, 0.0]),
    "session_force": (lambda x: riffler.Session(block(), BALL, max_force=x), [*NEVER, -1]),
    "session_tolerance": (lambda x: riffler.Session(block(), BALL, tolerance=x), [*NEVER, 0.0, 1e-12]),
}


def fed(feed):
    return riffler.Program(np.array(MOVE), feed, spindle=1000.0, tools={1: BALL})


def corner():
    """A floor at z = 0 and a wall at x = 5."""
    solid, room = (riffler.Volume.block([0, -10, -5], [20, 10, 20], 1.0, "xyz") for _ in range(2))
    return solid.subtract(room.clip([5, 0, 0], [-1, 0, 0]).clip([0, 0, 0], [0, 0, -1])).to_mesh()


CORNER = corner()


def located(**options):
    upright = path().orient({0: UP})
    return plan.cutter_locations(upright, BALL, riffler.Collider(CORNER), **options)


@pytest.mark.parametrize("name", CALLS)
def test_absurd_numbers_are_refused_by_name(name):
    call, numbers = CALLS[name]
    for number in numbers:
        start = time.monotonic()
        with pytest.raises(ValueError) as caught:
            call(number)
        assert time.monotonic() - start < 5 and len(str(caught.value)) > 10, number


def interrupted(script, seconds=30):
    """Seconds until a script that would run for long has ended, after a Ctrl-C."""
    code = f"""
        import _thread, signal, threading, time
        signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell's background jobs ignore it
        import numpy as np
        import riffler
        from riffler import plan
        {textwrap.indent(textwrap.dedent(script), " " * 8).strip()}
        def press():
            time.sleep(1)
            global pressed
            pressed = time.monotonic()
            _thread.interrupt_main()
        threading.Thread(target=press, daemon=True).start()
        try:
            work()
        except KeyboardInterrupt:
            print(time.monotonic() - pressed)
    """
    done = subprocess.run(
        [sys.executable, "-c", textwrap.dedent(code)], capture_output=True, text=True, timeout=seconds, check=False
    )
    assert done.returncode == 0, done.stderr[-2000:]
    return float(done.stdout)


@pytest.mark.parametrize(
    "call", ["riffler.Program.read(name, options=how)", "next(riffler.Program.stream(name, options=how))"]
)
def test_ctrl_c_interrupts_reading_nc_code(call, tmp_path):
    path = tmp_path / "a.ngc"
    path.write_text("o1 repeat [999990]\no2 if [0]\n" + "G1 X1\n" * 20_000 + "o2 endif\no1 endrepeat\nM2\n")
    assert (
        interrupted(f"""
        name, how = {str(path)!r}, {{"max_turns": 1e9}}
        def work():
            {call}
    """)
        < 2
    )


def test_ctrl_c_interrupts_reading_a_mesh(tmp_path):
    path = tmp_path / "a.obj"
    path.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\n" + "f 1 2 3\n" * 200_000)
    assert (
        interrupted(f"""
        def work():
            while True:
                riffler.Mesh.read({str(path)!r})
    """)
        < 2
    )


def test_progress_of_readers_can_cancel(tmp_path):
    path = tmp_path / "a.ngc"
    path.write_text("G1 X1 F100\n" * 50_000)
    with pytest.raises(riffler.Cancelled):
        riffler.Program.read(path, progress=lambda share: False)
    mesh = tmp_path / "a.obj"
    mesh.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\n" + "f 1 2 3\n" * 50_000)
    with pytest.raises(riffler.Cancelled):
        riffler.Mesh.read(mesh, progress=lambda share: False)
    journal = riffler.Journal()
    journal.save(tmp_path / "a.rjournal")
    shares = []
    journal.add_note("a", "b")
    journal.save(tmp_path / "a.rjournal")
    riffler.Journal.load(tmp_path / "a.rjournal", progress=shares.append)
    assert shares
