"""Recorded runs with events: contacts, stops, ropes, freewheels, sticking joints, Genevas.

    make check-events                 every run beside recorded.jsonl; ONLY=text those whose names contain it
    make record-events                after a change of numbers that is meant, and stated in CHANGELOG.md

A run keeps what happened (time, name, what, impulse, energy), the end state, work, the rows that held at each output,
and motion and forces at two times between events; of a run that is refused, the class of the error and the words that
name its cause. Each run has its own bounds, measured by moving its numbers a little: see difference.py.
"""
