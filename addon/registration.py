"""What the add-on registers, section by section, and unregisters in the reverse order."""

import importlib
from typing import NamedTuple

from .common import native


class Section(NamedTuple):
    """A folder of the add-on, "" for its root, and its modules that have something to register, in order.

    A module has CLASSES, which may be empty. It may have attach(), called after they are registered, and detach(),
    called before they are unregistered, even if attach() has failed halfway.
    """

    folder: str
    names: tuple[str, ...]

    def register(self):
        for module in self.modules():
            _take(module)

    def paths(self):
        """The modules' names, below the add-on."""
        return [f"{self.folder}.{name}" if self.folder else name for name in self.names]

    def modules(self):
        return [_module(path) for path in self.paths()]


# The order of the features is their layer order, too (tools/check_layers.py): a feature imports `common`,
# `translations`, `blender` and the features before it, never a later one. A section without a folder may import all of
# them.
SECTIONS = (
    Section("", ("properties", "preferences")),
    Section("blender", ("attributes", "doctor")),
    Section(
        "sculpt",
        (
            "sculpt_store",
            "live_registry",
            "mesh_edits",
            "kept_strokes",
            "kept_settings",
            "stroke_operator",
            "first_stroke",
            "resize",
            "live_view",
            "tool_panel",
            "panel",
            "stroke_list",
            "size_gizmo",
        ),
    ),
    Section("pen", ("operators", "trace", "panel")),
    Section(
        "stock",
        (
            "new_stock",
            "solid",
            "cut",
            "keep_curves",
            "clay",
            "protection",
            "relief",
            "result",
            "export",
            "import_cad",
            "detail",
            "millimetres",
            "recover",
            "deviation_legend",
            "recover_panel",  # above the others while it has something to show
            "panel",
            "clay_panel",
            "result_panel",
        ),
    ),
    Section(
        "plan",
        (
            "plan_store",
            "obstacles",  # is notified of changes before the modules that use it
            "replan",
            "orientation_probe",
            "path_view",
            "orientation_map_view",
            "tool_icons",
            "operators.machine_options",
            "operators.setup",
            "operators.find",
            "operators.from_strokes",
            "operators.change_tool",
            "operators.scene_unit",
            "operators.watch",
            "operators.switch_paths",
            "operators.keys",
            "operators.least_tilt",
            "operators.turn",
            "operators.orient_by_pointer",
            "operators.orient_by_pen",
            "panel",
            "paths_panel",
            "machine_panel",
            "timeline_panel",
            "orientation_gizmo",
        ),
    ),
    Section("machining", ("job_store", "moves_view", "make_stock", "edit_operations", "calculate", "panel")),
    Section("program", ("line_view", "simulation", "plan_nc", "job_nc", "verify", "panel")),
    # Running work is cancelled while its class is still registered. The toolbar's buttons call registered operators.
    Section("", ("blender.long_work", "toolbar", "menus", "keymaps", "translations")),
)
FALLBACK = "blender.fallback"  # instead of all modules, if the native core does not load

_undo = []  # one function per registered thing


def register():
    core, error = native.load()
    try:
        if core is None:
            fallback = _module(FALLBACK)
            fallback.set_error(error)
            _take(fallback)
        else:
            modules()  # all are imported before the first class is registered
            for section in SECTIONS:
                section.register()
    except Exception:
        unregister()  # roll back: never leave a partial registration; Blender shows the error
        raise


def unregister():
    """Unregisters everything, continuing after errors; then raises the first error."""
    first = None
    while _undo:
        try:
            _undo.pop()()
        except Exception as error:
            first = first or error
    if first:
        raise first


def modules():
    """All modules of all sections, in order."""
    return [module for section in SECTIONS for module in section.modules()]


def _module(name):
    return importlib.import_module(f"{__package__}.{name}")


def _one_line(cls):
    """The docstring on one line: a tooltip wraps by itself."""
    if "\n" in (cls.__doc__ or "") and "bl_idname" in vars(cls) and "bl_description" not in vars(cls):
        cls.bl_description = " ".join(cls.__doc__.split())


def _take(module):
    import bpy

    for cls in module.CLASSES:
        _one_line(cls)
        _module("blender.versions").own_words(cls)
        bpy.utils.register_class(cls)
        _undo.append(lambda cls=cls: bpy.utils.unregister_class(cls))
    if hasattr(module, "detach"):  # first: an attach() that fails halfway leaves something to undo
        _undo.append(module.detach)
    if hasattr(module, "attach"):
        module.attach()
