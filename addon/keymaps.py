"""The add-on's own keys, in addition to those of its tools: registered in Blender's add-on key configuration, and
removed with the add-on. The user's changes are in the user's configuration, and stay there."""

from dataclasses import dataclass, field

import bpy
import rna_keymap_ui

from . import menus
from .pen import operators as pen_operators
from .program import simulation
from .sculpt import panel
from .translations import CONTEXT


@dataclass(frozen=True)
class Key:
    keymap: str
    operator: str
    event: dict
    label: str
    given: dict = field(default_factory=dict)  # settings of the operator
    space: str = "EMPTY"

    def is_of(self, item):
        """Other add-ons' keys may call operators without such a property, or operators that no longer exist."""
        given = self.given.items()
        return item.idname == self.operator and all(getattr(item.properties, n, None) == v for n, v in given)


def _menu(operator, menu, **event):
    return Key("Object Mode", operator, event, menu.bl_label, {"name": menu.bl_idname})


STOP, PEN_STOP = simulation.RIFFLER_OT_simulate_stop, pen_operators.RIFFLER_OT_pen_stop
# No version of Blender uses these keys, except Esc, which is ours only during a simulation, and a device's session.
KEYS = (
    _menu("wm.call_menu_pie", panel.RIFFLER_MT_sculpt_pie, type="W", ctrl=True, shift=True),
    _menu("wm.call_menu", menus.RIFFLER_MT_object, type="W", ctrl=True, alt=True),
    Key("3D View", STOP.bl_idname, {"type": "ESC"}, STOP.bl_label, space="VIEW_3D"),
    Key("3D View", PEN_STOP.bl_idname, {"type": "ESC"}, PEN_STOP.bl_label, space="VIEW_3D"),
)
CLASSES = ()
_made = []  # (keymap, item)


def attach():
    configuration = bpy.context.window_manager.keyconfigs.addon
    if configuration is None:  # Blender without a window may have no configuration
        return
    for key in KEYS:
        keymap = configuration.keymaps.new(key.keymap, space_type=key.space)
        item = keymap.keymap_items.new(key.operator, value="PRESS", **key.event)
        _made.append((keymap, item))
        for name, value in key.given.items():
            setattr(item.properties, name, value)


def detach():
    while _made:
        keymap, item = _made.pop()
        keymap.keymap_items.remove(item)


def users():
    """(keymap, item) of each of KEYS in the user's configuration, which takes precedence; the item is None if the user
    has removed it."""
    configuration = bpy.context.window_manager.keyconfigs.user
    for key in KEYS:
        keymap = configuration.keymaps.get(key.keymap) if configuration is not None else None
        items = keymap.keymap_items if keymap is not None else ()
        yield keymap, next(filter(key.is_of, items), None)


def draw(layout, context):
    """One row for each key, as in Blender's own list: edited there, and reset by its arrow."""
    layout.label(text="Keys", text_ctxt=CONTEXT)
    for key, (keymap, item) in zip(KEYS, users(), strict=True):
        if item is None:
            layout.label(
                text=f"{key.label}: removed. Use Restore in the list Keymap, {key.keymap}, to bring it back",
                icon="INFO",
            )
            continue
        layout.context_pointer_set("keymap", keymap)
        configuration = context.window_manager.keyconfigs.user
        rna_keymap_ui.draw_kmi([], configuration, keymap, item, layout, 0)
