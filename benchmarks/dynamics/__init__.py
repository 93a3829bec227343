"""Motions under load: a pendulum, N four-bars in a row, Andrews' squeezer, a chain.

Every code runs at its best settings.

A code's module has VERSION, ``ladders(case)`` (settings to try, each ladder from cheap to exact) and
``prepare(case, settings)``, which returns ``fresh`` and ``record``: ``fresh()`` makes a run ready to be timed, and
``record()`` integrates once more and returns what is held against the limits.
"""

CODES = ("mbsd", "exudyn", "mujoco", "scipy", "sundials")
