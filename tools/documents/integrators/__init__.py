"""Measured integrators for docs/integrators.md."""
