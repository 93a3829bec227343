"""Blender's process from outside: its job, its answers, its patience. Inside is `worker` with `scene`.

What is inside is a part of every frame's key: a change there renders the frames again.
"""
