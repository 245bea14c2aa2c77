"""riffler pen monitor, calibrate and simulate with the simulated pen, and what they draw and conclude."""

from __future__ import annotations

import csv
import json
import os
import signal
import subprocess
import sys
import time
import tomllib

import numpy as np
import pytest
import riffler
from commands import ENVIRONMENT, RIFFLER, in_shell, result, riffle
from riffler.command.live import SCALE, Braille, History, chart
from riffler.command.pen_calibrate import side_view, toml, tour
from riffler.command.pen_carving import TOOL, block_at, hand_at, table_at
from riffler.command.pen_diagnosis import Postures, bubble_of, joints, judge

terminal = pytest.mark.skipif(sys.platform == "win32", reason="Windows has no pseudo-terminals of this kind")


@pytest.fixture(scope="module")
def geometry():
    return riffler.pen.PenGeometry.load("riffler")


@pytest.fixture(scope="module")
def stroke(geometry):
    """Counts of 64 postures all over the workspace."""
    poses = tour(geometry, geometry.forward([geometry.home])[0])
    return geometry.counts(geometry.inverse([next(poses) for _ in range(64)])[0])


def in_terminal(*words: object, keys: dict[float, bytes], cwd) -> tuple[str, int]:
    """What a command writes to a terminal of 90 columns, and its status; `keys` are pressed at their seconds."""
    import fcntl
    import pty
    import struct
    import termios

    ours, its = pty.openpty()
    fcntl.ioctl(its, termios.TIOCSWINSZ, struct.pack("HHHH", 50, 90, 0, 0))
    env = {**ENVIRONMENT, "TERM": "xterm"}
    command = [*RIFFLER, *map(str, words)]
    process = subprocess.Popen(command, stdin=its, stdout=its, stderr=its, cwd=cwd, env=env, start_new_session=True)
    os.close(its)
    out, start = b"", time.monotonic()
    os.set_blocking(ours, False)
    left = sorted(keys.items())
    while time.monotonic() - start < 60:
        if left and time.monotonic() - start > left[0][0]:
            os.write(ours, left.pop(0)[1])
        try:
            piece = os.read(ours, 65536)
        except BlockingIOError:
            time.sleep(0.02)
            continue
        except OSError:  # the other end is closed
            break
        if not piece:
            break
        out += piece
    os.close(ours)
    return out.decode(errors="replace"), process.wait(10)


# ---- what is drawn


def test_braille_dots_are_at_their_coordinates():
    canvas = Braille(2, 1)
    canvas.dot(0, 0)
    canvas.dot(3, 3)
    assert canvas.lines() == ["⡀⠈"]
    canvas.dot(-1, 0)
    canvas.dot(4, 0)
    canvas.dot(0, 4)
    assert canvas.lines() == ["⡀⠈"]
    canvas.column(1, -5, 99)
    assert canvas.lines() == ["⣸⠈"]
    with pytest.raises(ValueError, match="at least 1"):
        Braille(0, 1)


def test_every_dot_has_its_own_bit():
    seen = set()
    for x in range(2):
        for y in range(4):
            canvas = Braille(1, 1)
            canvas.dot(x, y)
            seen.add(int(canvas.cells[0, 0]))
    assert seen == {1, 2, 4, 8, 16, 32, 64, 128}


def test_a_line_leaves_no_gap():
    canvas = Braille(10, 10)
    canvas.line(0, 0, 19, 39)
    rows = canvas.lines()
    assert rows[0][-1] != "⠀" and rows[-1][0] != "⠀"
    assert all(any(c != "⠀" for c in row) for row in rows)


def test_history_keeps_its_seconds_and_gives_the_range_of_values():
    history = History(10.0)
    for k in range(2001):
        history.add(0.01 * k, np.sin(0.01 * k), 5.0)
    assert len(history.rows) <= 1002
    bands = history.bands(20)
    assert bands.shape == (20, 2, 2)
    edges = 10 + 0.5 * np.arange(21)
    for column in range(20):
        t = np.linspace(edges[column], edges[column + 1], 200)
        np.testing.assert_allclose(bands[column, 0], [np.sin(t).min(), np.sin(t).max()], atol=0.02)
    assert (bands[:, 1] == 5).all()
    assert (bands[1:, 0, 0] <= bands[:-1, 0, 1] + 1e-12).all() and (bands[1:, 0, 1] >= bands[:-1, 0, 0] - 1e-12).all()


