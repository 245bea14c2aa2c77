"""Roughing, judged by a height map that every move cuts by brute force, in numpy: depth, width of cut, what is left."""

import math

import numpy as np
import pytest
import riffler
from commands import result
from riffler import plan
from riffler.plan.operations import CUT, LEAD, LINK, RAPID

CELL = 0.125  # mm
STOCK = (40.0, 30.0, 12.0)
SLIVER = 0.02  # mm: material thinner than this is none


def pocketed() -> riffler.Mesh:
    """A block with a pocket, a slot of 7 mm off it and an island in it."""
    volume = riffler.Volume.block((0, 0, 0), STOCK, pitch=0.5, directions="xyz")
    wide, narrow = riffler.Tool.flat(diameter=12, length=30), riffler.Tool.flat(diameter=7, length=30)
    volume.carve(wide, [(10, 9, 4, 0, 0, 1), (30, 9, 4, 0, 0, 1), (30, 21, 4, 0, 0, 1)])
    volume.carve(narrow, [(10, 9, 4, 0, 0, 1), (10, 24, 4, 0, 0, 1)])
    return volume.to_mesh(tolerance=0.01)


def relief() -> riffler.Mesh:
    return riffler.shape.relief([[0.3, 1.0, 0.4], [0.6, 0.3, 0.9]], size=STOCK[:2], depth=10)


PARTS = {"pocketed": pocketed, "relief": relief}


def stock() -> riffler.Volume:
    return riffler.Volume.block((0, 0, 0), STOCK, pitch=0.5)


class Judge:
    """Heights of the stock over small cells."""

    def __init__(self, op: plan.Operation) -> None:
        self.op, self.radius = op, op.tool.diameter / 2
        self.x, self.y = (np.arange(CELL / 2, size, CELL) for size in STOCK[:2])
        self.z = np.full((len(self.x), len(self.y)), STOCK[2])
        self.widths: list[tuple[float, float]] = []  # of cuts, with their lengths
        self.plunged = 0.0  # mm³, by moves straight down
        self.cut_by = dict.fromkeys((RAPID, LEAD, CUT, LINK), 0.0)  # mm³
        for k in range(1, len(op)):
            self.move(op.poses[k - 1, :3], op.poses[k, :3], int(op.kind[k]))

    def lower_side(self, square):
        if self.op.tool.kind == "flat":
            return np.where(square <= self.radius**2, 0.0, np.inf)
        r = self.radius
        return np.where(square <= r * r, r - np.sqrt(np.maximum(r * r - square, 0)), np.inf)

    def move(self, a, b, kind) -> None:
        steps = max(1, math.ceil(np.linalg.norm(b - a) / CELL))
        way = (b - a)[:2]
        flat = np.linalg.norm(way)
        across = np.array([-way[1], way[0]]) / flat if flat > 0 else np.zeros(2)
        width = 0.0
        for step in range(1, steps + 1):
            p = a + (b - a) * step / steps
            i, j = (
                slice(*np.searchsorted(axis, [c - self.radius, c + self.radius]))
                for axis, c in ((self.x, p[0]), (self.y, p[1]))
            )
            dx, dy = self.x[i, None] - p[0], self.y[None, j] - p[1]
            here, low = self.z[i, j], p[2] + self.lower_side(dx * dx + dy * dy)
            gone = np.maximum(here - low, 0)
            if gone.max(initial=0) > SLIVER:
                at = (dx * across[0] + dy * across[1])[gone > SLIVER]
                width = max(width, at.max() - at.min())
            self.plunged += gone.sum() * CELL**2 * (flat == 0)
            self.cut_by[kind] += gone.sum() * CELL**2
            self.z[i, j] = np.minimum(here, low)
        if kind == CUT:
            self.widths.append((width, flat))


@pytest.fixture(scope="module", params=PARTS, ids=str)
def roughed(request):
    part = PARTS[request.param]()
    setup = plan.Setup(part, stock())
    op = plan.rough(setup, riffler.Tool.flat(diameter=6, length=25), stepdown=2.5, engagement=0.4, allowance=0.3)
    return part, setup, op, Judge(op)


