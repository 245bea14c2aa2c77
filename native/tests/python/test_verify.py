"""Verification of programs, judged by a height map, dense sampling and closed forms of the test's own."""

import numpy as np
import pytest
import riffler
from riffler import deprecated
from verify_reference import (
    UP,
    HeightMap,
    blocks,
    box_mesh,
    busy_program,
    busy_scene,
    held,
    kinds,
    line_of_moves,
    path,
    program,
    rows,
    state,
    tops,
)

# --- cutting -------------------------------------------------------------------------------------------------------

CUTTERS = {
    "flat": (lambda: riffler.Tool.flat(6, 40), (3.0, 0.0)),
    "ball": (lambda: riffler.Tool.ball(6, 40), (3.0, 3.0)),
    "bull": (lambda: riffler.Tool.fillet(8, 1, 40), (4.0, 1.0)),
}


def random_program(seed, n, rapids=0.25):
    """Moves of all lengths over and in a block from z = -10 to 0, rapids high up and deep down."""
    rng = np.random.default_rng(seed)
    tips = np.column_stack([rng.uniform(-4, 34, n), rng.uniform(-4, 24, n), rng.uniform(-6, 1, n)])
    rapid = rng.random(n) < rapids
    tips[rapid & (rng.random(n) < 0.6), 2] = 3.0
    still = rng.random(n) < 0.2  # plunges and retracts
    for row in np.flatnonzero(still[1:]) + 1:
        tips[row, :2] = tips[row - 1, :2]
    return tips, rapid


@pytest.mark.parametrize("cutter", CUTTERS)
@pytest.mark.parametrize("seed", range(6))
def test_three_axis_programs_are_cut_like_a_height_map(cutter, seed):
    make, profile = CUTTERS[cutter]
    lower, upper, h = [0, 0, -10], [30, 20, 0], 0.5
    tips, rapid = random_program(seed, 60)
    report = riffler.verify(program(path(tips), make(), rapid=rapid), riffler.Volume.block(lower, upper, h))
    heights = HeightMap(lower, upper, h)
    removed, deepest = np.zeros(len(tips)), np.zeros(len(tips))
    for row in range(1, len(tips)):
        lost = heights.cut(profile, tips[row - 1], tips[row])
        removed[row], deepest[row] = lost.sum() * h * h, lost.max()
    assert np.abs(tops(report.volume) - heights.z).max() < 1e-7
    assert np.abs(report.removed - removed).max() < 1e-5
    assert rows(report, "rapid") == np.flatnonzero(rapid & (deepest > 0.01)).tolist()
    assert any(rows(report, "rapid")), "the program should have some"
    for f in report.findings:
        if f.kind == "rapid":
            assert f.value == pytest.approx(removed[f.row : f.last_row + 1].sum(), rel=1e-6)
            assert f.unit == "mm³" and f.line == f.row + 100 and f.last_line == f.last_row + 100
    assert not report.passed


@pytest.mark.parametrize("directions", ["z", "xyz"])
def test_slabs_together_equal_the_stock_carved_as_a_whole(directions):
    tool = riffler.Tool.fillet(6, 1, 30)
    rng = np.random.default_rng(5)
    axis = rng.normal(size=(80, 3)) * [0.3, 0.3, 0] + UP
    poses = np.column_stack([rng.uniform([0, 0, -6], [60, 40, 2], (80, 3)), axis])
    poses[:, 3:] /= np.linalg.norm(poses[:, 3:], axis=1)[:, None]
    stock = riffler.Volume.block([0, 0, -10], [60, 40, 0], 0.25, directions)
    before = stock.to_bytes()
    report = riffler.verify(program(poses, tool), stock)
    whole = stock.copy()
    cut = whole.carve(tool, poses)
    assert report.volume.to_bytes() == whole.to_bytes()
    assert np.allclose(report.removed[1:], cut.removed, rtol=1e-12, atol=1e-12)
    assert stock.to_bytes() == before


