"""Operations on a part: finishing, judged by a dense z-map of its cutter in numpy, not by the drop cutter."""

import math

import numpy as np
import pytest
import riffler
from finish_judge import boss_on_plate, heights, setup_of, solid_under, sphere_on_plate, z_map
from riffler import plan

RNG = 20261129


def terrain(size=14.0, n=13, height=2.5, seed=RNG):
    random = np.random.default_rng(seed)
    x = np.linspace(0, size, n)
    z = np.zeros((n, n))
    for k in range(1, 5):
        a, b, c = random.uniform(-1, 1, 3)
        z += np.sin(2 * math.pi * k * (a * x[:, None] + b * x[None, :]) / size + c) / k
    z = 3 + (z - z.min()) / (z.max() - z.min()) * height
    return solid_under(x, z)


BALL = riffler.Tool.ball(diameter=6, length=40)
FLAT = riffler.Tool.flat(diameter=4, length=40)


@pytest.mark.parametrize("allowance", [0.0, 0.3])
@pytest.mark.parametrize("angle", [0.0, 0.7])
def test_a_terrain_is_cut_to_its_cusp_and_no_deeper(angle, allowance):
    part = terrain()
    cusp, tolerance = 0.1, 0.02
    op = plan.finish(setup_of(part), BALL, cusp=cusp, tolerance=tolerance, angle=angle, allowance=allowance)
    random = np.random.default_rng(RNG)
    x, y = random.uniform(3.5, 10.5, (2, 150))
    eps = 1e-4
    z, gx, gy = heights(part, x, y), heights(part, x + eps, y), heights(part, x, y + eps)
    up = 1 / np.sqrt(1 + ((gx - z) / eps) ** 2 + ((gy - z) / eps) ** 2)  # cosine of the slope
    over = (z_map(op, x, y) - z) * up
    if allowance:
        assert distances(part, x, y, z + over / up).min() >= allowance - tolerance - 1e-3
        over += 0.02 * allowance  # next to a ridge the upright gap counts too little
    else:
        assert over.min() >= -tolerance - 1e-3
    # Where the ball fits; under creases of the facets it does not reach the part by what the chord of a facet makes.
    reached = plan_reaches(part, BALL, x, y, z, allowance)
    assert reached.sum() > 75
    assert over[reached].max() <= allowance + cusp + tolerance + 0.01
    assert over[reached].max() > allowance + 0.3 * cusp, "the rows are not closer than they need be"


def distances(part, x, y, z, reach=0.8, step=0.05):
    """Distances of points above a part from it, by a dense cloud of its z-map: at most 0.004 mm too large."""
    g = np.arange(-reach, reach + step / 2, step)
    gx, gy = (k.ravel() for k in np.meshgrid(g, g))
    px, py = x[:, None] + gx, y[:, None] + gy
    pz = heights(part, px.ravel(), py.ravel()).reshape(px.shape)
    return np.sqrt(gx**2 + gy**2 + (pz - z[:, None]) ** 2).min(axis=1)


def plan_reaches(part, tool, x, y, z, allowance):
    """Points that the cutter touches somewhere, by a dense search over places of the cutter on a z-map."""
    g = np.arange(-1, 15.01, 0.1)
    gx, gy = np.meshgrid(g, g, indexing="ij")
    surface = heights(part, gx.ravel(), gy.ravel()).reshape(gx.shape)
    r = tool.diameter / 2 + allowance
    k = math.ceil(r / 0.1)
    tip = np.full(gx.shape, -np.inf)
    padded = np.pad(surface, k, constant_values=-np.inf)
    for i in range(-k, k + 1):
        for j in range(-k, k + 1):
            if math.hypot(i, j) * 0.1 <= r:
                drop = r - math.sqrt(r * r - (i * i + j * j) * 0.01)
                tip = np.maximum(tip, padded[k + i : k + i + len(g), k + j : k + j + len(g)] - drop)
    best = np.full(x.shape, np.inf)
    for i in range(len(g)):
        rho2 = (x[:, None] - g[i]) ** 2 + (y[:, None] - g[None, :]) ** 2
        low = np.where(rho2 <= r * r, tip[i] + r - np.sqrt(np.maximum(r * r - rho2, 0)), np.inf)
        best = np.minimum(best, low.min(axis=1))
    return best - z < 0.01


