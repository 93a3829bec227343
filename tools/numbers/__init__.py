"""The guard of the solver's numbers: the raw bytes of many runs' results, against those recorded.

    make check-numbers              every run; ONLY=text those whose names contain it
    make record-numbers             after a change of numbers that is meant, and stated in CHANGELOG.md
    make keep-numbers               before a change that may move last digits: keeps the numbers themselves
    make check-numbers WITHIN=1e-9  after it: how far each run has moved, and whether any is farther than that
    make check-events               runs in which something happens, within bounds: see events/

A difference of one last digit is found. It is no test of what is right: the tests are.
"""
