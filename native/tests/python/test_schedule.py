"""Feeds from the simulated removal, checked with a height map in numpy that each move cuts."""

import math

import numpy as np
import pytest
import riffler

CELL = 0.1
SIZE = (60.0, 24.0)
FLAT = riffler.Tool.flat(diameter=6, length=30)
BALL = riffler.Tool.ball(diameter=6, length=30)


def steps():
    """A stock with steps of 1, 4 and 2 mm above the floor at z = 6."""
    volume = riffler.Volume.block((0, 0, 0), (*SIZE, 10), pitch=0.25)
    wide = riffler.Tool.flat(diameter=24, length=40)
    volume.carve(wide, [(8, y, 7, 0, 0, 1) for y in (-20, 44)])
    volume.carve(wide, [(56, y, 8, 0, 0, 1) for y in (-20, 44)])
    return volume


def heights():
    x, y = np.meshgrid(np.arange(CELL / 2, SIZE[0], CELL), np.arange(CELL / 2, SIZE[1], CELL), indexing="ij")
    return x, y, np.where(x <= 20, 7.0, np.where(x >= 44, 8.0, 10.0))


def judged(program, window=2.0):
    """(row, removal rate in mm³/min) for windows of each move at feed, for upright flat and ball cutters."""
    x, y, z = heights()
    out = []
    for k in range(1, len(program)):
        a, b = program.poses[k - 1, :3], program.poses[k, :3]
        tool = program.tools[int(program.tool[k])]
        r, length = tool.diameter / 2, float(np.linalg.norm(b - a))
        count = max(1, round(length / window))
        for piece in range(count):
            gone = 0.0
            for share in np.linspace(piece / count, (piece + 1) / count, max(2, math.ceil(length / count / CELL) + 1)):
                p = a + share * (b - a)
                i, j = (slice(max(0, int((c - r) / CELL)), max(0, int((c + r) / CELL) + 2)) for c in p[:2])
                square = (x[i, j] - p[0]) ** 2 + (y[i, j] - p[1]) ** 2
                low = p[2] + (0 if tool.kind == "flat" else r - np.sqrt(np.maximum(r * r - square, 0)))
                cut = np.where(square <= r * r, np.maximum(z[i, j] - low, 0), 0)
                gone += cut.sum() * CELL**2
                z[i, j] -= cut
            if not program.rapid[k] and length > 0:
                out.append((k, gone * program.feed[k] / (length / count)))
    return np.array(out)


def path(tool=FLAT, feed=1500.0):
    poses = [(-6, 8, 20, 0, 0, 1), (-6, 8, 6, 0, 0, 1), (66, 8, 6, 0, 0, 1), (66, 15, 6, 0, 0, 1), (-6, 15, 6, 0, 0, 1),
             (-6, 15, 20, 0, 0, 1)]  # fmt: skip
    return riffler.Program(
        poses,
        [0, feed, feed, feed, feed, 0],
        rapid=[True, False, False, False, False, True],
        spindle=9000,
        line=range(1, 7),
        tools={1: tool},
        provenance={"job": "steps"},
    )


@pytest.mark.parametrize("tool", [FLAT, BALL], ids=["flat", "ball"])
def test_the_rate_stays_below_the_limit_and_is_used(tool):
    limit = 9000.0
    before = path(tool)
    assert judged(before)[:, 1].max() > 2 * limit
    after = before.scheduled(steps(), removal_rate=limit)
    row, rates = judged(after).T
    assert rates.max() < 1.06 * limit, "more than the cells of the judge explain"
    slowed = after.feed[row.astype(int)] < 1500
    assert slowed.sum() > 20 and np.quantile(rates[slowed], 0.3) > 0.75 * limit, "slower than need be"
    assert after.feed[~after.rapid].max() == 1500
    assert len(after) < 60, "rows without a jump are divided"


def test_nothing_but_feeds_and_rows_changes():
    before, after = path(), path().scheduled(steps(), removal_rate=9000)
    at = [int(np.flatnonzero((after.poses == pose).all(axis=1) & (after.line == line))[-1]) for pose, line in
          zip(before.poses, before.line, strict=True)]  # fmt: skip
    assert at == sorted(at) and (after.rapid[at] == before.rapid).all() and (after.spindle == 9000).all()
    assert after.provenance == before.provenance and after.tools == before.tools
    for k in range(len(after)):  # each new row is on the move that it divides
        end = int(after.line[k]) - 1
        a, b = before.poses[max(end - 1, 0), :3], before.poses[end, :3]
        way = b - a
        share = np.clip(np.dot(after.poses[k, :3] - a, way) / max(np.dot(way, way), 1e-12), 0, 1)
        assert np.allclose(after.poses[k, :3], a + share * way, atol=1e-9)
    stock = steps()
    first, second = (riffler.verify(program, stock).volume for program in (before, after))
    assert first.volume == pytest.approx(second.volume, abs=1e-6)
    assert stock.volume == steps().volume


