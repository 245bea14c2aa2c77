"""The scene's millimetres."""

from ..core import units

clean = units.clean


def mm_per_unit(scene):
    """scene mm = Blender units × scale_length × 1000, whatever units the scene shows."""
    return units.mm_per_unit(scene.unit_settings.scale_length)


def set_millimetres(scene, screens, unit=1.0):
    """One Blender unit is `unit` millimetres, shown as such, and a part of some metres stays within the view's
    clipping."""
    settings = scene.unit_settings
    settings.system = "METRIC"
    settings.scale_length = unit / 1000
    settings.length_unit = "MILLIMETERS"
    for screen in screens:
        for area in screen.areas:
            if area.type == "VIEW_3D":
                space = area.spaces.active
                space.clip_start = max(0.1 / unit, 0.01)  # Blender's own; nearer, it tells far surfaces apart no more
                space.clip_end = max(space.clip_end, 10_000.0 / unit)
