"""Operators that make and edit a plan."""
