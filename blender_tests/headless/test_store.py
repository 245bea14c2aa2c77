"""The volume inside the .blend."""

import bpy
import numpy as np

import support


def cut_stock(depth=2.0):
    support.scale(1)
    ob = support.stock()
    c = support.curve("Line", [(10, 15, 20), (30, 15, 20)], mm_per_unit=1)
    bpy.ops.riffler.cut_curve(curve=c.name, depth=depth, tool=support.FLAT)
    bpy.context.view_layer.objects.active = ob
    return ob


def images():
    return [i for i in bpy.data.images if support.part("bl.packed").IDENTITY in i]


def test_save_and_reopen():
    ob = cut_stock()
    name, key = ob.name, support.part("bl.store").identity(ob.data)
    shape, co = support.shape(support.content(ob).volume), support.coordinates(ob.data)
    path = support.out("saved.blend")
    for compress in (False, True):
        bpy.ops.wm.save_as_mainfile(filepath=path, compress=compress)
        bpy.ops.wm.read_homefile()
        bpy.ops.wm.open_mainfile(filepath=path)
        ob = bpy.data.objects[name]
        assert support.part("bl.store").identity(ob.data) == key
        assert support.same(support.shape(support.content(ob).volume), shape)
        assert np.array_equal(support.coordinates(ob.data), co)
        assert len(support.content(ob).cuts) == 1
    bpy.context.view_layer.objects.active = ob
    bpy.ops.riffler.cut_curve(curve="Line", depth=3, tool=support.FLAT)
    assert len(support.content(ob).cuts) == 2


def test_a_purge_keeps_it_and_a_deleted_sculpt_takes_it_along():
    ob = cut_stock()
    bpy.ops.outliner.orphans_purge()
    assert len(images()) == 1 and support.content(ob).volume.volume < 24000
    mesh = ob.data
    bpy.data.objects.remove(ob)
    bpy.data.meshes.remove(mesh)
    path = support.out("empty.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    assert not images()


def test_a_copy_shares_until_one_is_cut():
    a = cut_stock()
    b = a.copy()
    b.data = a.data.copy()
    bpy.context.collection.objects.link(b)
    assert len(images()) == 1
    before, co = support.shape(support.content(a).volume), support.coordinates(a.data)
    bpy.context.view_layer.objects.active = b
    bpy.ops.riffler.cut_curve(curve="Line", depth=4, tool=support.FLAT)
    assert len(images()) == 2
    assert support.same(before, support.shape(support.content(a).volume))
    assert np.array_equal(co, support.coordinates(a.data))
    assert support.content(b).volume.volume < support.content(a).volume.volume


def test_a_linked_duplicate_is_one_thing():
    a = cut_stock()
    b = a.copy()
    bpy.context.collection.objects.link(b)
    bpy.context.view_layer.objects.active = b
    bpy.ops.riffler.cut_curve(curve="Line", depth=4, tool=support.FLAT)
    assert len(images()) == 1 and support.content(a) is support.content(b)


def test_renaming_changes_nothing():
    ob = cut_stock()
    volume = support.content(ob).volume.volume
    ob.name, ob.data.name, images()[0].name = "Other", "Name", "picture"
    support.part("bl.store").clear_cache()
    assert support.content(ob).volume.volume == volume


def test_an_appended_sculpt_brings_its_volume():
    ob = cut_stock()
    name, volume = ob.name, support.content(ob).volume.volume
    path = support.out("library.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.read_homefile()
    with bpy.data.libraries.load(path, link=False) as (_, into):
        into.objects = [name]
    ob = into.objects[0]
    bpy.context.collection.objects.link(ob)
    assert support.content(ob).volume.volume == volume


def test_a_linked_sculpt_can_be_read_but_not_cut():
    ob = cut_stock()
    name, volume = ob.name, support.content(ob).volume.volume
    path = support.out("library.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.read_homefile()
    with bpy.data.libraries.load(path, link=True) as (_, into):
        into.objects = [name]
    ob = into.objects[0]
    bpy.context.collection.objects.link(ob)
    bpy.context.view_layer.objects.active = ob
    assert support.content(ob).volume.volume == volume
    assert not bpy.ops.riffler.cut_curve.poll()
    bpy.ops.riffler.export_stl(filepath=support.out("linked.stl"))


def test_unpacked_files_are_read():
    ob = cut_stock()
    name, volume = ob.name, support.content(ob).volume.volume
    bpy.ops.wm.save_as_mainfile(filepath=support.out("unpacked.blend"))
    bpy.ops.file.unpack_all(method="WRITE_LOCAL")
    support.part("bl.store").clear_cache()
    assert support.content(bpy.data.objects[name]).volume.volume == volume


def test_damaged_data_is_named_and_nothing_is_changed():
    ob = cut_stock()
    image = images()[0]
    data = bytearray(image.packed_file.data)
    data[len(data) // 2] ^= 1
    image.pack(data=bytes(data), data_len=len(data))
    support.part("bl.store").clear_cache()
    support.refused(lambda: bpy.ops.riffler.cut_curve(curve="Line", tool=support.FLAT), "damaged")
    support.refused(lambda: bpy.ops.riffler.export_stl(filepath=support.out("damaged.stl")), "damaged")
    assert len(ob.data.polygons) > 0


def test_an_edited_mesh_is_noticed_and_rebuilt():
    ob = cut_stock()
    sculpts = support.part("bl.sculpts")
    co = support.coordinates(ob.data)
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
    assert not sculpts.edited(ob.data) and np.array_equal(co, support.coordinates(ob.data))


def test_material_slots_stay():
    ob = cut_stock()
    ob.data.materials.append(bpy.data.materials.new("Wax"))
    bpy.ops.riffler.cut_curve(curve="Line", depth=3, tool=support.FLAT)
    assert ob.data.materials[0].name == "Wax"


def test_stock_and_undo_before_it():
    support.scale(1)
    support.push("empty")
    bpy.ops.riffler.new_stock("EXEC_DEFAULT", True, size=(10, 10, 10), pitch=0.5)
    name = bpy.context.object.name
    bpy.ops.ed.undo()
    assert name not in bpy.data.objects and not images()
    bpy.ops.ed.redo()
    support.part("bl.store").clear_cache()
    assert support.content(bpy.data.objects[name]).volume.volume == 1000
