"""Operators: thin shells around core and bl."""