def test_a_roughing_program_is_free_of_gouges_and_collisions(roughed):
    _, setup, op, _ = roughed
    assert len(plan.program(setup, [op])) == len(op) > 500
    assert op.report.cut_mm > 200 and op.report.time_s > 60


def test_no_move_is_below_part_and_allowance(roughed):
    part, _, op, judge = roughed
    above = riffler.Collider(part)
    low = op.kind != RAPID
    grown = riffler.Tool.flat(diameter=6 + 2 * 0.29, length=25)
    for pose in op.poses[low][::7]:
        lifted = pose + np.array([0, 0, 1e-4, 0, 0, 0])
        assert above.query(grown, lifted).depth < 0.02, pose
    assert judge.z.min() >= -1e-9


def test_cuts_are_as_wide_as_requested(roughed):
    _, _, op, judge = roughed
    assert 0.2 < op.report.largest_engagement <= 0.4 + 1e-9
    widths, lengths = np.array(judge.widths).T
    limit = 0.4 * 6 + 2 * CELL  # the cells' size on both sides
    assert lengths[widths > limit].sum() < 0.002 * lengths.sum(), np.sort(widths / 6)[-10:]
    assert widths.max() < 1.25 * 0.4 * 6
    assert lengths[widths > 0.5 * limit].sum() > 0.2 * lengths.sum(), "the cutter hardly cuts"


def test_links_and_rapids_cut_nothing(roughed):
    *_, judge = roughed
    whole = sum(judge.cut_by.values())
    assert judge.cut_by[RAPID] < 1e-4 * whole and judge.cut_by[LINK] < 3e-4 * whole  # single cells at the rim
    assert judge.cut_by[LEAD] < 0.5 * whole, "leads do most of the work"


def test_remaining_material_is_at_most_a_layer_high_where_the_tool_reaches(roughed):
    part, _, _, judge = roughed
    gx, gy = np.meshgrid(judge.x[::4], judge.y[::4], indexing="ij")
    wide = riffler.Tool.flat(diameter=6 + 2 * 0.33, length=25)
    heights, _ = plan.drop(np.stack([gx, gy, np.zeros_like(gx)], -1).reshape(-1, 3), wide, part)
    floor = np.maximum(np.nan_to_num(heights.reshape(gx.shape)), 0.0)
    left = judge.z[::4, ::4]
    # the tool can stand there: nothing higher than a layer over where it would rest
    assert (left - floor).max() <= 0.3 + 2.5 + 0.05 + 1e-6
    assert (left < STOCK[2] - 1).mean() > 0.2


def test_cleared_regions_are_not_cut_again(roughed):
    _, setup, op, _ = roughed
    again = plan.Setup(setup.part, setup.stock)
    again.apply(op)
    rest = plan.rough(again, op.tool, stepdown=2.5, engagement=0.4, allowance=0.3)
    assert len(rest) == 0 or rest.report.cut_mm < 0.05 * op.report.cut_mm
    assert len(rest) or "reaches no material" in rest.reason


@pytest.mark.parametrize("kind", ["ball", "fillet"])
def test_other_cutters_and_conventional_milling_work(kind):
    tool = (
        riffler.Tool.ball(diameter=6, length=25)
        if kind == "ball"
        else riffler.Tool.fillet(diameter=8, corner_radius=1, length=25)
    )
    setup = plan.Setup(pocketed(), stock())
    op = plan.rough(setup, tool, stepdown=4, engagement=0.3, climb=False)
    assert len(plan.program(setup, [op])) > 300 and op.report.largest_engagement <= 0.3 + 1e-9


def test_climb_has_its_material_on_the_right():
    part = riffler.Volume.block((0, 0, 0), (*STOCK[:2], 3), pitch=1, directions="xyz").to_mesh()
    turning = {}
    for climb in (True, False):
        op = plan.rough(plan.Setup(part, stock()), riffler.Tool.flat(diameter=8, length=25), stepdown=5, climb=climb)
        middle = np.array([STOCK[0] / 2, STOCK[1] / 2])
        p = op.poses[:, :2] - middle
        turn = p[:-1, 0] * p[1:, 1] - p[:-1, 1] * p[1:, 0]
        turning[climb] = turn[op.kind[1:] == CUT].sum()
    assert turning[True] < 0 < turning[False], "from outside inwards, the material on the right is clockwise"


