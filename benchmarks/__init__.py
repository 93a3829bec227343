"""Timings beside peers: ``make bench``.

Every code runs in a process of its own, all in turn, round after round.
"""
