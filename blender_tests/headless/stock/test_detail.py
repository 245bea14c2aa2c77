"""A sculpt shows the triangles that its shape needs, or all: live, in the file, and with a mask or colours."""

from pathlib import Path

import bpy
import numpy as np
import riffler

from support import common
from support.sculpting import is_shown, live, matches_its_volume, nothing_is_left, sculpt, stroke, work

MASKED = np.array([[20.0, 15, -5, 0, 0, 1], [20, 15.001, -5, 0, 0, 1]])


def needs_normals():
    if not common.part("blender.versions").OWN_NORMALS:
        raise common.Skip("before Blender 4.5 a sculpt always shows all triangles")


def chunk_triangles(name):
    mark = bpy.data.objects[name].riffler.mark
    return sum(len(ob.data.polygons) for ob in common.part("sculpt.chunks").collection_of(mark).objects)


def all_triangles(name):
    return len(live().content(bpy.data.objects[name]).volume.to_mesh().triangles)


def test_strokes_show_a_tenth_of_the_triangles_one_click_shows_all_and_undo_reverts_it():
    needs_normals()
    name = sculpt(pitch=0.5)
    mesh = bpy.data.objects[name].data
    run = work(name)
    assert chunk_triangles(name) < 0.05 * all_triangles(name)
    run.stages.take_counts()
    stroke(name, 3)
    needed = run.stages.take_counts()["bytes"]
    is_shown(name)
    assert bpy.ops.riffler.detail("EXEC_DEFAULT", True, detail="ALL") == {"FINISHED"}
    nothing_is_left()
    matches_its_volume(name)
    assert len(mesh.polygons) == all_triangles(name) == mesh.riffler.all_triangles and mesh.riffler.shown_within == 0
    run = work(name)
    is_shown(name)
    assert chunk_triangles(name) == all_triangles(name)
    run.stages.take_counts()
    stroke(name, 4)
    assert run.stages.take_counts()["bytes"] > 10 * needed
    is_shown(name)
    live().end_all()
    common.push("end")
    for _ in range(3):
        bpy.ops.ed.undo()
    assert bpy.data.objects[name].data.riffler.detail == "NEEDED"
    is_shown(name)
    stroke(name, 6)
    is_shown(name)
    live().end_all()
    matches_its_volume(name)
    mesh = bpy.data.objects[name].data
    assert 20 * len(mesh.polygons) < mesh.riffler.all_triangles
    assert abs(mesh.riffler.shown_within - 0.05) < 1e-6  # a tenth of the pitch


def test_the_choice_is_saved_and_a_file_opens_as_it_was_shown():
    needs_normals()
    sizes = {}
    for detail in ("NEEDED", "ALL"):
        name = sculpt(size=(60, 60, 20))
        stroke(name, 2)
        assert bpy.ops.riffler.detail(detail=detail) == {"FINISHED"}
        path = common.out(f"{detail}.blend")
        bpy.ops.wm.save_as_mainfile(filepath=path, compress=False)
        sizes[detail] = Path(path).stat().st_size
        before = common.coordinates(bpy.data.objects[name].data)
        bpy.ops.wm.open_mainfile(filepath=path)
        mesh = bpy.data.objects[name].data
        assert mesh.riffler.detail == detail and np.array_equal(common.coordinates(mesh), before)
        matches_its_volume(name)
        for k in range(2):
            stroke(name, 5 + k)
            is_shown(name)
        live().end_all()
        matches_its_volume(name)
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        Path(path).unlink()
    common.figure("bytes of a file, as needed and all", list(sizes.values()))
    assert sizes["NEEDED"] < 0.5 * sizes["ALL"]


def test_a_sculpt_shows_all_triangles_while_it_has_a_mask():
    needs_normals()
    name = sculpt(size=(40, 30, 20))
    run = work(name)
    stroke(name, 1)
    assert chunk_triangles(name) < 0.1 * all_triangles(name)
    run.begin_stroke()
    run.carve(riffler.Tool.flat(20, 60), MASKED, mode="mask")
    run.show()
    assert chunk_triangles(name) == all_triangles(name)
    run.cancel_stroke()
    is_shown(name)
    assert chunk_triangles(name) < 0.1 * all_triangles(name)
    run.begin_stroke()
    run.carve(riffler.Tool.flat(20, 60), MASKED, mode="mask")
    assert run.finish_stroke(bpy.context, "mask")
    detail = common.part("stock.detail")
    for k in range(2, 5):
        stroke(name, k)
        is_shown(name)
    assert "mask" in detail.all_for(bpy.data.objects[name])
    for _ in range(4):
        bpy.ops.ed.undo()
    is_shown(name)
    assert detail.all_for(bpy.data.objects[name]) == "" and chunk_triangles(name) < 0.1 * all_triangles(name)
    stroke(name, 2)
    is_shown(name)
    for step in (bpy.ops.ed.undo, bpy.ops.ed.redo):
        step()
        is_shown(name)
    run = work(name)
    run.begin_stroke()
    run.carve(riffler.Tool.flat(20, 60), MASKED, mode="mask")
    assert run.finish_stroke(bpy.context, "mask")
    live().end_all()
    matches_its_volume(name)
    assert "mask" in detail.all_for(bpy.data.objects[name])
    assert bpy.ops.riffler.mask_clear() == {"FINISHED"}
    matches_its_volume(name)
    assert detail.all_for(bpy.data.objects[name]) == "" and bpy.data.objects[name].data.riffler.shown_within > 0


def test_distances_are_shown_on_all_triangles_and_measured_from_all():
    needs_normals()
    name = sculpt(size=(40, 30, 20))
    stroke(name, 1)
    live().end_all()
    bpy.ops.mesh.primitive_cube_add(size=1, location=(20, 15, 10))
    other = bpy.context.object
    other.scale = (40, 30, 20)
    bpy.context.view_layer.update()
    ob = bpy.data.objects[name]
    common.select(ob)
    needed, every = len(ob.data.polygons), all_triangles(name)
    assert needed < 0.1 * every
    assert bpy.ops.riffler.show_deviation(reference=other.name) == {"FINISHED"}
    assert len(ob.data.polygons) == every and ob.data.riffler.detail == "NEEDED"
    assert "colours" in common.part("stock.detail").all_for(ob)
    shown = np.empty(len(ob.data.vertices), np.float32)
    ob.data.attributes["riffler_deviation"].data.foreach_get("value", shown)
    exact = common.content(ob).volume.to_mesh()
    box = riffler.Volume.block((0, 0, 0), (40, 30, 20), pitch=5.0, directions="xyz").to_mesh()
    assert np.allclose(shown, exact.deviation(box, signed=True), atol=1e-4)
    assert bpy.ops.riffler.hide_deviation() == {"FINISHED"}
    assert len(ob.data.polygons) == needed and common.part("stock.detail").all_for(ob) == ""


def test_edits_of_the_mesh_are_neither_lost_nor_overwritten():
    name = sculpt(size=(40, 30, 20))
    ob = bpy.data.objects[name]
    common.select(ob)
    ob.data.vertices[0].co.x -= 1
    ob.data.update()
    common.refused(lambda: bpy.ops.riffler.detail(detail="ALL"), "was edited", "Apply Mesh Edits")
    assert ob.data.riffler.detail == "NEEDED"
    assert bpy.ops.riffler.rebuild() == {"FINISHED"}
    assert bpy.ops.riffler.detail(detail="ALL") == {"FINISHED"}
    matches_its_volume(name)
