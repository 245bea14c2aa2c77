"""A device traces exact faces: of imported CAD files and of Blender's NURBS surfaces."""

import time

import bpy
import numpy as np
import riffler
from mathutils import Euler, Matrix

from support import common
from support.cad_parts import part, with_reader
from support.device_sessions import no_session

FAST = {"device": "simulated", "gap": 0.0, "scale": 1.0}


def torus(rotation=(0, 0, 0), location=(0, 0, 0)):
    """A torus of the radii 20 and 8 mm about the object's z."""
    bpy.ops.riffler.import_cad(filepath=part("torus.step"), tolerance=0.3)
    ob = bpy.context.object
    ob.rotation_euler, ob.location = rotation, location
    bpy.context.view_layer.update()
    return ob


def off_torus(points):
    return np.hypot(np.hypot(points[:, 0], points[:, 1]) - 20, points[:, 2]) - 8


def traced(ob):
    """The curve's points in the object's own frame."""
    (curve,) = (o for o in bpy.data.objects if o.type == "CURVE")
    points = np.array([p.co[:3] for s in curve.data.splines for p in s.points])
    return common.part("common.poses").transform_points(np.linalg.inv(np.array(ob.matrix_world, float)), points)


class Mouse:
    """A device that a test moves: its tool stands upright, tip `z` mm above the world's origin."""

    def __init__(self, z):
        self.pen, self._time = riffler.pen.Pointer("mouse"), 0.0
        self.pen.set_frame(origin=(0, 0, z), depth=1e-3)
        self.give(0, 0)

    def give(self, x, y):
        self._time += 0.008
        self.pen.give(x, y, pressure=0.0, buttons=0, time=self._time)


def session_of(ob, mouse, spacing=None, **more):
    """A session without the operator, whose device is a mouse. With a `spacing`, in mm, the collider has fewer points
    than the operator's 100 000, which take 1.2 s."""
    near = common.part("blender.exact_surfaces").reader(bpy.context, ob)(None)
    stiff = common.part("pen.pure.trace_run").STIFFNESS
    collider = riffler.Collider.made(near, spacing=spacing, stiffness=stiff, holder_stiffness=stiff)
    session = common.part("pen.trace_session").TraceSession
    return session(bpy.context, ob, mouse.pen, riffler.Tool.ball(6, 30), (near, collider), {}, **more)


def over(session, mouse, way):
    """Leads the mouse along the points (n, 2), and returns what was touched at each."""
    seen = []
    for x, y in way:
        mouse.give(x, y)
        end = time.monotonic() + 20
        last = np.full(6, np.inf)
        while session.run.pose is None or np.abs(session.run.pose - last).max() > 1e-3:
            assert time.monotonic() < end and session.look(), session.problem
            last = session.run.pose if session.run.pose is not None else last
            time.sleep(0.01)
            session.look()
        seen.append((session.run.pose, session.run.contact, session.run.depth))
    return seen


@common.core_bound
def test_the_simulated_pen_traces_a_step_file_and_leaves_a_curve_on_its_exact_faces():
    with_reader()
    common.scale(1)
    ob = torus()
    bpy.context.scene.cursor.location = (20, 0, 8)
    for seconds in (5.0, 10.0, 20.0, 40.0):  # a busy computer cuts the force now and then
        more = {"seconds": seconds, "start": "CURSOR", "tool": common.BALL}
        if bpy.ops.riffler.pen_trace("EXEC_DEFAULT", True, **FAST, **more) == {"FINISHED"}:
            break
    no_session()
    points = traced(ob)
    assert len(points) > 20 and abs(off_torus(points)).max() < 1e-5
    # refusals change nothing
    before = len(bpy.data.objects)
    bpy.context.scene.cursor.location = (20, 0, 0)
    common.refused(lambda: bpy.ops.riffler.pen_trace(**FAST, **more), "mm deep in torus")
    common.refused(lambda: bpy.ops.riffler.pen_trace(**FAST), "seconds: give the duration")
    ob.data.vertices[0].co.z += 5
    common.refused(lambda: bpy.ops.riffler.pen_trace(**FAST, **more), "mm from the faces of torus.step")
    no_session()
    assert len(bpy.data.objects) == before
    bpy.ops.mesh.primitive_cube_add()
    assert not bpy.ops.riffler.pen_trace.poll()


