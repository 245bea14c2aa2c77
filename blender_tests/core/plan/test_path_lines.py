"""A plan's lines by the tool's movement, titles of findings, names on the timeline, sizes of tools and parts."""

import json
import math

import numpy as np
import pytest
import riffler

from addon.common import presets, tool_sizes
from addon.plan.pure import machine_fields, path_lines, path_names, size_guess
from addon.program.pure import finding_titles, program_timeline


def path(points=11, closed=False, lean=0.6):
    """A straight valley along y; a ball of 3 mm radius touches floor and wall."""
    y = np.linspace(0, 10, points)
    centres = np.stack([3 + 0 * y, y, 3 + 0 * y], axis=1)
    contacts = np.stack([centres - [0, 0, 3], centres - [3, 0, 0]], axis=1)
    normals = np.broadcast_to([[[0.0, 0, 1], [1, 0, 0]]], (points, 2, 3))
    bare = riffler.plan.PencilPath(3.0, centres, contacts, normals, closed=closed)
    return bare.orient({0: (lean, 0, math.sqrt(1 - lean**2))})


def rows_of(some):
    return np.hstack([some.centres - some.radius * some.axes, some.axes])


def test_rows_on_the_path_are_cut_and_those_above_it_lifted():
    some = path()
    rows = rows_of(some)
    rows[4:7, :3] += 2 * rows[4:7, 3:]
    assert np.allclose(path_lines.lifts(some, rows), [0, 0, 0, 0, 2, 2, 2, 0, 0, 0, 0], atol=1e-12)
    found = path_lines.of_path(some, rows, "free")
    assert len(found["cut"]) == 6 and len(found["lifted"]) == 4
    assert np.allclose(found["cut"][0], [[3, 0, 3], [3, 1, 3]]), "along the ball's centres"


def test_rows_between_points_are_lifted_as_their_neighbours_are():
    some = path()
    rows = rows_of(some)
    rows[4:7, :3] += 2 * rows[4:7, 3:]
    between = (rows[3] + rows[4]) / 2 + [5, 0, 0, 0, 0, 0]
    assert np.allclose(path_lines.lifts(some, np.insert(rows, 4, between, axis=0))[3:6], [0, 1, 2], atol=1e-12)
    off = rows + np.array([5, 0, 0, 0, 0, 0])
    assert np.array_equal(path_lines.lifts(some, off), np.zeros(11)), "none of them is on the path"


@pytest.mark.parametrize("state", ["keyed", "unplanned", "blocked", "off"])
def test_uncut_paths_are_one_line_along_the_centres(state):
    found = path_lines.of_path(path(), None if state != "off" else rows_of(path()), state)
    assert list(found) == [state] and len(found[state]) == 10
    loop = path_lines.of_path(path(closed=True), None, state)[state]
    assert len(loop) == 11 and np.array_equal(loop[-1, 1], loop[0, 0])


def test_colliding_stretches_are_separate_lines():
    hits = path_lines.hits(np.arange(1.0, 12.0), [(3, 5), (9, 9)])
    assert hits.tolist() == [False, False, True, True, True, False, False, False, True, False, False]
    found = path_lines.of_path(path(), None, "keyed", hits)
    assert len(found["collides"]) == 6 and len(found["keyed"]) == 4
    line = path_lines.of_path(path(), None, "keyed")["keyed"]
    assert np.array_equal(found["collides"], line[[1, 2, 3, 4, 7, 8]])
    assert np.array_equal(found["keyed"], line[[0, 5, 6, 9]])
    loop = path(closed=True)
    assert list(path_lines.of_path(loop, None, "keyed", np.ones(11, bool))) == ["keyed"], "of another path"
    assert len(path_lines.of_path(loop, None, "keyed", np.ones(12, bool))["collides"]) == 11
    assert list(path_lines.of_path(path(), None, "blocked", hits)) == ["blocked"]


def test_moves_between_cuts_are_lead_ins_rapids_and_retracts():
    tool = riffler.Tool.ball(6, 30)
    cuts = [rows_of(path(lean=0.0)), rows_of(path(lean=0.0)) + np.array([40, 0, 0, 0, 0, 0])]
    program = riffler.Program.from_cl(cuts, tools=[tool], feed=600, safe_height=50)
    begins = program_timeline.begins(program.poses, cuts)
    found = path_lines.of_links(program.poses, begins, [len(c) for c in cuts], 3.0)
    total = sum(map(len, found.values())) + sum(len(c) - 1 for c in cuts)
    assert set(found) == {"lead", "retract", "rapid"} and total == len(program.poses) - 1
    assert np.allclose(found["rapid"][:, :, 2], 53), "at safe height, the ball's centre a radius above"
    up, down = found["retract"][:, :, 2], found["lead"][:, :, 2]
    assert np.all(np.diff(up, axis=1) >= 0) and np.all(np.diff(down, axis=1) <= 0)
    with pytest.raises(ValueError, match="the program does not contain path 2 unchanged"):
        program_timeline.begins(program.poses, [cuts[0], cuts[1] + 1])


