"""Estimates, reliefs and 3MF, without Blender."""
