"""Plans of five-axis cuts: part and fixtures, paths, key orientations on the timeline, collisions."""
