"""Both carved stocks on a table: a .blend and its picture. Runs inside Blender's Python (bpy).

<blender python> demo/scene.py head.stl egg.stl out/demo/riffler.blend out/demo/riffler.png
"""

from __future__ import annotations

import argparse
import os
import sys
from math import cos, pi, radians, sin
from pathlib import Path

import bpy
from mathutils import Vector

FLOOR = -66.0  # mm
HEAD_AT, EGG_AT = Vector((-45.0, 0.0, 0.0)), Vector((54.0, -6.0, -3.0))


def node(material, kind: str, **inputs):
    """A node of the material with inputs set by name: `Noise Scale` is written noise_scale."""
    made = material.node_tree.nodes.new(kind)
    for name, value in inputs.items():
        made.inputs[name.replace("_", " ").title()].default_value = value
    return made


def grain(material):
    """Growth rings of a trunk that stood behind the figure, with fibres: a factor of about 0 to 1."""
    link = material.node_tree.links.new
    place = node(material, "ShaderNodeTexCoord")
    trunk = node(material, "ShaderNodeMapping", location=(30.0, 75.0, 0.0), scale=(1.0, 1.0, 0.22))
    trunk.inputs["Rotation"].default_value = (0.16, 0.1, 0.0)
    rings = node(material, "ShaderNodeTexWave", scale=0.14, distortion=3.5, detail=2.0, detail_scale=0.05)
    rings.wave_type, rings.rings_direction, rings.wave_profile = "RINGS", "Z", "SIN"
    stretch = node(material, "ShaderNodeMapping", scale=(1.0, 1.0, 0.04))
    fibres = node(material, "ShaderNodeTexNoise", scale=1.6, detail=3.0)
    both = node(material, "ShaderNodeMix")
    both.inputs["Factor"].default_value = 0.35
    link(place.outputs["Object"], trunk.inputs["Vector"])
    link(place.outputs["Object"], stretch.inputs["Vector"])
    link(trunk.outputs["Vector"], rings.inputs["Vector"])
    link(stretch.outputs["Vector"], fibres.inputs["Vector"])
    link(rings.outputs["Fac"], both.inputs["A"])
    link(fibres.outputs["Fac"], both.inputs["B"])
    return both.outputs["Result"]


def new_material(
    name: str, light: tuple, dark: tuple, stain: tuple, roughness: float, wood: bool, hollows: float = 3.0
):
    """A dull finish with a darker stain where the surface hollows: what wax leaves in a carved line."""
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    link = material.node_tree.links.new
    surface = material.node_tree.nodes["Principled BSDF"]
    surface.inputs["Roughness"].default_value = roughness
    if not wood:
        surface.inputs["Subsurface Weight"].default_value = 0.12
        surface.inputs["Subsurface Radius"].default_value = (1.0, 0.55, 0.35)
        surface.inputs["Subsurface Scale"].default_value = 1.5
    figure = ramp(material, 0.0, dark, 1.0, light)
    if wood:
        link(grain(material), figure.inputs["Fac"])
    hollow = node(material, "ShaderNodeAmbientOcclusion", distance=hollows)
    hollow.samples, hollow.only_local = 2, True
    open_sky = ramp(material, 0.52, (0.0, 0.0, 0.0), 0.985, (1.0, 1.0, 1.0))
    stained = node(material, "ShaderNodeMixRGB", color1=(*stain, 1.0), color2=(*light, 1.0))
    link(hollow.outputs["AO"], open_sky.inputs["Fac"])
    link(open_sky.outputs["Color"], stained.inputs["Fac"])
    if wood:
        link(figure.outputs["Color"], stained.inputs["Color2"])
    link(stained.outputs["Color"], surface.inputs["Base Color"])
    return material


