"""Dormand and Prince 8(5,3), the usual method."""

from mbsd.dynamics.integrators.dop853.loop import DOP853

__all__ = ["DOP853"]
