"""Hand tools: the direction of the blade along a stroke, what a groove removes, and mirrored copies."""

import itertools

import numpy as np
import pytest
import riffler
from hands import Run

from addon.common import glyphs, hand_tools
from addon.sculpt.pure import brush_stroke, symmetry
from addon.sculpt.pure.roll import Roll
from addon.sculpt.pure.stroke_path import Piece, Sample
from addon.sculpt.pure.view_rays import ViewRays

SIZE, PIXEL = (400, 300), 0.1
V_TOOL = {"kind": "v_tool", "angle": np.pi / 2, "width": 8.0, "bevel": 0.5, "length": 25.0}


def roll_of(points, string=0.5, **more):
    """The pieces of a stroke on z = 0 through the points, in calls of three rows as events bring them."""
    roll, rows = Roll(string, np.array([0.0, 1, 0]), **more), np.zeros((len(points) + 1, 6))
    rows[1:, :2], rows[0, :2], rows[:, 5] = points, points[0], 1
    rows[0, 2] = 1.0  # comes down first
    pieces = []
    for k in range(0, len(rows) - 1, 2):
        part = rows[k : k + 3]
        pieces += roll.add(Piece(part, np.ones(len(part) - 1), k == 0))
    return pieces + roll.end()


def test_a_blade_points_along_a_circle_from_its_first_row_on():
    a = np.radians(np.arange(0, 180, 2))
    pieces = roll_of(10 * np.c_[np.cos(a), np.sin(a)])
    assert [piece.new for piece in pieces] == [True] + [False] * (len(pieces) - 1)
    rows = np.vstack([pieces[0].poses, *(piece.poses[1:] for piece in pieces[1:])])
    assert len(rows) == len(a) + 1, "nothing is left out"
    assert all(np.array_equal(b.poses[0], a.poses[-1]) for a, b in itertools.pairwise(pieces))
    along = np.c_[-np.sin(a), np.cos(a), 0 * a]
    angle = np.degrees(np.arccos(np.clip((rows[1:, 6:] * along).sum(axis=1), -1, 1)))
    assert angle.max() < 6, "the string lags by half its length and a step"
    assert np.allclose(np.linalg.norm(rows[:, 6:], axis=1), 1)


def test_a_blade_is_lifted_where_the_pointer_turns_back_and_never_turns_by_a_half_turn():
    x = np.r_[np.arange(0, 10, 0.25), np.arange(10, 0, -0.25)]
    pieces = roll_of(np.c_[x, 0 * x])
    assert sum(piece.new for piece in pieces) == 2
    assert np.allclose(pieces[0].poses[:, 6:], [1, 0, 0]) and np.allclose(pieces[-1].poses[:, 6:], [-1, 0, 0])
    for piece in pieces:
        assert ((piece.poses[1:, 6:] * piece.poses[:-1, 6:]).sum(axis=1) > 0).all()


def test_a_click_points_up_in_the_view_and_leans_and_turns_as_set():
    (piece,) = roll_of([(0, 0)], lean=0.5, turn=np.pi / 2)
    assert np.allclose(piece.poses[-1, 3:6], [np.sin(0.5), 0, np.cos(0.5)])  # turned to the left, leaning back
    assert np.allclose(piece.poses[-1, 6:], [-np.cos(0.5), 0, np.sin(0.5)])


@pytest.fixture
def run():
    volume = riffler.Volume.block((-20, -15, -8), (20, 15, 4), 0.25, "xyz")
    volume.carve(riffler.Tool.flat(diameter=200, length=30), [(-1, 0, 0, 0, 0, 1), (1, 0, 0, 0, 0, 1)])
    return Run(volume)


def cut(run, length, tool=V_TOOL, **chosen):
    """mm³ removed by a stroke along x, seen from above."""
    view = ViewRays(np.diag([2 / (SIZE[0] * PIXEL), 2 / (SIZE[1] * PIXEL), -0.01, 1.0]), SIZE)
    before = run.volume.copy()
    made = brush_stroke.BrushStroke(run, tool, view, brush_stroke.Choice(mode="hand", **chosen))
    for x in (-10, -5, length - 10):
        made.add(Sample(0.5 * SIZE[0] + x / PIXEL, 0.5 * SIZE[1]))
    made.end()
    run.volume, after = before, run.volume
    return before.volume - after.volume, after


