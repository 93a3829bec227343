"""The model in space, by name: bodies at their poses, markers, rows, joints, drivers."""
