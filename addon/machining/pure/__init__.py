"""What needs no Blender."""
