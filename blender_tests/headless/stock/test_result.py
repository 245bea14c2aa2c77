"""From sculpts to meshes and files, and their distance from the reference."""

import os

import bpy
import numpy as np
import riffler

from support import common


def sculpt():
    common.scale(1)
    ob = common.stock(size=(40, 30, 20), pitch=0.5, directions="xyz")
    path = common.curve("C", [(-5, 15, 18), (45, 15, 18)], mm_per_unit=1.0)
    common.select(ob)
    bpy.ops.riffler.cut_curve(curve=path.name, tool=common.BALL)
    return ob


def values(mesh, name, field="value", width=1):
    out = np.empty(len(mesh.vertices) * width, np.float32)
    mesh.attributes[name].data.foreach_get(field, out)
    return out.reshape(-1, width) if width > 1 else out


def test_a_mesh_has_the_reported_error():
    ob = sculpt()
    exact = common.content(ob).volume.to_mesh()
    assert bpy.ops.riffler.to_mesh(tolerance=0.02, iterations=3, smooth_tolerance=0.01) == {"FINISHED"}
    made = bpy.context.object
    assert made != ob and not made.data.riffler.store and ob.hide_get()
    co, tri = common.coordinates(made.data), common.triangles(made.data)
    assert 0 < len(tri) < 0.2 * len(exact.triangles)
    mesh = riffler.Mesh(co.astype(float), tri)
    assert mesh.audit().open_edges == 0
    # compared with the dense surface, in both directions: smoothing and decimating each keep their tolerance
    error = max(np.abs(mesh.deviation(exact)).max(), np.abs(exact.deviation(mesh)).max())
    assert 1e-4 < error < 0.03 + 1e-5
    assert abs(made.data["riffler_error"] - error) < 1e-5  # coordinates are float32 in Blender
    said = common.part("stock.result").said_of(made.data)
    assert f"{len(tri):,}".replace(",", "\u00a0") in said, said
    assert abs(float(said.partition("at most ")[2].partition(" mm")[0]) - error) < 2e-5, said


def test_without_decimation_and_smoothing_the_mesh_is_the_sculpts():
    ob = sculpt()
    exact = common.content(ob).volume.to_mesh()
    assert bpy.ops.riffler.to_mesh(tolerance=0.0, hide_sculpt=False) == {"FINISHED"}
    made = bpy.context.object.data
    assert len(made.polygons) == len(exact.triangles) and not ob.hide_get() and made["riffler_error"] == 0


def test_3mf_and_stl_hold_the_same_surface():
    ob = sculpt()
    ob.location.x = 7
    bpy.context.view_layer.update()
    common.select(ob)
    for name in ("stl", "3mf"):
        path = common.out(f"result.{name}")
        assert getattr(bpy.ops.riffler, f"export_{name}")(filepath=path) == {"FINISHED"}
    modes = {os.stat(common.out(f"result.{name}")).st_mode & 0o777 for name in ("stl", "3mf")}
    assert len(modes) == 1 and modes.pop() & 0o400  # like any new file
    stl = riffler.Mesh.read(common.out("result.stl"))
    assert abs(stl.bounds[0][0] - 7) < 1e-4
    import zipfile
    from xml.etree import ElementTree

    with zipfile.ZipFile(common.out("result.3mf")) as archive:
        model = ElementTree.fromstring(archive.read("3D/3dmodel.model"))
    core = "{http://schemas.microsoft.com/3dmanufacturing/core/2015/02}"
    x = [float(v.get("x")) for v in model.iter(core + "vertex")]
    assert abs(min(x) - 7) < 1e-6 and len(list(model.iter(core + "triangle"))) == len(stl.triangles)
    common.refused(lambda: bpy.ops.riffler.export_3mf(filepath=common.out("none/result.3mf")), "none")


