"""Renders meshes, flat shaded under low light, as tools/close_ups.py asks. Runs in Blender's Python."""

from __future__ import annotations

import json
import os
import sys

import bpy
import numpy as np
from mathutils import Vector


def load(path: str):
    records = np.fromfile(path, np.uint8)[84:].reshape(-1, 50)[:, :48].copy().view("<f4").reshape(-1, 4, 3)
    corners = records[:, 1:].reshape(-1, 3)
    vertices, index = np.unique(corners, axis=0, return_inverse=True)
    mesh = bpy.data.meshes.new("Mesh")
    mesh.from_pydata(vertices.tolist(), [], index.reshape(-1, 3).tolist())
    mesh.shade_flat()
    thing = bpy.data.objects.new("Mesh", mesh)
    bpy.context.scene.collection.objects.link(thing)
    material = bpy.data.materials.new("Wax")
    material.use_nodes = True
    shader = material.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = (0.55, 0.30, 0.16, 1)
    shader.inputs["Roughness"].default_value = 0.35
    mesh.materials.append(material)


def light(direction, target, energy: float) -> None:
    data = bpy.data.lights.new("Sun", "SUN")
    data.energy, data.angle = energy, 0.05
    holder = bpy.data.objects.new("Sun", data)
    holder.rotation_euler = (-Vector(direction)).to_track_quat("-Z", "Y").to_euler()
    bpy.context.scene.collection.objects.link(holder)


def picture(mesh: str, picture: str, target, direction, width: float) -> None:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    load(mesh)
    target, direction = Vector(target), Vector(direction).normalized()
    side = Vector((0, 0, 1)).cross(direction).normalized()
    light(direction + 1.6 * side, target, 3.2)
    light(direction - 1.2 * side + Vector((0, 0, 0.5)), target, 0.7)
    data = bpy.data.cameras.new("Camera")
    data.type, data.ortho_scale, data.clip_end = "ORTHO", width, 1000.0
    camera = bpy.data.objects.new("Camera", data)
    camera.location = target + 300 * direction
    camera.rotation_euler = (-direction).to_track_quat("-Z", "Y").to_euler()
    scene.collection.objects.link(camera)
    scene.camera = camera
    scene.world = bpy.data.worlds.new("World")
    scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.75, 0.8, 0.85, 1)
    scene.world.node_tree.nodes["Background"].inputs["Strength"].default_value = 0.35
    scene.render.engine = "CYCLES"
    scene.cycles.samples, scene.cycles.use_denoising, scene.cycles.max_bounces = 24, False, 2
    scene.render.resolution_x = scene.render.resolution_y = 720
    scene.render.filepath = picture
    bpy.ops.render.render(write_still=True)


for job in json.loads(sys.argv[1]):
    picture(**job)
sys.stdout.flush()
os._exit(0)  # everything is written
