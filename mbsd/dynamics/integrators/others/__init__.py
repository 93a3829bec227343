"""Integrators of other libraries over the solver's accelerations, for cross-checking."""

from mbsd.dynamics.integrators.others import scipy_methods

__all__ = ["scipy_methods"]
