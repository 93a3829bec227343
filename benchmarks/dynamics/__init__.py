"""Motions under load: a pendulum, N four-bars in a row, Andrews' squeezing mechanism; every code at its best settings.

A code's module has VERSION, CANDIDATES (problem name to settings to try, cheapest first) and
``run(problem, settings, samples)``, which returns seconds of the integration, times (T,), poses and velocities
(T, nb, 3) of the centres of mass, with two samples at least.
"""

CODES = ("mbsd", "exudyn", "mujoco", "scipy", "ida")
BARS = {"A01": 5.0, "A02 N=1": 20.0, "A02 N=10": 20.0, "A02 N=40": 20.0, "A03": 50.0}
"""How many times the time of mbsd the best peer takes at least."""
