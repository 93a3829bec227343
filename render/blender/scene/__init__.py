"""The scene in Blender: bodies, materials, lights, arrows."""
