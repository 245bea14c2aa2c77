"""Kinds of fields that several groups of settings have."""

from bpy.props import FloatProperty


def length(name, default, description, low=0.0, high=1e5):
    """In mm, whatever units the scene shows."""
    return FloatProperty(name=name, default=default, min=low, max=high, precision=3, step=10, description=description)
