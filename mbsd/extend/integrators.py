"""Names for an integrator of your own; docs/extending.md shows one. Importing this loads the compiler.

derivative, project     rates of a state, and a state closed onto the constraints
close_step              the same at the end of a step of fixed length, and whether it closes
begin, fixed_step       the start of ``advance``, and the next step of a method with fixed ones
record, record_here     outputs between steps, and at the end of a step
add_formulation         coordinates of your own
start_state, output_for    where a run begins, and room for its outputs
advance_with, tolerances, Rates, Stepper    a solver of another library over the model's rates
kernel, apart, internal, inlined    how its functions are compiled
"""

from mbsd.compiling.jit import apart, inlined, internal, kernel
from mbsd.dynamics.formulation import add_formulation, close_step, derivative, project
from mbsd.dynamics.formulation import begin_run as begin
from mbsd.dynamics.formulation import record_output as record
from mbsd.dynamics.integrators.full_matrix import differentiate, factor_full, solve_full, too_large
from mbsd.dynamics.integrators.kind import Integrator, Option, without_sliding
from mbsd.dynamics.integrators.kind import register as register_integrator
from mbsd.dynamics.integrators.outside import PULL, STAGES, Rates, Stepper, advance_with, tolerances
from mbsd.dynamics.integrators.step_size import allowed, first_step
from mbsd.dynamics.state import (
    ACCEPTED,
    ERROR,
    EVALUATIONS,
    NEXT,
    NO_CONVERGENCE,
    NOT_FINITE,
    PAUSED,
    POWER,
    REACHED,
    REJECTED,
    STEP,
    STEP_TOO_SMALL,
    TIME,
    WORK,
    Output,
    Settings,
    State,
    fixed_step,
    output_for,
    record_here,
    start_state,
)

__all__ = [
    "ACCEPTED",
    "ERROR",
    "EVALUATIONS",
    "NEXT",
    "NOT_FINITE",
    "NO_CONVERGENCE",
    "PAUSED",
    "POWER",
    "PULL",
    "REACHED",
    "REJECTED",
    "STAGES",
    "STEP",
    "STEP_TOO_SMALL",
    "TIME",
    "WORK",
    "Integrator",
    "Option",
    "Output",
    "Rates",
    "Settings",
    "State",
    "Stepper",
    "add_formulation",
    "advance_with",
    "allowed",
    "apart",
    "begin",
    "close_step",
    "derivative",
    "differentiate",
    "factor_full",
    "first_step",
    "fixed_step",
    "inlined",
    "internal",
    "kernel",
    "output_for",
    "project",
    "record",
    "record_here",
    "register_integrator",
    "solve_full",
    "start_state",
    "tolerances",
    "too_large",
    "without_sliding",
]
