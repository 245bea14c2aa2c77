"""The scene's millimetres."""

from ..common import units

clean = units.clean


def mm_per_unit(scene):
    """scene mm = Blender units × scale_length × 1000, in any displayed units."""
    return units.mm_per_unit(scene.unit_settings.scale_length)


SHOWN = {"MM": "MILLIMETERS", "CM": "CENTIMETERS", "M": "METERS", "INCH": "INCHES"}


def set_unit(scene, screens, mm, shown="MM"):
    """Makes one Blender unit `mm` millimetres; lengths are shown in one of size_guess.UNITS. With millimetres, a part
    of some metres stays within the views' clipping."""
    settings = scene.unit_settings
    settings.system = "IMPERIAL" if shown == "INCH" else "METRIC"
    settings.scale_length = mm / 1000
    settings.length_unit = SHOWN[shown]
    if shown != "MM":
        return
    for screen in screens:
        for area in screen.areas:
            if area.type == "VIEW_3D":
                space = area.spaces.active
                # Blender's own value; a smaller one loses depth precision at far surfaces
                space.clip_start = max(0.1 / mm, 0.01)
                space.clip_end = max(space.clip_end, 10_000.0 / mm)