def test_any_number_of_threads_gives_the_same_bytes(monkeypatch):
    setup, tool = plan.Setup(relief(), stock()), riffler.Tool.flat(diameter=6, length=25)
    found = []
    for threads in ("1", "2", "4"):
        monkeypatch.setenv("RIFFLER_THREADS", threads)
        found.append(plan.rough(setup, tool, stepdown=3).poses.tobytes())
    assert found[0] == found[1] == found[2]


def test_passes_are_linked_through_what_is_cleared(roughed):
    _, _, op, _ = roughed
    stats = op.report.stats
    assert stats["direct"] > 0.2 * (stats["direct"] + stats["retracts"])
    at_feed = np.linalg.norm(np.diff(op.poses[:, :3], axis=0), axis=1)[op.kind[1:] != RAPID].sum()
    assert op.report.air_mm < 0.4 * at_feed  # a small part: half as much on real ones


def drops_of(op) -> np.ndarray:
    """mm down and mm across of each lead that goes down."""
    way = np.diff(op.poses[:, :3], axis=0)
    lead = (op.kind[1:] == LEAD) & (way[:, 2] < -1e-9)
    return np.column_stack([-way[lead, 2], np.linalg.norm(way[lead, :2], axis=1)])


def slotted(width: float) -> riffler.Mesh:
    """A block with a closed slot, 28 mm long."""
    volume = riffler.Volume.block((0, 0, 0), STOCK, pitch=0.25, directions="xyz")
    tool = riffler.Tool.flat(diameter=width, length=30)
    volume.carve(tool, [(x, 15, 6, 0, 0, 1) for x in (6 + width / 2, 34 - width / 2)])
    return volume.to_mesh(tolerance=0.01)


@pytest.mark.parametrize(("width", "entry"), [(7.5, "ramps"), (20, "helices")])
@pytest.mark.parametrize("slope", [0.008, 0.1])
def test_slots_are_entered_where_there_is_room_and_never_steeper_than_requested(width, entry, slope):
    setup = plan.Setup(slotted(width), stock())
    op = plan.rough(setup, riffler.Tool.flat(diameter=6, length=25), stepdown=3, allowance=0.2, slope=slope)
    assert op.report.stats[entry] == op.report.stats["levels"] > 0 and not op.report.blocked
    down, across = drops_of(op).T
    slanted = across > 0
    assert slanted.sum() > 10
    assert (np.arctan2(down, across)[slanted] <= slope * (1 + 1e-6)).all()
    judge = Judge(op)
    assert judge.plunged < 5e-3 * sum(judge.cut_by.values()), "straight down only where there is none but slivers"
    middle = judge.z[np.ix_(abs(judge.x - 20) < 12, abs(judge.y - 15) < 2.5)]
    assert middle.max() <= 6 + 0.2 + 3 + 0.05


def test_a_square_pocket_a_little_wider_than_the_tool_is_cleared():
    volume = riffler.Volume.block((0, 0, 0), STOCK, pitch=0.25, directions="xyz")
    corners = [(18, 13), (22, 13), (22, 17), (18, 17), (18, 13)]
    volume.carve(riffler.Tool.flat(diameter=6, length=30), [(x, y, 6, 0, 0, 1) for x, y in corners])
    op = plan.rough(
        plan.Setup(volume.to_mesh(tolerance=0.01), stock()),
        riffler.Tool.flat(diameter=6.35, length=25),
        stepdown=3,
        allowance=0.1,
    )
    assert len(op) and not op.report.blocked
    judge = Judge(op)
    assert judge.z[np.ix_(abs(judge.x - 20) < 4, abs(judge.y - 15) < 3)].max() < 6 + 0.1 + 3


def test_a_hole_smaller_than_tool_and_allowance_is_left_out_and_named():
    volume = riffler.Volume.block((0, 0, 0), STOCK, pitch=0.25, directions="xyz")
    volume.carve(riffler.Tool.flat(diameter=14, length=30), [(12, 15, 5, 0, 0, 1), (16, 15, 5, 0, 0, 1)])
    volume.carve(riffler.Tool.flat(diameter=5, length=30), [(34, 15, 5, 0, 0, 1), (34.1, 15, 5, 0, 0, 1)])
    op = plan.rough(plan.Setup(volume.to_mesh(), stock()), riffler.Tool.flat(diameter=6, length=25), stepdown=3)
    assert op.report.cut_mm > 100
    (hole,) = op.report.blocked
    assert "narrower than the tool" in hole.reason
    assert np.hypot(*(hole.place[:2] - (34, 15))) < 3


