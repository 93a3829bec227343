"""What is in the picture at every moment, without Blender. It imports shared and presets."""
