"""Frames, the folder that keeps them, stills, and the film that they make."""
