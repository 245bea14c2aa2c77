"""New stock: sizes in every unit, objects as material, and refusals."""

import bpy
import numpy as np
import riffler

from support import common, operator_task


def test_a_block_has_its_size_in_mm_in_any_scene():
    for unit in (1000.0, 1.0, 10.0, 25.4):
        common.scale(unit)
        ob = common.stock(size=(40, 30, 20), pitch=0.5)
        volume = common.content(ob).volume
        assert np.array_equal(volume.upper - volume.lower, (40, 30, 20))
        assert volume.volume == 24000
        assert np.allclose(np.array(ob.dimensions) * unit, (40, 30, 20), rtol=1e-5), (unit, ob.dimensions[:])


def test_the_mesh_is_closed_and_encloses_the_block():
    for directions in ("z", "xyz"):
        common.scale(1)
        ob = common.stock(size=(10, 8, 6), pitch=0.5, directions=directions)
        ob.data.calc_loop_triangles()
        tri = np.array([t.vertices[:] for t in ob.data.loop_triangles])
        assert abs(common.mesh_volume(common.coordinates(ob.data), tri) - 480) < 5, directions
        edges = np.sort(np.concatenate([tri[:, [0, 1]], tri[:, [1, 2]], tri[:, [2, 0]]]), axis=1)
        assert (np.unique(edges, axis=0, return_counts=True)[1] == 2).all()
        assert not ob.data.validate()


def test_a_stock_stands_at_the_chosen_origin():
    common.scale(1)
    for origin, lower in (("CORNER", (0, 0, 0)), ("TOP", (-20, -15, -20)), ("CENTRE", (-20, -15, -10))):
        ob = common.stock(origin=origin)
        assert np.array_equal(common.content(ob).volume.lower, lower)
    bpy.context.scene.cursor.location = (1, 2, 3)
    assert common.stock().location[:] == (1, 2, 3)


def test_the_new_sculpt_is_active_and_alone_selected():
    a = common.stock()
    b = common.stock()
    assert bpy.context.object == b and bpy.context.selected_objects == [b]
    assert a.data != b.data


def test_an_object_becomes_material_with_its_modifiers_scale_and_place():
    common.scale(1000)
    bpy.ops.mesh.primitive_uv_sphere_add(segments=64, ring_count=32, radius=0.02, location=(0.5, 0.2, 0.1))
    sphere = bpy.context.object
    sphere.rotation_euler = (0.3, 0.2, 0.1)
    sphere.scale = (1, 1, 0.5)
    array = sphere.modifiers.new("two", "ARRAY")
    array.use_relative_offset, array.use_constant_offset = False, True
    array.constant_offset_displace = (0.1, 0, 0)
    bpy.context.view_layer.update()
    bpy.ops.riffler.new_stock(source="OBJECT", pitch=0.5, directions="z")
    ob = bpy.context.object
    volume = common.content(ob).volume
    ideal = 2 * 4 / 3 * np.pi * 20**3 * 0.5
    assert abs(volume.volume / ideal - 1) < 0.01, volume.volume
    assert np.allclose(volume.upper - volume.lower, (140, 40, 20), atol=0.5)
    assert np.allclose(ob.scale, 1) and np.allclose(ob.location, (0.5, 0.2, 0.1))
    assert np.allclose(ob.rotation_euler, (0.3, 0.2, 0.1), atol=1e-6)
    assert sphere.hide_get()


def test_a_mirrored_object_is_material_too():
    common.scale(1)
    bpy.ops.mesh.primitive_cube_add(size=10)
    bpy.context.object.scale = (-1, 1, 1)
    bpy.context.view_layer.update()
    bpy.ops.riffler.new_stock(source="OBJECT", pitch=0.5, directions="z")
    assert abs(common.content(bpy.context.object).volume.volume - 1000) < 1e-6


def test_stock_of_a_sculpt_is_the_shown_mesh():
    """Its volume itself if it is unscaled; mirrored, larger or with a modifier, its surface."""
    common.scale(1)
    for scale, modifier, exact in (((1, 1, 1), "", True), ((-1, 1, 1), "", False), ((2, 2, 2), "", False),
                                   ((1, 1, 1), "MIRROR", False)):  # fmt: skip
        for ob in list(bpy.data.objects):
            bpy.data.objects.remove(ob)
        source = common.stock(size=(10, 6, 4), pitch=0.5, directions="xyz", origin="CORNER")
        source.location, source.scale, source.rotation_euler.z = (3, 5, 7), scale, 0.4
        if modifier:
            source.modifiers.new(modifier, modifier)
        bpy.context.view_layer.update()
        depsgraph = bpy.context.evaluated_depsgraph_get()
        box = box_of(source.evaluated_get(depsgraph))
        before = common.content(source).volume
        assert bpy.ops.riffler.new_stock(source="OBJECT", pitch=0.5, directions="xyz") == {"FINISHED"}
        made = bpy.context.object
        assert made != source and source.hide_get()
        assert np.allclose(box_of(made), box, atol=0.02), (scale, modifier, box_of(made), box)
        assert (common.content(made).volume.to_bytes() == before.to_bytes()) == exact


