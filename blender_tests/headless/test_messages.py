"""Messages where something is impossible: every refusal names the remedy, and nothing is changed or lost."""

import os
import struct
from pathlib import Path

import bmesh
import bpy
import numpy as np

from support import common, plans, programs

# ---------------------------------------------------------------------- why a button is grey

# Operators that change the active sculpt: refused in every one of the states below.
OF_SCULPTS = {
    "cut_curve", "cut_recording", "stroke", "pen_sculpt", "rebuild", "resample", "room", "crop", "split", "take_edits",
    "mask_form", "mask_invert", "mask_clear", "relief", "to_mesh",
}  # fmt: skip


def operators():
    for module in common.part("registration").modules():
        for cls in module.CLASSES:
            if issubclass(cls, bpy.types.Operator):
                yield cls.bl_idname.partition(".")[2]


def refusals():
    """By operator, why it is refused now; only refused ones."""
    found = {}
    for name in operators():
        call = getattr(bpy.ops.riffler, name)
        if not call.poll():
            try:
                call()
            except RuntimeError as error:
                found[name] = str(error).strip().partition("poll() ")[2]
    return found


def nothing_selected():
    common.stock()
    bpy.ops.object.select_all(action="DESELECT")
    bpy.context.view_layer.objects.active = None


def wrong_type():
    common.select(bpy.data.objects["Camera"])


def edit_mode():
    common.stock()
    bpy.ops.object.mode_set(mode="EDIT")