# --- the part ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("directions", ["z", "xyz"])
def test_a_gouge_of_known_depth_is_found_on_its_lines(directions):
    part = box_mesh([0, 0, -20], [40, 30, -5])
    stock = riffler.Volume.block([0, 0, -20], [40, 30, 0], 0.25, directions)
    tips = line_of_moves([-10, 15, -5], [50, 15, -5], 1.0)
    tips[25:31, 2] = -5.2
    report = riffler.verify(program(path(tips), riffler.Tool.flat(6, 30)), stock, part)
    assert kinds(report) == ["gouge"]
    (found,) = report.findings
    # The move into the depth and the move out of it gouge too.
    assert (found.row, found.last_row, found.line, found.last_line) == (25, 31, 125, 131)
    assert found.value == pytest.approx(0.2, abs=0.004) and found.unit == "mm"
    mesh, distance = report.stock_deviation()
    assert len(distance) == len(mesh.vertices) and distance.min() == pytest.approx(-0.2, abs=0.01)
    finer = riffler.verify(program(path(tips), riffler.Tool.flat(6, 30)), stock, part, gouge_tolerance=0.25)
    assert finer.passed


@pytest.mark.parametrize("cutter", CUTTERS)
def test_gouges_of_random_programs_are_as_deep_as_on_the_height_map(cutter):
    make, profile = CUTTERS[cutter]
    lower, upper, h = [0, 0, -10], [30, 20, 0], 0.5
    tips, rapid = random_program(11, 60)
    tips[:, 2] -= 1.5
    part = box_mesh([3, 4, -10], [26, 17, -3])
    report = riffler.verify(program(path(tips), make(), rapid=rapid), riffler.Volume.block(lower, upper, h), part)
    heights = HeightMap(lower, upper, h)
    side = np.minimum(np.minimum(heights.x - 3, 26 - heights.x), np.minimum(heights.y - 4, 17 - heights.y))
    wanted = np.zeros(len(tips))
    for row in range(1, len(tips)):
        before = heights.z.copy()
        lost = heights.cut(profile, tips[row - 1], tips[row]) > 1e-6
        # Halfway down the part is farthest from its top and its bottom.
        deepest = np.clip(-6.5, heights.z, np.minimum(before, -3))
        depth = np.minimum(side, np.minimum(-3 - deepest, deepest + 10))
        wanted[row] = depth[lost].max(initial=0)
    assert not ((wanted > 0.049) & (wanted < 0.051)).any(), "the scene should leave no doubt"
    assert rows(report, "gouge") == np.flatnonzero(wanted > 0.05).tolist() and wanted.max() > 1
    for f in report.findings:
        if f.kind == "gouge":
            worst = wanted[f.row : f.last_row + 1].max()
            assert 0.99 * worst - 1e-6 <= f.value <= worst + 1e-6


def test_a_hole_drilled_through_the_part_is_as_deep_as_its_middle():
    part = box_mesh([0, 0, -20], [40, 30, -5])
    stock = riffler.Volume.block([0, 0, -20], [40, 30, 0], 0.5)
    report = riffler.verify(program(path([[20, 15, 5], [20, 15, -30]]), riffler.Tool.flat(6, 60)), stock, part)
    (found,) = [f for f in report.findings if f.kind == "gouge"]
    assert found.value == pytest.approx(7.5, rel=0.02) and found.row == 1
    assert found.point[2] == pytest.approx(-12.5, abs=0.2)


def test_rest_material_is_mapped_with_the_height_of_the_cusps():
    radius, over = 3.0, 2.0
    cusp = radius - np.sqrt(radius**2 - (over / 2) ** 2)
    part = box_mesh([0, 0, -10], [30, 30, -5])
    stock = riffler.Volume.block([0, 0, -10], [30, 30, 0], 0.2)  # rays stand on the cusps
    tips = []
    for k, y in enumerate(np.arange(-4.1, 34.1, over)):
        tips += [[-5, y, -5], [35, y, -5]][:: 1 if k % 2 == 0 else -1]
    whole = program(path(tips), riffler.Tool.ball(6, 30))
    report = riffler.verify(whole, stock, part)
    mesh, distance = report.stock_deviation()
    assert tops(report.volume)[10:-10, 10:-10].max() == pytest.approx(cusp - 5, abs=1e-6)
    # Between the rays the mesh cuts the cusps off, by half a pitch times their slope.
    slack = 0.1 * (over / 2) / (radius - cusp) + 0.005
    inner = np.all((mesh.vertices[:, :2] > 2) & (mesh.vertices[:, :2] < 28), axis=1) & (mesh.vertices[:, 2] > -7)
    assert cusp - slack < distance[inner].max() < cusp + 0.001 and distance[inner].min() > -0.01
    assert report.passed and any("rest" in sentence for sentence in report.not_checked)
    assert riffler.verify(whole, stock, part, rest_tolerance=cusp + 0.001).passed
    judged = riffler.verify(whole, stock, part, rest_tolerance=cusp - 0.001)
    assert kinds(judged) == ["rest"] and judged.findings[0].value == pytest.approx(cusp, abs=1e-6)