def box_of(ob):
    """The box of its vertices, in the world."""
    at = np.array(ob.matrix_world) @ np.column_stack([common.coordinates(ob.data), np.ones(len(ob.data.vertices))]).T
    return np.array([at[:3].min(axis=1), at[:3].max(axis=1)])


def test_what_is_refused_changes_nothing():
    before = len(bpy.data.objects), len(bpy.data.meshes), len(bpy.data.images)
    bpy.ops.mesh.primitive_plane_add(size=0.01)
    plane = bpy.context.object
    common.refused(lambda: bpy.ops.riffler.new_stock(source="OBJECT", pitch=0.5))
    assert not plane.hide_get()
    bpy.data.objects.remove(plane)
    bpy.context.view_layer.objects.active = None
    common.refused(lambda: bpy.ops.riffler.new_stock(source="OBJECT", pitch=0.5), "select the object")
    common.refused(lambda: common.stock(size=(1e5, 1e5, 1e5), pitch=0.001, directions="xyz"))
    assert (len(bpy.data.objects), len(bpy.data.meshes) - 1, len(bpy.data.images)) == before


def test_sizes_that_make_no_sense_are_refused_by_the_name_of_their_field():
    common.scale(1)
    before = seen()
    nan, inf = float("nan"), float("inf")
    for size, pitch, *words in (
        ((-5, 60, 30), 0.5, "Size along x", "0.001 mm", "pitch of 0.5 mm: make it larger"),
        ((100, 0.001, 30), 0.5, "Size along y is 0.001 mm", "use a finer pitch"),
        ((100, 60, nan), 0.5, "Size along z must be a positive length in mm, not nan"),
        ((inf, 60, 30), 0.5, "100000 × 60 × 30 mm", "coarser pitch"),
        ((100, 60, 30), 1000, "Size along x is 100 mm", "pitch of 1000 mm"),
        ((100, 60, 30), -1, "at 0.0001 mm", "coarser pitch"),
        ((100, 60, 30), nan, "pitch must be a positive length in mm, not nan"),
    ):
        common.refused(lambda size=size, pitch=pitch: common.stock(size=size, pitch=pitch), *words)
        assert seen() == before, (size, pitch)
    bpy.ops.mesh.primitive_cube_add(size=10)
    common.refused(
        lambda: bpy.ops.riffler.new_stock(source="OBJECT", pitch=1000), "1000 mm is longer than", "10 × 10 × 10 mm"
    )


def seen():
    """All objects, the visible and selected ones, and the active one."""
    kinds = bpy.data.objects, bpy.data.meshes, bpy.data.images
    chosen = [(ob.name, ob.hide_get(), ob.select_get()) for ob in bpy.context.view_layer.objects]
    return [len(kind) for kind in kinds], chosen, bpy.context.object.name


def of_mesh():
    return bpy.ops.riffler.new_stock("EXEC_DEFAULT", True, source="OBJECT", pitch=0.5, directions="z")


def test_the_facets_of_an_object_become_round_on_request():
    """Blender's own sphere and cylinder of 40 mm: facets 0.2 mm deep, and the bar's sharp rim."""
    common.scale(1)
    off = {}
    for rounded in (False, True):
        bpy.ops.mesh.primitive_uv_sphere_add(radius=20)
        assert bpy.ops.riffler.new_stock(source="OBJECT", pitch=0.5, rounded=rounded) == {"FINISHED"}
        at = np.linalg.norm(common.coordinates(bpy.context.object.data), axis=1)
        bpy.ops.mesh.primitive_cylinder_add(radius=20, depth=40, location=(60, 0, 0))
        assert bpy.ops.riffler.new_stock(source="OBJECT", pitch=0.5, rounded=rounded) == {"FINISHED"}
        off[rounded] = np.abs(at - 20).max(), common.content(bpy.context.object).volume.volume / (16e3 * np.pi) - 1
        assert np.ptp(common.coordinates(bpy.context.object.data)[:, 2]) < 40 + 1e-4
    assert off[False][0] > 0.15 and off[False][1] < -5e-3, off
    assert off[True][0] < 0.02 and abs(off[True][1]) < 1e-3, off


