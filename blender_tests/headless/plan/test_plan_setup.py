"""A plan's setup: part, fixtures, tool; libraries of files; and plans in the .blend."""

import json
from pathlib import Path
from types import SimpleNamespace

import bpy
import numpy as np
import riffler

from support import common

ASSEMBLY = {
    "name": "Six",
    "kind": "ball",
    "diameter": 6.0,
    "length": 25.0,
    "shank": [[25.0, 3.0, 40.0, 3.0]],
    "holder": [[40.0, 14.0, 70.0, 16.0]],
}


def settings():
    return bpy.context.scene.riffler.plan


def cube(name="Part", size=20, location=(0, 0, 0)):
    bpy.ops.mesh.primitive_cube_add(size=size, location=location)
    bpy.context.object.name = name
    return bpy.context.object


def tool_file(name, text):
    path = Path(common.out(name))
    path.write_text(text if isinstance(text, str) else json.dumps(text), encoding="utf-8")
    return str(path)


def a_plan(name="part", points=5):
    y = np.linspace(0, 10, points)
    centres = np.stack([3 + 0 * y, y, 3 + 0 * y], axis=1)
    contacts = np.stack([centres - [0, 0, 3], centres - [3, 0, 0]], axis=1)
    normals = np.broadcast_to([[[0.0, 0, 1], [1, 0, 0]]], (points, 2, 3))
    path = riffler.plan.PencilPath(3.0, centres, contacts, normals, closed=False)
    return riffler.plan.Plan([path], riffler.Tool.ball(6, 30), part={"name": name}, tolerance=0.01)


# ---- part and fixtures


def test_the_part_is_the_active_object_in_mm_of_the_world():
    parts = common.part("blender.object_surfaces")
    for unit in (1000.0, 1.0, 25.4):
        common.scale(unit)
        ob = cube(size=20 / unit, location=(50 / unit, 0, 0))
        ob.scale = (1, 2, 1)
        ob.rotation_euler = (0, 0, np.pi / 2)
        bpy.context.view_layer.update()
        assert bpy.ops.riffler.plan_part() == {"FINISHED"} and settings().part == ob
        mesh = parts.in_world(bpy.context, ob)
        assert np.allclose(mesh.bounds, [(30, -10, -10), (70, 10, 10)], atol=1e-4), (unit, mesh.bounds)
        assert abs(mesh.volume - 16000) < 0.1


def test_a_mirrored_part_has_its_normals_outside():
    common.scale(1)
    ob = cube()
    ob.scale = (-1, 1, 1)
    bpy.context.view_layer.update()
    assert common.part("blender.object_surfaces").in_world(bpy.context, ob).volume > 0


def test_a_sheared_part_is_refused_with_the_remedy():
    common.scale(1)
    above = cube("Above")
    above.scale = (1, 3, 1)
    ob = cube("Part")
    ob.parent, ob.rotation_euler = above, (0, 0, 0.5)
    bpy.context.view_layer.update()
    common.refused(bpy.ops.riffler.plan_part, "Part is sheared", "Parent > Clear and Keep Transformation")
    assert settings().part is None
    bpy.ops.object.parent_clear(type="CLEAR_KEEP_TRANSFORM")
    assert bpy.ops.riffler.plan_part() == {"FINISHED"}


def test_what_cannot_be_a_part_is_refused():
    common.scale(1)
    bpy.ops.object.empty_add()
    common.refused(bpy.ops.riffler.plan_part, "has no surface")
    bpy.context.view_layer.objects.active = None
    common.refused(bpy.ops.riffler.plan_part, "Select the object")
    mesh = bpy.data.meshes.new("Nothing")
    ob = bpy.data.objects.new("Nothing", mesh)
    bpy.context.collection.objects.link(ob)
    bpy.context.view_layer.objects.active = ob
    common.refused(bpy.ops.riffler.plan_part, "Nothing has no faces")
    assert settings().part is None


def test_a_hidden_part_is_read_and_a_disabled_one_refused():
    common.scale(1)
    ob = cube()
    ob.modifiers.new("More", "ARRAY").count = 2
    ob.hide_set(True)
    settings().part = ob
    assert abs(common.part("blender.object_surfaces").in_world(bpy.context, ob).volume - 16000) < 1e-6
    ob.hide_viewport = True
    common.refused(bpy.ops.riffler.plan_find, "Part is disabled", "enable it")
    ob.hide_viewport = False
    collection = bpy.data.collections.new("Away")
    bpy.context.scene.collection.children.link(collection)
    for other in ob.users_collection:
        other.objects.unlink(ob)
    collection.objects.link(ob)
    layer = bpy.context.view_layer.layer_collection.children["Away"]
    for place, name in ((collection, "hide_viewport"), (layer, "exclude")):
        setattr(place, name, True)
        common.refused(bpy.ops.riffler.plan_find, "Part is disabled", "enable it")
        setattr(place, name, False)
    common.refused(bpy.ops.riffler.plan_find, "Part: no pencil cut")