def test_old_attributes_of_a_report_give_what_the_methods_do():
    block = riffler.Volume.block((0, 0, 0), (10, 10, 5), 0.5, "xyz")
    report = riffler.verify(riffler.Program([[5, 5, 9, 0, 0, 1]], feed=600), block, block.to_mesh())
    deprecated.forget()
    with pytest.warns(DeprecationWarning, match=r"VerifyReport.deviation is deprecated, use .*stock_deviation\(\)"):
        assert report.deviation is report.stock_deviation()
    with pytest.warns(DeprecationWarning, match=r"VerifyReport.part_map is deprecated, use .*part_deviation\(\)"):
        assert report.part_map is report.part_deviation()


def test_the_part_map_measures_the_material_over_the_part():
    part = box_mesh([0, 0, -10], [30, 30, -5])
    stock = riffler.Volume.block([0, 0, -10], [30, 30, 0], 0.5)
    report = riffler.verify(program(path([[-20, 0, 9], [-20, 0, 10]]), riffler.Tool.ball(6, 30)), stock, part)
    top = part.vertices[:, 2] > -6
    assert report.part_deviation().shape == (8,) and np.abs(report.part_deviation()[~top]).max() < 0.3
    empty = riffler.Volume.block([100, 100, 100], [101, 101, 101], 0.5)
    nothing = riffler.verify(
        program(path([[100.5, 100.5, 90], [100.5, 100.5, 110]]), riffler.Tool.flat(6, 30)), empty, part
    )
    assert np.all(nothing.part_deviation() == -np.inf) and len(nothing.stock_deviation()[1]) == 0


def test_a_stock_that_lacks_some_of_the_part_is_reported_before_the_first_move():
    part = box_mesh([0, 0, -10], [30, 30, 2])
    stock = riffler.Volume.block([0, 0, -10], [30, 30, 0], 0.5)
    moves = program(path([[-20, 0, 9], [-20, 0, 10]]), riffler.Tool.ball(6, 30))
    report = riffler.verify(moves, stock, part)
    assert [(f.kind, f.row) for f in report.findings] == [("gouge", 0)]
    assert report.findings[0].value == pytest.approx(2)
    hollow = blocks(0.5, [0, 0, -10], [30, 30, 0], ([0, 0, -10], [30, 30, -4]))
    (found,) = riffler.verify(moves, hollow, box_mesh([0, 0, -10], [30, 30, 0])).findings
    assert found.row == 0 and found.value == pytest.approx(4, rel=0.02)


# --- other checks --------------------------------------------------------------------------------------------------


def test_a_feed_into_material_with_a_standing_spindle_is_found():
    stock = riffler.Volume.block([0, 0, -10], [60, 40, 0], 0.5)
    poses = path([[-10, 20, 5], [-10, 20, -1], [20, 20, -1], [40, 20, -1]])
    report = riffler.verify(program(poses, held(), spindle=[0, 0, 0, 500]), stock)
    assert [(f.kind, f.row, f.last_row) for f in report.findings] == [("spindle", 2, 2)]


def test_times_and_rates_follow_the_feed():
    stock = riffler.Volume.block([0, 0, -10], [60, 40, 0], 0.5)
    tilted = [np.sin(0.5), 0, np.cos(0.5)]
    poses = np.vstack([path([[-10, 20, 5], [-10, 20, -1], [50, 20, -1]]), np.append([50, 20, -1], tilted)])
    report = riffler.verify(program(poses, held(), feed=[0, 0, 600, 600], rapid=[1, 1, 0, 0]), stock, rapid_feed=6000)
    assert report.seconds == pytest.approx([0, 0.06, 6.0, np.degrees(0.5) / 60])
    assert report.time == pytest.approx(report.seconds.sum())
    assert report.rate[2] == pytest.approx(report.removed[2] / 6 * 60) and report.rate[0] == 0