@common.core_bound
def test_the_tool_stays_out_of_the_exact_surface_of_an_object_that_was_turned_and_moved():
    """Its triangles are up to 0.3 mm inside. The normals are those of the torus."""
    with_reader()
    common.scale(1)
    ob = torus((0.4, 0.1, 0.7), (3, -2, 1))
    mouse = Mouse(2.0)
    session = session_of(ob, mouse)
    seen = over(session, mouse, [(x, 0.0) for x in np.arange(6, 34, 1.0)])
    session.finish()
    no_session()
    turn = np.array(ob.matrix_world, float)
    touching = [(pose, contact, depth) for pose, contact, depth in seen if contact is not None]
    assert len(touching) > 5
    for pose, (point, normal), depth in touching:
        own = np.linalg.inv(turn) @ np.append(point, 1)
        assert abs(off_torus(own[None, :3])).max() < 1e-6
        ring = 20 * np.array([*own[:2], 0]) / np.hypot(*own[:2])
        expected = turn[:3, :3] @ ((own[:3] - ring) / 8)
        assert np.allclose(normal, expected, atol=1e-5)
        centre = (np.linalg.inv(turn) @ np.append(pose[:3] + 3 * pose[3:], 1))[None, :3]
        assert abs(3 - off_torus(centre)[0] - depth) < 1e-5
        assert depth < 0.2
    assert abs(off_torus(traced(ob))).max() < 2e-5


def test_undo_takes_a_traced_curve_away():
    common.scale(1)
    bpy.ops.surface.primitive_nurbs_surface_torus_add(radius=10)
    ob = bpy.context.object
    common.push("before")
    mouse = Mouse(2.0)
    session = session_of(ob, mouse, spacing=0.5)
    seen = over(session, mouse, [(x, 0.0) for x in (8.0, 9.0, 10.0)])
    assert any(contact is not None for _, contact, _ in seen)
    session.finish()
    no_session()
    assert len(traced(ob)) > 1
    bpy.ops.ed.undo()
    assert not [o for o in bpy.data.objects if o.type == "CURVE"]


SURFACES = ("sphere", "torus", "cylinder", "surface")


def test_blenders_nurbs_surfaces_are_exact_and_face_outwards():
    exact = common.part("blender.exact_surfaces")
    common.scale(1000)
    for kind in SURFACES:
        getattr(bpy.ops.surface, f"primitive_nurbs_surface_{kind}_add")(radius=0.03, location=(0.1, 0, 0))
        ob = bpy.context.object
        ob.data.resolution_u = ob.data.resolution_v = 9
        ob.scale = (1, 2, -1)
        ob.rotation_euler = Euler((0.3, 0.2, 0.1))
        bpy.context.view_layer.update()
        surface = exact.reader(bpy.context, ob)(None)
        co, _ = common.part("blender.meshes").read(ob, bpy.context.evaluated_depsgraph_get())
        shown = 1000 * common.part("common.poses").transform_points(np.array(ob.matrix_world, float), co)
        assert surface.closest(shown)[2].max() < 1e-4, kind  # Blender computes in single precision
        mesh = surface.to_mesh(0.05)
        if kind in ("sphere", "torus"):
            assert mesh.volume > 1000 and not mesh.audit().open_edges, kind
        bpy.data.objects.remove(ob)


def test_a_session_ends_when_its_object_is_moved_or_removed():
    common.scale(1)
    for remove in (False, True):
        bpy.ops.surface.primitive_nurbs_surface_torus_add(radius=10)
        ob = bpy.context.object
        mouse = Mouse(40.0)
        session = session_of(ob, mouse, spacing=0.5)
        over(session, mouse, [(1.0, 0.0)])
        if remove:
            bpy.data.objects.remove(ob)
        else:
            ob.matrix_world = Matrix.Translation((1, 0, 0))
            bpy.context.view_layer.update()
        assert not session.look() and session.ended
        assert ("removed" if remove else "moved") in session.summary()[1]
        no_session()
