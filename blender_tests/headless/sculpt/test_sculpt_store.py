"""The volume inside the .blend."""

import bpy
import numpy as np

from support import common


def cut_stock(depth=2.0):
    common.scale(1)
    ob = common.stock()
    c = common.curve("Line", [(10, 15, 20), (30, 15, 20)], mm_per_unit=1)
    bpy.ops.riffler.cut_curve(curve=c.name, depth=depth, tool=common.FLAT)
    bpy.context.view_layer.objects.active = ob
    return ob


def images():
    return [i for i in bpy.data.images if common.part("blender.packed_images").IDENTITY in i]


def test_a_file_keeps_everything_when_saved_and_reopened():
    ob = cut_stock()
    name, key = ob.name, common.part("sculpt.sculpt_store").identity(ob.data)
    shape, co = common.shape(common.content(ob).volume), common.coordinates(ob.data)
    path = common.out("saved.blend")
    for compress in (False, True):
        bpy.ops.wm.save_as_mainfile(filepath=path, compress=compress)
        bpy.ops.wm.read_homefile()
        bpy.ops.wm.open_mainfile(filepath=path)
        ob = bpy.data.objects[name]
        assert common.part("sculpt.sculpt_store").identity(ob.data) == key
        assert common.same(common.shape(common.content(ob).volume), shape)
        assert np.array_equal(common.coordinates(ob.data), co)
        assert len(common.content(ob).cuts) == 1
    bpy.context.view_layer.objects.active = ob
    bpy.ops.riffler.cut_curve(curve="Line", depth=3, tool=common.FLAT)
    assert len(common.content(ob).cuts) == 2


def test_a_purge_keeps_it_and_a_deleted_sculpt_takes_it_along():
    ob = cut_stock()
    bpy.ops.outliner.orphans_purge()
    assert len(images()) == 1 and common.content(ob).volume.volume < 24000
    mesh = ob.data
    bpy.data.objects.remove(ob)
    bpy.data.meshes.remove(mesh)
    path = common.out("empty.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    assert not images()


def test_a_copy_shares_until_one_is_cut():
    a = cut_stock()
    b = a.copy()
    b.data = a.data.copy()
    bpy.context.collection.objects.link(b)
    assert len(images()) == 1
    before, co = common.shape(common.content(a).volume), common.coordinates(a.data)
    bpy.context.view_layer.objects.active = b
    bpy.ops.riffler.cut_curve(curve="Line", depth=4, tool=common.FLAT)
    assert len(images()) == 2
    assert common.same(before, common.shape(common.content(a).volume))
    assert np.array_equal(co, common.coordinates(a.data))
    assert common.content(b).volume.volume < common.content(a).volume.volume


def test_a_linked_duplicate_is_one_thing():
    a = cut_stock()
    b = a.copy()
    bpy.context.collection.objects.link(b)
    bpy.context.view_layer.objects.active = b
    bpy.ops.riffler.cut_curve(curve="Line", depth=4, tool=common.FLAT)
    assert len(images()) == 1 and common.content(a) is common.content(b)


def test_renaming_changes_nothing():
    ob = cut_stock()
    volume = common.content(ob).volume.volume
    ob.name, ob.data.name, images()[0].name = "Other", "Name", "picture"
    common.part("sculpt.sculpt_store").clear_cache()
    assert common.content(ob).volume.volume == volume


def test_an_appended_sculpt_brings_its_volume():
    ob = cut_stock()
    name, volume = ob.name, common.content(ob).volume.volume
    path = common.out("library.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.read_homefile()
    with bpy.data.libraries.load(path, link=False) as (_, into):
        into.objects = [name]
    ob = into.objects[0]
    bpy.context.collection.objects.link(ob)
    assert common.content(ob).volume.volume == volume


def test_a_linked_sculpt_can_be_read_but_not_cut():
    ob = cut_stock()
    name, volume = ob.name, common.content(ob).volume.volume
    path = common.out("library.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.read_homefile()
    with bpy.data.libraries.load(path, link=True) as (_, into):
        into.objects = [name]
    ob = into.objects[0]
    bpy.context.collection.objects.link(ob)
    bpy.context.view_layer.objects.active = ob
    assert common.content(ob).volume.volume == volume
    assert not bpy.ops.riffler.cut_curve.poll()
    bpy.ops.riffler.export_stl(filepath=common.out("linked.stl"))


def test_unpacked_files_are_read():
    ob = cut_stock()
    name, volume = ob.name, common.content(ob).volume.volume
    bpy.ops.wm.save_as_mainfile(filepath=common.out("unpacked.blend"))
    bpy.ops.file.unpack_all(method="WRITE_LOCAL")
    common.part("sculpt.sculpt_store").clear_cache()
    assert common.content(bpy.data.objects[name]).volume.volume == volume


def test_damaged_data_is_named_and_nothing_is_changed():
    ob = cut_stock()
    image = images()[0]
    data = bytearray(image.packed_file.data)
    data[len(data) // 2] ^= 1
    image.pack(data=bytes(data), data_len=len(data))
    common.part("sculpt.sculpt_store").clear_cache()
    common.refused(lambda: bpy.ops.riffler.cut_curve(curve="Line", tool=common.FLAT), "damaged")
    common.refused(lambda: bpy.ops.riffler.export_stl(filepath=common.out("damaged.stl")), "damaged")
    assert len(ob.data.polygons) > 0


def test_an_edited_mesh_is_noticed_and_rebuilt():
    ob = cut_stock()
    sculpts = common.part("sculpt.sculpts")
    co = common.coordinates(ob.data)
    assert not sculpts.edited(ob.data)
    ob.scale = (2, 2, 2)
    bpy.ops.object.select_all(action="DESELECT")
    ob.select_set(True)
    bpy.ops.object.transform_apply(location=False, rotation=False)
    assert sculpts.edited(ob.data)
    bpy.ops.riffler.rebuild()
    assert not sculpts.edited(ob.data)
    ob.data.clear_geometry()
    assert sculpts.edited(ob.data)
    bpy.ops.riffler.rebuild()
    assert not sculpts.edited(ob.data) and np.array_equal(co, common.coordinates(ob.data))


def test_material_slots_stay():
    ob = cut_stock()
    ob.data.materials.append(bpy.data.materials.new("Wax"))
    bpy.ops.riffler.cut_curve(curve="Line", depth=3, tool=common.FLAT)
    assert ob.data.materials[0].name == "Wax"


def test_undo_before_the_first_stock_removes_it():
    common.scale(1)
    common.push("empty")
    bpy.ops.riffler.new_stock("EXEC_DEFAULT", True, size=(10, 10, 10), pitch=0.5)
    name = bpy.context.object.name
    bpy.ops.ed.undo()
    assert name not in bpy.data.objects and not images()
    bpy.ops.ed.redo()
    common.part("sculpt.sculpt_store").clear_cache()
    assert common.content(bpy.data.objects[name]).volume.volume == 1000
