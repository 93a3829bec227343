"""mbsd: planar multibody mechanisms. Numbers in SI, angles in radians, counter-clockwise.

    from mbsd import Mechanism, constant_rate

Kernels are compiled and scipy is loaded only when something is solved. This import alone loads nothing: each name is
loaded when it is asked for, the classes that methods return among them.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

from mbsd.base.errors import (
    AssemblyError,
    BranchError,
    EquilibriumError,
    InitialConditionWarning,
    LimitError,
    MechanismError,
    MobilityError,
    ModelError,
    ModelWarning,
    SimulationError,
    SingularPoseError,
)

if TYPE_CHECKING:
    from mbsd.analyses.efforts import ActuatedMotion
    from mbsd.analyses.equilibrium import Equilibrium
    from mbsd.analyses.findings import Finding
    from mbsd.analyses.modes import Mode
    from mbsd.analyses.state_space import Linearisation
    from mbsd.balancing.balance import Balance, balance
    from mbsd.balancing.flywheel import flywheel
    from mbsd.balancing.means import BalanceShaft, Counterweight
    from mbsd.derivatives.sensitivities import Sensitivities
    from mbsd.dynamics.events.moment import Moment
    from mbsd.kinematics.batch import Batch
    from mbsd.mechanism import STANDARD_GRAVITY, Body, Force, Joint, Marker, Mechanism
    from mbsd.model.cylinders.cycle import GasCycle
    from mbsd.model.cylinders.engine_cycles import four_stroke, pressure_table, two_stroke
    from mbsd.model.event import Event, Happening, angle_reaches, distance_reaches, speed_reaches
    from mbsd.model.laws import Motion, constant_rate, cycloidal, function, harmonic, polynomial, recorded, table
    from mbsd.model.laws.curve import Curve, curve
    from mbsd.model.outlines.outline import Outline, arc_through, circle, spline_through
    from mbsd.pictures import Animation, Picture, Svg
    from mbsd.results.fluids import GasView, HydraulicView
    from mbsd.results.force_view import ForceView
    from mbsd.results.friction import FrictionView
    from mbsd.results.solution import Solution
    from mbsd.results.views import ContactView, DriverView, EnergyView, FrameView, JointView, Mobility, Stats
    from mbsd.studies.simulated import Simulated, simulated
    from mbsd.studies.study import study
    from mbsd.synthesis.fit_path import PathFit, SynthesisError, fit_path
    from mbsd.synthesis.optimise import Optimum, optimise
    from mbsd.tolerancing.dimensions.clearance import Clearance
    from mbsd.tolerancing.dimensions.spreads import Normal, Triangular, Uniform
    from mbsd.tolerancing.outcome import Tolerances
    from mbsd.tolerancing.tolerances import tolerances

__version__ = "1.0.0"

__all__ = [
    "STANDARD_GRAVITY",
    "ActuatedMotion",
    "Animation",
    "AssemblyError",
    "Balance",
    "BalanceShaft",
    "Batch",
    "Body",
    "BranchError",
    "Clearance",
    "ContactView",
    "Counterweight",
    "Curve",
    "DriverView",
    "EnergyView",
    "Equilibrium",
    "EquilibriumError",
    "Event",
    "Finding",
    "Force",
    "ForceView",
    "FrameView",
    "FrictionView",
    "GasCycle",
    "GasView",
    "Happening",
    "HydraulicView",
    "InitialConditionWarning",
    "Joint",
    "JointView",
    "LimitError",
    "Linearisation",
    "Marker",
    "Mechanism",
    "MechanismError",
    "Mobility",
    "MobilityError",
    "Mode",
    "ModelError",
    "ModelWarning",
    "Moment",
    "Motion",
    "Normal",
    "Optimum",
    "Outline",
    "PathFit",
    "Picture",
    "Sensitivities",
    "Simulated",
    "SimulationError",
    "SingularPoseError",
    "Solution",
    "Stats",
    "Svg",
    "SynthesisError",
    "Tolerances",
    "Triangular",
    "Uniform",
    "angle_reaches",
    "arc_through",
    "balance",
    "circle",
    "constant_rate",
    "curve",
    "cycloidal",
    "distance_reaches",
    "fit_path",
    "flywheel",
    "four_stroke",
    "function",
    "harmonic",
    "optimise",
    "polynomial",
    "pressure_table",
    "recorded",
    "simulated",
    "speed_reaches",
    "spline_through",
    "study",
    "table",
    "tolerances",
    "two_stroke",
]

_ROOMS = {
    "mbsd.analyses.efforts": "ActuatedMotion",
    "mbsd.analyses.equilibrium": "Equilibrium",
    "mbsd.analyses.findings": "Finding",
    "mbsd.analyses.modes": "Mode",
    "mbsd.analyses.state_space": "Linearisation",
    "mbsd.balancing.balance": "Balance balance",
    "mbsd.balancing.flywheel": "flywheel",
    "mbsd.balancing.means": "BalanceShaft Counterweight",
    "mbsd.derivatives.sensitivities": "Sensitivities",
    "mbsd.dynamics.events.moment": "Moment",
    "mbsd.kinematics.batch": "Batch",
    "mbsd.mechanism": "Body Force Joint Marker Mechanism STANDARD_GRAVITY",
    "mbsd.model.cylinders.cycle": "GasCycle",
    "mbsd.model.cylinders.engine_cycles": "four_stroke pressure_table two_stroke",
    "mbsd.model.event": "Event Happening angle_reaches distance_reaches speed_reaches",
    "mbsd.model.laws": "Motion constant_rate cycloidal function harmonic polynomial recorded table",
    "mbsd.model.laws.curve": "Curve curve",
    "mbsd.model.outlines.outline": "Outline arc_through circle spline_through",
    "mbsd.pictures": "Animation Picture Svg",
    "mbsd.results.fluids": "GasView HydraulicView",
    "mbsd.results.force_view": "ForceView",
    "mbsd.results.friction": "FrictionView",
    "mbsd.results.solution": "Solution",
    "mbsd.results.views": "ContactView DriverView EnergyView FrameView JointView Mobility Stats",
    "mbsd.studies.simulated": "Simulated simulated",
    "mbsd.studies.study": "study",
    "mbsd.synthesis.fit_path": "PathFit SynthesisError fit_path",
    "mbsd.synthesis.optimise": "Optimum optimise",
    "mbsd.tolerancing.dimensions.clearance": "Clearance",
    "mbsd.tolerancing.dimensions.spreads": "Normal Triangular Uniform",
    "mbsd.tolerancing.outcome": "Tolerances",
    "mbsd.tolerancing.tolerances": "tolerances",
}
"""Public names of each module."""
_LATER = {name: module for module, names in _ROOMS.items() for name in names.split()}
"""Home of each name, loaded on request, so that the stages can look at what changed without numpy."""


def __getattr__(name: str) -> Any:
    if name not in _LATER:
        from difflib import get_close_matches

        meant = [] if name.startswith("_") else get_close_matches(name, __all__, n=1)
        raise AttributeError(
            f"module 'mbsd' has no attribute '{name}'" + "".join(f", did you mean '{m}'?" for m in meant)
        )
    value = globals()[name] = getattr(importlib.import_module(_LATER[name]), name)
    return value


def __dir__() -> list[str]:
    return sorted({*__all__, *(name for name in globals() if name.startswith("__"))})
