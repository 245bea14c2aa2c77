"""What the add-on registers, in order; taken back in the reverse order."""

import importlib

from .core import native

# A module has CLASSES, which may be empty, and may have attach(), called once they are registered, and detach(), called
# before they are unregistered, even where attach() has failed in the middle.
MODULES = (
    "properties",
    "preferences",
    "bl.attributes",
    "bl.store",
    "bl.plan_store",
    "bl.live",
    "bl.edits",
    "bl.tools_kept",
    "operators.stock",
    "operators.solid",
    "operators.cut",
    "operators.clay",
    "operators.mask",
    "operators.relief",
    "operators.result",
    "operators.pen",
    "operators.stroke",
    "operators.begin",
    "operators.resize",
    "operators.live_view",
    "operators.export",
    "operators.scene",
    "operators.doctor",
    "operators.recover",
    "operators.machine",
    "operators.plan_setup",
    "operators.plan_find",
    "operators.plan_tool",
    "operators.plan_scene_unit",
    "operators.plan_watch",
    "bl.surroundings",  # hears of changes before those who ask it
    "bl.replan",
    "bl.looking",
    "drawing.paths",
    "drawing.plan_lines",
    "operators.plan_paths",
    "drawing.cspace",
    "operators.plan_keys",
    "operators.plan_least_tilt",
    "operators.plan_nc",
    "bl.simulating",
    "operators.verify",
    "drawing.legend",
    "operators.plan_turn",
    "operators.long",  # after the operators: what runs is cancelled while its class is still there
    "ui.recover_panel",  # on top of the others, when there is something to be said
    "ui.panels",
    "ui.tool_panel",
    "ui.clay_panel",
    "ui.result_panel",
    "ui.pen_panel",
    "bl.tool_pictures",
    "ui.plan_panel",
    "ui.paths_panel",
    "ui.machine_panel",
    "ui.timeline_panel",
    "ui.verify_panel",
    "ui.sculpt_panel",
    "gizmos.size",
    "gizmos.orientation",
    "ui.toolbar",  # last: what its buttons call is there
    "ui.menus",
    "ui.keymaps",
    "translations",
)
FALLBACK = "ui.fallback"  # instead of them all, where the native core does not load

_undo = []  # one function per thing that was registered


def register():
    core, error = native.load()
    try:
        if core is None:
            fallback = _module(FALLBACK)
            fallback.set_error(error)
            _take(fallback)
        else:
            for module in modules():
                _take(module)
    except Exception:
        unregister()  # half an add-on helps nobody; Blender shows the error
        raise


def unregister():
    """Takes back all there is to take back, whatever fails; then raises what failed first."""
    first = None
    while _undo:
        try:
            _undo.pop()()
        except Exception as error:
            first = first or error
    if first:
        raise first


def modules():
    """Those of MODULES; all are imported before the first is made use of."""
    return [_module(name) for name in MODULES]


def _module(name):
    return importlib.import_module(f"{__package__}.{name}")


def _one_line(cls):
    """A tooltip wraps by itself: the lines of a docstring are the source's."""
    if "\n" in (cls.__doc__ or "") and "bl_idname" in vars(cls) and "bl_description" not in vars(cls):
        cls.bl_description = " ".join(cls.__doc__.split())


def _take(module):
    import bpy

    for cls in module.CLASSES:
        _one_line(cls)
        _module("bl.versions").own_words(cls)
        bpy.utils.register_class(cls)
        _undo.append(lambda cls=cls: bpy.utils.unregister_class(cls))
    if hasattr(module, "detach"):  # first: what fails in the middle leaves something to be taken back
        _undo.append(module.detach)
    if hasattr(module, "attach"):
        module.attach()
