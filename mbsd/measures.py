"""Measures of many simulations (:meth:`mbsd.Mechanism.simulate_many`): what is kept of each."""

from mbsd.dynamics.measures.kinds import Measure, final, first, integral, largest, samples, smallest

__all__ = ["Measure", "final", "first", "integral", "largest", "samples", "smallest"]
