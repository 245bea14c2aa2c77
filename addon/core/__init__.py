"""What the add-on knows without Blender: no module here imports bpy, so plain Python tests all of it."""