def linked():
    name = common.stock().name
    path = common.out("messages.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.read_homefile()
    with bpy.data.libraries.load(path, link=True) as (_, into):
        into.objects = [name]
    bpy.context.collection.objects.link(into.objects[0])
    bpy.context.view_layer.objects.active = into.objects[0]


def work_running():
    common.stock()
    bpy.context.window_manager.riffler.running = "Cutting"


def pen_elsewhere():
    common.stock()
    bpy.context.window_manager.riffler.sculpting = True


STATES = {
    nothing_selected: "Select a sculpt",
    wrong_type: "Select a sculpt",
    edit_mode: "Leave Edit Mode",
    linked: "Make Local",
    work_running: "Esc cancels",
    pen_elsewhere: "Esc ends it",
}


def test_no_button_is_grey_without_saying_why():
    progress = bpy.context.window_manager.riffler
    for state, remedy in STATES.items():
        bpy.ops.wm.read_homefile(use_empty=False)
        common.scale(1)
        state()
        try:
            found = refusals()
        finally:
            progress = bpy.context.window_manager.riffler
            progress.running, progress.sculpting = "", False
            if bpy.context.mode != "OBJECT":
                bpy.ops.object.mode_set(mode="OBJECT")
        unsaid = [name for name, why in found.items() if not why or "context is incorrect" in why]
        assert not unsaid, (state.__name__, unsaid)
        assert set(found) >= OF_SCULPTS, (state.__name__, OF_SCULPTS - set(found))
        wrong = {name: found[name] for name in OF_SCULPTS if remedy not in found[name]}
        assert not wrong, (state.__name__, wrong)


def test_starting_on_another_sculpt_parks_the_work_on_the_first():
    """A session on one sculpt, and another sculpt is cut: the first keeps its carvings."""
    from support import sculpting

    first, second = sculpting.sculpt("First"), sculpting.sculpt("Second")
    sculpting.stroke(first, 1)
    carved = sculpting.live().of(bpy.data.objects[first]).volume.to_bytes()
    common.select(bpy.data.objects[second])
    assert not refusals().keys() & OF_SCULPTS
    assert bpy.ops.riffler.mask_invert() == {"FINISHED"}
    assert common.content(bpy.data.objects[first]).volume.to_bytes() == carved
    sculpting.matches_its_volume(first)


def test_a_scene_that_becomes_millimetres_keeps_live_work():
    from support import sculpting

    name = sculpting.sculpt()
    common.scale(10)
    bpy.ops.riffler.rebuild()
    sculpting.stroke(name, 1)
    carved = sculpting.live().of(bpy.data.objects[name]).volume.to_bytes()
    bpy.ops.riffler.millimetres()
    sculpting.nothing_is_left()
    ob = bpy.data.objects[name]
    assert common.content(ob).volume.to_bytes() == carved
    assert np.allclose(ob.dimensions[:2], sculpting.SIZE[:2])
    sculpting.matches_its_volume(name)


# ---------------------------------------------------------------------- bad input


def cube(size=20.0, **more):
    bpy.ops.mesh.primitive_cube_add(size=size, **more)
    return bpy.context.object


def refused(call, *words):
    """With all the words, and afterwards nothing exists that did not before."""
    before = [len(x) for x in (bpy.data.objects, bpy.data.meshes, bpy.data.images, bpy.data.curves)]
    text = common.refused(call, *words)
    assert [len(x) for x in (bpy.data.objects, bpy.data.meshes, bpy.data.images, bpy.data.curves)] == before, text


def from_object(**more):
    return bpy.ops.riffler.new_stock(source="OBJECT", **{"pitch": 0.5, "directions": "z", **more})


def test_objects_without_volume_are_refused():
    common.scale(1)
    bpy.ops.mesh.primitive_plane_add(size=20)
    refused(from_object, "Plane is flat", "Solidify")
    empty = bpy.data.objects.new("Nothing", bpy.data.meshes.new("Nothing"))
    bpy.context.collection.objects.link(empty)
    common.select(empty)
    refused(from_object, "Nothing has no faces", "choose another")
    common.select(bpy.data.objects["Camera"])
    refused(from_object, "select the object", "mesh")


def opened(ob):
    made = bmesh.new()
    made.from_mesh(ob.data)
    made.faces.ensure_lookup_table()
    bmesh.ops.delete(made, geom=[made.faces[0]], context="FACES")
    made.to_mesh(ob.data)
    made.free()


def test_an_open_object_is_closed_with_a_note():
    common.scale(1)
    opened(cube())
    assert "is not closed: 4 open edges" in common.printed(from_object)
    assert abs(common.content(bpy.context.object).volume.volume - 8000) < 1
    cube(location=(50, 0, 0))
    assert "closed" not in common.printed(from_object)


def test_metres_taken_for_millimetres_are_refused_at_once():
    """Blender's own cube, 2 m, at 0.5 mm would be 192 million triangles: more than its arrays hold."""
    common.scale(1000)
    cube(2.0)
    refused(from_object, "2000 × 2000 × 2000 mm", "coarser pitch", "Scene in Millimetres")
    bpy.context.view_layer.objects.active = None
    refused(lambda: common.stock(size=(2000, 2000, 2000), pitch=0.5), "coarser pitch", "Scene in Millimetres")
    bpy.ops.riffler.millimetres()
    common.select(cube(20.0))
    assert from_object() == {"FINISHED"}


def test_the_panel_explains_a_scaled_or_sheared_sculpt():
    common.scale(1)
    ob = common.stock()
    distorted = common.part("blender.refusals").scaled
    assert distorted(ob) == ""
    ob.rotation_euler, ob.location = (0.3, 0.2, 0.1), (5, 6, 7)
    bpy.context.view_layer.update()
    assert distorted(ob) == ""
    ob.scale = (1, 1, 2)
    bpy.context.view_layer.update()
    assert "Clear > Scale" in distorted(ob)
    line = common.curve("Line", [(10, 15, 20), (30, 15, 20)], mm_per_unit=1)
    assert "Clear > Scale" in common.printed(lambda: bpy.ops.riffler.cut_curve(curve=line.name, tool=common.FLAT))
    above = bpy.data.objects.new("Above", None)
    bpy.context.collection.objects.link(above)
    ob.scale, ob.parent, above.scale = (1, 1, 1), above, (1, 3, 1)
    bpy.context.view_layer.update()
    assert "Parent > Clear and Keep Transformation" in distorted(ob)


def test_a_sheared_or_missing_part_is_reported():
    common.scale(1)
    part = plans.part_object()
    settings = bpy.context.scene.riffler.plan
    common.select(part)
    bpy.ops.riffler.plan_part()
    above = bpy.data.objects.new("Above", None)
    bpy.context.collection.objects.link(above)
    above.scale, part.parent, part.rotation_euler = (1, 3, 1), above, (0.5, 0.3, 0.2)
    bpy.context.view_layer.update()
    refused(bpy.ops.riffler.plan_find, "Step is sheared", "Clear and Keep Transformation")
    part.parent = None
    bpy.data.objects.remove(above)
    bpy.context.collection.objects.unlink(part)
    assert settings.part == part
    assert "set another part" in refusals()["plan_find"]
    bpy.data.objects.remove(part)
    assert "select one and use Set Part" in refusals()["plan_find"]


def test_missing_files_are_reported():
    common.scale(1)
    ob = common.stock()
    before = bpy.context.scene.riffler.plan.tool
    for call in (bpy.ops.riffler.plan_tool_open, bpy.ops.riffler.cut_recording):
        refused(lambda call=call: call(filepath="/nowhere/x.rjournal"), "/nowhere", "choose")
    refused(lambda: bpy.ops.riffler.plan_tool(path="/nowhere/x.json"), "x.json", "choose a tool file")
    refused(lambda: bpy.ops.riffler.new_stock(source="RECORDING", recording="/nowhere/x.rjournal"), "choose another")
    common.select(ob)
    recording = {"device": "recording", "recording": "/nowhere/x.rjournal", "seconds": 1.0}
    refused(lambda: bpy.ops.riffler.pen_sculpt(**recording), "/nowhere/x.rjournal", "choose another")
    assert bpy.context.scene.riffler.plan.tool == before


def exports():
    return {name: getattr(bpy.ops.riffler, f"export_{name}") for name in ("stl", "3mf", "nc", "recording")}


def writes_only_where_it_may(name, call):
    """An export: the folders it refuses, with which words; and that it writes where it may."""
    folder = Path(common.out("locked"))
    folder.mkdir(exist_ok=True)
    path, access = folder / f"x.{name}", os.access
    path.unlink(missing_ok=True)
    refused(lambda: call(filepath="/nowhere/x", check_existing=False), "no folder /nowhere", "choose another")
    os.access = lambda place, mode: str(place) != str(folder) and access(place, mode)  # the tests may run as root
    try:
        refused(lambda: call(filepath=str(path), check_existing=False), "may not be written", "another")
    finally:
        os.access = access
    assert not path.exists()
    assert call(filepath=str(path), check_existing=False) == {"FINISHED"} and path.stat().st_size > 100
    path.unlink()


def test_missing_or_read_only_folders_are_reported():
    common.scale(1)
    ob = common.stock()
    line = common.curve("Line", [(10, 15, 20), (30, 15, 20)], mm_per_unit=1)
    bpy.ops.riffler.cut_curve(curve=line.name, tool=common.FLAT)
    for name, call in exports().items():
        writes_only_where_it_may(name, call)
    assert common.content(ob).cuts
    pen = {"device": "simulated", "record": True, "folder": "/nowhere", "seconds": 1.0}
    refused(lambda: bpy.ops.riffler.pen_sculpt(**pen), "no folder /nowhere", "choose another")
    refused(lambda: bpy.ops.riffler.plan_tool_save(folder="/proc/x"), "/proc/x", "choose a folder that can be written")
    programs.resolved()
    writes_only_where_it_may("plan.ngc", bpy.ops.riffler.plan_nc)


def test_a_sculpt_of_a_newer_version_is_kept_and_named():
    common.scale(1)
    ob = common.stock()
    packed, store = common.part("blender.packed_images"), common.part("sculpt.sculpt_store")
    image = ob.data.riffler.store
    block = bytearray(packed.read(image, "the sculpt"))
    block[8:12] = struct.pack("<I", 99)
    packed.write(image, bytes(block), common.part("sculpt.pure.sculpt_payload").content_id(bytes(block)))
    store.clear_cache()
    for call in (bpy.ops.riffler.mask_invert, lambda: bpy.ops.riffler.export_stl(filepath=common.out("newer.stl"))):
        refused(call, "format 99", "install a newer one")
    assert packed.read(image, "the sculpt") == bytes(block) and len(ob.data.polygons) > 0


def test_a_plan_of_a_newer_version_is_kept_and_named():
    common.scale(1)
    packed, store = common.part("blender.packed_images"), common.part("plan.plan_store")
    import riffler

    ob = store.new(bpy.context, riffler.plan.Plan(plans.paths()[:1], plans.TOOL, tolerance=0.01))
    image = ob.riffler.plan.store
    block = packed.read(image, "the plan")
    newer = block.replace(b'"version": 1', b'"version": 99', 1).replace(b'"version":1', b'"version":99', 1)
    assert newer != block
    packed.write(image, newer, common.part("sculpt.pure.sculpt_payload").content_id(newer))
    store.clear_cache()
    common.select(ob)
    refused(bpy.ops.riffler.plan_show, "newer Riffler")
    assert packed.read(image, "the plan") == newer


# ---------------------------------------------------------------------- its own folder


def listing(root):
    """(size, time) of every file, except Python's caches of modules."""
    paths = [p for p in root.rglob("*") if p.is_file() and "__pycache__" not in p.parts]
    return {p: (p.stat().st_size, p.stat().st_mtime_ns) for p in paths}


def test_nothing_is_written_into_the_addons_own_folder():
    import riffler

    from support import sculpting

    roots = [Path(common.part("registration").__file__).resolve().parent, Path(riffler.__file__).resolve().parent]
    before = [listing(root) for root in roots]
    assert all(len(found) > 20 for found in before)
    name = sculpting.sculpt()
    sculpting.stroke(name, 1)
    common.part("sculpt.live_registry").end_all()
    line = common.curve("Line", [(10, 15, 20), (30, 15, 20)], mm_per_unit=1)
    common.select(bpy.data.objects[name])
    bpy.ops.riffler.cut_curve(curve=line.name, tool=common.FLAT)
    for kind, call in exports().items():
        call(filepath=common.out(f"own.{kind}"), check_existing=False)
    bpy.ops.riffler.pen_sculpt(device="simulated", seconds=0.5, gap=500.0)
    bpy.ops.riffler.to_mesh()
    bpy.ops.riffler.plan_tool(name=common.part("common.presets").presets()[0]["name"])
    bpy.ops.riffler.plan_tool_save(name="Own folder")
    bpy.ops.riffler.doctor()
    common.select(plans.part_object())
    bpy.ops.riffler.plan_part()
    bpy.ops.riffler.plan_find()
    bpy.ops.riffler.plan_to_timeline()
    assert [listing(root) for root in roots] == before
    bpy.ops.preferences.addon_disable(module=common.MODULE)
    bpy.ops.preferences.addon_enable(module=common.MODULE)
    # Blender itself unpacks an extension's wheels again.
    now = [listing(root) for root in roots]
    assert now[0] == before[0] and now[1].keys() == before[1].keys()
    saved = common.part("plan.tool_libraries").target() / "Own folder.json"
    assert saved.is_file()
    saved.unlink()
