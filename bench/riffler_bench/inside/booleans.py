"""One swept ball taken from a block: by the boolean modifier of Blender, and by a move of the add-on's live sculpt."""

import time

import bpy
import host
import numpy as np
from sculpt_mode import block
from stroke import BALL, DEPTH, HEIGHT, RADIUS, removed, sculpt

WAY = 20.0  # mm


def capsule(segments=64):
    """Vertices and triangles of a ball's sweep along x, its lowest line DEPTH below the block's top: rings about x."""
    quarter = np.linspace(0, np.pi / 2, segments // 4 + 1)
    x = np.concatenate([-WAY / 2 - RADIUS * np.cos(quarter[1:]), WAY / 2 + RADIUS * np.sin(quarter[:-1])])
    r = np.concatenate([RADIUS * np.sin(quarter[1:]), RADIUS * np.cos(quarter[:-1])])
    around = 2 * np.pi * np.arange(segments) / segments
    rings = np.stack(
        [np.broadcast_to(x[:, None], (len(x), segments)), r[:, None] * np.cos(around), r[:, None] * np.sin(around)], -1
    )
    poles = [(-WAY / 2 - RADIUS, 0, 0), (WAY / 2 + RADIUS, 0, 0)]
    co = np.vstack([rings.reshape(-1, 3), *poles])
    co[:, 2] += HEIGHT / 2 + RADIUS - DEPTH
    k, n = np.arange(segments), len(x)
    after = (k + 1) % segments
    tri = []
    for row in range(n - 1):
        a, b, c, d = (
            row * segments + k,
            row * segments + after,
            (row + 1) * segments + after,
            (row + 1) * segments + k,
        )
        tri += [np.c_[a, b, c], np.c_[a, c, d]]
    last = (n - 1) * segments
    tri += [
        np.c_[np.full(segments, n * segments), after, k],
        np.c_[np.full(segments, n * segments + 1), last + k, last + after],
    ]
    tri = np.concatenate(tri)
    return co, tri if host.enclosed(co, tri) > 0 else tri[:, ::-1]


def solvers():
    return {"solvers": [item.identifier for item in bpy.types.BooleanModifier.bl_rna.properties["solver"].enum_items]}


def modifier(solver, side, repeats):
    """Evaluates the modifier repeatedly: moves the tool by nothing and tags its object as changed."""
    ob = block(side)
    before = host.enclosed(*host.numbers(ob.data))
    mesh = bpy.data.meshes.new("Capsule")
    host.part("blender.meshes").fill(mesh, *capsule())
    tool = bpy.data.objects.new("Capsule", mesh)
    bpy.context.collection.objects.link(tool)
    bpy.context.view_layer.update()
    cut = ob.modifiers.new("cut", "BOOLEAN")
    cut.operation, cut.solver, cut.object = "DIFFERENCE", solver, tool
    times = host.Times()

    def evaluated():
        ob.update_tag(refresh={"DATA"})
        bpy.context.view_layer.update()

    evaluated()  # the first builds the whole graph
    for _ in range(repeats):
        times.of("evaluation", evaluated)
    result = ob.evaluated_get(bpy.context.evaluated_depsgraph_get())
    gone = before - host.enclosed(*host.numbers(result.data))
    figures = {"triangles": len(ob.data.polygons), "after": len(result.data.loop_triangles)}
    return figures | times.medians("evaluation") | {"removed_mm3": gone, "removed_over": gone / removed(WAY) - 1}


def live(side, repeats):
    """The same way in one move; undone by Blender each time."""
    ob, run, _ = sculpt(side)
    import riffler

    name, tool, times, gone = ob.name, riffler.Tool.from_dict(BALL), host.Times(), []
    tip = HEIGHT / 2 - DEPTH  # of the block, whose middle is at 0
    offset = run.volume.lower + (run.volume.upper - run.volume.lower) / 2
    poses = np.array([[x, 0, tip, 0, 0, 1] for x in (-WAY / 2, WAY / 2)])
    poses[:, :3] += offset

    def cut(run):
        run.carve(tool, poses)
        run.show()
        bpy.context.view_layer.update()

    for _ in range(repeats + 1):
        run = host.part("sculpt.live_registry").of(bpy.data.objects[name])
        before = run.volume.volume
        run.begin_stroke()
        begin = time.perf_counter(), time.process_time()
        cut(run)
        times.add("cut", time.perf_counter() - begin[0], time.process_time() - begin[1])
        gone.append(before - run.volume.volume)
        run.cancel_stroke()
        bpy.context.view_layer.update()
    times.wall["cut"].pop(0), times.cpu["cut"].pop(0)
    assert len(set(gone)) == 1, gone
    found = {"triangles": len(run.volume.to_mesh().triangles), "removed_mm3": gone[0]}
    return found | times.medians("cut") | {"removed_over": gone[0] / removed(WAY) - 1}
