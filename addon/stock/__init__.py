"""The material as a whole: making it, cutting along curves, cropping, masking, measuring, exporting, recovering."""
