"""The sound of a film, made by numpy from data.json, parts.json and the film's clock. Without Blender."""
