"""Shared by the add-on's tests. `common`, and modules that use it, run in a Blender."""