def test_history_holds_a_value_until_the_next_and_has_none_before_the_first():
    history = History(10.0)
    assert history.bands(4).shape == (4, 0, 2)
    history.add(0.0, 1.0)
    history.add(4.0, 3.0)
    bands = history.bands(10)[:, 0]
    assert np.isnan(bands[:6]).all() or np.isnan(bands[:5]).all()
    assert bands[-1].tolist() == [1.0, 3.0] and bands[-2].tolist() == [1.0, 1.0]


def test_charts_have_a_scale_and_a_constant_is_a_line_in_the_middle():
    history = History(10.0)
    for k in range(101):
        history.add(0.1 * k, 7.0)
    lines = chart("height  mm", ["z"], history, 60, 5, least=2).plain.split("\n")
    assert lines[0] == "height  mm  z" and len(lines) == 7
    assert all(len(line) <= 60 for line in lines)
    assert lines[1].split("│")[0].strip() == "8" and lines[5].split("│")[0].strip() == "6"
    assert set(lines[3][SCALE:]) <= {"⠤", "⠒", "⠉", "⣀"} and not set(lines[1][SCALE:] + lines[5][SCALE:]) - {"⠀"}
    assert "-10 s" in lines[6] and lines[6].endswith("now")
    empty = chart("force  N", "xyz", History(5.0), 40, 3, least=1, zero=True).plain
    assert "nan" not in empty


# ---- monitor


def test_monitor_prints_a_line_per_second_without_a_terminal(tmp_path):
    done = riffle("pen", "monitor", "simulated", "--seconds", "2.6", cwd=tmp_path)
    assert done.returncode == 0 and done.stderr == ""
    lines = [line for line in done.stdout.splitlines() if "buttons" in line]
    assert len(lines) == 3 and all("connected" in line and "mm/s" in line for line in lines)
    assert "homed" in done.stdout


def test_monitor_writes_a_row_for_each_report_that_it_saw(tmp_path):
    data = result("pen", "monitor", "simulated", "--seconds", "2", "--csv", "a.csv", cwd=tmp_path)
    with (tmp_path / "a.csv").open(newline="") as stream:
        rows = list(csv.DictReader(stream))
    assert len(rows) == data["seen"] > 100
    assert data["link"]["reports"] >= data["seen"] and data["homed"] and data["fault"] == 0
    sequence = [int(row["sequence"]) for row in rows]
    assert sequence == sorted(set(sequence))
    times = np.array([float(row["time_s"]) for row in rows])
    assert (np.diff(times) > 0).all() and times[-1] - times[0] < 2.5
    axes = np.array([[float(row[key]) for key in ("axis_x", "axis_y", "axis_z")] for row in rows])
    np.testing.assert_allclose(np.linalg.norm(axes, axis=1), 1, atol=1e-5)
    assert data["most"]["stretch_mm"] < 0.25 and data["most"]["force_N"] == 0


@terminal
def test_monitor_ends_with_ctrl_c_and_keeps_what_it_saw(tmp_path):
    command = [*RIFFLER, "pen", "monitor", "simulated", "--csv", "a.csv", "--json"]
    # A shell's background jobs are born deaf to Ctrl-C, and this test may be in one.
    awake = {"preexec_fn": lambda: signal.signal(signal.SIGINT, signal.SIG_DFL)}
    process = subprocess.Popen(command, cwd=tmp_path, env=ENVIRONMENT, stdout=subprocess.PIPE, text=True, **awake)
    end = time.monotonic() + 30
    while not list(tmp_path.iterdir()) and time.monotonic() < end:
        time.sleep(0.05)
    time.sleep(1)
    process.send_signal(signal.SIGINT)
    out, _ = process.communicate(timeout=30)
    assert process.returncode == 0
    assert json.loads(out)["seen"] == len((tmp_path / "a.csv").read_text().splitlines()) - 1