@pytest.mark.parametrize("tool", [BALL, FLAT], ids=["ball", "flat"])
@pytest.mark.parametrize("angle", [0.0, math.radians(10), 1.1])
def test_a_box_turned_by_ten_degrees_is_never_entered(tool, angle):
    part = boss_on_plate()
    tolerance = 0.01
    op = plan.finish(setup_of(part), tool, cusp=0.1, tolerance=tolerance, angle=angle)
    x, y = np.random.default_rng(3).uniform(1, 29, (2, 600))
    z = heights(part, x, y)
    left = z_map(op, x, y, step=0.05) - z
    assert left.min() >= -tolerance - 1e-6
    flat = z < 3.1  # and further than the radius from the box in all directions
    for turn in np.linspace(0, 2 * math.pi, 33):
        for reach in (1, 2, 3.2):
            flat &= heights(part, x + reach * math.cos(turn), y + reach * math.sin(turn)) < 3.1
    assert left[z > 7.9].max() <= 0.1 + tolerance + 1e-3
    assert left[flat & (x > 4) & (x < 26) & (y > 4) & (y < 26)].max() <= 0.1 + tolerance + 1e-3


def test_walls_along_the_rows_are_finished_by_rows_next_to_them():
    part = boss_on_plate(0.0)
    op = plan.finish(setup_of(part), BALL, cusp=0.05, tolerance=0.01)
    # The wall of the boss at y = 15 + 4.5, in the middle of its length: rows pass at most cusp + tolerance outside.
    middle = (np.abs(op.poses[:, 0] - 15) < 6) & (op.kind == 2) & (op.poses[:, 2] < 3.2)
    gap = op.poses[middle, 1] - (19.5 + 3)
    assert gap[gap > -0.02].min() <= 0.06
    assert op.report.stats["added"] > 0


def test_rapids_of_a_dome_touch_nothing_and_verify_agrees():
    part = sphere_on_plate()
    setup = setup_of(part, origin=(15, 15, 0))
    op = plan.finish(setup, BALL, cusp=0.1, tolerance=0.02)
    assert set(np.unique(op.kind)) <= {0, 1, 2, 3}
    assert (op.feed[op.kind == 0] == 0).all() and (op.feed[op.kind != 0] > 0).all()
    setup.apply(op)
    assert setup.stock.volume < setup.stock_before(op).volume
    program = plan.program(setup, [op])
    assert len(program) == len(op)
    assert np.allclose(np.asarray(program.poses)[:, :3] + [15, 15, 0], op.poses[:, :3])
    top = max(part.bounds[1][2], setup.stock.upper[2])
    across = (op.kind[1:] == 0) & (np.abs(np.diff(op.poses[:, :2], axis=0)).max(axis=1) > 0)
    assert (op.poses[1:][across][:, 2] >= top + setup.clearance - 1e-9).all()
    assert op.report.cut_mm > 0 and op.report.time_s > 0 and op.report.largest_engagement is None


def test_the_program_is_written_read_back_and_verified(tmp_path):
    part = boss_on_plate()
    setup = setup_of(part)
    op = plan.finish(setup, BALL, cusp=0.2, tolerance=0.02, feed=900)
    other = plan.finish(setup, FLAT, cusp=0.2, tolerance=0.02, slopes=(0, 0.1))
    program = plan.program(setup, [op, other])
    assert sorted(program.tools) == [1, 2]
    program.write(tmp_path / "p.ngc", post="3-axis", tolerance=0.002)
    back = riffler.Program.read(tmp_path / "p.ngc", machine="3-axis")
    report = riffler.verify(back, setup.stock, part, tools=dict(program.tools), tolerance=0.02, gouge_tolerance=0.025)
    assert report.findings == []


