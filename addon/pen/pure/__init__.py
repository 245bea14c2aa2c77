"""A session with a device, without Blender."""
