"""Riffler in Blender: carve a block with a pen as if milling it; take STL and NC code away.

This module imports neither bpy nor the native core, so `addon.core` is importable anywhere, and a core that does not
load ends in a panel that says why rather than in a traceback.
"""

bl_info = {  # Blender before 4.2; later ones read blender_manifest.toml
    "name": "Riffler",
    "description": "Carve stock as if milling it, take STL and NC code away",
    "author": "The Riffler authors",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "3D View > Sidebar > Riffler",
    "category": "Sculpt",
}


def register():
    from . import registration

    registration.register()


def unregister():
    from . import registration

    registration.unregister()