def test_any_number_of_threads_gives_the_same_bytes(monkeypatch):
    part, found = boss_on_plate(), []
    for threads in ("1", "2", "4"):
        monkeypatch.setenv("RIFFLER_THREADS", threads)
        found.append(plan.finish(setup_of(part), BALL, cusp=0.1, angle=0.3).poses.tobytes())
    assert found[0] == found[1] == found[2]


def test_slopes_and_regions_leave_the_rest_alone():
    part = boss_on_plate()
    square = np.array([(8, 2, 0), (22, 2, 0), (22, 7, 0), (8, 7, 0)], float)
    op = plan.finish(setup_of(part), BALL, cusp=0.1, tolerance=0.01, region=[square])
    cuts = op.poses[op.kind == 2]
    assert len(cuts)
    assert cuts[:, 0].min() >= 8 - 0.02 and cuts[:, 0].max() <= 22.02 and cuts[:, 1].max() <= 7.02
    tops = plan.finish(setup_of(part), FLAT, cusp=0.1, slopes=(0.0, 0.1))
    assert set(np.round(tops.poses[tops.kind == 2][:, 2], 2)) <= {3.0, 8.0}
    nothing = plan.finish(setup_of(part), BALL, slopes=(0.5, 0.9))
    assert len(nothing) == 0 and "slopes" in nothing.reason
    far = plan.finish(setup_of(part), BALL, region=[square + np.array([500, 0, 0])])
    assert len(far) == 0 and "region" in far.reason
    with pytest.raises(ValueError, match="none has poses: no face"):
        plan.program(setup_of(part), [far])


def test_flat_parts_and_single_triangles_are_finished():
    flat = riffler.Mesh([(0, 0, 2), (20, 0, 2), (20, 20, 2), (0, 20, 2)], [(0, 1, 2), (0, 2, 3)])
    stock = riffler.Volume.block((0, 0, 0), (20, 20, 4), 0.5)
    op = plan.finish(plan.Setup(flat, stock), FLAT)
    assert np.allclose(op.poses[op.kind == 2][:, 2], 2)
    one = riffler.Mesh([(2, 2, 1), (18, 4, 3), (8, 17, 2)], [(0, 1, 2)])
    op = plan.finish(plan.Setup(one, stock), BALL, cusp=0.1, angle=2.5)
    x, y = np.random.default_rng(5).uniform(3, 17, (2, 500))
    z = heights(one, x, y)
    on = np.isfinite(z)
    left = z_map(op, x[on], y[on], step=0.05) - z[on]
    assert left.min() >= -0.0051 and left.max() <= 0.11


def test_holder_and_fixtures_block_with_a_reason():
    part = boss_on_plate()
    short = riffler.Tool.ball(diameter=3, length=4).with_holder([(4, 8, 30, 8)])
    op = plan.finish(setup_of(part), short, cusp=0.2, tolerance=0.02)
    assert [b.reason for b in op.report.blocked] == ["the holder meets the part", "the holder meets the stock"]
    clamp = riffler.Volume.block((0, 0, 3), (5, 30, 20), 0.5, "xyz").to_mesh()
    op = plan.finish(setup_of(part, fixtures=[clamp]), BALL, cusp=0.2, tolerance=0.02)
    assert "the tool meets a fixture" in [b.reason for b in op.report.blocked]
    cuts = op.poses[op.kind == 2]
    aside = np.hypot(np.maximum(cuts[:, 0] - 5, 0), np.maximum.reduce([-cuts[:, 1], cuts[:, 1] - 30, 0 * cuts[:, 1]]))
    assert aside.min() >= 3 - 0.02


