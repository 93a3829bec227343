"""Results in space, by name: bodies, joints, drivers, traced points, energy."""
