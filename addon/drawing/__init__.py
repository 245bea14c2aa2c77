"""What is drawn over the 3D view, and belongs to no object: the tool under the pointer, force, bars with scales."""
