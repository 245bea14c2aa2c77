"""The scene's millimetres."""

from ..core import size_guess, units

clean = units.clean


def mm_per_unit(scene):
    """scene mm = Blender units × scale_length × 1000, whatever units the scene shows."""
    return units.mm_per_unit(scene.unit_settings.scale_length)


SHOWN = {"MM": "MILLIMETERS", "CM": "CENTIMETERS", "M": "METERS", "INCH": "INCHES"}


def set_unit(scene, screens, unit):
    """One Blender unit is one of core.size_guess.UNITS, shown as such, and a part of some metres stays within the
    view's clipping."""
    settings = scene.unit_settings
    settings.system = "IMPERIAL" if unit == "INCH" else "METRIC"
    settings.scale_length = size_guess.UNITS[unit] / 1000
    settings.length_unit = SHOWN[unit]
    if unit != "MM":
        return
    for screen in screens:
        for area in screen.areas:
            if area.type == "VIEW_3D":
                space = area.spaces.active
                space.clip_start = 0.1
                space.clip_end = max(space.clip_end, 10_000.0)
