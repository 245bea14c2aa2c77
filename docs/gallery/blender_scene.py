"""Renders what picture.py gathered. Runs in Blender's Python: blender_scene.py scene.npz picture.jpg"""

from __future__ import annotations

import os
import sys

import bpy
import numpy as np
from mathutils import Vector


def add(number: int, vertices: np.ndarray, triangles: np.ndarray, look: np.ndarray) -> None:
    mesh = bpy.data.meshes.new(f"Thing {number}")
    mesh.from_pydata(vertices.tolist(), [], triangles.tolist())
    thing = bpy.data.objects.new(mesh.name, mesh)
    bpy.context.scene.collection.objects.link(thing)
    if look[4] > 0:
        mesh.shade_smooth()
        mesh.set_sharp_from_angle(angle=float(look[4]))
    material = bpy.data.materials.new(mesh.name)
    material.use_nodes = True
    shader = material.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = (*map(float, look[:3]), 1)
    shader.inputs["Roughness"].default_value = 0.4
    shader.inputs["Alpha"].default_value = float(look[3])
    mesh.materials.append(material)


def light(direction: Vector, energy: float, angle: float) -> None:
    data = bpy.data.lights.new("Sun", "SUN")
    data.energy, data.angle = energy, angle
    holder = bpy.data.objects.new("Sun", data)
    holder.rotation_euler = (-direction).to_track_quat("-Z", "Y").to_euler()
    bpy.context.scene.collection.objects.link(holder)


def main(scene_file: str, picture: str) -> None:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    with np.load(scene_file) as data:
        for k in range(int(data["count"])):
            add(k, data[f"vertices_{k}"], data[f"triangles_{k}"], data[f"look_{k}"])
        view = data["view"]
    target, direction, width = Vector(view[:3]), Vector(view[3:6]).normalized(), float(view[6])
    side = Vector((0, 0, 1)).cross(direction).normalized()
    light(direction + 1.3 * side + Vector((0, 0, 0.8)), 3.0, 0.1)
    light(direction - 1.4 * side + Vector((0, 0, 0.4)), 0.9, 0.3)
    data = bpy.data.cameras.new("Camera")
    data.type, data.ortho_scale, data.clip_end = "ORTHO", width, 2000.0
    camera = bpy.data.objects.new("Camera", data)
    camera.location = target + 600 * direction
    camera.rotation_euler = (-direction).to_track_quat("-Z", "Y").to_euler()
    scene.collection.objects.link(camera)
    scene.camera = camera
    scene.world = bpy.data.worlds.new("World")
    scene.world.use_nodes = True
    background = scene.world.node_tree.nodes["Background"].inputs
    background["Color"].default_value, background["Strength"].default_value = (0.82, 0.86, 0.9, 1), 0.5
    scene.view_settings.view_transform = "Standard"
    scene.render.engine = "CYCLES"
    scene.cycles.samples, scene.cycles.use_denoising, scene.cycles.max_bounces = 32, False, 3
    scene.render.resolution_x, scene.render.resolution_y = int(view[7]), int(view[8])
    scene.render.image_settings.file_format = "JPEG"
    scene.render.image_settings.quality = 88
    scene.render.filepath = picture
    bpy.ops.render.render(write_still=True)


main(*sys.argv[1:3])
sys.stdout.flush()
os._exit(0)  # a bpy module may hang at exit; everything is written
