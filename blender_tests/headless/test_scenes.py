"""Scenes as artists have them: collections that are excluded or linked, objects scaled to zero, shape keys, many
objects. Impossible actions are reported, nothing is left half done, and nothing is searched again and again."""

from types import SimpleNamespace

import bpy
import numpy as np
import riffler

from support import common, keyframed_plan, plans, programs, sculpting
from support.sculpting import live


def datablocks():
    """Numbers of the datablocks that the add-on makes."""
    places = (bpy.data.objects, bpy.data.meshes, bpy.data.images, bpy.data.collections, bpy.data.materials)
    return tuple(map(len, places))


def exclude(ob):
    """Puts an object into a collection of its own that the view layer excludes."""
    home = bpy.data.collections.new("Away")
    bpy.context.scene.collection.children.link(home)
    for collection in ob.users_collection:
        collection.objects.unlink(ob)
    home.objects.link(ob)
    layer = bpy.context.view_layer.layer_collection.children["Away"]
    layer.exclude = True
    return layer


def linked(name="Elsewhere"):
    """A collection of another file, with a cube, in this scene."""
    path = common.out("elsewhere.blend")
    bpy.ops.wm.read_homefile(use_empty=False)
    home = bpy.data.collections.new(name)
    home.objects.link(bpy.data.objects.new("Far Cube", bpy.data.objects["Cube"].data))
    bpy.context.scene.collection.children.link(home)
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.read_homefile(use_empty=False)
    with bpy.data.libraries.load(path, link=True) as (_, into):
        into.collections = [name]
    bpy.context.scene.collection.children.link(bpy.data.collections[name])
    return bpy.data.collections[name]


def activate(name):
    layer = bpy.context.view_layer.layer_collection.children[name]
    bpy.context.view_layer.active_layer_collection = layer
    return layer


# ------------------------------------------------------------------ collections
def test_a_stock_in_an_excluded_collection_is_not_simulated_and_nothing_is_left():
    programs.resolved()
    stock = programs.stock()
    exclude(stock)
    before = datablocks()
    common.refused(lambda: bpy.ops.riffler.simulate(source="PLAN"), "Stock is disabled", "Outliner")
    assert common.part("program.simulation").active() is None and datablocks() == before


def test_a_stock_in_an_excluded_collection_is_verified_once_it_is_enabled():
    """Its place is unknown before: excluded objects are not evaluated."""
    programs.resolved()
    stock = programs.stock()
    home = exclude(stock)
    common.refused(lambda: bpy.ops.riffler.verify(source="PLAN"), "Stock is disabled", "Outliner")
    home.exclude = False
    for coloured in ("PART", "LEFT"):
        assert bpy.ops.riffler.verify(source="PLAN", coloured=coloured) == {"FINISHED"}
    assert set(programs.settings().hidden.split()) == {"Step", "Stock"}
    assert bpy.ops.riffler.verify_clear() == {"FINISHED"} and not bpy.data.objects["Step"].hide_get()


def test_new_stock_is_visible_for_any_active_collection():
    linked()
    activate("Elsewhere")
    assert common.stock().users_collection == (bpy.context.scene.collection,)
    home = bpy.data.collections.new("Excluded")
    bpy.context.scene.collection.children.link(home)
    activate("Excluded").exclude = True
    ob = common.stock()
    bpy.context.view_layer.update()
    assert bpy.context.object == ob and ob.visible_get()


def test_fixtures_of_another_file_are_not_changed():
    bpy.context.scene.riffler.plan.fixtures = linked()
    for name, operator in (("Cube", "plan_fixtures_add"), ("Far Cube", "plan_fixtures_remove")):
        common.select(bpy.data.objects[name])
        common.refused(getattr(bpy.ops.riffler, operator), "Elsewhere is linked", "choose another collection")


def test_a_mesh_of_another_file_is_not_coloured():
    linked()
    common.select(bpy.data.objects["Far Cube"])
    common.refused(lambda: bpy.ops.riffler.show_deviation(reference="Cube"), "Far Cube is linked", "Make Local")


