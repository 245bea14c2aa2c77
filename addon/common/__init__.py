"""What several features need and no Blender: plain Python tests all of it."""