@terminal
def test_monitor_draws_in_a_terminal(tmp_path):
    out, status = in_terminal("pen", "monitor", "simulated", "--seconds", "2", keys={}, cwd=tmp_path)
    assert status == 0
    for word in ("position from the start  mm", "force felt  N", "stretch", "lost 0", "Ctrl-C ends it", "⠀"):
        assert word in out


def test_monitor_plays_a_recording(tmp_path):
    journal = riffler.Journal()
    journal.set_stock([0, 0, 0], [10, 10, 10], 1)
    journal.add_tool(1, riffler.Tool.ball(2, length=20))
    times = np.linspace(0, 0.5, 51)
    journal.add_stroke(1, [[t, 0, 5, 0, 0, 1] for t in times], times=times.tolist())
    journal.save(tmp_path / "a.rjournal")
    data = result("pen", "monitor", "a.rjournal", "--seconds", "1", cwd=tmp_path)
    assert data["device"] == "recording" and data["seen"] > 10
    assert data["pose"] == [0.5, 0, 5, 0, 0, 1]
    assert "nothing to calibrate" in riffle("pen", "calibrate", "a.rjournal", "--yes", cwd=tmp_path).stderr


@pytest.mark.parametrize("part", ["monitor", "calibrate"])
def test_a_missing_device_is_reported_with_the_devices_present(part, tmp_path):
    words = ["--yes"] if part == "calibrate" else []
    done = riffle("pen", part, "simulatde", *words, cwd=tmp_path)
    assert done.returncode == 2 and "no device 'simulatde'" in done.stderr and "simulated" in done.stderr
    done = riffle("pen", part, "/dev/hidraw99", *words, cwd=tmp_path)
    assert done.returncode == 2 and "/dev/hidraw99: no such device" in done.stderr
    assert '"simulated" needs no hardware' in done.stderr
    done = riffle("pen", part, "gone.rjournal", *words, cwd=tmp_path)
    assert done.returncode == 2 and done.stderr.count("\n") == 1


def test_files_are_checked_before_a_device_is_opened(tmp_path):
    done = riffle("pen", "monitor", "simulated", "--csv", "a.txt", cwd=tmp_path)
    assert done.returncode == 2 and "--csv a.txt: a name that ends with .csv expected" in done.stderr
    done = riffle("pen", "monitor", "simulated", "--seconds", "0", cwd=tmp_path)
    assert done.returncode == 2 and "--seconds must be positive" in done.stderr


# ---- calibrate


def test_calibrate_passes_a_right_pen_and_keeps_an_existing_report(tmp_path):
    words = "pen", "calibrate", "simulated", "--yes", "--seconds", "5", "--out", "a.toml"
    data = result(*words, cwd=tmp_path)
    assert data["fits"] and data["geometry"] == "riffler" and data["postures"] >= 20
    assert data["stretch"]["most"] < data["stretch"]["tolerance"]
    report = tomllib.loads((tmp_path / "a.toml").read_text())
    assert report["channels"] == {
        "order": ["R2", "R3", "R1", "L2", "L3", "L1"],
        "home": [0, 0, -5133, 0, 0, 5133],
        "sign": [1] * 6,
    }
    low, high = report["ranges"]["L1"]["seen"]
    assert report["ranges"]["L1"]["limits"] == [-0.6, 1.2] and -0.6 < low < high < 1.2
    done = riffle(*words, cwd=tmp_path)
    assert done.returncode == 2 and "a.toml: already exists" in done.stderr and "--force" in done.stderr


def test_lost_counts_are_found_and_named(tmp_path):
    (tmp_path / "a.toml").write_text("old")
    words = "--yes", "--seconds", "8", "--lose", "L1=60", "--out", "a.toml", "--force"
    data = result("pen", "calibrate", "simulated", *words, cwd=tmp_path, status=1)
    assert not data["fits"] and data["joints"] == ["L1"] and "L1 reads" in data["verdict"]
    assert abs(data["channels"]["home"][5] - (5133 + 60)) <= 6
    assert data["stretch"]["most"] > 0.25 > 0.1 > data["stretch"]["rms_after"]
    assert tomllib.loads((tmp_path / "a.toml").read_text())["verdict"] == data["verdict"]