def test_a_part_in_the_wrong_unit_is_reported():
    ob = cube(size=20)
    for unit, level, words in (
        (1, "INFO", "20 × 20 × 20 mm, 12 triangles"),
        (1000, "WARNING", "looks like micrometre"),
    ):
        common.scale(unit)
        mesh = common.part("blender.object_surfaces").in_world(bpy.context, ob)
        said = common.part("plan.operators.setup").described(mesh)
        assert said[0] == level and words in said[1], said


def test_fixtures_are_a_collection_and_never_the_part():
    common.scale(1)
    part, vise = cube("Part"), cube("Vise", location=(40, 0, 0))
    settings().part = part
    part.select_set(True)
    vise.select_set(True)
    bpy.ops.riffler.plan_fixtures_add()
    assert [ob.name for ob in common.part("plan.obstacles").fixture_objects(settings(), part)] == ["Vise"]
    assert vise.users_collection and settings().fixtures in vise.users_collection
    bpy.context.view_layer.objects.active = vise
    common.refused(bpy.ops.riffler.plan_part, "Vise is a fixture")
    assert settings().part == part
    home = vise.users_collection[0]
    home.objects.unlink(vise)  # only the fixtures' collection is left
    bpy.ops.riffler.plan_fixtures_remove()
    assert (
        common.part("plan.obstacles").fixture_objects(settings(), part) == [] and vise.name in bpy.context.scene.objects
    )
    common.refused(bpy.ops.riffler.plan_fixtures_remove, "Select the fixtures")


def is_fixture(ob):
    home = settings().fixtures
    return home is not None and home.objects.get(ob.name) == ob


def test_a_linked_vise_is_no_fixture_before_it_is_real():
    """An object that stands for a collection has no surface of its own: it would be ignored."""
    common.scale(1)
    settings().part = cube("Part")
    jaws, inside = cube("Jaws", location=(40, 0, 0)), bpy.data.collections.new("Vise")
    for home in jaws.users_collection:
        home.objects.unlink(jaws)
    inside.objects.link(jaws)
    bpy.ops.object.collection_instance_add(collection=inside.name)
    vise = bpy.context.object
    common.refused(bpy.ops.riffler.plan_fixtures_add, f"{vise.name} is an instance of Vise", "Make Instances Real")
    home = settings().fixtures = bpy.data.collections.new("Fixtures")
    bpy.context.scene.collection.children.link(home)
    home.objects.link(vise)
    text = common.refused(bpy.ops.riffler.plan_find, "Part: no pencil cut")  # the search ignores fixtures
    take = common.part("plan.obstacles").take
    ob = common.part("plan.plan_store").new(bpy.context, a_plan())
    try:
        take(bpy.context, ob)
    except ValueError as error:
        text = str(error)
    assert "is an instance of Vise" in text and "take it out of the fixtures" in text
    common.select(vise)
    bpy.ops.object.duplicates_make_real()
    real = bpy.context.selected_objects
    bpy.data.objects.remove(vise)
    common.select(real[0])
    bpy.ops.riffler.plan_fixtures_add()
    assert [name for name, _ in take(bpy.context, ob).fixtures] == [real[0].name]


def test_a_flat_fixture_is_named_with_the_remedy():
    """In any orientation; also one that was added to the collection by other means."""
    common.scale(1)
    settings().part = cube("Part")
    for turn in ((0, 0, 0), (0.3, 0.4, 0.5)):
        bpy.ops.mesh.primitive_plane_add(size=20, location=(40, 0, 0), rotation=turn)
        plane = bpy.context.object
        common.refused(bpy.ops.riffler.plan_fixtures_add, f"{plane.name} is flat", "Solidify", "out of the fixtures")
        assert not is_fixture(plane)
    plane.modifiers.new("Thick", "SOLIDIFY").thickness = 1
    bpy.ops.riffler.plan_fixtures_add()
    assert is_fixture(plane)
    plane.modifiers.clear()
    bpy.context.view_layer.update()
    ob = common.part("plan.plan_store").new(bpy.context, a_plan())
    try:
        common.part("plan.obstacles").now(bpy.context, ob)
    except ValueError as error:
        assert plane.name in str(error) and "flat sheet" in str(error) and "Solidify" in str(error), error
    else:
        raise AssertionError("a sheet has become a volume")


# ---- tools


def test_every_preset_is_a_tool_of_the_library():
    for tool in common.part("common.presets").presets():
        bpy.ops.riffler.plan_tool(name=tool["name"])
        assert settings().tool_dict() == tool and settings().source == ""


