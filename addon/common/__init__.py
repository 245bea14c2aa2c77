"""What several features need without Blender: plain Python tests all of it."""