def test_deviation_is_an_attribute_in_mm_with_colours():
    ob = sculpt()
    bpy.ops.mesh.primitive_cube_add(size=1)
    reference = bpy.context.object
    reference.dimensions = (40, 30, 19.9)
    reference.location = (20, 15, 9.95)
    bpy.context.view_layer.update()
    common.select(ob)
    assert bpy.ops.riffler.show_deviation(reference=reference.name, scale=0.2) == {"FINISHED"}
    distance, z = values(ob.data, "riffler_deviation"), common.coordinates(ob.data)[:, 2]
    inside = (np.abs(common.coordinates(ob.data)[:, 1] - 15) > 4) & (z > 19.99)
    assert np.allclose(distance[inside], 0.1, atol=1e-3)
    assert distance.min() < -1.5  # the groove
    colour = values(ob.data, "riffler_deviation_colour", "color", 4)
    assert colour[np.argmin(distance), 0] > colour[np.argmin(distance), 2]
    assert ob.data.color_attributes.active_color.name == "riffler_deviation_colour"
    assert bpy.ops.riffler.hide_deviation() == {"FINISHED"}
    assert "riffler_deviation" not in ob.data.attributes and not bpy.ops.riffler.hide_deviation.poll()
    common.refused(lambda: bpy.ops.riffler.show_deviation(reference="Nothing"), "there is no object")
    common.refused(lambda: bpy.ops.riffler.show_deviation(reference=ob.name), "itself")


def test_stock_from_a_sculpt_is_its_volume():
    ob = sculpt()
    before = common.content(ob).volume.to_bytes()
    common.select(ob)
    assert bpy.ops.riffler.new_stock(source="OBJECT", pitch=0.5, directions="xyz") == {"FINISHED"}
    copy = bpy.context.object
    assert copy != ob and ob.hide_get() and common.content(copy).volume.to_bytes() == before
    common.select(copy)
    assert bpy.ops.riffler.new_stock(source="OBJECT", pitch=1.0, directions="z") == {"FINISHED"}
    coarse = common.content(bpy.context.object).volume
    assert coarse.pitch == 1.0 and abs(coarse.volume - common.content(ob).volume.volume) < 0.005 * coarse.volume


def test_a_reference_without_a_surface_is_refused():
    bpy.ops.mesh.primitive_cube_add()
    bpy.context.collection.objects.link(bpy.data.objects.new("Nothing", None))
    common.refused(lambda: bpy.ops.riffler.show_deviation(reference="Nothing"), "Nothing", "has no surface")


def coloured():
    """A sculpt that shows its distance from a cube, and the previous settings of its views."""
    ob = sculpt()
    bpy.ops.mesh.primitive_cube_add(size=30)
    reference = bpy.context.object
    common.select(ob)
    before = shadings()
    assert "VERTEX" not in before
    common.push("before")
    assert bpy.ops.riffler.show_deviation("EXEC_DEFAULT", True, reference=reference.name) == {"FINISHED"}
    assert set(shadings()) == {"VERTEX"} and common.part("stock.deviation_legend").mesh_of(bpy.context) == ob.data
    return ob, before


def shadings():
    return [space.shading.color_type for _, _, space in common.part("blender.views").views()]


def test_cutting_a_coloured_surface_removes_colours_legend_and_shading():
    ob, before = coloured()
    bpy.ops.riffler.crop(point=(30, 0, 0), normal=(1, 0, 0))
    assert "riffler_deviation_scale" not in ob.data and shadings() == before
    assert common.part("stock.deviation_legend").mesh_of(bpy.context) is None


def test_undo_restores_the_views_and_redo_colours_them_again():
    ob, before = coloured()
    name = ob.name
    bpy.ops.ed.undo()
    assert shadings() == before and "riffler_deviation_scale" not in bpy.data.objects[name].data
    bpy.ops.ed.redo()
    assert set(shadings()) == {"VERTEX"} and "riffler_deviation_scale" in bpy.data.objects[name].data
    assert bpy.ops.riffler.hide_deviation() == {"FINISHED"}
    assert shadings() == before


def test_views_stay_coloured_while_another_mesh_is_coloured():
    ob, before = coloured()
    assert bpy.ops.riffler.to_mesh(tolerance=0.0, hide_sculpt=False) == {"FINISHED"}
    other = bpy.context.object
    bpy.ops.riffler.show_deviation(reference=ob.name)
    assert bpy.ops.riffler.hide_deviation() == {"FINISHED"} and set(shadings()) == {"VERTEX"}
    common.select(ob)
    assert bpy.ops.riffler.hide_deviation() == {"FINISHED"} and shadings() == before
    assert "riffler_shading" not in other.data


def test_a_legend_needs_colours():
    ob, _ = coloured()
    ob.data.attributes.remove(ob.data.attributes["riffler_deviation_colour"])  # as Blender's own tools may
    assert common.part("stock.deviation_legend").mesh_of(bpy.context) is None
