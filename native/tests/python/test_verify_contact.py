"""Shank, holder and fixtures: hits on the right rows, and on no others."""

import numpy as np
import pytest
import riffler
from verify_reference import (
    HOLDER,
    UP,
    blocks,
    box_mesh,
    held,
    in_frusta,
    kinds,
    line_of_moves,
    near_frusta,
    path,
    points_of,
    program,
    rows,
)

STEP_LOWER, STEP_UPPER = [0, 0, -30], [60, 40, 0]


def stepped(h=0.25):
    """Low on the left (z = -20), high on the right of x = 30 (z = 0)."""
    return blocks(h, STEP_LOWER, STEP_UPPER, ([0, 0, -30], [60, 40, -20]), ([30, 0, -30], [60, 40, 0]))


def test_holder_hits_on_the_right_line_and_not_one_move_earlier():
    tips = line_of_moves([10, 20, -20.5], [24, 20, -20.5], 1.0)  # the holder's lower face at z = -0.5
    report = riffler.verify(program(path(tips), held()), stepped())
    # The first rays of the wall stand at x = 30.125: reached when the tip passes x = 20.125, in the move to 21.
    assert rows(report, "holder") == [11, 12, 13, 14]
    (found,) = [f for f in report.findings if f.kind == "holder"]
    assert (found.line, found.last_line, found.tool, found.member) == (111, 114, 1, "holder")
    # The worst row is the last, from x = 23 to 24: rays within 10 mm of that move, half a millimetre of each.
    x, y = np.meshgrid(30.125 + 0.25 * np.arange(40), 0.125 + 0.25 * np.arange(160), indexing="ij")
    inside = np.hypot(np.maximum(x - 24, 0), y - 20) < 10
    assert found.value == pytest.approx(inside.sum() * 0.5 * 0.25**2, rel=1e-9)
    assert found.point[2] == pytest.approx(-0.25) and found.point[0] > 30
    assert kinds(report) == ["holder"]


@pytest.mark.parametrize(("above", "hit"), [(0.01, False), (0.0, False), (-0.02, True)])
def test_a_holder_that_stays_a_hundredth_of_a_millimetre_above_does_not_hit(above, hit):
    tips = line_of_moves([10, 20, -20 + above], [26, 20, -20 + above], 0.5)
    report = riffler.verify(program(path(tips), held()), stepped())
    assert kinds(report) == (["holder"] if hit else [])


def test_one_long_move_and_many_short_ones_hit_alike():
    for step in (100.0, 1.0, 0.01):
        tips = line_of_moves([10, 20, -20.5], [26, 20, -20.5], step)
        found = rows(riffler.verify(program(path(tips), held()), stepped()), "holder")
        first = tips[found[0], 0]
        assert 20.125 < first <= 20.125 + step + 0.03 or step > 10
        assert found == list(range(found[0], len(tips)))


def test_a_shank_wider_than_the_cutter_is_found():
    tool = riffler.Tool.ball(6, 15).with_shank([(15, 5, 60, 5)]).with_holder([(60, 10, 90, 10)])
    tips = line_of_moves([10, 20, -20.5], [26.5, 20, -20.5], 0.5)
    report = riffler.verify(program(path(tips), tool), stepped())
    # The shank reaches the wall's first rays at x = 25.125.
    assert kinds(report) == ["shank"] and rows(report, "shank")[0] == np.argmax(tips[:, 0] > 25.135)


def test_material_removed_by_an_earlier_move_is_not_hit():
    """A pocket that only the cutter's own passes make room in: the holder is as low as the stock's top all the time."""
    tool = riffler.Tool.flat(20, 5).with_holder([(5, 9, 60, 9)])
    stock = riffler.Volume.block([0, 0, -20], [60, 40, 0], 0.25)
    tips = [[-15, 20, 2]]
    for z in (-4, -8, -12):
        tips += [[-15, 20, z], [40, 20, z], [-15, 20, z]]
    assert kinds(riffler.verify(program(path(tips), tool), stock)) == []
    # Without the pass before it the second one is too deep.
    assert kinds(riffler.verify(program(path(np.delete(tips, [1, 2, 3], axis=0)), tool), stock)) == ["holder"]


def test_a_thin_shank_may_follow_its_cutter_in_one_plunge():
    tool = riffler.Tool.flat(6, 4).with_shank([(4, 2, 60, 2)]).with_holder([(60, 10, 80, 10)])
    stock = riffler.Volume.block([0, 0, -40], [20, 20, 0], 0.25)
    down = program(path([[10, 10, 5], [10, 10, -30]]), tool)
    assert kinds(riffler.verify(down, stock)) == []
    # And it must not come first: up from below, the shank would meet the roof before the cutter does.
    cave = blocks(0.25, [0, 0, -40], [20, 20, 0], ([0, 0, -10], [20, 20, -5]))
    up = program(path([[10, 10, -80], [10, 10, -2]]), riffler.Tool.flat(6, 4).with_shank([(4, 2, 40, 2)]))
    assert "shank" in kinds(riffler.verify(up, cave))