def ramp(material, start: float, first: tuple, end: float, last: tuple):
    made = material.node_tree.nodes.new("ShaderNodeValToRGB")
    for element, position, colour in zip(made.color_ramp.elements, (start, end), (first, last), strict=True):
        element.position, element.color = position, (*colour, 1.0)
    return made


def plain_material(name: str, colour: tuple, roughness: float, metallic: float = 0.0):
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    surface = material.node_tree.nodes["Principled BSDF"]
    surface.inputs["Base Color"].default_value = (*colour, 1.0)
    surface.inputs["Roughness"].default_value = roughness
    surface.inputs["Metallic"].default_value = metallic
    return material


def carved(path: Path, name: str, place: Vector, nod: float, turn: float, material) -> None:
    bpy.ops.wm.stl_import(filepath=str(path))
    figure = bpy.context.object
    figure.name = figure.data.name = name
    figure.location = place
    figure.rotation_euler = (radians(nod), 0.0, radians(turn))
    figure.data.materials.append(material)
    figure.data.set_sharp_from_angle(angle=radians(32.0))


def stand(place: Vector, top: float, wood, brass) -> None:
    """A turned foot and a pin that holds the figure."""
    bpy.ops.mesh.primitive_cylinder_add(vertices=128, radius=21, depth=9, location=(place.x, place.y, FLOOR + 4.5))
    foot = bpy.context.object
    bevel = foot.modifiers.new("Bevel", "BEVEL")
    bevel.width, bevel.segments = 1.6, 5
    foot.data.materials.append(wood)
    height = top - FLOOR
    at = (place.x, place.y, FLOOR + height / 2)
    bpy.ops.mesh.primitive_cylinder_add(vertices=64, radius=2.4, depth=height, location=at)
    bpy.context.object.data.materials.append(brass)
    for part in (foot, bpy.context.object):
        part.data.shade_smooth()
        part.data.set_sharp_from_angle(angle=radians(40.0))


def light(name: str, place: tuple, target: Vector, size: float, watts: float, colour: tuple) -> None:
    lamp = bpy.data.lights.new(name, "AREA")
    lamp.shape, lamp.size, lamp.energy, lamp.color = "DISK", size, watts, colour
    holder = bpy.data.objects.new(name, lamp)
    holder.location = place
    holder.rotation_euler = (target - Vector(place)).to_track_quat("-Z", "Y").to_euler()
    bpy.context.scene.collection.objects.link(holder)


def backdrop(material, floor: float = FLOOR) -> None:
    """A floor that bends up into a wall."""
    bend = [(220.0 + 260.0 * sin(k * pi / 48), 260.0 - 260.0 * cos(k * pi / 48)) for k in range(25)]
    profile = [(-900.0, 0.0), *bend, (480.0, 1200.0)]
    vertices = [(x, y, floor + z) for y, z in profile for x in (-1500.0, 1500.0)]
    faces = [(2 * k, 2 * k + 1, 2 * k + 3, 2 * k + 2) for k in range(len(profile) - 1)]
    mesh = bpy.data.meshes.new("Backdrop")
    mesh.from_pydata(vertices, [], faces)
    mesh.shade_smooth()
    mesh.materials.append(material)
    bpy.context.scene.collection.objects.link(bpy.data.objects.new("Backdrop", mesh))


def camera(place: tuple, target: tuple, lens: float) -> None:
    data = bpy.data.cameras.new("Camera")
    data.lens, data.clip_start, data.clip_end = lens, 10.0, 5000.0
    holder = bpy.data.objects.new("Camera", data)
    holder.location = place
    holder.rotation_euler = (Vector(target) - Vector(place)).to_track_quat("-Z", "Y").to_euler()
    bpy.context.scene.collection.objects.link(holder)
    bpy.context.scene.camera = holder


