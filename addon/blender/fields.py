"""Kinds of fields that several groups of settings have."""

import zlib

from bpy.props import FloatProperty


def length(name, default, description, low=0.0, high=1e5):
    """In mm, whatever units the scene shows."""
    return FloatProperty(name=name, default=default, min=low, max=high, precision=3, step=10, description=description)


def angle(name, default, description, low, high):
    """In rad, shown in the unit that the scene has for angles."""
    return FloatProperty(name=name, default=default, min=low, max=high, subtype="ANGLE", description=description)


def stored_number(identifier):
    """The number that a .blend keeps of an entry in a choice. It stays when other entries are added."""
    return zlib.crc32(identifier.encode()) >> 1
