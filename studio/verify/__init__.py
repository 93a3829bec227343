"""Verification: same inputs give same outputs; files are built again in fresh processes and compared."""
