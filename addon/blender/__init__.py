"""Adapters to Blender that know no feature. Every difference between its versions is dealt with in versions.py only."""
