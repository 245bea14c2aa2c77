"""xdotool's events reach Blender: the pointer at the exact pixel, the button, a key with its modifier, Ctrl-Z."""

import bpy

INSTALL = False
REAL_EVENTS = True
PIXELS = False
seen = []


class TEST_OT_watch(bpy.types.Operator):
    """Records every event."""

    bl_idname = "test.watch"
    bl_label = "Watch"

    def invoke(self, context, event):
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        seen.append((event.type, event.value, event.mouse_x, event.mouse_y, event.ctrl))
        return {"FINISHED"} if event.type == "ESC" else {"RUNNING_MODAL"}


def first(kind, value):
    return next((s for s in seen if s[:2] == (kind, value)), None)


def steps(screen):
    bpy.utils.register_class(TEST_OT_watch)
    screen.to_view()
    yield 0.5
    with screen.override():
        bpy.ops.test.watch("INVOKE_DEFAULT")
    r = screen.region()
    points = [(r.x + 200 + 20 * i, r.y + 150 + 7 * i) for i in range(8)]
    yield from screen.drag(points)
    yield lambda: first("LEFTMOUSE", "RELEASE")
    assert first("LEFTMOUSE", "PRESS")[2:4] == points[0]
    assert first("LEFTMOUSE", "RELEASE")[2:4] == points[-1]
    moved = [s[2:4] for s in seen if s[0] == "MOUSEMOVE"]
    assert set(moved) & set(points[1:]), moved
    screen.key("G", ctrl=True)
    yield lambda: first("G", "PRESS")
    assert first("G", "PRESS")[4]
    screen.key("ESC")
    yield lambda: first("ESC", "PRESS")
    yield from undone(screen)


def undone(screen):
    """By the keymap, as for a user."""
    with screen.override():
        bpy.ops.ed.undo_push(message="Before")
        bpy.ops.mesh.primitive_cone_add()
        bpy.ops.ed.undo_push(message="Cone")
    assert "Cone" in bpy.data.objects
    yield 0.5
    screen.key("Z", ctrl=True)
    yield lambda: "Cone" not in bpy.data.objects
