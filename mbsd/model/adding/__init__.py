"""Shared parts of functions that add joints, drivers, forces and contacts: checks and entries."""