# ------------------------------------------------------------------ objects
def test_a_sculpt_scaled_to_zero_is_reported_with_the_remedy():
    ob = bpy.data.objects[sculpting.sculpt()]
    common.curve("Line", [(-15, 0, 8), (15, 0, 8)], mm_per_unit=1.0)
    before = common.content(ob).volume.to_bytes()
    calls = {
        "cut_curve": {"curve": "Line"},
        "crop": {"normal": (0, 0, 1)},
        "mask_form": {"form": "Cube"},
        "take_edits": {},
        "pen_sculpt": {"seconds": 0.1, "device": "simulated", "start": "CURSOR"},
    }
    for scale in ((0, 0, 0), (1, 1, 0)):
        ob.scale = scale
        common.select(ob)
        bpy.context.view_layer.update()
        for name, settings in calls.items():
            call = getattr(bpy.ops.riffler, name)
            common.refused(lambda c=call, s=settings: c(**s), "scaled to nothing", "Clear > Scale")
    assert common.content(ob).volume.to_bytes() == before and not live().lives


def test_the_panel_explains_a_scale():
    ob = bpy.data.objects[sculpting.sculpt()]
    panel = common.part("stock.panel").RIFFLER_PT_sculpt
    for scale, expected in (
        ((1, 1, 1), []),
        ((1, 1, 0), ["The object is scaled to nothing: use Object > Clear > Scale."]),
        ((1, 2, 1), ["The object is scaled or mirrored: its millimetres are not the scene's."]),
    ):
        ob.scale = scale
        bpy.context.view_layer.update()
        shown = told(lambda layout, context: panel._warnings(None, layout, context, ob))
        assert [" ".join(shown)] == (expected or [""]), (scale, shown)


def told(draw):
    """The lines of a sidebar of Blender's own width, which would cut off longer ones in their middle."""
    shown = []
    column = SimpleNamespace(label=lambda text, icon: shown.append(text))
    layout = SimpleNamespace(column=lambda align: column, operator=lambda *_, **more: None)
    preferences = SimpleNamespace(system=SimpleNamespace(ui_scale=1.0))  # 0 without a window
    region = SimpleNamespace(width=220)
    draw(layout, SimpleNamespace(region=region, preferences=preferences, scene=bpy.context.scene, object=None))
    assert all(len(line) <= 26 for line in shown), shown
    return shown


def test_the_sidebar_is_wide_enough_for_the_panels_text_without_a_sculpt():
    panel = common.part("stock.panel").RIFFLER_PT_sculpt
    shown = told(lambda layout, context: panel.draw(SimpleNamespace(layout=layout), context))
    assert " ".join(shown) == "No sculpt is active. Make one below."


def test_the_cursor_over_a_live_sculpt_scaled_to_zero_raises_no_error():
    name = sculpting.sculpt()
    run = sculpting.work(name)
    pointer, tool = common.part("sculpt.pointer"), bpy.context.scene.riffler.tool.dictionary()
    carve = common.part("sculpt.brushes").of("remove")
    space = SimpleNamespace(perspective_matrix=np.diag([1 / 60, 1 / 60, -1 / 60, 1]))
    context = SimpleNamespace(region=SimpleNamespace(width=600, height=600), region_data=space, scene=bpy.context.scene)
    assert pointer._on_surface(context, carve, run, tool, (500, 500))  # from above, over the stock
    bpy.data.objects[name].scale = (1, 1, 0)
    bpy.context.view_layer.update()
    assert pointer._on_surface(context, carve, run, tool, (500, 500)) is None
    live().end_all()


def test_a_plane_that_is_flat_crops_and_one_that_is_a_line_is_refused():
    ob = bpy.data.objects[sculpting.sculpt()]
    plane = bpy.data.objects.new("Plane", None)
    bpy.context.collection.objects.link(plane)
    plane.location = ob.location
    volumes = []
    for scale in ((1, 1, 1), (1, 1, 0), (2, 3, 0)):  # the user pressed S Z 0
        plane.location.z = ob.matrix_world.translation.z + 12
        plane.scale = scale
        bpy.context.view_layer.update()
        common.select(ob)
        common.push("crop")
        assert bpy.ops.riffler.crop("EXEC_DEFAULT", True, plane="Plane") == {"FINISHED"}
        volumes.append(common.content(ob).volume.volume)
        bpy.ops.ed.undo()
        ob, plane = bpy.data.objects[ob.name], bpy.data.objects["Plane"]
    assert np.ptp(volumes) < 1e-9 * volumes[0]
    plane.scale = (0, 1, 1)
    bpy.context.view_layer.update()
    common.select(ob)
    common.refused(lambda: bpy.ops.riffler.crop(plane="Plane"), "Plane is scaled to nothing", "Clear > Scale")
    bpy.data.images.new("Picture", 8, 8)
    call = lambda: bpy.ops.riffler.relief(image="Picture", place="Plane")  # noqa: E731
    common.refused(call, "Plane is scaled to nothing")


