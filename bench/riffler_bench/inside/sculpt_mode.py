"""Blender's own sculpt mode at the same work: its draw brush, as wide as the add-on's tool, along the same lines on a
mesh of as many triangles: with fixed and with dynamic topology."""

import bpy
import host
import numpy as np
from stroke import HEIGHT, PITCH, RADIUS, WAY, lines

SHRUNK = 0.1  # without a window a view cannot be turned: what is sculpted is made to fit it


def block(side, scale=1.0):
    import riffler

    half = side / 2
    volume = riffler.Volume.block((-half, -half, -HEIGHT / 2), (half, half, HEIGHT / 2), PITCH, "xyz")
    surface = volume.to_mesh()
    return host.plain("Block", scale * np.asarray(surface.vertices), surface.triangles)


def enter(kind, side, scale=1.0):
    """Into sculpt mode; the object and its number of triangles."""
    ob = block(side, scale)
    triangles = len(ob.data.polygons)
    bpy.ops.ed.undo_push(message="Mesh")
    with bpy.context.temp_override(window=bpy.context.window_manager.windows[0]):
        bpy.ops.object.mode_set("EXEC_DEFAULT", True, mode="SCULPT")  # an undo step, without which 3.4's undo crashes
    sculpt = bpy.context.tool_settings.sculpt
    if kind == "dyntopo":
        bpy.ops.sculpt.dynamic_topology_toggle()
        sculpt.detail_type_method, sculpt.constant_detail_resolution = "CONSTANT", 1 / (scale * PITCH)
    brush(scale)
    bpy.context.view_layer.update()
    return ob, triangles


def brush(scale=1.0):
    """The draw brush, inwards, as wide as the tool."""
    sculpt = bpy.context.tool_settings.sculpt
    if sculpt.brush is None:  # brushes are assets from 4.3 on
        essentials = "brushes/essentials_brushes-mesh_sculpt.blend/Brush/Draw"
        bpy.ops.brush.asset_activate(asset_library_type="ESSENTIALS", relative_asset_identifier=essentials)
    if sculpt.brush is None:
        raise RuntimeError("there is no brush to sculpt with")
    sculpt.brush.direction, sculpt.brush.strength = "SUBTRACT", 0.1
    shared = getattr(bpy.context.tool_settings, "unified_paint_settings", None) or sculpt.unified_paint_settings
    for size in (shared, sculpt.brush):
        size.use_locked_size = "SCENE"
        if hasattr(size, "unprojected_radius"):
            size.unprojected_radius = scale * RADIUS
        else:  # 5.0: diameters
            size.unprojected_size = 2 * scale * RADIUS
    sculpt.use_symmetry_x = sculpt.use_symmetry_y = sculpt.use_symmetry_z = False


def moved(ob, side, way, scale=1.0):
    """Leaves sculpt mode and measures what strokes `way` mm long did to the mesh: depth, length and number of
    triangles. Raises RuntimeError for strokes shorter than that."""
    bpy.ops.object.mode_set(mode="OBJECT")
    evaluated = ob.evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh = evaluated.to_mesh()
    top = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("co", top)
    top = top.reshape(-1, 3) / scale
    inside = (top[:, 2] > 0) & (abs(top[:, :2]).max(axis=1) < side / 2 - 1)  # not the block's walls
    depth = float(HEIGHT / 2 - top[inside, 2].min())
    lower = inside & (top[:, 2] < HEIGHT / 2 - 0.1 * depth)
    reached = float(np.ptp(top[lower, 0])) if depth > 1e-3 else 0.0
    mesh.calc_loop_triangles()
    after = len(mesh.loop_triangles)
    evaluated.to_mesh_clear()
    if reached < way:
        raise RuntimeError(f"the brush went {reached:.1f} mm of {way:.1f}")
    return {"deepest_mm": depth, "reached_mm": reached, "triangles_after": after}


def windowed(kind, side, strokes, events):
    """As stroke.windowed: from each event of the mouse to the picture that shows what it did."""
    from view import View

    ob, triangles = enter(kind, side)
    view = View(side)
    with view.override():
        bpy.ops.wm.tool_set_by_id(name="builtin_brush.Draw")
    brush()
    yield 3.0
    times, drawing, graph = host.Times(), [], []
    for line in lines(side, strokes, events):
        way = [view.pixel((x, y, HEIGHT / 2)) for x, y in line]
        view.send("MOUSEMOVE", "NOTHING", way[0])
        yield 0.5
        view.send("LEFTMOUSE", "PRESS", way[0])
        yield lambda: view.drawn
        yield 0.5
        for pixel in way[1:]:
            view.send("MOUSEMOVE", "NOTHING", pixel)
            yield lambda: view.drawn
            times.add("event", *view.latency())
            drawing.append(view.drawing[-1])
            graph.append(sum(view.graph))
        view.send("LEFTMOUSE", "RELEASE", way[-1])
        yield 1.0
    wall = np.array(times.wall["event"])
    p50, p95 = np.percentile(wall, (50, 95))
    work = wall - drawing - np.array(graph)
    out = {"p50_s": p50, "p95_s": p95, "cpu_s": float(np.median(times.cpu["event"])), "events": len(wall)}
    out |= {
        "draw_s": float(np.median(drawing)),
        "depsgraph_s": float(np.median(graph)),
        "sculpt_s": float(np.median(work)),
    }
    yield from view.history(times, ["undo"] * strokes)
    out |= {f"{name}_s": times.medians(name)["wall_s"] for name in ("undo", "redo")}
    out |= {"triangles": triangles, "side": side, "renderer": view.renderer()}
    return out | moved(ob, side, WAY * (events - 1))


def headless(kind, side, strokes, events):
    """Without drawing: a whole stroke by the operator, its time shared by its events."""
    ob, triangles = enter(kind, side, SHRUNK)
    window = bpy.context.window_manager.windows[0]
    area = next(a for s in (window.screen, *bpy.data.screens) for a in s.areas if a.type == "VIEW_3D")
    region = next(r for r in area.regions if r.type == "WINDOW")
    times, space = host.Times(), area.spaces.active.region_3d
    from bpy_extras import view3d_utils

    known = set(bpy.types.OperatorStrokeElement.bl_rna.properties.keys())  # some went with 4.0
    for line in lines(side, strokes, events):
        rows = []
        for k, (x, y) in enumerate(line):
            place = [SHRUNK * value for value in (x, y, HEIGHT / 2)]
            mouse = view3d_utils.location_3d_to_region_2d(region, space, place)
            rows.append({key: value for key, value in {
                "name": "", "location": place, "mouse": mouse, "mouse_event": mouse, "pressure": 1.0,
                "size": 1.0, "pen_flip": False, "is_start": k == 0, "time": k / 60, "x_tilt": 0.0, "y_tilt": 0.0,
            }.items() if key in known})  # fmt: skip
        with bpy.context.temp_override(window=window, area=area, region=region):
            times.of("stroke", lambda rows=rows: bpy.ops.sculpt.brush_stroke(stroke=rows, mode="NORMAL"))
    figures = times.medians("stroke")
    out = {"p50_s": figures["wall_s"] / events, "cpu_s": figures["cpu_s"] / events, "events": strokes * events}
    return out | {"triangles": triangles, "side": side} | moved(ob, side, WAY * (events - 1), SHRUNK)
