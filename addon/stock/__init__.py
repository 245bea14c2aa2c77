"""The material as a whole: made, cut along curves, cropped, masked, measured, exported, recovered."""