def test_shape_keys_disappear_with_their_vertices():
    ob = bpy.data.objects[sculpting.sculpt()]
    common.curve("Line", [(-15, 0, 18), (15, 0, 18)], mm_per_unit=1.0)
    common.select(ob)
    ob.shape_key_add(name="Basis")
    ob.shape_key_add(name="Key").value = 1.0
    edited = common.part("sculpt.sculpts").edited
    assert edited(ob.data)  # so the panel offers to apply or discard them
    common.refused(lambda: bpy.ops.riffler.cut_curve(curve="Line", tool=common.FLAT, depth=2.0), "Apply Mesh Edits")
    assert ob.data.shape_keys is not None and bpy.ops.riffler.rebuild() == {"FINISHED"}
    assert bpy.ops.riffler.cut_curve(curve="Line", tool=common.FLAT, depth=2.0) == {"FINISHED"}
    bpy.context.view_layer.update()
    seen = ob.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    assert np.array_equal(common.coordinates(seen), common.coordinates(ob.data))
    assert not edited(ob.data)
    sculpting.matches_its_volume(ob.name)


def test_shape_keys_are_taken_over_as_edits():
    ob = bpy.data.objects[sculpting.sculpt(pitch=0.5)]
    volume = common.content(ob).volume.volume
    common.select(ob)
    ob.shape_key_add(name="Basis")
    key = ob.shape_key_add(name="Longer")
    co = np.empty((len(key.data), 3), np.float32)
    key.data.foreach_get("co", co.ravel())
    co[:, 0] *= 1.5
    key.data.foreach_set("co", co.ravel())
    key.value = 1.0
    bpy.context.view_layer.update()
    assert bpy.ops.riffler.take_edits() == {"FINISHED"}
    assert abs(common.content(ob).volume.volume - 1.5 * volume) < 1e-3 * volume
    sculpting.matches_its_volume(ob.name)


# ------------------------------------------------------------------ failures
def test_one_sculpt_that_cannot_be_ended_keeps_no_other_from_being_saved():
    first, second = sculpting.sculpt("First"), sculpting.sculpt("Second")
    sculpting.stroke(first, 1)
    made = sculpting.stroke(second, 2)
    run = live().of(bpy.data.objects[first])
    original = run.end

    def end():
        raise MemoryError

    run.end = end
    try:
        bpy.ops.wm.save_as_mainfile(filepath=common.out("one.blend"), copy=True)
        assert common.content(bpy.data.objects[second]).volume.to_bytes() == made
        assert "First: there is not enough memory" in bpy.context.window_manager.riffler.notice
        assert [r.name for r in live().awake()] == [first]
        bpy.context.window_manager.riffler.notice = ""
        bpy.ops.wm.save_as_mainfile(filepath=common.out("one.blend"), copy=True)
        assert not bpy.context.window_manager.riffler.notice  # the same problem is not reported again
        common.select(bpy.data.objects[second])
        common.refused(bpy.ops.riffler.rebuild, "not enough memory")
    finally:
        run.end = original
        live().end_all()
    sculpting.nothing_is_left()


