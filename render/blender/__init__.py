"""Everything that touches bpy, in a process of its own. From a Scene and its States to pictures or a .blend.

The sources in this folder are a part of every frame's key: a change here renders the frames again.
"""
