"""Blocks, spheres and cylinders that are added as sculpts."""

import bpy
import numpy as np

from support import common

LONGEST = 200.0  # mm, of the solids added here: 0.2 m


def added(**settings):
    """The new sculpt, in a scene whose unit is a metre, with the cursor elsewhere."""
    common.scale(1000)
    bpy.context.scene.cursor.location = (0.3, -0.2, 0.1)
    assert bpy.ops.riffler.add_solid(**settings) == {"FINISHED"}
    ob = bpy.context.object
    assert np.allclose(ob.matrix_world.translation, (0.3, -0.2, 0.1)) and ob.select_get()
    return ob


def millimetres(ob):
    """(n, 3): the mesh's vertices in the object's frame."""
    return common.coordinates(ob.data).astype(float) * 1000


def test_a_sphere_has_its_radius_everywhere_and_no_facets():
    ob = added(shape="SPHERE", radius=0.1)
    volume = common.content(ob).volume
    assert ob.name == "Sphere" and volume.directions == "xyz" and 150 <= LONGEST / volume.pitch <= 200
    off = np.linalg.norm(millimetres(ob), axis=1) - 100
    assert abs(off).max() < 0.01 * volume.pitch, (off.min(), off.max())
    assert abs(volume.volume / (4e6 / 3 * np.pi) - 1) < 1e-4


def test_a_cylinder_has_round_sides_and_flat_caps_with_sharp_edges():
    ob = added(shape="CYLINDER", radius=0.05, depth=0.2)
    co, pitch = millimetres(ob), common.content(ob).volume.pitch
    radius, height = np.hypot(co[:, 0], co[:, 1]), abs(co[:, 2])
    assert abs(np.minimum(abs(radius - 50), abs(height - 100))).max() < 0.01 * pitch
    assert (radius < 50 + 0.01 * pitch).all() and (height < 100 + 0.01 * pitch).all()
    edge = (radius > 50 - 0.02 * pitch) & (height > 100 - 0.02 * pitch)
    assert edge.sum() > 2 * 2 * np.pi * 50 / pitch / 2, edge.sum()  # half a vertex for each pitch of both rims


def test_a_block_is_its_size_and_may_have_rays_of_one_direction():
    ob = added(shape="BLOCK", size=(0.2, 0.1, 0.05), directions="z", rays=100)
    volume = common.content(ob).volume
    assert volume.pitch == 2 and volume.directions == "z"
    assert np.allclose(volume.lower, (-100, -50, -25)) and np.allclose(volume.upper, (100, 50, 25))
    assert abs(volume.volume - 1e6) < 1e-6


def test_sizes_are_in_the_scenes_units():
    common.scale(1)
    bpy.ops.riffler.add_solid(shape="SPHERE", radius=10)
    assert np.allclose(common.content(bpy.context.object).volume.upper, 10)


def test_undo_removes_the_solid_and_redo_restores_it():
    common.scale(1)
    bpy.ops.ed.undo_push(message="before")
    bpy.ops.riffler.add_solid("EXEC_DEFAULT", True, shape="SPHERE", radius=10)
    bytes_before = common.content(bpy.data.objects["Sphere"]).volume.to_bytes()
    bpy.ops.ed.undo()
    assert "Sphere" not in bpy.data.objects
    bpy.ops.ed.redo()
    assert common.content(bpy.data.objects["Sphere"]).volume.to_bytes() == bytes_before


def test_impossible_solids_are_refused_with_a_remedy_and_leave_nothing():
    common.scale(1)
    meshes, objects = len(bpy.data.meshes), len(bpy.data.objects)
    add = bpy.ops.riffler.add_solid
    common.refused(lambda: add(shape="SPHERE", radius=0), "Radius is 0")
    common.refused(lambda: add(shape="CYLINDER", radius=1, depth=0), "Depth is 0")
    common.refused(lambda: add(shape="BLOCK", size=(1, 0, 1)), "Size Y is 0")
    thin = common.refused(lambda: add(shape="CYLINDER", radius=0.1, depth=100), "too thin for 180 rays", "1\u00a0000")
    assert "Cylinder" in thin
    common.refused(lambda: add(shape="SPHERE", radius=1, rays=100_000), "fewer rays")
    assert (len(bpy.data.meshes), len(bpy.data.objects)) == (meshes, objects)
    assert add(shape="CYLINDER", radius=0.1, depth=100, rays=1000) == {"FINISHED"}  # the remedy works
    assert add(shape="SPHERE", radius=1, rays=2) == {"FINISHED"}
