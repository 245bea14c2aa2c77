"""Strokes, journals and what a sculpt keeps in the .blend, without Blender."""
