"""A program on the timeline and on a stock, without Blender."""
