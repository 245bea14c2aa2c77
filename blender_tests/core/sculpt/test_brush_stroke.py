"""Strokes on a volume, seen from above: what is carved and added, what a text repeats, what is refused."""

import json

import numpy as np
import pytest
import riffler
from hands import Run

from addon.sculpt import brushes
from addon.sculpt.pure import brush_stroke
from addon.sculpt.pure.stroke_path import Sample
from addon.sculpt.pure.view_rays import ViewRays

BALL = {"kind": "ball", "diameter": 6.0, "length": 30.0}
SIZE = (400, 300)
PIXEL = 0.1  # mm
# Up to where a cone of 0.5 rad, tangent to a tip ball of 1 mm, is 3 mm wide.
TAPER = 1 - np.sin(0.5) + (3 - np.cos(0.5)) / np.tan(0.5)


def above():
    """From +z, a millimetre is ten pixels; the middle of the view is the origin."""
    matrix = np.diag([2 / (SIZE[0] * PIXEL), 2 / (SIZE[1] * PIXEL), -0.01, 1.0])
    return ViewRays(matrix, SIZE)


@pytest.fixture
def run():
    volume = riffler.Volume.block((-20, -15, -8), (20, 15, 4), 0.25, "xyz")
    volume.carve(riffler.Tool.flat(diameter=200, length=30), [(-1, 0, 0, 0, 0, 1), (1, 0, 0, 0, 0, 1)])
    return Run(volume)


def at(x, y):
    """Pixels of a place on the top, mm."""
    return Sample(0.5 * SIZE[0] + x / PIXEL, 0.5 * SIZE[1] + y / PIXEL)


def stroke(run, *places, tool=BALL, **chosen):
    made = brush_stroke.BrushStroke(run, tool, above(), brush_stroke.Choice(**chosen))
    for place in places:
        made.add(place if isinstance(place, Sample) else at(*place))
    made.end()
    return made


def groove(length, depth, radius=3.0):
    """Closed form: a segment of the circle along the path, and two halves of a cap of the ball."""
    half = np.arccos((radius - depth) / radius)
    segment = radius**2 * (half - np.sin(half) * np.cos(half))
    return length * segment + np.pi * depth**2 * (3 * radius - depth) / 3


@pytest.mark.parametrize("along, side", [((0, 1, 0), (20, 0, 0)), ((1, 0, 0), (0, 15, 0))])
def test_the_cutter_does_not_tip_over_where_the_pointer_crosses_an_edge(run, along, side):
    """The edge between the top and a side: the axis at either pixel next to it is about the mean of both faces, and
    jumps by less than it turns within the width of the cutter."""
    towards, edge = np.array(side) / np.linalg.norm(side) + (0, 0, 1), np.array(side, float)
    view = np.diag([1.0, 1, 1, 1])
    view[:3, :3] = np.array([along, np.cross(towards, along), -towards]) / ([1], [np.sqrt(2)], [np.sqrt(2)])
    view[:3, :3] *= np.array([[2 / (SIZE[0] * PIXEL)], [2 / (SIZE[1] * PIXEL)], [0.01]])
    view[:3, 3] = -view[:3, :3] @ edge
    tool = {"kind": "flat", "diameter": 24.0, "length": 30.0}
    made = brush_stroke.BrushStroke(run, tool, ViewRays(view, SIZE), brush_stroke.Choice(depth=1.0))
    axes = [made.hover(0.5 * SIZE[0], 0.5 * SIZE[1] + y)[0][3:] for y in (-0.7, 0.7)]
    assert np.degrees(np.arccos(axes[0] @ axes[1])) < 22, axes
    assert min(a @ towards / np.sqrt(2) for a in axes) > np.cos(np.radians(12))


@pytest.mark.parametrize("axis", ["NORMAL", "VIEW", "UP"])
def test_a_straight_drag_is_a_groove(run, axis):
    before = run.volume.volume
    made = stroke(run, (-10, 0), (0, 0), (10, 0), depth=0.8, axis=axis)
    assert made.removed == pytest.approx(before - run.volume.volume)
    assert made.removed == pytest.approx(groove(20, 0.8), rel=0.01)
    assert made.pose[2] == pytest.approx(-0.8, abs=1e-3) and made.moves > 20
    assert np.linalg.norm(made.force) > 0


@pytest.mark.parametrize("axis", ["NORMAL", "VIEW", "UP"])
def test_an_added_bead_is_the_groove_turned_upside_down(run, axis):
    before = run.volume.volume
    made = stroke(run, (-10, 0), (10, 0), depth=0.8, axis=axis, mode="add")
    assert run.volume.volume - before == pytest.approx(groove(20, 0.8), rel=0.01)
    assert made.pose[2] == pytest.approx(0.8, abs=1e-3) and made.pose[5] == pytest.approx(-1)
    corners = run.volume.to_mesh().vertices
    assert corners[:, 2].max() == pytest.approx(0.8, abs=0.01)
    assert corners[:, 2].min() == pytest.approx(-8, abs=1e-6)  # nothing came out of the other side


@pytest.mark.parametrize(
    "tool, height",
    [
        (BALL, 3.0),
        ({"kind": "flat", "diameter": 6.0, "length": 30.0}, 0.8),
        ({"kind": "fillet", "diameter": 6.0, "corner_radius": 1.0, "length": 30.0}, 1.0),
        ({"kind": "taper", "diameter": 6.0, "tip_radius": 1.0, "half_angle": 0.5, "length": 30.0}, TAPER),
    ],
)
def test_the_tool_that_adds_material_is_no_longer_than_its_end(tool, height):
    given = riffler.Tool.from_dict(tool)
    short = brushes.of("add").cutter(given, 0.8)
    assert short.length == pytest.approx(height, abs=0.01) and short.diameter == 6
    low = np.linspace(0, 0.99 * short.length, 30)

    def width(t):
        line = np.vstack([p for _, p in t.outline(tolerance=1e-5)])
        return np.interp(low, line[:, 1], line[:, 0])

    assert np.allclose(width(short), width(given), atol=2e-3)


