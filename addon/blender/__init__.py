"""Adapters to Blender that know no feature. Only versions.py handles the differences between Blender's versions."""