def test_pieces_are_not_lost_where_one_of_them_cannot_be_made():
    common.scale(1)
    ob = common.stock(size=(40, 30, 20), pitch=0.5, directions="xyz")
    volume = common.content(ob).volume.copy()
    for x in (13.0, 26.0):  # two slots through the block: three pieces
        volume.carve(riffler.Tool.flat(4, 40), np.array([[x, -4, -1, 0, 0, 1], [x, 34, -1, 0, 0, 1]]))
    sculpts = common.part("sculpt.sculpts")
    sculpts.commit(ob.data, common.part("common.contents").Content(volume, []), 1.0)
    before, count, commit, calls = common.content(ob).volume.to_bytes(), datablocks(), sculpts.commit, []

    def failing(*arguments, **more):
        calls.append(arguments)
        if len(calls) == 2:
            raise MemoryError
        return commit(*arguments, **more)

    sculpts.commit = failing
    try:
        common.refused(bpy.ops.riffler.split, "not enough memory")
    finally:
        sculpts.commit = commit
    assert common.content(ob).volume.to_bytes() == before and len(calls) == 2
    assert datablocks()[:2] == count[:2]
    assert bpy.ops.riffler.split() == {"FINISHED"} and len(bpy.data.objects) == count[0] + 2


def test_a_linked_duplicate_of_the_remaining_material_is_kept():
    programs.resolved()
    programs.stock()
    bpy.ops.riffler.verify(source="PLAN", coloured="LEFT")
    common.select(programs.settings().left)
    bpy.ops.object.duplicate(linked=True)
    name = bpy.context.object.name
    bpy.ops.riffler.verify_clear()
    assert "Stock Left" not in bpy.data.objects and len(bpy.data.objects[name].data.polygons)


# ------------------------------------------------------------------ many objects
def test_plans_are_searched_once_among_many_objects():
    ob = plans.on_timeline()
    store = common.part("plan.plan_store")
    for _ in range(200):
        bpy.context.scene.collection.objects.link(bpy.data.objects.new("Other", None))
    bpy.context.view_layer.objects.active = bpy.data.objects["Other"]
    keyframed_plan.update()
    before = store.searches
    for _ in range(50):
        assert store.active(bpy.context) == ob and bpy.ops.riffler.plan_resolve.poll() is False
    assert store.searches == before + 1
    bpy.data.objects["Other"].location.x = 1
    keyframed_plan.update()
    assert store.active(bpy.context) == ob and store.searches == before + 1
    # every change of the list is noticed at once
    twin = store.new(bpy.context, store.plan(ob), "Twin")
    assert store.in_scene(bpy.context.scene) == [ob, twin]
    bpy.data.objects.remove(twin)
    assert store.in_scene(bpy.context.scene) == [ob]
    ob.name = "Renamed"
    assert store.in_scene(bpy.context.scene) == [ob]
    assert store.in_scene(bpy.data.scenes.new("Empty")) == []
    (home,) = ob.users_collection
    home.objects.unlink(ob)  # the number of objects is unchanged
    keyframed_plan.update()
    assert store.in_scene(bpy.context.scene) == []
    home.objects.link(ob)
    keyframed_plan.update()
    assert store.in_scene(bpy.context.scene) == [ob]


def overridden(name):
    """The library override of an object of this file, in a new one; active, and the only one selected."""
    path = common.out("overridden.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.read_homefile()
    with bpy.data.libraries.load(path, link=True) as (_, into):
        into.objects = [name]
    ob = into.objects[0].override_create()
    bpy.context.collection.objects.link(ob)
    common.select(ob)
    return ob


def test_an_overridden_plan_is_changed_only_once_it_is_local():
    """An override does not keep the plan's data: edits would be lost when the file is opened again."""
    store = common.part("plan.plan_store")
    ob = overridden(plans.on_timeline().name)
    plan = store.plan(ob)
    for call in ("plan_to_timeline", "plan_key", "plan_resolve"):
        common.refused(getattr(bpy.ops.riffler, call), "overrides", "Make Local")
    try:
        store.write(ob, plan)
    except ValueError as error:
        assert f"{ob.name} overrides" in str(error) and "Make Local" in str(error)
    else:
        raise AssertionError("edits of an override were taken")
    bpy.ops.object.make_local(type="SELECT_OBJECT")
    ob = bpy.context.object
    assert bpy.ops.riffler.plan_to_timeline() == {"FINISHED"}
    path, name = common.out("local.blend"), ob.name
    store.write(ob, riffler.plan.Plan(plan.paths[:1], plan.tool))
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    assert len(store.plan(bpy.data.objects[name]).paths) == 1


def test_an_overridden_sculpt_is_not_cut():
    overridden(common.stock().name)
    common.refused(bpy.ops.riffler.cut_curve, "overrides", "Make Local")