def test_the_tool_follows_the_original_surface_unless_it_accumulates(run):
    places = [(x, 0) for x in (0, 0.5, 0, 0.5, 0, 0.5, 0)]
    once = stroke(run, *places, depth=0.3)
    assert once.pose[2] == pytest.approx(-0.3, abs=1e-6) and once.looks == []

    made = brush_stroke.BrushStroke(run, BALL, above(), brush_stroke.Choice(depth=0.3, accumulate=True))
    for x, y in places:
        made.add(at(x, y))
        made.look()
    made.end()
    assert made.pose[2] < -1.4 and made.looks == list(range(1, 8))


@pytest.mark.parametrize("accumulate", [False, True])
def test_a_text_repeats_a_stroke_to_the_byte(accumulate):
    volumes = []
    for _ in range(2):
        volume = riffler.Volume.block((-20, -15, -8), (20, 15, 0), 0.25, "xyz")
        run = Run(volume)
        choice = brush_stroke.Choice(depth=0.3, pressure="DEPTH", axis="TILT", string=12.0, accumulate=accumulate)
        if not volumes:
            made = brush_stroke.BrushStroke(run, BALL, above(), choice)
            for k in range(40):
                place = at(0.4 * k - 8, 3 * np.sin(k / 4))
                made.add(place._replace(pressure=0.3 + k / 80, tilt_x=0.01 * k, time=0.016 * k))
                if k % 3 == 1:
                    made.look()
            made.end()
            text = made.text()
        else:
            view, samples, looks = brush_stroke.read(text)
            again = brush_stroke.BrushStroke(run, BALL, view, choice)
            brush_stroke.replay(again, samples, looks)
            assert again.text() == text and again.removed == made.removed
        volumes.append(volume.to_bytes())
    assert volumes[0] == volumes[1]


def test_pieces_of_one_stroke_are_marked_as_continued(run):
    stroke(run, (-5, 0), (0, 0), (5, 0))
    assert [entry[1] for entry in run.log] == [True, False, False]
    run.log.clear()
    assert stroke(run, (-100, 0), (-90, 0)).moves == 0 and run.log == []


def test_keep_out_is_called_for_every_pose(run):
    def lifted(poses, dt):
        poses = poses.copy()
        poses[:, 2] = np.maximum(poses[:, 2], -0.1)
        return poses, dt

    made = brush_stroke.BrushStroke(run, BALL, above(), brush_stroke.Choice(depth=0.8), keep_out=lifted)
    made.add(at(0, 0))
    made.end()
    assert made.removed == pytest.approx(groove(0, 0.1), rel=0.05) and made.lifted == 1
    shut = brush_stroke.BrushStroke(run, BALL, above(), brush_stroke.Choice(depth=0.8), keep_out=lambda poses, dt: None)
    shut.add(at(5, 0))
    assert shut.moves == 0 and shut.lifted == 2


@pytest.mark.parametrize("kind", ["ball", "flat"])
def test_dabs_of_smoothing_have_their_middle_on_the_surface(run, kind):
    made = stroke(run, (-5, 0), (5, 3), mode="soften", depth=2.0, axis="VIEW", tool={**BALL, "kind": kind})
    assert made.moves > 5 and made.removed == 0
    assert np.allclose(run.poses[:, 2], 0, atol=1e-6) and np.allclose(run.poses[-1, :2], (5, 3), atol=1e-6)
    assert np.linalg.norm(np.diff(run.poses[1:, :2], axis=0), axis=1).max() < 1.1


def test_hovering_shows_what_a_click_would_do_and_carves_nothing(run):
    probe = brush_stroke.BrushStroke(run, BALL, above(), brush_stroke.Choice(depth=0.8), surface=run.mesher)
    pose, point, normal = probe.hover(*at(3, 2)[:2])
    assert np.allclose(pose, (3, 2, -0.8, 0, 0, 1), atol=1e-6) and np.allclose(point, (3, 2, 0), atol=1e-6)
    assert np.allclose(normal, (0, 0, 1)) and probe.hover(-500, 0) is None and run.log == []


@pytest.mark.parametrize(
    "change, words",
    [
        (lambda d: d.pop("rows"), "rows"),
        (lambda d: d.update(rows=[]), "no rows"),
        (lambda d: d["rows"].append([1]), "row 2"),
        (lambda d: d["rows"].append([1, "x"]), "row 2"),
        (lambda d: d["rows"].append([1, float("nan")]), "row 2"),
        (lambda d: d["rows"].append([1] * 7), "row 2"),
        (lambda d: d["view"].update(matrix=[1] * 15), "matrix"),
        (lambda d: d["view"].update(matrix=[0] * 16), "view"),
        (lambda d: d.update(looks=[5]), "looks"),
        (lambda d: d.update(view=3), "JSON"),
    ],
)
def test_bad_strokes_are_refused(change, words):
    data = json.loads(
        json.dumps({"view": {"matrix": np.eye(4).ravel().tolist(), "size": [9, 9]}, "rows": [[1, 2], [3, 4]]})
    )
    change(data)
    with pytest.raises(ValueError, match=words):
        brush_stroke.read(json.dumps(data))


def test_modes_have_names(run):
    with pytest.raises(ValueError, match="mode"):
        stroke(run, (0, 0), mode="polish")
    with pytest.raises(ValueError, match="JSON"):
        brush_stroke.read("{")