def test_rapids_before_the_first_tool_are_skipped_and_reported():
    stock = riffler.Volume.block([0, 0, -10], [60, 40, 0], 0.5)
    poses = path([[0, 0, 50], [10, 10, 50], [10, 10, 5]])
    report = riffler.verify(program(poses, held(), rapid=[1, 1, 1], feed=0, tool=[0, 0, 1]), stock)
    assert report.passed and any("before a tool" in sentence for sentence in report.not_checked)


# --- bad input -----------------------------------------------------------------------------------------------------


def test_bad_input_is_one_clear_error_and_changes_nothing():
    stock = riffler.Volume.block([0, 0, -10], [20, 20, 0], 0.5)
    before = stock.to_bytes()
    good = program(path([[-10, 10, 5], [-10, 10, -1], [30, 10, -1]]), riffler.Tool.ball(6, 30))
    unknown = program(path([[-10, 10, 5], [-10, 10, -1], [30, 10, -1]]), None, tool=[3, 3, 3])
    part = box_mesh([0, 0, -10], [20, 20, -1])
    cases = [
        (lambda: riffler.verify(unknown, stock), "tool 3 is unknown (row 1, line 101)"),
        (lambda: riffler.verify(unknown, stock, tools={3: "ball"}), "tools must be a dict"),
        (lambda: riffler.verify(good, stock, tolerance=0), "tolerance must be a positive length"),
        (lambda: riffler.verify(good, stock, gouge_tolerance=float("nan")), "gouge_tolerance"),
        (lambda: riffler.verify(good, stock, part, rest_tolerance=-1), "rest_tolerance"),
        (lambda: riffler.verify(good, stock, rest_tolerance=0.1), "no part to compare"),
        (lambda: riffler.verify(good, stock, rapid_feed=0), "rapid_feed"),
        (lambda: riffler.verify(good, stock, part_mesh=stock), "part_mesh"),
        (lambda: riffler.verify(good, stock, fixtures=[part, 3]), "fixtures, number 1"),
        (lambda: riffler.verify(good, stock, fixtures=part), "fixtures must be a list"),
        (lambda: riffler.verify(3, stock), "iterable of Programs"),
        (lambda: riffler.verify([good, 3], stock), "iterable of Programs"),
        (lambda: riffler.verify([good, good], stock), "a chunk must begin with the row"),
        (
            lambda: riffler.verify(
                program(np.vstack([path([[0, 0, 5]]), path([[9, 0, 5]], [0, 0, -1])]), held()), stock
            ),
            "row 1: the axis is exactly opposite",
        ),
        (
            lambda: riffler.verify(program(path([[0, 0, 5], [9, 0, 5]]), held(), tool=[0, 0]), stock),
            "before any tool is called (row 1, line 101)",
        ),
    ]
    for call, message in cases:
        with pytest.raises((TypeError, ValueError)) as caught:
            call()
        assert message in str(caught.value)
    assert stock.to_bytes() == before
    with pytest.raises(TypeError):
        riffler.verify(good, None)


def test_a_cancelled_run_leaves_the_verification_usable():
    poses, rapid, tool, stock, part, fixtures = busy_scene()
    kept = riffler.Verification(stock, part, fixtures)
    whole = busy_program(poses, rapid, tool)
    kept.run(whole)
    poses[300, 2] -= 1
    edited = busy_program(poses, rapid, tool)
    with pytest.raises(riffler.Cancelled):
        kept.run(edited, progress=lambda share: share < 0.3)
    shares = []
    report = kept.run(edited, progress=shares.append)
    assert state(report) == state(riffler.verify(edited, stock, part, fixtures))
    assert shares == sorted(shares) and shares[0] >= 0 and shares[-1] <= 1
    with pytest.raises(riffler.Cancelled):
        riffler.verify(whole, stock, part, fixtures, progress=lambda share: False)


def test_empty_programs_pass():
    stock = riffler.Volume.block([0, 0, -10], [20, 20, 0], 0.5)
    for rows_ in (0, 1):
        report = riffler.verify(program(path(np.zeros((rows_, 3)))), stock)
        assert report.passed and len(report.removed) == rows_ and report.volume.to_bytes() == stock.to_bytes()
    kept = riffler.Verification(stock)
    cut = program(path([[10, 10, 5], [10, 10, -5]]), held())
    for one in (program(path(np.zeros((0, 3)))), cut, program(path(np.zeros((0, 3)))), cut):
        assert state(kept.run(one)) == state(riffler.verify(one, stock))
    assert riffler.verify([], stock).passed
