"""Names for derivatives of runs in coordinates of your own; docs/extending.md shows them.

run_tangents            a run of an added formulation and its changes with numbers
Run, Parameter          what is run, and a number of the formulation or of its start
RunTangents, RunEvent   what comes back, and an event on the way
"""

from mbsd.derivatives.formulations import Parameter, Run, RunEvent, RunTangents, run_tangents

__all__ = ["Parameter", "Run", "RunEvent", "RunTangents", "run_tangents"]