def test_a_slot_too_narrow_for_a_helix_is_reported():
    volume = riffler.Volume.block((0, 0, 0), STOCK, pitch=0.25, directions="xyz")
    volume.carve(riffler.Tool.flat(diameter=7, length=30), [(20, 15, 6, 0, 0, 1), (20.1, 15, 6, 0, 0, 1)])
    setup = plan.Setup(volume.to_mesh(), stock())
    op = plan.rough(setup, riffler.Tool.flat(diameter=6, length=25), stepdown=3, allowance=0.1)
    (place,) = op.report.blocked
    assert "too narrow for a helix or a ramp" in place.reason
    assert np.allclose(place.place[:2], (20, 15), atol=0.6)
    assert not len(op), "it is no drill"


@pytest.mark.parametrize(
    ("wrong", "text"),
    [
        ({"stepdown": 0}, "stepdown"),
        ({"stepdown": 60}, "more than the cutter's length"),
        ({"engagement": 0}, "engagement must be a share"),
        ({"engagement": 1.5}, "engagement must be a share"),
        ({"engagement": math.nan}, "engagement must be a share"),
        ({"allowance": -1}, "allowance"),
        ({"tolerance": 0}, "tolerance"),
        ({"slope": 0}, "slope"),
        ({"slope": 1e-4}, "slope must be from 0.001"),
        ({"feed": 0}, "feed"),
        ({"plunge": -3}, "plunge"),
    ],
)
def test_bad_options_are_named(wrong, text):
    setup = plan.Setup(relief(), stock())
    with pytest.raises(ValueError, match=text):
        plan.rough(setup, riffler.Tool.flat(diameter=6, length=25), **wrong)


def test_a_tool_too_small_for_the_stock_is_named():
    part = riffler.Volume.block((0, 0, 0), (400, 400, 5), pitch=10, directions="xyz").to_mesh()
    setup = plan.Setup(part, riffler.Volume.block((0, 0, 0), (400, 400, 10), pitch=5))
    with pytest.raises(ValueError, match="million places"):
        plan.rough(setup, riffler.Tool.flat(diameter=0.5, length=5))


def test_a_part_as_high_as_its_stock_leaves_nothing_to_do():
    block = riffler.Volume.block((0, 0, 0), STOCK, pitch=1, directions="xyz").to_mesh()
    op = plan.rough(plan.Setup(block, stock()), riffler.Tool.flat(diameter=6, length=25))
    assert len(op) == 0 and "reaches no material" in op.reason


def test_level_faces_are_cut_to_the_allowance():
    plate = riffler.Volume.block((0, 0, 0), (*STOCK[:2], 7.3), pitch=0.1, directions="xyz").to_mesh()
    setup = plan.Setup(plate, stock())
    op = plan.rough(setup, riffler.Tool.flat(diameter=8, length=25), stepdown=2, allowance=0.2, tolerance=0.04)
    setup.apply(op)
    assert setup.stock.volume == pytest.approx(STOCK[0] * STOCK[1] * (7.3 + 0.2 + 0.02), rel=1e-3)
    assert op.report.stats["levels"] == 3  # at 10, 8 and 7.52


def test_roughing_can_be_cancelled():
    setup = plan.Setup(relief(), stock())
    with pytest.raises(riffler.Cancelled):
        plan.rough(setup, riffler.Tool.flat(diameter=6, length=25), progress=lambda share: share < 0.4)


def test_the_command_writes_a_program(tmp_path):
    relief().write(tmp_path / "part.stl")
    words = ["--tool", "flat:6", "--stock", "40x30x12", "--pitch", "0.5", "--stepdown", "3", "--out", "rough.ngc"]
    data = result("plan", "rough", "part.stl", *words, cwd=tmp_path)
    assert data["largest_engagement"] <= 0.4 + 1e-9 and data["stats"]["levels"] >= 2
    assert (tmp_path / "rough.ngc").read_text().count("\n") > 300
