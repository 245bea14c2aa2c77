"""Photographs what picture.py gathered, on a table in a studio's light. Runs in Blender's Python: studio.py scene.npz
picture.jpg. Materials, lights and backdrop are those of the demonstration."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import bpy
import numpy as np
from mathutils import Vector

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

from demo import scene as studio


def add(number: int, vertices: np.ndarray, triangles: np.ndarray, look: np.ndarray) -> None:
    mesh = bpy.data.meshes.new(f"Thing {number}")
    mesh.vertices.add(len(vertices))
    mesh.vertices.foreach_set("co", vertices.ravel())
    mesh.loops.add(triangles.size)
    mesh.loops.foreach_set("vertex_index", triangles.ravel())
    mesh.polygons.add(len(triangles))
    mesh.polygons.foreach_set("loop_start", np.arange(0, triangles.size, 3, dtype=np.int32))
    mesh.update(calc_edges=True)
    bpy.context.scene.collection.objects.link(bpy.data.objects.new(mesh.name, mesh))
    mesh.shade_smooth()
    mesh.set_sharp_from_angle(angle=float(look[4]))
    colour = tuple(map(float, look[:3]))
    stain = tuple(0.13 * c for c in colour)
    mesh.materials.append(studio.new_material(mesh.name, colour, colour, stain, 0.62, wood=False, hollows=2.6))


def lights(target: Vector, size: float) -> None:
    """Key from the left, a cool rim from behind, a wide soft fill: as far and bright as the subject is large."""
    for name, at, wide, watts, colour in (
        ("Key", (-2.3, -1.0, 1.6), 0.6, 92.0, (1.0, 0.94, 0.86)),
        ("Rim", (1.9, 1.7, 1.6), 1.0, 55.0, (0.80, 0.89, 1.0)),
        ("Fill", (1.7, -2.9, 0.5), 2.4, 11.0, (0.9, 0.95, 1.0)),
    ):
        place = target + size * Vector(at)
        studio.light(name, tuple(place), target, size * wide, watts * size * size, colour)


def main(scene_file: str, picture: str) -> None:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    with np.load(scene_file) as data:
        for k in range(int(data["count"])):
            add(k, data[f"vertices_{k}"], data[f"triangles_{k}"], data[f"look_{k}"])
        view = data["view"]
    target, eye, width, floor = Vector(view[:3]), Vector(view[3:6]), float(view[6]), float(view[9])
    studio.backdrop(studio.plain_material("Paper", (0.085, 0.105, 0.12), 0.75), floor)
    lights(target, width)
    studio.camera(tuple(eye), tuple(target), 36.0 * (target - eye).length / width)
    scene.world = bpy.data.worlds.new("World")
    scene.world.use_nodes = True
    background = scene.world.node_tree.nodes["Background"].inputs
    background["Color"].default_value, background["Strength"].default_value = (0.20, 0.22, 0.25, 1), 0.35
    studio.render_settings(scene, int(view[10]), os.cpu_count() or 2)
    scene.cycles.time_limit = 0.0
    scene.render.resolution_x, scene.render.resolution_y = int(view[7]), int(view[8])
    scene.render.image_settings.file_format, scene.render.image_settings.quality = "JPEG", 90
    scene.render.filepath = picture
    bpy.ops.render.render(write_still=True)


main(*sys.argv[1:3])
sys.stdout.flush()
os._exit(0)  # a bpy module may hang at exit; everything is written
