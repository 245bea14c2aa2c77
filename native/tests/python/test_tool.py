"""riffler.Tool: sizes, profiles, the dict form, and what is refused."""

import json
import math
import pickle

import numpy as np
import pytest
import riffler
from riffler.command import tools

TOOLS = {
    "ball": riffler.Tool.ball(6, 30),
    "flat": riffler.Tool.flat(6, 30),
    "fillet": riffler.Tool.fillet(8, 1, 30),
    "taper": riffler.Tool.taper(0.5, 0.2, 8, 40),
    "flat taper": riffler.Tool.taper(0.5, 0.2, 8, 40, flat_tip=True),
    "cone end": riffler.Tool.cone_end(1.0, 1, 0.4, 8, 40),
    "profile": riffler.Tool.profile([(1, 0), (3, 2, 1, 2), (2, 6)], 20),
}


SHAPES = {shape.name: shape for shape in riffler.Tool.shapes()}
# What each row of the table makes of the first values of its form.
TOOLS |= {f"first {name}": getattr(riffler.Tool, name)(*(s.default for s in SHAPES[name].sizes)) for name in SHAPES}


@pytest.mark.parametrize("name", TOOLS)
def test_a_tool_survives_its_dict_json_and_pickle(name):
    tool = TOOLS[name].with_shank([(30, 3, 40, 4)]).with_holder([(40, 10, 60, 12)]).named("mine")
    again = riffler.Tool.from_dict(json.loads(json.dumps(tool.to_dict())))
    assert again == tool == pickle.loads(pickle.dumps(tool))
    assert again.to_dict() == tool.to_dict()
    assert (again.name, again.length, again.diameter) == ("mine", tool.length, tool.diameter)
    assert again.shank == [(30, 3, 40, 4)]
    assert again.holder == [(40, 10, 60, 12)]


@pytest.mark.parametrize(("name", "diameter", "length"), [("ball", 6, 30), ("fillet", 8, 30), ("cone end", 8, 40)])
def test_tools_have_the_requested_sizes(name, diameter, length):
    assert TOOLS[name].diameter == pytest.approx(diameter, abs=1e-12)
    assert TOOLS[name].length == length


@pytest.mark.parametrize("name", SHAPES)
def test_a_shape_is_made_alike_by_its_function_its_dict_and_the_command_line(name):
    shape, tool = SHAPES[name], TOOLS[f"first {name}"]
    sizes = {s.name: s.default for s in shape.sizes}
    assert getattr(riffler.Tool, name)(**sizes) == tool
    entry = tool.to_dict()
    assert entry == {"name": tool.name, "kind": name, **sizes}
    assert [type(entry[s.name]) for s in shape.sizes] == [bool if s.unit == "bool" else float for s in shape.sizes]
    given = [s for s in shape.sizes if s.unit != "bool" and s.name != "length"]
    numbers = [math.degrees(s.default) if s.unit == "rad" else s.default for s in given]
    text = ":".join([name.replace("_", "-"), *map(repr, numbers), "30"])
    typed = tools.parse(text).make(1).to_dict()
    assert typed.pop("name") == text and typed.pop("kind") == name
    assert typed == pytest.approx({s.name: s.default for s in shape.sizes}, rel=1e-12)
    kind = name.replace("_", "-")
    assert tools.FORMS[kind] == f"{kind}:{':'.join(s.name for s in given)}[:length]"


def test_shapes_describe_themselves_for_forms():
    assert list(SHAPES)[:5] == ["ball", "flat", "fillet", "taper", "cone_end"], "Blender files keep the numbers"
    taper = {s.name: s for s in SHAPES["taper"].sizes}
    assert list(taper) == ["tip_radius", "half_angle", "diameter", "length", "flat_tip"]
    assert [s.unit for s in taper.values()] == ["mm", "rad", "mm", "mm", "bool"]
    assert taper["half_angle"].default == math.radians(5) and taper["flat_tip"].default is False
    assert SHAPES["fillet"].sizes[1].largest == 0.5 and taper["diameter"].largest is None
    for shape in SHAPES.values():
        text = getattr(riffler.Tool, shape.name).__doc__
        assert shape.label and shape.description in text and repr(shape) == f"<riffler.ToolShape {shape.name}>"
        assert all(f"\n{s.name} : " in text and s.label and 0 <= s.low <= s.default <= s.high for s in shape.sizes)


def revolved(tool):
    """Volume of the solid of revolution, mm³, from its outline."""
    ((_, points),) = tool.outline(tolerance=1e-4)
    r, z = points.T
    return math.pi / 3 * np.sum(np.diff(z) * (r[1:] ** 2 + r[1:] * r[:-1] + r[:-1] ** 2))


@pytest.mark.parametrize("name", SHAPES)
def test_a_cutter_that_stands_still_removes_its_own_volume(name):
    volume = riffler.Volume.block([0, 0, 0], [8, 8, 32], 0.05)
    removed = volume.carve(TOOLS[f"first {name}"], [[4, 4, 1, 0, 0, 1]] * 2).removed
    assert removed[0] == pytest.approx(revolved(TOOLS[f"first {name}"]), rel=2e-3)


def plunged(tool, depth):
    """What the tool removes when it is plunged `depth` into a block, mm³."""
    volume = riffler.Volume.block([0, 0, 0], [20, 20, 30], 0.1)
    volume.carve(tool, [[10, 10, 35, 0, 0, 1], [10, 10, 30 - depth, 0, 0, 1]])
    return 20 * 20 * 30 - volume.volume


