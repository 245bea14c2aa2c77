"""Plans of parts that are made here: a step with one straight valley, and a pocket with a valley all around."""

import bpy
import numpy as np
import riffler

from support import common

TOOL = riffler.Tool.ball(diameter=6, length=25).with_shank([(25, 3, 40, 3)]).with_holder([(40, 14, 70, 16)])
UP = (0.0, 0.0, 1.0)
# Its profile in (y, z), 60 mm along x: one inner edge, at y = 20, z = 8.
STEP = np.array([(0, 0), (40, 0), (40, 24), (20, 24), (20, 8), (0, 8)], float)


def step(length=60.0):
    """Vertices and triangles of the step."""
    vertices = np.concatenate([np.column_stack([np.full(6, x), STEP]) for x in (0.0, length)])
    caps = np.array([(0, 5, 4), (0, 4, 1), (1, 4, 3), (1, 3, 2)])
    k = np.arange(6)
    after = (k + 1) % 6
    sides = np.vstack([np.c_[k, after, 6 + k], np.c_[after, 6 + after, 6 + k]])
    return vertices, np.vstack([caps, caps[:, ::-1] + 6, sides])


def part_object(mm_per_unit=1.0):
    """The step as an object of the scene."""
    vertices, triangles = step()
    mesh = bpy.data.meshes.new("Step")
    mesh.from_pydata((vertices / mm_per_unit).tolist(), [], triangles.tolist())
    ob = bpy.data.objects.new("Step", mesh)
    bpy.context.collection.objects.link(ob)
    bpy.context.view_layer.update()
    return ob


def ring(radius=20.0, count=90):
    """A closed path around a pin on a plate, both touched by a ball of 6 mm: centres 3 mm off the two."""
    a = 2 * np.pi * np.arange(count) / count
    way = np.c_[np.cos(a), np.sin(a), np.zeros(count)]
    centres = radius * way + [0, 0, 3]
    contacts = np.stack([centres - 3 * way, centres - [0, 0, 3]], axis=1)
    normals = np.stack([way, np.tile(UP, (count, 1))], axis=1)
    return riffler.plan.PencilPath(3.0, centres, contacts, normals, closed=True)


def paths():
    """The step's valley, 60 mm straight, with two keys; and the ring with three."""
    (valley,) = riffler.plan.pencil(riffler.Mesh(*step()), TOOL)
    valley = valley.orient({0: (0, -0.6, 0.8), len(valley) - 1: (0.6, 0, 0.8)}, interpolation="smooth")
    loop = ring()
    axes = {k: loop.axis(k, 0.3, 0.2) for k in (0, 30, 60)}
    return [valley, loop.orient(axes, interpolation="slerp")]


def on_timeline(mm_per_unit=1.0, chosen=None, **more):
    """The plan's object, with its tool on the timeline."""
    common.scale(mm_per_unit)
    bpy.context.scene.riffler.plan.feed = 600  # 2.4 frames to a millimetre
    plan = riffler.plan.Plan(chosen or paths(), TOOL, tolerance=0.01)
    ob = common.part("plan.plan_store").new(bpy.context, plan)
    bpy.ops.riffler.plan_to_timeline("EXEC_DEFAULT", True, **more)
    bpy.context.view_layer.update()
    return ob