def test_calibrate_names_wrong_arguments(tmp_path):
    def refused(*words: str) -> str:
        done = riffle("pen", "calibrate", *words, cwd=tmp_path)
        assert done.returncode == 2 and done.stdout == ""
        return done.stderr

    assert "run it in a terminal" in refused("simulated")
    assert "JOINT=N expected, of the joints L1, L2" in refused("simulated", "--yes", "--lose", "Q1=3")
    assert "must be a whole number from 1" in refused("simulated", "--yes", "--lose", "L1=x")
    assert "a name that ends with .toml" in refused("simulated", "--yes", "--out", "a.txt")
    assert "move the pen about for longer" in refused("simulated", "--yes", "--seconds", "0.05")


@terminal
def test_calibrate_guides_the_user(tmp_path):
    """Enter where the pen is at home, and Enter where it has been everywhere."""
    keys = {3.0: b"\n", 9.0: b"\n"}
    out, status = in_terminal("pen", "calibrate", "simulated", "--seconds", "40", keys=keys, cwd=tmp_path)
    assert status == 0, out
    for word in ("Home posture of riffler", "press Enter", "lean it to all sides", "█", "the pen is right"):
        assert word in out


def test_one_counter_that_is_off_is_found_in_every_joint(geometry, stroke):
    for k, channel in enumerate(geometry.channels):
        for off in (-200, -60, 40):
            counts = stroke.copy()
            counts[:, k] += off
            found = judge(geometry, counts)
            assert found.channels == (channel.name,) and not found.fits and found.rms_after < 0.02
            assert abs(found.home[k] - (channel.home - off)) <= 1
    assert judge(geometry, stroke).fits


def test_wrong_signs_and_exchanged_plugs_are_found(geometry, stroke):
    names = [c.name for c in geometry.channels]
    gone = stroke - geometry.home
    for k, name in enumerate(names):
        counts = gone.copy()
        counts[:, k] *= -1
        found = judge(geometry, geometry.home + counts)
        assert found.channels == (name,) and found.sign[k] == -1 and "wrong direction" in found.text
    for a, b in ((0, 1), (1, 4), (2, 5), (3, 4)):
        counts = gone.copy()
        counts[:, [a, b]] = counts[:, [b, a]]
        found = judge(geometry, geometry.home + counts)
        assert found.channels == (names[a], names[b]) and "exchanged" in found.text


def test_a_bad_home_posture_is_no_single_counters_fault(geometry, stroke):
    found = judge(geometry, stroke + np.array([150, -90, 200, -120, 60, 90]))
    assert not found.fits and found.channels == () and "home posture" in found.text
    alike = judge(geometry, np.repeat(stroke[:1], 30, axis=0) + np.array([0, 60, 0, 0, 0, 0]))
    assert "too alike" in alike.text


def test_postures_are_kept_where_a_joint_has_turned(geometry, stroke):
    postures = Postures(geometry)
    for row in np.repeat(stroke, 3, axis=0):
        postures.add(row, 0.0)
    assert len(postures.kept) == len(stroke)
    angles = {c.name: (c.sign * stroke[:, k] / c.steps * 2 * np.pi) for k, c in enumerate(geometry.channels)}
    for joint in joints(postures):
        assert (joint.low, joint.high) == pytest.approx((angles[joint.name].min(), angles[joint.name].max()))
        assert 5 < joint.noticed < 40 and not joint.beyond


def test_the_home_posture_is_drawn_from_the_geometry(geometry):
    """At home the upper arms hang and the fore arms are level: an L for each arm, and the grip between their ends."""
    lines = side_view(geometry)
    assert len(lines) == 16 and all(len(line) == 36 for line in lines)
    full = [k for k, line in enumerate(lines) if sum(c != "⠀" for c in line) > 20]
    assert len(full) == 2, "two fore arms, one above the other"
    assert lines[full[0]].rstrip("⠀").endswith("R") and lines[full[1]].rstrip("⠀").endswith("L")
    assert all(any(c != "⠀" for c in line[:4]) for line in lines[1:-1]), "and the upper arms down to them"


