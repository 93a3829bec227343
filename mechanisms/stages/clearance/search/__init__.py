"""Branch and bound over spans of time: least gaps in the plane and in space."""
