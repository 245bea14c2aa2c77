"""The 3D views of all screens."""

import bpy


def views():
    """Every 3D view: name of its screen, number of its area, space."""
    for screen in bpy.data.screens:
        for k, area in enumerate(screen.areas):
            if area.type == "VIEW_3D":
                yield screen.name, k, area.spaces.active