class Carving(Run):
    def carve(self, tool, poses, dt=None, mode="remove", new=True):
        return self.volume.carve(tool, poses, dt=dt)


@pytest.mark.parametrize("lean", [0.0, 1.0, 1.3])
def test_a_v_tool_cuts_the_groove_of_its_sections(run, lean):
    """A section perpendicular to the stroke of a blade that leans back by `lean` is as steep as its ground end."""
    run = Carving(run.volume)
    depth = 2.0
    short, _ = cut(run, 10, depth=depth, lean=lean)
    long, after = cut(run, 20, depth=depth, lean=lean)
    steep = np.sin(lean) + np.cos(lean) / np.tan(V_TOOL["bevel"])
    assert (long - short) / 10 == pytest.approx(depth**2 / steep, rel=0.02)
    counts, spans = after.intervals("z")
    heights = spans[np.cumsum(counts.ravel()) - 1, 1].reshape(counts.shape)
    assert -depth - 1e-6 < heights.min() < -depth + 0.13 * steep, "a ray is up to half a pitch from the deepest line"


def test_the_deepest_corner_of_a_skew_blade_is_at_the_depth(run):
    run = Carving(run.volume)
    skew = {"kind": "chisel", "width": 8.0, "thickness": 3.0, "bevel": 0.5, "length": 25.0, "skew": 0.3}
    _, after = cut(run, 20, skew, depth=0.8, lean=1.0)
    counts, spans = after.intervals("z")
    heights = spans[np.cumsum(counts.ravel()) - 1, 1]
    assert heights.min() == pytest.approx(-0.8, abs=0.1)


@pytest.mark.parametrize("preset", ["Gouge No. 3, 12 mm", "V-Tool 60°, 6 mm"])
def test_the_chip_of_a_deep_groove_is_removed(run, preset):
    run, tool = Carving(run.volume), hand_tools.preset(preset)
    _, after = cut(run, 20, hand_tools.tool_dict(tool["kind"], tool), depth=3.0, lean=tool["lean"])
    counts, spans = after.intervals("z")
    assert counts.max() == 1 and spans[:, 1].min() < -2.4


def test_a_tool_without_an_edge_is_refused(run):
    with pytest.raises(ValueError, match="is no hand tool"):
        cut(run, 10, {"kind": "ball", "diameter": 6.0, "length": 30.0})


def test_mirrored_copies_of_a_skew_blade_cut_the_mirror_image():
    tool = riffler.Tool.chisel(6, 2, 0.5, 20, skew=0.4)
    image = hand_tools.mirrored(tool)
    assert image.to_dict()["skew"] == -0.4 and hand_tools.mirrored(riffler.Tool.v_tool(1, 8, 0.5, 20)) is not image
    volume = riffler.Volume.block((-10, -10, -5), (10, 10, 0), 0.25, "z")
    poses = np.array([[2.0, -6, -1, 0, -0.6, 0.8, 0, 0.8, 0.6], [4, 6, -1, 0, -0.6, 0.8, 0, 0.8, 0.6]])
    for copy, mirrors in symmetry.copies(poses, symmetry.maps("X"), (0, 0, 0), symmetric=False):
        volume.carve(image if mirrors else tool, copy)
    counts, spans = volume.intervals("z")
    heights = spans[np.cumsum(counts.ravel()) - 1, 1].reshape(counts.shape)
    assert heights.min() < -0.9 and np.allclose(heights, heights[::-1], atol=1e-6)
    assert len(symmetry.copies(poses * (0, 1, 1, 0, 1, 1, 0, 1, 1), symmetry.maps("X"), (0, 0, 0), False)) == 2


def test_every_preset_is_a_tool_with_a_unique_name():
    tools = [hand_tools.tool_dict(t["kind"], t, t["name"]) for t in hand_tools.presets()]
    assert all(len(riffler.Tool.from_dict(tool).hulls) == 1 for tool in tools)
    assert len({tool["name"] for tool in tools}) == len(tools)
    with pytest.raises(ValueError, match="kind must be one of gouge"):
        hand_tools.tool_dict("spoon", {})


def test_an_outline_has_the_corners_of_the_convex_hull():
    square = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 1), (1, 0)]
    assert glyphs.outline(square).tolist() == [[0, 0], [2, 0], [2, 2], [0, 2]]
