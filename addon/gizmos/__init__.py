"""Handles in the 3D view."""
