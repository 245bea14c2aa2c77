"""Writes, simulates and verifies programs, made from plans, files or cuts."""
