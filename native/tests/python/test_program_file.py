"""Programs as .rprog files: to the bit and back, pickled, cancelled, damaged."""

import copy
import pickle

import numpy as np
import pytest
import riffler
from hypothesis import given, settings
from hypothesis import strategies as st

FIXED = settings(derandomize=True, deadline=None, max_examples=60, database=None)
TOOL = riffler.Tool.taper(1, 0.2, 12, 60).with_shank([(60, 6, 80, 8)]).with_holder([(80, 20, 120, 20)]).named("é")


def program(n=100, seed=0):
    rng = np.random.default_rng(seed)
    axes = rng.normal(size=(n, 3))
    axes /= np.linalg.norm(axes, axis=1)[:, None]
    rapid = rng.random(n) < 0.2
    return riffler.Program(
        np.hstack([rng.normal(size=(n, 3)) * 50, axes]), np.where(rapid, 0, rng.uniform(1, 9e3, n)), rapid=rapid,
        tool=rng.integers(0, 4, n), line=rng.integers(0, 99, n), spindle=rng.normal(size=n) * 9e3,
        tools={1: riffler.Tool.ball(6, 30), 3: TOOL}, provenance={"part": "Ünal", "": "x"},
    )  # fmt: skip


def assert_same(a, b):
    for name in ("poses", "feed", "rapid", "tool", "line", "spindle"):
        one, other = getattr(a, name), getattr(b, name)
        assert one.dtype == other.dtype and one.tobytes() == other.tobytes(), name
    assert a.provenance == b.provenance
    assert {n: t.to_dict() for n, t in a.tools.items()} == {n: t.to_dict() for n, t in b.tools.items()}


def test_everything_reads_back_to_the_bit(tmp_path):
    for n in (0, 1, 100, 40_000):
        p = program(n)
        p.save(tmp_path / "p.rprog")
        back = riffler.Program.load(tmp_path / "p.rprog")
        assert_same(p, back)
        assert (tmp_path / "p.rprog").read_bytes() == p.to_bytes() == back.to_bytes()
    assert [path.name for path in tmp_path.iterdir()] == ["p.rprog"]


def test_programs_are_pickled_and_copied():
    p = program()
    assert_same(p, pickle.loads(pickle.dumps(p)))
    assert_same(p, copy.deepcopy(p))


def test_a_recording_becomes_a_program_and_a_file(tmp_path):
    t = np.linspace(0, 1, 50)
    poses = np.column_stack([30 * t, np.sin(9 * t), -t, 0 * t, 0 * t, 1 + 0 * t])
    journal = riffler.Journal()
    journal.set_stock((0, -5, -5), (30, 5, 0), 0.5)
    journal.add_tool(2, TOOL)
    journal.add_note("artist", "Ünal")
    journal.add_stroke(2, poses, times=4 * t)
    journal.save(tmp_path / "s.rjournal")
    p = riffler.Journal.load(tmp_path / "s.rjournal").program(spindle=9000)
    cut = p.poses[~p.rapid]
    assert cut.tobytes() == poses.tobytes() and set(p.tool) == {2} and p.tools[2].to_dict() == TOOL.to_dict()
    way = np.linalg.norm(np.diff(poses[:, :3], axis=0), axis=1)
    np.testing.assert_allclose(p.feed[~p.rapid][1:], 60 * way / np.diff(4 * t), rtol=1e-12)
    p.save(tmp_path / "s.rprog")
    assert_same(p, riffler.Program.load(tmp_path / "s.rprog"))


def test_a_cancelled_save_leaves_the_old_file(tmp_path):
    file = tmp_path / "p.rprog"
    program().save(file)
    old = file.read_bytes()
    with pytest.raises(riffler.Cancelled):
        program(50_000, 1).save(file, progress=lambda share: False)
    assert file.read_bytes() == old
    with pytest.raises(riffler.Cancelled):
        riffler.Program.load(file, progress=lambda share: False)
    shares = []
    riffler.Program.load(file, progress=shares.append)
    assert shares == sorted(shares) and shares[-1] == 1


def test_other_files_are_recognised_and_refused(tmp_path):
    file = tmp_path / "p.rprog"
    file.write_text("G21\n")
    with pytest.raises(riffler.FormatError, match=r"^p\.rprog, byte 0: not a \.rprog file"):
        riffler.Program.load(file)
    with pytest.raises(riffler.FormatError, match=r"^none\.rprog: cannot be opened"):
        riffler.Program.load(tmp_path / "none.rprog")
    with pytest.raises(RuntimeError):
        program().save(tmp_path / "no" / "p.rprog")


GOOD = program(40).to_bytes()


@FIXED
@given(st.integers(0, len(GOOD) - 1), st.integers(1, 255))
def test_any_damaged_byte_is_found(at, flip):
    damaged = bytearray(GOOD)
    damaged[at] ^= flip
    with pytest.raises(riffler.FormatError, match="byte "):
        riffler.Program.from_bytes(bytes(damaged))
    with pytest.raises(riffler.FormatError, match="byte "):
        riffler.Program.from_bytes(GOOD[:at])
