"""Adapters to Blender. Every difference between its versions is dealt with in versions.py, and nowhere else."""
