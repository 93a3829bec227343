"""The least gap of two pieces by branch and bound over spans of time, in the plane and in space."""