def test_tilting_into_a_wall_hits_on_the_row_that_dense_sampling_finds():
    tool = held()
    angles = np.radians(np.arange(0, 31, 1.0))
    axes = np.column_stack([np.sin(angles), 0 * angles, np.cos(angles)])
    poses = np.column_stack([np.tile([18.0, 20.0, -19.5], (len(angles), 1)), axes])
    stock = stepped()
    # As close as the rays: the depth grows by 0.36 mm from row to row where the holder comes in.
    points = near_frusta(points_of(stock, 0.2, lower=(29, -1, -12)), HOLDER, poses)
    depth = np.array(
        [in_frusta(near_frusta(points, HOLDER, pose[None]), HOLDER, pose).max(initial=-9) for pose in poses]
    )
    assert not ((depth > 0) & (depth < 0.03)).any(), "the scene should leave no doubt"
    report = riffler.verify(program(poses, tool), stock)
    assert rows(report, "holder") == np.flatnonzero(depth > 0.02).tolist()


@pytest.mark.parametrize("seed", range(4))
def test_five_axis_hits_agree_with_dense_sampling(seed):
    rng = np.random.default_rng(seed)
    tool = riffler.Tool.ball(4, 10).with_shank([(10, 2, 16, 3)]).with_holder([(16, 6, 30, 8)])
    stock = blocks(0.5, [0, 0, -12], [24, 24, 6], ([0, 0, -12], [24, 24, -6]), ([14, 0, -12], [24, 24, 6]))
    poses, wanted = [], {"shank": [], "holder": []}
    unsure = set()
    last = None
    left = stock.copy()
    for row in range(25):
        axis = UP + rng.normal(size=3) * [0.35, 0.35, 0]
        pose = np.append(rng.uniform([2, 2, -6], [14, 22, 0]), axis / np.linalg.norm(axis))
        poses.append(pose)
        if last is not None:
            left.carve(tool, np.array([last, pose]))
            points = points_of(left, 0.25, lower=(-1, -1, -1))  # neither shank nor holder comes lower
            t = np.linspace(0, 1, 80)[:, None]
            angle = np.arccos(np.clip(last[3:] @ pose[3:], -1, 1))
            way = (np.sin((1 - t) * angle) * last[3:] + np.sin(t * angle) * pose[3:]) / np.sin(angle)
            tips = last[:3] + t * (pose[:3] - last[:3])
            for name, frusta in (("shank", [(10, 2, 16, 3)]), ("holder", [(16, 6, 30, 8)])):
                near = near_frusta(points, frusta, np.column_stack([tips, way]))
                sampled = (in_frusta(near, frusta, np.append(p, a)) for p, a in zip(tips, way, strict=True))
                depth = max(found.max(initial=-np.inf) for found in sampled)
                if depth > 0.02:
                    wanted[name].append(row)
                elif depth > -0.3:
                    unsure.add((name, row))  # between samples
        last = pose
    report = riffler.verify(program(np.array(poses), tool), stock)
    for name in ("shank", "holder"):
        found = set(rows(report, name))
        # What the material hits before this move's cutter has taken it is found on top of what is left after it.
        before = {r for r in found - set(wanted[name]) if (name, r) not in unsure}
        assert set(wanted[name]) <= found and len(before) <= 3, (name, found, wanted[name])
    assert wanted["holder"] or wanted["shank"]


def test_a_tool_whose_description_ends_below_material_does_not_pass():
    bare = riffler.Tool.flat(6, 5)
    stock = riffler.Volume.block([0, 0, -20], [60, 40, 0], 0.25)
    slot = lambda z: program(path([[-10, 20, z], [70, 20, z]]), bare)  # noqa: E731
    assert riffler.verify(slot(-4.5), stock).passed
    deep = riffler.verify(slot(-6), stock)
    assert kinds(deep) == ["unknown"] and not deep.passed and "describe the shank" in deep.findings[0].message
    assert any("tool 1" in sentence for sentence in deep.not_checked)
    with_holder = bare.with_shank([(5, 2, 6, 2)]).with_holder([(6, 2, 8, 2)])
    beyond = riffler.verify(program(path([[-10, 20, -12], [70, 20, -12]]), with_holder), stock)
    (unknown,) = [f for f in beyond.findings if f.kind == "unknown"]
    assert "describe the shank" not in unknown.message, "they are described"
    assert unknown.message.startswith("the holder of tool 1 ends 8.000 mm above the tip, and material stands above")


# --- fixtures ------------------------------------------------------------------------------------------------------


def test_fixtures_are_met_by_cutter_and_holder_on_the_right_rows():
    stock = riffler.Volume.block([0, 0, -10], [60, 40, 0], 0.25)
    clamp = box_mesh([40, 15, -10], [50, 25, 8])
    vise = riffler.Volume.block([0, -20, -10], [60, -1, -5], 0.5)
    tips = line_of_moves([5, 20, -1], [45, 20, -1], 1.0)
    report = riffler.verify(program(path(tips), held()), stock, None, [vise, clamp])
    # The clamp's first rays at x = 40.125; the ball's equator passes 3 mm ahead of the tip.
    assert rows(report, "fixture") == [r for r in range(len(tips)) if tips[r, 0] + 3 > 40.125]
    (found,) = report.findings
    assert (found.fixture, found.member) == (1, "cutter") and "fixture 2" in found.message
    over = path(line_of_moves([5, 20, 8], [45, 20, 8], 1.0))  # its tip just touches the clamp's top
    assert riffler.verify(program(over, held()), stock, None, [vise, clamp]).passed
    tall = box_mesh([40, 15, -10], [50, 25, 19.5])  # below the holder's face by half a millimetre, next to the shank
    report = riffler.verify(program(path([[5, 20, -1], [31, 20, -1]]), held()), stock, None, [tall])
    assert kinds(report) == ["fixture"] and report.findings[0].member == "holder"
