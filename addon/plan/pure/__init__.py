"""Keys, motions, clearances and tools of plans, without Blender."""