def test_a_tool_is_taken_from_a_file_with_shank_and_holder():
    path = tool_file("tools.json", [{"name": "Other", "kind": "flat", "diameter": 3, "length": 9}, ASSEMBLY])
    bpy.ops.riffler.plan_tool(name="Six", path=path)
    assert riffler.Tool.from_dict(settings().tool_dict()) == riffler.Tool.from_dict(ASSEMBLY)
    assert settings().source == path
    toml = tool_file("cone.toml", 'kind = "ball"\ndiameter = 2\nlength = 8\n')
    bpy.ops.riffler.plan_tool_open(filepath=toml)
    assert settings().tool_dict() == {"name": "cone", "kind": "ball", "diameter": 2, "length": 8}


def test_the_tool_outlives_its_file_and_the_session():
    path = tool_file("gone.json", ASSEMBLY)
    bpy.ops.riffler.plan_tool(path=path)
    Path(path).unlink()
    blend = common.out("tool.blend")
    bpy.ops.wm.save_as_mainfile(filepath=blend)
    bpy.ops.wm.read_homefile()
    bpy.ops.wm.open_mainfile(filepath=blend)
    assert riffler.Tool.from_dict(settings().tool_dict()).name == "Six"
    common.refused(lambda: bpy.ops.riffler.plan_tool(name="Six", path=path), "gone.json", "No such file")
    assert settings().tool_dict()["name"] == "Six"


def test_a_bad_tool_file_is_named_with_the_line_and_changes_nothing():
    before = settings().tool
    path = tool_file("bad.json", '[\n{"kind": "ball", "diameter": 6, "length": 30},\n{"kind": "spoon"}]')
    common.refused(lambda: bpy.ops.riffler.plan_tool(name="", path=path), "bad.json, line 3", "spoon")
    common.refused(lambda: bpy.ops.riffler.plan_tool(name="Nobody"), "no tool 'Nobody'", "Ball 6 mm")
    assert settings().tool == before


def test_the_cutter_of_sculpting_is_a_tool_too():
    bpy.context.scene.riffler.tool.diameter = 5.5
    bpy.ops.riffler.plan_tool(sculpting=True)
    assert riffler.Tool.from_dict(settings().tool_dict()).diameter == 5.5


def test_shank_and_holder_are_put_on_and_saved():
    bpy.ops.riffler.plan_tool(name="Ball 6 mm")
    bpy.ops.riffler.plan_assembly(shank=6, reach=45, holder=28, upper=32, height=30)
    tool = riffler.Tool.from_dict(settings().tool_dict())
    assert tool.shank == [(30.0, 3.0, 45.0, 3.0)] and tool.holder == [(45.0, 14.0, 75.0, 16.0)]
    common.refused(lambda: bpy.ops.riffler.plan_assembly(reach=20), "above the cutter", "30 mm")
    folder = common.out("library")
    bpy.ops.riffler.plan_tool_save(name="Six long", folder=folder)
    assert riffler.Tool.from_dict(json.loads((Path(folder) / "Six long.json").read_text())) == tool.named("Six long")
    bpy.ops.riffler.plan_assembly(shank=0, holder=0)
    bare = riffler.Tool.from_dict(settings().tool_dict())
    assert bare.shank == [] and bare.holder == []


STEPPED = [(50, 10, 60, 25), (60, 25, 65, 25), (65, 15, 100, 15)]
NECKED = [(25, 2, 35, 3), (35, 3, 50, 3)]


def assembled(**changed):
    """Shank and holder of a stepped tool, after OK in the dialog with its sizes, some `changed`."""
    tool = riffler.Tool.ball(diameter=6, length=25).with_shank(NECKED).with_holder(STEPPED)
    settings().take(tool.to_dict())
    sizes = {"shank": 4, "reach": 50, "holder": 20, "upper": 30, "height": 50}
    assert bpy.ops.riffler.plan_assembly(**{**sizes, **changed}) == {"FINISHED"}
    tool = riffler.Tool.from_dict(settings().tool_dict())
    return tool.shank, tool.holder


def test_a_stepped_shank_or_holder_keeps_its_pieces_where_its_sizes_stay():
    assert assembled() == (NECKED, STEPPED)
    shank, holder = assembled(reach=57.3)
    assert shank == [(25, 2, 35, 3), (35, 3, 57.3, 3)]
    assert holder == [(57.3, 10, 67.3, 25), (67.3, 25, 72.3, 25), (72.3, 15, 107.3, 15)]
    assert assembled(upper=32) == (NECKED, [(50, 10, 100, 16)])
    assert assembled(shank=6) == ([(25, 3, 50, 3)], STEPPED)
    assert assembled(shank=0) == ([], STEPPED) and assembled(holder=0) == (NECKED, [])
    common.refused(lambda: assembled(reach=33), "begins at 35 mm", "more reach")


