"""Property types that several groups of settings share."""

import zlib

from bpy.props import FloatProperty


def length(name, default, description, low=0.0, high=1e5):
    """A length in mm, in any scene units."""
    return FloatProperty(name=name, default=default, min=low, max=high, precision=3, step=10, description=description)


def angle(name, default, description, low, high):
    """An angle in rad, shown in the scene's unit for angles."""
    return FloatProperty(name=name, default=default, min=low, max=high, subtype="ANGLE", description=description)


def stored_number(identifier):
    """The number that a .blend stores for an enum entry. It stays the same when other entries are added."""
    return zlib.crc32(identifier.encode()) >> 1
