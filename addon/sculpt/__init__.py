"""Sculpting by hand: live sculpts, their strokes and undo, the sculpt tools, the cutter."""
