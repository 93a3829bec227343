"""Radau IIA of order 5, for stiff mechanisms."""

from mbsd.dynamics.integrators.radau.loop import RADAU

__all__ = ["RADAU"]
