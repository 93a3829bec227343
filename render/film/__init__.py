"""What is in the picture at each moment: bodies, camera, clock. Without Blender."""
