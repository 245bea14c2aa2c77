"""Adapters to Blender. Every difference between its versions is dealt with here, and nowhere else."""
