"""The sculpt tools without a window: in the toolbar, strokes from scripts, fixtures, refusals."""

import json
from pathlib import Path

import bpy
import numpy as np
import riffler

from support import common, leak_check

SIZE = (400, 300)
PIXEL = 0.1  # mm


def tools():
    return common.part("sculpt.tools").TOOLS


def volume_of(ob):
    return common.part("sculpt.live_registry").content(ob).volume


def view(middle):
    """From the stock's +Z, ten pixels per millimetre, centred on `middle` (mm)."""
    matrix = np.diag([2 / (SIZE[0] * PIXEL), 2 / (SIZE[1] * PIXEL), -0.01, 1.0])
    matrix[:3, 3] = -(matrix[:3, :3] @ np.append(middle, 0))
    return {"matrix": matrix.ravel().tolist(), "size": list(SIZE)}


def stroke(*places, middle=(20, 15), **more):
    """A script's stroke through places on the top (mm)."""
    rows = [[0.5 * SIZE[0] + (x - middle[0]) / PIXEL, 0.5 * SIZE[1] + (y - middle[1]) / PIXEL] for x, y in places]
    text = json.dumps({"view": view(middle), "rows": rows})
    return bpy.ops.riffler.stroke(stroke=text, tool=more.pop("tool", common.BALL), **more)


def groove(length, depth, radius=3.0):
    """Closed form: a segment of the circle along the path, and two halves of a cap of the ball."""
    half = np.arccos((radius - depth) / radius)
    segment = radius**2 * (half - np.sin(half) * np.cos(half))
    return length * segment + np.pi * depth**2 * (3 * radius - depth) / 3


def settings(**chosen):
    found = bpy.context.scene.riffler.sculpt
    for key, value in chosen.items():
        setattr(found, key, value)
    return found


def test_the_toolbar_has_the_tools_in_two_groups_with_existing_icons():
    from bl_ui.space_toolsystem_toolbar import VIEW3D_PT_tools_active as toolbar

    groups = [g for g in toolbar._tools["OBJECT"] if isinstance(g, tuple) and g[0] is not None]
    ours = [g for g in groups if getattr(g[0], "idname", "").startswith("riffler.")]
    assert [[t.idname for t in g] for g in ours] == [
        [t.bl_idname for t in g] for g in common.part("sculpt.tools").GROUPS
    ]
    assert [t.idname for g in ours for t in g] == [t.bl_idname for t in tools()]
    (plan,) = [t for t in toolbar._tools["OBJECT"] if getattr(t, "idname", "") == "riffler.plan"]
    for tool in (*ours[0], *ours[1], plan):
        data = Path(tool.icon + ".dat").read_bytes()
        assert data[:4] == b"VCO\0" and len(data) > 500 and (len(data) - 8) % 18 == 0
        assert tool.draw_cursor and tool.draw_settings and tool.widget
    keys = [line for line in leak_check.keymaps() if "riffler.stroke" in line]
    assert len(keys) == 6 * len(tools())  # each on the active sculpt, and elsewhere


def test_fields_of_the_panels_are_the_scenes_but_make_no_undo_steps():
    scene, shown = bpy.context.scene.riffler, bpy.context.window_manager.riffler
    for place in ("sculpt", "tool", "hand_tool"):
        kept, fields = getattr(scene, place), getattr(shown, place)
        own = set(fields.bl_rna.properties.keys()) - {"rna_type", "name"}
        assert own == set(kept.bl_rna.properties.keys()) - {"rna_type", "name", "fixtures", "preset"}
        for key in own:
            field, same = (group.bl_rna.properties[key] for group in (fields, kept))
            assert (field.name, field.description, field.type) == (same.name, same.description, same.type)
            value = getattr(kept, key)
            assert getattr(fields, key) == value, key
    shown.sculpt.radius, shown.sculpt.axis, shown.sculpt.mirror = 4.0, "UP", {"X", "Z"}
    assert scene.tool.diameter == 8.0 and scene.sculpt.axis == "UP" and scene.sculpt.mirror == {"X", "Z"}
    assert shown.tool.diameter == 8.0 and shown.sculpt.mirror == {"X", "Z"}
    shown.tool.kind = "taper"
    assert scene.tool.kind == "taper" == shown.tool.kind