def test_bubbles_are_larger_than_the_noise():
    assert bubble_of(np.zeros(4)) == 0.01
    assert bubble_of(np.array([0.0, 0.05, 0.02])) == 0.08
    for noise in np.linspace(0, 0.6, 61):
        assert noise < bubble_of(np.array([noise])) < 1


def test_reports_are_toml():
    data = {
        "text": 'a "b" \\ \t µ',
        "right": True,
        "values": [1, 2.5, "x"],
        "t": {"a": 1, "b": None},
        "r": {"k": {"a": 2}},
    }
    assert tomllib.loads(toml(data)) == {**data, "t": {"a": 1}}


# ---- simulate


def test_the_simulated_hand_carves(tmp_path):
    # On a machine that is busy the force is taken away for a while, and nothing is cut then.
    for seconds in (6, 12, 24):
        folder = tmp_path / str(seconds)
        folder.mkdir()
        words = "--seconds", seconds, "--pitch", "1", "--out", "a.rvol", "--journal", "a.rjournal"
        data = result("pen", "simulate", *words, cwd=folder)
        if data["removed"] > 100:
            break
    assert data["strokes"] >= 1 and data["steps"] > 500
    assert data["removed"] > 100
    assert 0 < data["step_us"]["p50"] <= data["step_us"]["p99"]
    assert data["force_n"] > 0.05 and data["energy_least"] > -1
    block = 50 * 40 * 16
    assert riffler.Volume.load(folder / "a.rvol").volume == pytest.approx(block - data["removed"], rel=1e-12)
    result("volume", "replay", "a.rjournal", "--out", "b.rvol", cwd=folder)
    assert (folder / "a.rvol").read_bytes() == (folder / "b.rvol").read_bytes()
    strokes = riffler.Journal.load(folder / "a.rjournal").strokes
    assert len(strokes) == data["strokes"] and all(len(stroke.poses) > 10 for stroke in strokes)


def test_the_hand_stays_over_the_block_and_goes_down_only_with_its_button_held(geometry):
    home = geometry.forward([geometry.home])[0]
    volume, table = block_at(home, 1.0), table_at(home)
    poses, buttons = zip(*(hand_at(home, t) for t in np.arange(0, 60, 0.02)), strict=True)
    poses, held = np.array(poses), np.array(buttons) == 1
    assert geometry.inverse(poses[::25])[1] == [("reached", "reached")] * len(poses[::25])
    assert (poses[~held, 2] > volume.upper[2]).all()
    assert (poses[:, :2] > volume.lower[:2]).all() and (poses[:, :2] < volume.upper[:2]).all()
    assert held.mean() > 0.5
    clear = table.clearance(riffler.Tool.ball(TOOL, 40.0), poses[::25])
    assert clear[0] > 5 and clear.min() == pytest.approx(-2, abs=0.5), "the last passes press on the table"


def test_a_run_becomes_a_figure(tmp_path):
    pytest.importorskip("matplotlib")
    data = result("pen", "simulate", "--seconds", "3", "--pitch", "1", "--plot", "a.png", cwd=tmp_path)
    png = (tmp_path / "a.png").read_bytes()
    assert data["plot"] == "a.png" and png[:8] == b"\x89PNG\r\n\x1a\n" and len(png) > 20000


def test_simulate_names_wrong_arguments(tmp_path):
    def refused(*words: str, **env: str) -> str:
        done = (in_shell if env else riffle)("pen", "simulate", *words, cwd=tmp_path, **env)
        assert done.returncode == 2 and done.stdout == ""
        return done.stderr

    assert "--stiffness must be positive" in refused("--stiffness", "-1")
    assert "ends with .png" in refused("--plot", "a.pdf")
    pytest.importorskip("matplotlib")
    if sys.platform.startswith("linux"):
        assert "--window needs a display" in refused("--window", DISPLAY="", WAYLAND_DISPLAY="")


@terminal
def test_simulate_draws_in_a_terminal(tmp_path):
    out, status = in_terminal("pen", "simulate", "--seconds", "2", "--pitch", "1", keys={}, cwd=tmp_path)
    assert status == 0
    for word in ("tool from the start  mm", "force felt  N", "energy", "removed", "Ctrl-C ends it"):
        assert word in out
