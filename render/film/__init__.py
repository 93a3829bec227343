"""The content of the picture at each moment: bodies, camera, clock. Without Blender."""
