"""Strokes, journals and a sculpt's data in the .blend, without Blender."""
