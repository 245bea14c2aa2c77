"""The add-on's own keys beside those of its tools: in Blender's add-on key configuration, taken back with the add-on.
What a user makes of them is in the user's configuration, and stays there."""

import bpy
import rna_keymap_ui

from . import menus, sculpt_panel

# Keymap, operator, key, and what the operator is given. Blender has nothing on these keys in any version.
KEYS = (
    ("Object Mode", "wm.call_menu_pie", {"type": "W", "ctrl": True, "shift": True}, sculpt_panel.RIFFLER_MT_sculpt_pie),
    ("Object Mode", "wm.call_menu", {"type": "W", "ctrl": True, "alt": True}, menus.RIFFLER_MT_object),
)
CLASSES = ()
_made = []  # (keymap, item)


def attach():
    configuration = bpy.context.window_manager.keyconfigs.addon
    if configuration is None:  # Blender without a window may have none
        return
    for name, operator, key, menu in KEYS:
        keymap = configuration.keymaps.new(name)
        item = keymap.keymap_items.new(operator, value="PRESS", **key)
        item.properties.name = menu.bl_idname
        _made.append((keymap, item))


def detach():
    while _made:
        keymap, item = _made.pop()
        keymap.keymap_items.remove(item)


def users():
    """(keymap, item) of each of KEYS in the user's configuration, which is the one that counts; the item is None where
    the user has removed it."""
    configuration = bpy.context.window_manager.keyconfigs.user
    for name, operator, _, menu in KEYS:
        keymap = configuration.keymaps.get(name) if configuration is not None else None
        items = keymap.keymap_items if keymap is not None else ()
        found = [i for i in items if i.idname == operator and i.properties.name == menu.bl_idname]
        yield keymap, next(iter(found), None)


def draw(layout, context):
    """One row for each key, as in Blender's own list: edited there, and put back by its arrow."""
    layout.label(text="Keys")
    for (name, _, _, menu), (keymap, item) in zip(KEYS, users(), strict=True):
        if item is None:
            layout.label(
                text=f"{menu.bl_label}: removed. Restore in the list Keymap, {name}, brings it back", icon="INFO"
            )
            continue
        layout.context_pointer_set("keymap", keymap)
        configuration = context.window_manager.keyconfigs.user
        rna_keymap_ui.draw_kmi([], configuration, keymap, item, layout, 0)
