"""Shared parts of the functions that add joints, drivers, forces and contacts: checks, and entries of the model."""