def test_undo_undoes_strokes_and_leaves_the_brush():
    common.scale(1)
    name = common.stock(pitch=0.5).name
    common.push("stock")
    before = volume_of(bpy.data.objects[name]).volume
    settings(radius=3.0, depth=0.5, mirror=set())
    bpy.ops.riffler.stroke(
        "EXEC_DEFAULT", True, stroke=json.dumps({"view": view((20, 15)), "rows": [[180, 150], [220, 150]]})
    )
    assert volume_of(bpy.data.objects[name]).volume < before
    settings(radius=1.5, depth=0.25, mirror={"X"}, axis="UP")
    bpy.context.scene.riffler.tool.kind = "flat"
    for step in (bpy.ops.ed.undo, bpy.ops.ed.redo):
        step()
        found = bpy.context.scene.riffler
        chosen = found.sculpt.radius, found.sculpt.depth, found.sculpt.mirror, found.sculpt.axis, found.tool.kind
        assert chosen == (1.5, 0.25, {"X"}, "UP", "flat"), chosen
    bpy.ops.ed.undo()
    assert volume_of(bpy.data.objects[name]).volume == before


def test_sizes_go_in_steps_as_in_sculpt_mode_and_no_key_leaves_an_undo_step():
    sculpt = settings(radius=4.0)
    bpy.ops.riffler.size_step(larger=True)
    bpy.ops.riffler.size_step(larger=True)
    assert abs(sculpt.radius - 4 / 0.81) < 1e-5
    bpy.ops.riffler.size_step()
    bpy.ops.riffler.size_step()
    assert abs(sculpt.radius - 4) < 1e-5
    for tool in tools():
        sizes = [(name, event["type"], event.get("shift", False)) for name, event, _ in tool.bl_keymap]
        for key in (("riffler.resize", "F", False), ("riffler.resize", "F", True)):
            assert key in sizes
        assert {e for n, e, _ in sizes if n == "riffler.size_step"} == {"LEFT_BRACKET", "RIGHT_BRACKET"}
    for cls in (*common.part("sculpt.resize").CLASSES, common.part("sculpt.tool_panel").RIFFLER_OT_tool_preset):
        assert "UNDO" not in cls.bl_options


@common.core_bound
def test_a_stroke_from_a_script_is_the_groove_of_the_formula_in_any_scene():
    for unit in (1000.0, 1.0):
        bpy.ops.wm.read_homefile()
        common.scale(unit)
        ob = common.stock(pitch=0.25, directions="xyz")
        settings(depth=0.8)
        before = volume_of(ob).volume
        assert stroke((10, 15), (30, 15)) == {"FINISHED"}
        removed = before - volume_of(ob).volume
        assert abs(removed / groove(20, 0.8) - 1) < 0.01, (unit, removed)


@common.core_bound
def test_material_is_added_within_the_stocks_box():
    common.scale(1)
    ob = common.stock(pitch=0.25, directions="xyz")
    settings(depth=2.0)
    stroke((10, 15), (30, 15))
    hollow = volume_of(ob).volume
    settings(depth=0.5)
    stroke((10, 15), (30, 15), mode="ADD")
    assert hollow < volume_of(ob).volume < 24000


@common.core_bound
def test_material_that_the_box_cuts_off_is_reported_at_once():
    common.scale(1)
    ob = common.stock(size=(40, 30, 20), pitch=0.5, directions="xyz")
    settings(depth=1.0)
    stroke((10, 15), (30, 15))
    add = lambda: stroke((14, 15), (26, 15), mode="ADD")  # noqa: E731
    settings(depth=0.5)
    assert "cut off" not in common.printed(add)  # it ends half a millimetre below the box
    settings(depth=1.5)
    assert "cut off at the stock's box: use Grow Box" in common.printed(add)
    common.part("sculpt.live_registry").end_all()
    top = common.coordinates(ob.data)[:, 2].max()
    assert top <= 20 + 1e-4
    assert bpy.ops.riffler.room(room=3.0) == {"FINISHED"}
    assert "cut off" not in common.printed(add)
    common.part("sculpt.live_registry").end_all()
    assert common.coordinates(ob.data)[:, 2].max() > top + 0.5
    assert "cut off" not in common.printed(lambda: stroke((10, 8), (30, 8)))  # what was added before
    path = common.out("added.rjournal")
    recorded(path, ob)
    assert "cut off at the stock's box" in common.printed(lambda: bpy.ops.riffler.cut_recording(filepath=path))


