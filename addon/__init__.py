"""Riffler in Blender: carve a block with a pen as if milling it, then export STL and NC code.

This module imports neither bpy nor the native core, so `addon.common` and every `pure` folder can be imported anywhere.
If the core does not load, a panel shows the reason instead of a traceback.
"""

import sys

bl_info = {  # Blender before 4.2; later ones read blender_manifest.toml
    "name": "Riffler",
    "description": "Carve stock as if milling it, export STL files and NC code",
    "author": "The Riffler authors",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "3D View > Sidebar > Riffler",
    "category": "Sculpt",
}
VERSION = ".".join(map(str, bl_info["version"]))  # before Blender puts the manifest's version into bl_info


def _forget_submodules():
    """Removes the submodules from sys.modules. After an update, and for Reload Scripts, Blender runs this file again,
    and would combine it with the old submodules."""
    for name in [n for n in sys.modules if n.startswith(f"{__name__}.")]:
        del sys.modules[name]
        globals().pop(name.removeprefix(f"{__name__}."), None)  # `from . import` looks here first


_forget_submodules()


def register():
    from . import registration

    registration.register()


def unregister():
    from . import registration

    registration.unregister()