def test_names_on_the_timeline_are_recognised():
    said = [path_names.name(2, 12.44), path_names.name(0, 5.0, True), path_names.name(1, 1e3, False, "Plan ▸ 2")]
    assert said == ["▸ Path 3, 12.4 mm", "▸ Path 1, 5 mm off", "Plan ▸ 2 ▸ Path 2, 1000 mm"]
    assert all(map(path_names.is_name, said))
    for other in ("Path 3, 12.4 mm", "Path 3", "▸ mine", "collides 3–7", "▸ Path 3, 12.4 mm!", ""):
        assert not path_names.is_name(other)


def test_titles_begin_with_what_differs():
    assert finding_titles.verified("Gouge", 0.7694, (43.8, 17.2, 7.2)) == "Gouge 0.77 at 44 17 7"
    assert finding_titles.verified("Rapid in material", 1234.5, (-0.2, 0, 1e3)) == "Rapid in material 1234 at 0 0 1000"
    assert finding_titles.verified("Out of reach", 0.0, (0, 0, 0)) == "Out of reach at 0 0 0"


def test_parts_are_odd_where_no_tool_of_that_size_makes_them():
    assert not size_guess.odd(60, 6) and not size_guess.odd(1800, 6) and not size_guess.odd(6, 6)
    assert size_guess.odd(4000, 6) and size_guess.odd(5.9, 6) and not size_guess.odd(0, 6)
    assert [size_guess.likely(x) for x in (0.06, 4, 12, 90, 1e6)] == ["M", "INCH", "CM", "MM", "MM"]


@pytest.mark.parametrize("kind", ["ball", "flat", "fillet", "taper", "cone_end"])
@pytest.mark.parametrize(("key", "value"), [("diameter", 0.2), ("diameter", 60.0), ("length", 3.0), ("length", 200.0)])
def test_every_size_that_is_set_makes_a_tool(kind, key, value):
    """For a cutter with the other sizes that a change of its shape sets."""
    tool = riffler.Tool.ball(6, 40).with_shank([(40, 3, 60, 3)]).with_holder([(60, 14, 90, 16)]).to_dict()
    made = tool_sizes.changed(tool_sizes.changed(json.loads(json.dumps(tool)), "kind", kind), key, value)
    built = riffler.Tool.from_dict(made)
    assert built.kind == kind and math.isclose(made[key], value) and made["name"].endswith(" mm")
    further = made["length"] - 40
    assert built.shank[0][0] == pytest.approx(40 + further) and built.holder[0][2] == pytest.approx(90 + further)


@pytest.mark.parametrize("kind", presets.SIZES)
@pytest.mark.parametrize("diameter", [0.2, 6.0, 60.0])
def test_every_shape_can_be_chosen_at_any_diameter(kind, diameter):
    tool = riffler.Tool.ball(diameter, 5 * diameter).to_dict()
    made = tool_sizes.changed(tool, "kind", kind)
    built = riffler.Tool.from_dict(made)
    assert built.kind == kind and (made["diameter"], made["length"]) == (diameter, 5 * diameter)
    assert set(made) == {"kind", "name", *presets.SIZES[kind]}


def test_sizes_that_make_no_tool_are_refused():
    fillet = {"kind": "fillet", "diameter": 6.0, "corner_radius": 1.0, "length": 30.0}
    assert tool_sizes.changed(fillet, "corner_radius", 9.0)["corner_radius"] == 3, "as round as it can be"
    taper = {"kind": "taper", "diameter": 6.0, "tip_radius": 0.5, "half_angle": 0.1, "length": 30.0, "flat_tip": False}
    with pytest.raises(ValueError, match="length"):
        tool_sizes.changed(taper, "half_angle", 0.01)


def test_machines_and_options_have_names_that_blender_takes():
    names = [machine_fields.machine_identifier(name) for name in ("tcp-bc", "tcp_bc", "3-axis", "my mill.v2")]
    assert len(set(names)) == 4 and all(name.replace("_", "").isalnum() for name in names)
    fact = next(f for f in riffler.machine_options("linuxcnc-xyzac") if f.name == "max_rotary")
    assert machine_fields.label(fact) == "Max Rotary (deg/min)" and machine_fields.about(fact)[0].isupper()
    assert [f.name for f in machine_fields.missing("linuxcnc-xyzac", {})] == ["rot_point"]
    assert machine_fields.missing("linuxcnc-xyzac", {"tcp": True}) == []
    with pytest.raises(ValueError, match=r"Rot Point \(mm\) is not set, .*3D cursor"):
        machine_fields.check("linuxcnc-xyzac", {})
    with pytest.raises(ValueError, match=r"Pivot Length \(mm\) is not set, .*panel Machine$"):
        machine_fields.check("head-head", {"tcp": False})


def test_files_have_the_extension_of_the_machine_s_control(tmp_path, monkeypatch):
    monkeypatch.setenv("RIFFLER_MACHINES", str(tmp_path))
    (tmp_path / "mill.toml").write_text('description = "mill"\ncontrol = "sinumerik"\n')
    (tmp_path / "broken.toml").write_text("description = 3")
    found = [machine_fields.extension(m) for m in ("tcp", "heidenhain-bc", "apt", "mill", "broken")]
    assert found == [".ngc", ".h", ".apt", ".mpf", ".ngc"]
    assert machine_fields.file_filter("*.nc;*.tap") == "*.ngc;*.h;*.mpf;*.apt;*.nc;*.tap"