def recorded(path, ob):
    """A recording of a stroke that adds material beyond the box of a sculpt."""
    volume, journal = volume_of(ob), riffler.Journal()
    journal.set_stock(volume.lower, volume.upper, volume.pitch, volume.directions)
    journal.add_tool(1, riffler.Tool.ball(6, 4).to_dict())
    z = volume.upper[2] - 1
    journal.add_stroke(1, [[10, 5, z, 0, 0, 1], [30, 5, z, 0, 0, 1]], mode="add")
    journal.save(path)


@common.core_bound
def test_every_copy_of_a_stroke_is_made():
    common.scale(1)
    ob = common.stock(size=(40, 40, 20), pitch=0.25, directions="xyz")
    for chosen, count in (({"mirror": {"X", "Y"}}, 4), ({"radial": 3, "radial_axis": "Z"}, 3), ({}, 1)):
        settings(**{"mirror": set(), "radial": 1, "depth": 0.8, **chosen})
        before = volume_of(ob).volume
        stroke((28, 27), (32, 27), middle=(20, 20))
        removed = before - volume_of(ob).volume
        assert abs(removed / (count * groove(4, 0.8)) - 1) < 0.02, (chosen, removed)
        bpy.ops.wm.read_homefile()
        common.scale(1)
        ob = common.stock(size=(40, 40, 20), pitch=0.25, directions="xyz")


@common.core_bound
def test_a_mask_protects_the_material_that_it_covers():
    common.scale(1)
    ob = common.stock(pitch=0.25, directions="xyz")
    settings(depth=2.0)
    assert stroke((20, 15), mode="MASK") == {"FINISHED"}
    whole = volume_of(ob).volume
    settings(depth=0.5)
    assert stroke((20, 15)) == {"CANCELLED"} and volume_of(ob).volume == whole
    settings(depth=2.5)
    stroke((20, 15), mode="UNMASK")
    settings(depth=0.5)
    assert stroke((20, 15)) == {"FINISHED"} and volume_of(ob).volume < whole


@common.core_bound
def test_fixtures_keep_the_tool_out():
    common.scale(1)
    ob = common.stock(pitch=0.25, directions="xyz")
    clamps = bpy.data.collections.new("Clamps")
    bpy.context.scene.collection.children.link(clamps)
    bpy.ops.mesh.primitive_cube_add(size=4, location=(25, 15, 20))  # up to 2 mm above the stock's top
    cube = bpy.context.object
    for collection in list(cube.users_collection):
        collection.objects.unlink(cube)
    clamps.objects.link(cube)
    bpy.context.view_layer.objects.active = ob
    settings(depth=1.0, fixtures=clamps, axis="UP")
    stroke((10, 15), (25, 15))
    counts, spans = volume_of(ob).intervals("z")
    top = np.full(counts.shape, np.nan)
    top[counts > 0] = spans[np.cumsum(counts.ravel()[counts.ravel() > 0]) - 1, 1]
    x = 0.125 + 0.25 * np.arange(counts.shape[0])
    row = top[:, 59]  # y = 14.875
    assert abs(row[np.searchsorted(x, 12)] - 19) < 0.01
    assert row[(x > 23.1) & (x < 26.9)].min() == 20, "it went through the clamp"


def clamp(ob, place, size=4):
    """A cube that is a fixture of the sculpt tools."""
    clamps = bpy.data.collections.new("Clamps")
    bpy.context.scene.collection.children.link(clamps)
    bpy.ops.mesh.primitive_cube_add(size=size, location=place)
    cube = bpy.context.object
    for collection in list(cube.users_collection):
        collection.objects.unlink(cube)
    clamps.objects.link(cube)
    bpy.context.view_layer.objects.active = ob
    return clamps


