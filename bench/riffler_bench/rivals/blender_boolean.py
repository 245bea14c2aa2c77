"""Runs inside Blender's Python: B200's balls taken from the block one by one with a boolean modifier."""

from __future__ import annotations

import json
import os
import statistics
import sys
import time
from math import sin

import bpy  # isort: split

import bmesh  # exists once bpy has been imported

solver, moves = sys.argv[1], int(sys.argv[2])
bpy.ops.wm.read_factory_settings(use_empty=True)


def link(mesh):
    ob = bpy.data.objects.new("x", mesh)
    bpy.context.scene.collection.objects.link(ob)
    return ob


def made(build):
    bm = bmesh.new()
    build(bm)
    mesh = bpy.data.meshes.new("m")
    bm.to_mesh(mesh)
    bm.free()
    return mesh


block = made(lambda bm: bmesh.ops.create_cube(bm, size=1))
for v in block.vertices:
    v.co = ((v.co.x + 0.5) * 100, (v.co.y + 0.5) * 60, (v.co.z + 0.5) * 30)
stock = link(block)
ball = link(made(lambda bm: bmesh.ops.create_icosphere(bm, subdivisions=4, radius=3)))
names = [item.identifier for item in bpy.types.BooleanModifier.bl_rna.properties["solver"].enum_items]
name = solver if solver in names else {"FLOAT": "FAST"}.get(solver, solver)
if name not in names:
    sys.exit(f"no solver {solver} in {bpy.app.version_string}: {names}")
times = []
for k in range(moves):
    a = k / 200
    ball.location = (10 + 80 * a, 30 + 15 * sin(12 * a), 30 - 2 * a)
    start = time.perf_counter()
    modifier = stock.modifiers.new("cut", "BOOLEAN")
    modifier.operation, modifier.solver, modifier.object = "DIFFERENCE", name, ball
    mesh = bpy.data.meshes.new_from_object(stock.evaluated_get(bpy.context.evaluated_depsgraph_get()))
    stock.modifiers.clear()
    stock.data = mesh
    times.append(time.perf_counter() - start)
bm = bmesh.new()
bm.from_mesh(stock.data)
bmesh.ops.triangulate(bm, faces=bm.faces)
result = {
    "version": bpy.app.version_string,
    "solver": name,
    "median": statistics.median(times),
    "triangles": len(bm.faces),
    "volume": bm.calc_volume(),
}
print(json.dumps(result))
sys.stdout.flush()
os._exit(0)