def test_a_limit_that_nothing_reaches_changes_nothing():
    before = path()
    after = before.scheduled(steps(), removal_rate=1e9)
    assert (after.poses == before.poses).all() and (after.feed == before.feed).all() and len(after) == len(before)


def test_feeds_rise_where_highest_lets_them():
    before = path(feed=300.0)
    assert before.scheduled(steps(), removal_rate=9000).feed.max() == 300
    after = before.scheduled(steps(), removal_rate=9000, highest=2000)
    assert after.feed.max() == 2000 and judged(after)[:, 1].max() < 1.06 * 9000


def test_a_force_is_a_rate_times_the_constant():
    by_force = path().scheduled(steps(), force=7.5, removal_constant=0.05)
    by_rate = path().scheduled(steps(), removal_rate=9000)
    assert (by_force.feed == by_rate.feed).all() and (by_force.poses == by_rate.poses).all()
    both = path().scheduled(steps(), removal_rate=6000, force=7.5)
    assert judged(both)[:, 1].max() < 1.06 * 6000


def test_axes_that_turn_are_divided_on_their_great_circle():
    lean = [math.sin(0.4), 0, math.cos(0.4)]
    program = riffler.Program([(-6, 8, 6, 0, 0, 1), (66, 8, 6, *lean)], feed=1500, tools={1: BALL})
    after = program.scheduled(steps(), removal_rate=6000)
    share = (after.poses[:, 0] + 6) / 72
    angle = np.arctan2(after.poses[:, 3], after.poses[:, 5])
    assert len(after) > 4 and np.allclose(angle, 0.4 * share, atol=1e-9)
    assert (after.poses[-1] == program.poses[-1]).all()


def test_it_is_the_same_for_any_number_of_threads(monkeypatch):
    found = []
    for threads in ("1", "3"):
        monkeypatch.setenv("RIFFLER_THREADS", threads)
        found.append(path().scheduled(steps(), removal_rate=9000).to_bytes())
    assert found[0] == found[1]


@pytest.mark.parametrize(
    ("wrong", "text"),
    [
        ({}, "removal_rate or force must be given"),
        ({"removal_rate": 0}, "removal_rate must be positive"),
        ({"force": math.inf}, "force must be positive"),
        ({"removal_rate": 9, "lowest": 0}, "lowest must be positive"),
        ({"removal_rate": 9, "lowest": 9, "highest": 3}, "highest must not be less than lowest"),
        ({"force": 1, "removal_constant": -1}, "removal_constant must be positive"),
        (
            {"removal_rate": 900, "lowest": 200},
            r"row \d+, at \(.*\): the limit needs a feed of .* less than lowest, 200",
        ),
        ({"removal_rate": 900, "tools": {}}, None),
    ],
)
def test_impossible_limits_are_named(wrong, text):
    if text is None:
        program = riffler.Program([(0, 8, 6, 0, 0, 1), (9, 8, 6, 0, 0, 1)], feed=100, tool=4)
        with pytest.raises(ValueError, match="tool 4 of row 1 has no known shape; give it in tools"):
            program.scheduled(steps(), **wrong)
        assert program.scheduled(steps(), removal_rate=1e6, tools={4: FLAT}).feed[1] == 100
        return
    with pytest.raises(ValueError, match=text):
        path().scheduled(steps(), **wrong)


def test_empty_programs_and_rapids_alone():
    assert len(riffler.Program(np.zeros((0, 6)), feed=1.0).scheduled(steps(), removal_rate=1)) == 0
    rapids = riffler.Program([(0, 0, 30, 0, 0, 1), (9, 0, 30, 0, 0, 1)], 0, rapid=True)
    assert len(rapids.scheduled(steps(), removal_rate=1)) == 2


def test_it_can_be_cancelled():
    with pytest.raises(riffler.Cancelled):
        path().scheduled(steps(), removal_rate=9000, progress=lambda share: False)