def test_a_mesh_whose_work_is_cancelled_or_fails_leaves_nothing_behind():
    common.scale(1)
    bpy.ops.mesh.primitive_cube_add(size=10)
    common.push("cube")
    before = seen()
    for error in (riffler.Cancelled("cancelled"), RuntimeError("no thread"), MemoryError("too fine")):
        with operator_task.meshes_taken_by(operator_task.Task(looks=2, outcome=error)):
            common.refused(of_mesh, str(error))
        assert seen() == before, error
    nothing = riffler.Volume.block((0, 0, 0), (10, 10, 10), 0.5, "z")
    nothing.subtract(nothing.copy())
    _, report = riffler.Volume.from_mesh_with_report(riffler.Volume.block((0, 0, 0), (10, 10, 10), 0.5).to_mesh(), 0.5)
    with operator_task.meshes_taken_by(operator_task.Task(looks=2, outcome=(nothing, report))):
        common.refused(of_mesh, "has no volume at this pitch")
    assert seen() == before
    assert of_mesh() == {"FINISHED"} and bpy.context.object.name.endswith("Stock")


def test_stock_of_a_mesh_is_one_undo_step():
    common.scale(1)
    bpy.ops.mesh.primitive_cube_add(size=10)
    name = bpy.context.object.name
    common.push("cube")
    before = seen()
    assert of_mesh() == {"FINISHED"}
    bpy.ops.ed.undo()
    assert seen() == before
    bpy.ops.ed.redo()
    assert bpy.data.objects[name].hide_get() and bpy.context.object.name == f"{name} Stock"


def test_a_linked_mesh_is_hidden_and_not_another_one_of_the_same_name():
    common.scale(1)
    bpy.ops.mesh.primitive_cube_add(size=10)
    own = bpy.context.object
    own.name = "Part"
    path = common.out("linked.blend")
    bpy.data.libraries.write(path, {own}, fake_user=True)
    with bpy.data.libraries.load(path, link=True) as (_, wanted):
        wanted.objects = ["Part"]
    linked = wanted.objects[0]
    bpy.context.collection.objects.link(linked)
    common.select(linked)
    assert of_mesh() == {"FINISHED"}
    assert linked.hide_get() and not own.hide_get()
    common.select(linked)
    assert bpy.ops.riffler.plan_part() == {"FINISHED"} and bpy.context.scene.riffler.plan.part == linked


def test_fit_pitch_suits_the_size_of_the_stock():
    stock = bpy.context.scene.riffler.stock
    stock.size = (100, 60, 30)
    bpy.ops.riffler.fit_pitch()
    assert np.isclose(stock.pitch, 0.25)


def test_scene_in_millimetres_keeps_the_sculpts_size():
    common.scale(1000)
    ob = common.stock(size=(40, 30, 20))
    assert np.allclose(ob.dimensions, (0.04, 0.03, 0.02))
    bpy.ops.riffler.millimetres()
    assert np.allclose(ob.dimensions, (40, 30, 20)), ob.dimensions
    assert common.content(ob).volume.volume == 24000


def test_every_preset_makes_a_tool():
    import riffler

    presets = common.part("common.presets").presets()
    assert len({p["name"] for p in presets}) == len(presets)
    tool = bpy.context.scene.riffler.tool
    for preset in presets:
        bpy.ops.riffler.tool_preset(name=preset["name"])
        assert tool.from_preset() == preset, preset
        made = riffler.Tool.from_dict(tool.dictionary())
        assert made.name == preset["name"]
        assert {k: v for k, v in made.to_dict().items() if k in preset} == preset
    tool.diameter = 5.5
    assert tool.from_preset() is None
    assert riffler.Tool.from_dict(tool.dictionary()).diameter == 5.5


@common.core_bound
def test_a_warning_names_a_lump_of_few_rays():
    """Suzanne in a scene in millimetres, at the panel's default pitch."""
    common.scale(1)
    bpy.ops.mesh.primitive_monkey_add(size=2)
    said = common.printed(lambda: bpy.ops.riffler.new_stock(source="OBJECT", pitch=0.06))
    assert "46 rays along its longest side" in said and "Fit Pitch" in said, said
    bpy.context.scene.riffler.stock.source = "OBJECT"
    common.select(bpy.data.objects["Suzanne"])
    bpy.ops.riffler.fit_pitch()
    pitch = bpy.context.scene.riffler.stock.pitch
    said = common.printed(lambda: bpy.ops.riffler.new_stock(source="OBJECT", pitch=pitch))
    assert "rays along" not in said, said
