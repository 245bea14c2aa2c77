"""The stock at any row equals the result of carving up to it in one call, for any order of visits."""

import numpy as np
import pytest
import riffler

from addon.program.pure.program_prefix import LEAST, ProgramPrefix

TOOLS = [riffler.Tool.ball(diameter=6, length=25), riffler.Tool.flat(diameter=4, length=25)]


def block():
    return riffler.Volume.block((0, 0, 0), (30, 20, 10), 1.0, "xyz")


def runs(rng, counts=(150, 90)):
    out = []
    for tool, n in zip(TOOLS, counts, strict=True):
        tips = np.array((15, 10, 8)) + np.cumsum(rng.normal(0, 0.6, (n, 3)), axis=0)
        axes = np.array((0, 0, 1)) + rng.normal(0, 0.2, (n, 3))
        out.append((tool, np.hstack([tips, axes / np.linalg.norm(axes, axis=1, keepdims=True)])))
    return out


def carved(parts, row):
    """All rows up to that one, each run in one call."""
    volume = block()
    for tool, poses in parts:
        some = poses[: max(row + 1, 0)]
        if len(some) > 1:
            volume.carve(tool, some)
        row -= len(poses)
    return volume.to_bytes()


def test_scrubbing_gives_the_bytes_of_carving_the_prefix():
    rng = np.random.default_rng(5)
    parts = runs(rng)
    prefix = ProgramPrefix(block(), parts)
    assert prefix.rows == 240
    visited = [0, 7, 239, 149, 150, 151, 3, 0, *rng.integers(0, 240, 12)]
    for row in map(int, visited):
        assert prefix.step(row, float("inf")) and prefix.row == row
        assert prefix.volume.to_bytes() == carved(parts, row), row
    assert prefix.step(10_000, float("inf")) and prefix.row == 239  # beyond the end


def test_going_back_carves_little_again():
    prefix = ProgramPrefix(block(), runs(np.random.default_rng(6)))
    prefix.step(239, float("inf"))
    assert prefix.carved == 239
    for row in (238, 100, 200, 31):
        before = prefix.carved
        prefix.step(row, float("inf"))
        assert prefix.carved - before < LEAST
    before = prefix.carved
    prefix.step(31, float("inf"))
    assert prefix.carved == before


def test_a_budget_ends_a_step_between_two_rows():
    now = [0.0]

    def clock():
        now[0] += 0.01
        return now[0]

    parts = runs(np.random.default_rng(7), counts=(40, 30))
    prefix, steps = ProgramPrefix(block(), parts, clock=clock), 0
    while not prefix.step(69, 0.02):
        steps += 1
        assert prefix.volume.to_bytes() == carved(parts, prefix.row)
    assert steps > 3 and prefix.volume.to_bytes() == carved(parts, 69)
    assert prefix.pose(39)[0] is TOOLS[0] and prefix.pose(40)[0] is TOOLS[1]
    assert np.array_equal(prefix.pose(69)[1], parts[1][1][-1])


def test_nothing_to_simulate_is_reported():
    with pytest.raises(ValueError, match="nothing to simulate"):
        ProgramPrefix(block(), [])
