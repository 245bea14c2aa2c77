"""The scene's millimetres."""

from ..core import units

clean = units.clean


def mm_per_unit(scene):
    """scene mm = Blender units × scale_length × 1000, whatever units the scene shows."""
    return units.mm_per_unit(scene.unit_settings.scale_length)


def set_millimetres(scene, screens):
    """One Blender unit is one millimetre, shown as such, and a part of some metres stays within the view's clipping."""
    settings = scene.unit_settings
    settings.system = "METRIC"
    settings.scale_length = 0.001
    settings.length_unit = "MILLIMETERS"
    for screen in screens:
        for area in screen.areas:
            if area.type == "VIEW_3D":
                space = area.spaces.active
                space.clip_start = 0.1
                space.clip_end = max(space.clip_end, 10_000.0)