def test_the_dialog_names_the_pieces_that_become_one():
    assembled()
    operator = common.part("plan.operators.setup").RIFFLER_OT_plan_assembly

    def said(**changed):
        told = []
        layout = SimpleNamespace(prop=lambda *_: None, label=lambda text, icon: told.append(text))
        sizes = {"shank": 4.0, "reach": 50.0, "holder": 20.0, "upper": 30.0, "height": 50.0, **changed}
        drawn = SimpleNamespace(layout=layout, **sizes)
        drawn._unchanged = lambda *a: operator._unchanged(drawn, *a)
        operator.draw(drawn, bpy.context)
        return " ".join(text.split(" becomes")[0] for text in told)

    assert (said(), said(reach=60.0), said(shank=0.0, holder=0.0)) == ("", "", "")
    assert said(shank=6.0, upper=32.0) == "The shank The holder" and said(height=40.0) == "The holder"


def test_a_folder_that_cannot_be_written_is_named():
    before = settings().tool
    for folder in (tool_file("no_folder", "a file"), "/proc/riffler"):
        common.refused(
            lambda folder=folder: bpy.ops.riffler.plan_tool_save(folder=folder), folder, "that can be written"
        )
    assert settings().tool == before


def test_the_library_is_the_users_folder_and_not_the_addons():
    libraries = common.part("plan.tool_libraries")
    (folder,) = libraries.folders()
    addon = Path(common.part("registration").__file__).resolve().parent
    assert addon not in folder.resolve().parents
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "mine.json").write_text(json.dumps(ASSEMBLY))
    (folder / "broken.toml").write_text("kind = ")
    entries, problems = libraries.files()
    assert [e.name for e in entries] == ["Six"] and len(problems) == 1 and "broken.toml" in problems[0]
    bpy.ops.riffler.plan_tool(name="Six", path=str(entries[0].path))
    assert settings().tool_dict()["name"] == "Six"


# ---- plans in the .blend


def test_a_plan_is_kept_through_undo_save_and_copies():
    store = common.part("plan.plan_store")
    common.push("empty")
    ob = store.new(bpy.context, a_plan("one"))
    name, key = ob.name, store.identity(ob)
    assert store.is_plan(ob) and store.active(bpy.context) == ob and bpy.context.object == ob
    common.push("new")
    store.write(ob, a_plan("two", 9))
    common.push("written")
    assert store.identity(ob) != key
    bpy.ops.ed.undo()
    assert store.identity(bpy.data.objects[name]) == key
    bpy.ops.ed.redo()
    store.clear_cache()
    ob = bpy.data.objects[name]
    assert store.plan(ob).part == {"name": "two"} and len(store.plan(ob).paths[0]) == 9

    copy = ob.copy()
    bpy.context.collection.objects.link(copy)
    store.write(copy, a_plan("three"))
    assert store.plan(ob).part == {"name": "two"} and store.plan(copy).part == {"name": "three"}

    blend = common.out("plan.blend")
    copied = copy.name
    bpy.ops.wm.save_as_mainfile(filepath=blend)
    bpy.ops.wm.read_homefile()
    bpy.ops.wm.open_mainfile(filepath=blend)
    assert store.plan(bpy.data.objects[name]).part == {"name": "two"}
    assert store.plan(bpy.data.objects[copied]).part == {"name": "three"}


def test_a_stored_plan_reads_back_to_the_bit():
    store = common.part("plan.plan_store")
    plan = a_plan()
    ob = store.new(bpy.context, plan)
    assert store.plan(ob) is plan
    store.clear_cache()
    assert store.plan(ob) is not plan and riffler.plan.dumps(store.plan(ob)) == riffler.plan.dumps(plan)


def test_a_damaged_plan_is_named():
    store = common.part("plan.plan_store")
    ob = store.new(bpy.context, a_plan())
    image = ob.riffler.plan.store
    data = bytes(image.packed_file.data).replace(b"mm", b"in")
    image.pack(data=data, data_len=len(data))
    store.clear_cache()
    common.refused(bpy.ops.riffler.plan_show, ob.name, "damaged")
    common.part("blender.packed_images").write(image, data, common.part("sculpt.pure.sculpt_payload").content_id(data))
    common.refused(bpy.ops.riffler.plan_show, ob.name, "units")


def test_the_active_plan_is_found():
    store = common.part("plan.plan_store")
    assert store.active(bpy.context) is None
    a = store.new(bpy.context, a_plan())
    bpy.context.view_layer.objects.active = None
    assert store.active(bpy.context) == a
    b = store.new(bpy.context, a_plan())
    bpy.context.view_layer.objects.active = None
    assert store.active(bpy.context) is None
    child = cube()
    child.parent = a
    assert store.active(bpy.context) == a and store.in_scene(bpy.context.scene) == [a, b]