def test_bad_input_names_what_and_where():
    part, stock = boss_on_plate(), riffler.Volume.block((0, 0, 0), (30, 30, 9), 0.5)
    with pytest.raises(ValueError, match="stock: smaller than the part, x"):
        plan.Setup(part, riffler.Volume.block((0, 0, 0), (20, 30, 9), 0.5))
    with pytest.raises(ValueError, match="part: outside of the stock"):
        plan.Setup(part, riffler.Volume.block((100, 0, 0), (120, 30, 9), 0.5))
    with pytest.raises(ValueError, match="machine 3-axis holds the tool along z"):
        plan.Setup(part, stock, axis=(1, 0, 0))
    with pytest.raises(ValueError, match="clearance"):
        plan.Setup(part, stock, clearance=0)
    with pytest.raises(ValueError, match="machine must be one of"):
        plan.Setup(part, stock, machine="lathe")
    setup = plan.Setup(part, stock)
    for more, text in (
        ({"pattern": "zigzag"}, "pattern must be one of parallel"),
        ({"cusp": 0}, "cusp"),
        ({"cusp": 5}, "cusp must be less"),
        ({"tolerance": 0}, "tolerance"),
        ({"allowance": -1}, "allowance"),
        ({"angle": math.inf}, "angle"),
        ({"slopes": (1, 0.5)}, "slopes"),
        ({"region": [[(0, 0, 0), (1, 1, 0)]]}, "region, curve 0"),
        ({"feed": 0}, "feed"),
    ):
        with pytest.raises(ValueError, match=text):
            plan.finish(setup, BALL, **more)


def test_a_cancelled_call_leaves_nothing():
    setup = setup_of(terrain())
    shares = []

    def stop(share):
        shares.append(share)
        return len(shares) < 3

    with pytest.raises(riffler.Cancelled):
        plan.finish(setup, BALL, progress=stop)
    assert len(shares) == 3


def test_three_plus_two_is_the_upright_result_turned():
    part = terrain()
    turn = np.array([[0, 0, 1], [1, 0, 0], [0, 1, 0]], float)  # z becomes x
    turned = riffler.Mesh(np.asarray(part.vertices) @ turn.T, part.triangles)
    lower, upper = turned.bounds
    side = plan.Setup(turned, riffler.Volume.block(lower, upper, 0.5, "xyz"), axis=(1, 0, 0), machine="tcp")
    op = plan.finish(side, BALL, cusp=0.1, tolerance=0.01)
    assert np.allclose(op.poses[:, 3:], [1, 0, 0])
    back = op.poses[:, :3] @ turn
    x, y = np.random.default_rng(1).uniform(4, 10, (2, 100))
    upright = plan.Operation(np.hstack([back, op.poses[:, 3:]]), op.kind, op.feed, op.tool, op.report)
    over = z_map(upright, x, y, step=0.05) - heights(part, x, y)
    assert over.min() >= -0.02 and over.max() < 1


def test_the_command_writes_a_program_that_verify_passes(tmp_path, capsys):
    from riffler.cli import main

    boss_on_plate().write(tmp_path / "part.stl")
    out, part = str(tmp_path / "p.ngc"), str(tmp_path / "part.stl")
    arguments = [
        "plan",
        "finish",
        part,
        "--tool",
        "ball:6:40",
        "--cusp",
        "0.3",
        "--tolerance",
        "0.02",
        "--pitch",
        "0.5",
    ]
    assert main([*arguments, "--out", out]) == 0
    stock = ["--stock", "30x30x8", "--pitch", "0.5", "--tool", "ball:6:40", "--part", part]
    assert main(["nc", "verify", out, "--machine", "3-axis", *stock]) == 0
    capsys.readouterr()
    assert main([*arguments, "--slopes", "40,50", "--out", out]) != 0
    assert "slopes" in capsys.readouterr().err
