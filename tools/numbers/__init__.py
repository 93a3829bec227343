"""The guard of the solver's numbers: the raw bytes of many runs' results, against those recorded.

    make check-numbers              every run; ONLY=text those whose names contain it
    make record-numbers             after a change of numbers that is meant, and stated in CHANGELOG.md

A difference of one last digit is found. It is no test of what is right: the tests are.
"""
