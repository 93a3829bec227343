"""Joints, forces and contacts one by one; how they are compiled."""
