"""A scene in Blender: bodies, materials, light, arrows."""
