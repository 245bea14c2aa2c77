"""What the tests of the add-on share. `common`, and what uses it, runs in a Blender."""