def frustum(r0, r1, height):
    return math.pi * height * (r0 * r0 + r0 * r1 + r1 * r1) / 3


def closed_form_volumes():
    b, t = 0.2, 0.5
    r, z = t * math.cos(b), t * (1 - math.sin(b))
    rise = (4 - r) / math.tan(b)
    yield "ball", 20, 2 / 3 * math.pi * 27 + math.pi * 9 * 17
    yield "flat", 20, math.pi * 9 * 20
    yield "fillet", 20, math.pi * (16 * 19 + (9 * 1 + 2 * 3 * math.pi / 4 + 2 / 3))
    cap = math.pi * z * z * (t - z / 3)
    yield "taper", 25, cap + frustum(r, 4, rise) + math.pi * 16 * (25 - z - rise)
    r1, up = math.tan(1.0), (4 - math.tan(1.0)) / math.tan(0.4)
    yield "cone end", 20, frustum(0, r1, 1) + frustum(r1, 4, up) + math.pi * 16 * (19 - up)


@pytest.mark.parametrize(("name", "depth", "volume"), closed_form_volumes())
def test_plunged_tools_remove_their_own_volume(name, depth, volume):
    assert plunged(TOOLS[name], depth) == pytest.approx(volume, rel=2e-3)


@pytest.mark.parametrize(
    ("make", "word"),
    [
        (lambda: riffler.Tool.ball(0, 10), "diameter"),
        (lambda: riffler.Tool.ball(-1, 10), "diameter"),
        (lambda: riffler.Tool.ball(math.nan, 10), "diameter"),
        (lambda: riffler.Tool.ball(6, 0), "length"),
        (lambda: riffler.Tool.ball(6, 2), "length"),
        (lambda: riffler.Tool.flat(6, math.inf), "length"),
        (lambda: riffler.Tool.fillet(6, 4, 20), "corner_radius"),
        (lambda: riffler.Tool.taper(1, 2, 6, 20), "half_angle"),
        (lambda: riffler.Tool.taper(5, 0.2, 6, 20), "tip_radius"),
        (lambda: riffler.Tool.taper(0.5, 0.01, 6, 20), "length"),
        (lambda: riffler.Tool.cone_end(1.5, 10, 0.4, 6, 20), "tip_height"),
        (lambda: riffler.Tool.profile([], 10), "segments"),
        (lambda: riffler.Tool.profile([(1, 2, 3)], 10), "row 0"),
        (lambda: riffler.Tool.profile([(1, 2), (1, 1)], 10), "segment 1"),
        (lambda: riffler.Tool.profile([(1, 1), (3, 3, 0, 0)], 10), "segment 1"),
        (lambda: riffler.Tool.profile([(1, 1), (2e6, 3)], 10), "segment 1"),
        (lambda: riffler.Tool.ball(1e7, 2e7), "1e6 mm"),
        (lambda: riffler.Tool.ball(6, 20).with_shank([(20, 3, 10, 3)]), "shank"),
        (lambda: riffler.Tool.ball(6, 20).with_holder([(20, -3, 30, 3)]), "holder"),
        (lambda: riffler.Tool.from_dict({}), "kind"),
        (lambda: riffler.Tool.from_dict({"kind": "spoon"}), "spoon"),
        (lambda: riffler.Tool.from_dict({"kind": "ball", "diameter": 6}), "length"),
        (lambda: riffler.Tool.from_dict({"kind": "ball", "diameter": "six", "length": 3}), "diameter"),
    ],
)
def test_sizes_that_do_not_fit_are_refused_by_name(make, word):
    with pytest.raises(ValueError, match=word):
        make()


def test_shank_and_holder_never_cut():
    tool = riffler.Tool.ball(6, 10).with_shank([(10, 8, 20, 8)]).with_holder([(20, 15, 40, 15)])
    poses = np.array([[10, 10, 35, 0, 0, 1], [10, 10, 2, 0, 0, 1.0]])
    a = riffler.Volume.block([0, 0, 0], [20, 20, 30], 0.5)
    b = riffler.Volume.block([0, 0, 0], [20, 20, 30], 0.5)
    assert np.array_equal(a.carve(tool, poses).removed, b.carve(riffler.Tool.ball(6, 10), poses).removed)


def test_the_outline_is_that_of_the_pieces_within_its_tolerance():
    tool = riffler.Tool.ball(6, 20).with_shank([(15, 4, 25, 4)]).with_holder([(25, 10, 60, 12)])
    parts = tool.outline(tolerance=0.001)
    assert [name for name, _ in parts] == ["cutter", "shank", "holder"]
    points = dict(parts)
    assert points["cutter"][0] == pytest.approx([0, 0], abs=1e-12)
    assert points["cutter"][-1] == pytest.approx([3, 15], abs=1e-12)  # inside of the shank from here
    assert points["holder"][-1] == pytest.approx([0, 60], abs=1e-12)
    ball = points["cutter"][points["cutter"][:, 1] <= 3]
    assert np.hypot(ball[:, 0], ball[:, 1] - 3) == pytest.approx(3, abs=1e-12)
    middles = (ball[1:] + ball[:-1]) / 2
    assert 0 < (3 - np.hypot(middles[:, 0], middles[:, 1] - 3)).max() <= 0.001
    with pytest.raises(ValueError, match="tolerance"):
        tool.outline(tolerance=0)
