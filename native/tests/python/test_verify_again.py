"""A verification says the same, byte for byte, however the work is split; what is not needed is not done."""

import os
import subprocess
import sys

import numpy as np
import pytest
import riffler
from verify_reference import UP, busy_program, busy_scene, held, kinds, path, program, raster, state


def test_chunks_of_any_length_and_a_kept_verification_report_the_same():
    poses, rapid, tool, stock, part, fixtures = busy_scene()
    whole = busy_program(poses, rapid, tool)
    report = riffler.verify(whole, stock, part, fixtures)
    assert {"rapid", "holder", "fixture", "gouge"} <= set(kinds(report))
    for length in (1, 7, 250):
        starts = range(0, len(poses) - 1, length)
        chunks = (
            program(poses[a : a + length + 1], tool, rapid=rapid[a : a + length + 1],
                    feed=np.where(rapid[a : a + length + 1], 0, 1000), line=np.arange(len(poses))[a : a + length + 1])
            for a in starts
        )  # fmt: skip
        assert state(riffler.verify(chunks, stock, part, fixtures)) == state(report)
    assert state(riffler.Verification(stock, part, fixtures).run(whole)) == state(report)


def test_the_report_is_the_same_for_any_number_of_threads():
    code = (
        "import hashlib, test_verify as t, riffler\n"
        "poses, rapid, tool, stock, part, fixtures = t.busy_scene()\n"
        "r = riffler.verify(t.busy_program(poses, rapid, tool), stock, part, fixtures)\n"
        "print(hashlib.sha256(repr(t.state(r)).encode()).hexdigest(), r.stats)\n"
    )
    out = []
    for threads in ("1", "4"):
        places = os.pathsep.join(map(os.path.abspath, sys.path))
        environment = os.environ | {"RIFFLER_THREADS": threads, "PYTHONPATH": places}
        command = [sys.executable, "-c", code]
        folder = os.path.dirname(__file__)
        out.append(subprocess.run(command, env=environment, check=True, stdout=subprocess.PIPE, cwd=folder).stdout)
    assert out[0] == out[1] and len(out[0]) > 64


@pytest.mark.parametrize("seed", range(5))
def test_after_any_edit_the_report_is_that_of_a_fresh_run(seed):
    rng = np.random.default_rng(seed)
    poses, rapid, tool, stock, part, fixtures = busy_scene()
    kept = riffler.Verification(stock, part, fixtures)
    kept.run(busy_program(poses, rapid, tool))
    for _ in range(6):
        n = len(poses)
        at = int(rng.integers(1, n))
        match rng.integers(5):
            case 0:
                poses[at, 2] -= 0.7
            case 1:
                poses = np.insert(poses, at, [[*rng.uniform([0, 0, -8], [60, 40, 4]), *UP]], axis=0)
                rapid = np.insert(rapid, at, bool(rng.integers(2)))
            case 2:
                poses, rapid = np.delete(poses, [at], axis=0), np.delete(rapid, [at])
            case 3:
                poses = np.vstack([poses, [[*rng.uniform([0, 0, -8], [60, 40, 4]), *UP]]])
                rapid = np.append(rapid, False)
            case 4:  # several places at once, the number of rows unchanged
                for k in rng.integers(1, n, 3):
                    rapid[k] = ~rapid[k]
        edited = busy_program(poses, rapid, tool)
        again = kept.run(edited)
        assert state(again) == state(riffler.verify(edited, stock, part, fixtures))
    other = tool.with_holder([(14, 8, 40, 11)])
    edited = busy_program(poses, rapid, other)
    assert state(kept.run(edited)) == state(riffler.verify(edited, stock, part, fixtures))


def test_the_cost_of_an_edit_follows_what_it_touches():
    tips = raster(100, 1, -2, step=0.25)
    tool = held()
    stock = riffler.Volume.block([0, 0, -20], [100, 100, 0], 0.25)
    kept = riffler.Verification(stock)
    first = kept.run(program(path(tips), tool)).stats
    same = kept.run(program(path(tips), tool)).stats
    assert same.moves == 0 and same.slabs_kept == 49 and first.slabs_kept == 0
    tips[len(tips) // 2, 2] -= 0.5
    report = kept.run(program(path(tips), tool))
    assert report.stats.moves < 0.2 * first.moves and report.stats.slabs_kept >= 45
    assert state(report) == state(riffler.verify(program(path(tips), tool), stock))
    # At the end of the program the snapshots help too.
    tips[-200, 2] -= 0.5
    report = kept.run(program(path(tips), tool))
    assert report.stats.snapshots_used > 0 and report.stats.moves < 0.02 * first.moves
    assert state(report) == state(riffler.verify(program(path(tips), tool), stock))


def test_holders_above_the_stock_cost_nothing():
    tips = raster(100, 2, -2)
    stock = riffler.Volume.block([0, 0, -10], [100, 100, 0], 0.25)
    assert riffler.verify(program(path(tips), held()), stock).stats.probes == 0
