"""Importing CAD files with another Python: units, attribute of the exact faces, colours, other tolerances, errors."""

import bpy
import numpy as np

from support import common
from support.cad_parts import part, with_reader


def size(ob):
    return np.array([v.co for v in ob.data.vertices]).max(0) - np.array([v.co for v in ob.data.vertices]).min(0)


def test_an_assembly_comes_in_scene_units_with_faces_and_colours():
    with_reader()
    common.scale(1000)
    assert bpy.ops.riffler.import_cad(filepath=part("assembly.step")) == {"FINISHED"}
    ob = bpy.context.object
    assert ob.name.startswith("assembly") and np.allclose(size(ob) * 1000, (40, 20, 17), atol=1e-3)
    faces = np.empty(len(ob.data.polygons), np.int32)
    ob.data.attributes["riffler_face"].data.foreach_get("value", faces)
    assert len(np.unique(faces)) == 12
    (top,) = (n for n, name in enumerate(ob.data["riffler_cad_faces"]) if name == "datum A")
    heights = [ob.data.vertices[v].co.z * 1000 for p in ob.data.polygons if faces[p.index] == top for v in p.vertices]
    assert len(heights) == 6 and np.allclose(heights, 5, atol=1e-3)
    named = {p.material_index for p in ob.data.polygons if faces[p.index] == top}
    assert {ob.data.materials[k].name for k in named} == {"CAD #CC331A"}
    assert len({p.material_index for p in ob.data.polygons}) == 3  # red, blue, none


def test_the_tolerance_is_changed_afterwards():
    """In a scene of millimetres; the assembly's is of metres."""
    with_reader()
    common.scale(1)
    bpy.ops.riffler.import_cad(filepath=part("torus.step"), tolerance=0.5)
    ob = bpy.context.object
    assert np.allclose(size(ob), (56, 56, 16), atol=1.0)
    ob.location = (5, 0, 0)
    coarse = len(ob.data.polygons)
    assert bpy.ops.riffler.retessellate(tolerance=0.05) == {"FINISHED"}
    assert np.allclose(size(ob), (56, 56, 16), atol=0.1)
    assert len(ob.data.polygons) > 2 * coarse and tuple(ob.location) == (5, 0, 0)
    assert ob.data["riffler_cad_tolerance"] == 0.05 or abs(ob.data["riffler_cad_tolerance"] - 0.05) < 1e-6
    assert len(ob.data.attributes["riffler_face"].data) == len(ob.data.polygons)
    bpy.data.objects.remove(ob)
    assert not bpy.ops.riffler.retessellate.poll()


@common.core_bound
def test_errors_change_nothing():
    with_reader()
    wire, before = part("wire.step"), len(bpy.data.objects)
    common.refused(lambda: bpy.ops.riffler.import_cad(filepath=wire), "it has no faces")
    common.refused(lambda: bpy.ops.riffler.import_cad(filepath=common.out("none.step")), "none.step")
    nested = common.out("nested.step")
    with open(nested, "w") as file:
        file.write("ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION(" + 3_000_000 * "(")
    common.refused(lambda: bpy.ops.riffler.import_cad(filepath=nested), "nested.step: ")
    assert len(bpy.data.objects) == before and not any(m.name.startswith("wire") for m in bpy.data.meshes)