def least_clearance(ob, clamps):
    """The smallest clearance of the whole cut from the fixtures, between the poses, too."""
    solid = common.part("sculpt.fixtures").collider(bpy.context, clamps, common.part("sculpt.sculpts").from_world(ob))
    found = []
    for cut in common.part("sculpt.live_registry").content(ob).cuts:
        a, b = np.asarray(cut.poses)[:-1], np.asarray(cut.poses)[1:]
        way = np.concatenate([a + share * (b - a) for share in np.linspace(0, 1, 41)])
        found.append(solid.clearance(riffler.Tool.from_dict(cut.tool), way).min())
    return min(found)


@common.core_bound
def test_no_tool_passes_through_a_fixture_on_its_way_up_nor_do_copies_by_symmetry():
    common.scale(1)
    ob = common.stock(pitch=0.5, directions="z")
    clamps = clamp(ob, (30, 15, 20))
    settings(depth=1.0, fixtures=clamps, axis="UP")
    stroke((22, 15), (38, 15))
    assert least_clearance(ob, clamps) > -0.02
    settings(mirror={"X"})  # about x = 20: the clamp stands on the copy's side
    stroke((4, 15), (16, 15))
    copies = common.part("sculpt.live_registry").content(ob).cuts[1:]
    assert len(copies) == 2 and least_clearance(ob, clamps) > -0.02
    heights = [np.asarray(c.poses)[:, 2].max() for c in copies]
    assert heights[0] < 20.01 and heights[1] > 21.9, heights


def test_a_stroke_goes_around_an_obstacle_that_no_lift_clears():
    common.scale(1)
    ob = common.stock(pitch=0.5, directions="z")
    clamps = clamp(ob, (20, 15, 20), size=8)
    settings(depth=1.0, fixtures=clamps, axis="UP")
    run = common.part("sculpt.live_registry").begin(bpy.context, ob)
    run.maps = common.part("sculpt.pure.symmetry").maps("X")
    run.keep_out = lambda poses, dt: None if (np.abs(poses[:, 0] - 35) < 2).any() else (poses, dt)
    run.begin_stroke()
    for k in range(4):
        run.carve(
            riffler.Tool.ball(6, 30), np.array([[2.0 + k, 5, 18, 0, 0, 1], [3.0 + k, 5, 18, 0, 0, 1]]), new=k == 0
        )
    run.finish_stroke(bpy.context)
    first, *copies = run.cuts
    assert first.moves == 4
    ways = np.concatenate([np.abs(np.diff(np.asarray(c.poses)[:, 0])) for c in copies])
    assert ways.max() < 1.01, "a copy went on across what it was kept out of"


@common.core_bound
def test_a_mirrored_fixture_is_as_solid_as_any():
    """The tool is completely inside it, and touches none of its faces."""
    common.scale(1)
    ob = common.stock(pitch=0.5)
    jaws = bpy.data.collections.new("Jaws")
    bpy.context.scene.collection.children.link(jaws)
    bpy.ops.mesh.primitive_cube_add(size=120, location=(30, 15, 20))
    jaw = bpy.context.object
    jaws.objects.link(jaw)
    bpy.context.view_layer.objects.active = ob
    pose = np.array([[20, 15, 10, 0, 0, 1.0], [24, 15, 10, 0, 0, 1.0]])
    for scale in ((1, 1, 1), (-1, 1, 1), (-1, -1, -1)):
        jaw.scale = scale
        bpy.context.view_layer.update()
        solid = common.part("sculpt.fixtures").collider(bpy.context, jaws, common.part("sculpt.sculpts").from_world(ob))
        _, report = riffler.plan.lift(pose, riffler.Tool.ball(6, 30), solid, tolerance=0.001)
        assert not report.free.any() or np.all(report.lift > 60), scale