def render_settings(scene, samples: int, threads: int) -> None:
    scene.render.engine = "CYCLES"
    scene.render.resolution_x, scene.render.resolution_y = 1280, 720
    scene.render.threads_mode, scene.render.threads = "FIXED", threads
    scene.cycles.device = "CPU"
    scene.cycles.samples = samples
    scene.cycles.use_adaptive_sampling = True
    scene.cycles.adaptive_threshold = 0.03
    scene.cycles.use_denoising = True
    scene.cycles.max_bounces = 5
    scene.cycles.seed = 1
    scene.cycles.time_limit = 80.0  # s; what is missing then is left to the denoiser
    scene.view_settings.view_transform = "AgX"
    scene.view_settings.exposure = 0.12
    scene.view_settings.look = "AgX - Medium High Contrast"
    scene.unit_settings.system = "METRIC"
    scene.unit_settings.scale_length = 0.001
    scene.unit_settings.length_unit = "MILLIMETERS"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    for name in ("head", "egg", "blend", "picture"):
        parser.add_argument(name, type=Path)
    parser.add_argument("--samples", type=int, default=48)
    parser.add_argument("--threads", type=int, default=os.cpu_count() or 2)
    parser.add_argument("--percent", type=int, default=100)
    options = parser.parse_args()

    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    boxwood = new_material("Boxwood", (0.66, 0.37, 0.15), (0.53, 0.275, 0.105), (0.055, 0.018, 0.007), 0.45, True)
    bone = new_material("Bone", (0.82, 0.74, 0.60), (0.82, 0.74, 0.60), (0.11, 0.045, 0.02), 0.38, False)
    wood = plain_material("Dark wood", (0.035, 0.017, 0.010), 0.3)
    brass = plain_material("Brass", (0.78, 0.53, 0.22), 0.28, 1.0)
    carved(options.head, "Head", HEAD_AT, 6.0, 9.0, boxwood)
    carved(options.egg, "Egg", EGG_AT, 24.0, -12.0, bone)
    stand(HEAD_AT + Vector((0, 3, 0)), -10.0, wood, brass)
    stand(EGG_AT + Vector((2, 16, 0)), -30.0, wood, brass)
    studio(scene, (0.0, -430.0, 235.0), (-3.5, 0.0, -10.5), 77.0)
    finish(scene, options)


def studio(scene, camera_at: tuple, target: tuple, lens: float) -> None:
    """Backdrop, lights and camera."""
    backdrop(plain_material("Paper", (0.10, 0.125, 0.14), 0.7))
    light("Key", (-210.0, -170.0, 250.0), Vector((0, 0, 10)), 110.0, 1.35e6, (1.0, 0.93, 0.84))
    light("Rim", (230.0, 190.0, 190.0), Vector((0, 0, 10)), 130.0, 0.8e6, (0.80, 0.89, 1.0))
    light("Fill", (190.0, -330.0, 60.0), Vector((0, 0, 0)), 260.0, 0.2e6, (0.9, 0.95, 1.0))
    world = bpy.data.worlds.new("World")
    scene.world = world
    world.use_nodes = True
    world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.20, 0.22, 0.25, 1.0)
    world.node_tree.nodes["Background"].inputs["Strength"].default_value = 0.35
    camera(camera_at, target, lens)


def finish(scene, options: argparse.Namespace) -> None:
    """Saves the scene as `options.blend` and renders it to `options.picture`."""
    render_settings(scene, options.samples, options.threads)
    scene.render.resolution_percentage = options.percent
    options.blend.parent.mkdir(parents=True, exist_ok=True)
    bpy.context.preferences.filepaths.save_version = 0  # no riffler.blend1 of an earlier run
    bpy.ops.wm.save_as_mainfile(filepath=str(options.blend.resolve()), compress=True)
    scene.render.filepath = str(options.picture.resolve())
    bpy.ops.render.render(write_still=True)
    print(f"{options.blend}, {options.picture}")


if __name__ == "__main__":
    main()
    # As in suzanne.py: everything is written, so leave before the module is torn down.
    sys.stdout.flush()
    os._exit(0)
