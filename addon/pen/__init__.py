"""Sculpting with a pen or another device."""