def test_handles_of_a_mirrored_sculpt_are_as_large_as_of_any():
    common.scale(1)
    ob = common.stock(pitch=0.5)
    place = common.part("sculpt.size_gizmo")._place
    for scale, expected in (((1, 1, 1), 1), ((-1, 1, 1), 1), ((-2, -2, -2), 2), ((1, 1, 0), 0)):
        ob.scale = scale
        bpy.context.view_layer.update()
        assert abs(place(ob)[1] - expected) < 1e-6, scale


def test_undo_undoes_a_stroke():
    common.scale(1)
    name = common.stock(pitch=0.5).name
    common.push("stock")
    before = volume_of(bpy.data.objects[name]).volume
    shown = []
    for x in (10, 20, 30):
        stroke((x, 15), mode="REMOVE")
        common.push("stroke")
        shown.append(volume_of(bpy.data.objects[name]).volume)
    assert before > shown[0] > shown[1] > shown[2]
    bpy.ops.ed.undo()
    assert volume_of(bpy.data.objects[name]).volume == shown[1]
    bpy.ops.ed.redo()
    assert volume_of(bpy.data.objects[name]).volume == shown[2]


def test_objects_that_cannot_be_stroked_are_refused_and_nothing_changes():
    common.scale(1)
    ob = common.stock()
    before = volume_of(ob).volume
    good = json.dumps({"view": view((20, 15)), "rows": [[200, 150]]})
    common.refused(lambda: bpy.ops.riffler.stroke(), "stroke", "no pointer")
    common.refused(lambda: bpy.ops.riffler.stroke(stroke="{"), "JSON")
    common.refused(lambda: bpy.ops.riffler.stroke(stroke=json.dumps({"view": view((0, 0)), "rows": [[1]]})), "row 0")
    common.refused(lambda: bpy.ops.riffler.stroke(stroke=good, tool='{"kind": "ball"}'), "")
    common.refused(lambda: stroke((20, 15), mode="SOFTEN"), "three directions", "Change Pitch")
    assert stroke((200, 200)) == {"CANCELLED"}
    assert volume_of(ob).volume == before
    bpy.ops.object.select_all(action="DESELECT")
    bpy.context.view_layer.objects.active = None
    assert not bpy.ops.riffler.stroke.poll()


def test_an_events_pressure_and_tilt_count_only_where_a_tablet_made_it():
    from types import SimpleNamespace as Names

    sample = common.part("sculpt.stroke_operator").sample
    pen = Names(mouse_x=130, mouse_y=90, is_tablet=True, pressure=0.25, tilt=(0.5, -0.125))
    assert sample(pen, (100, 50))[:5] == (30, 40, 0.25, 0.5, 0.125)
    pen.is_tablet = False
    assert sample(pen, (100, 50))[:5] == (30, 40, 1.0, 0.0, 0.0)


def test_a_view_of_blenders_own_gives_the_rays_that_blender_gives():
    from bpy_extras import view3d_utils
    from mathutils import Matrix

    sight = common.part("sculpt.pure.view_rays").ViewRays
    for perspective in (True, False):
        size = (640, 480)
        camera = bpy.data.objects["Camera"]
        camera.data.type = "PERSP" if perspective else "ORTHO"
        bpy.context.view_layer.update()
        depsgraph = bpy.context.evaluated_depsgraph_get()
        window = camera.calc_matrix_camera(depsgraph, x=size[0], y=size[1])
        total = window @ camera.matrix_world.inverted()

        class Region:
            width, height = size

        class Space:
            perspective_matrix, view_matrix = Matrix(total), camera.matrix_world.inverted()
            is_perspective = perspective
            view_perspective = "PERSP"

        ours = sight(np.array(total), size)
        for pixel in ((3, 5), (320, 240), (600, 100)):
            origin, direction = ours.ray(*pixel)
            theirs = np.array(view3d_utils.region_2d_to_vector_3d(Region, Space, pixel))
            start = np.array(view3d_utils.region_2d_to_origin_3d(Region, Space, pixel))
            assert np.abs(direction - theirs).max() < 1e-4, (perspective, pixel, direction, theirs)
            away = start - origin
            assert np.linalg.norm(away - (away @ direction) * direction) < 1e-3 * max(1, np.linalg.norm(away))
