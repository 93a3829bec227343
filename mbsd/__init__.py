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
    "balance",
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
    "study",
    "table",
    "tolerances",
    "two_stroke",
]

_LATER = {
    "STANDARD_GRAVITY": "mbsd.mechanism",
    "ActuatedMotion": "mbsd.analyses.efforts",
    "Balance": "mbsd.balancing.balance",
    "BalanceShaft": "mbsd.balancing.means",
    "Animation": "mbsd.pictures",
    "Batch": "mbsd.kinematics.batch",
    "Body": "mbsd.mechanism",
    "Counterweight": "mbsd.balancing.means",
    "ContactView": "mbsd.results.views",
    "Curve": "mbsd.model.laws.curve",
    "DriverView": "mbsd.results.views",
    "EnergyView": "mbsd.results.views",
    "Equilibrium": "mbsd.analyses.equilibrium",
    "Event": "mbsd.model.event",
    "Finding": "mbsd.analyses.findings",
    "Force": "mbsd.mechanism",
    "ForceView": "mbsd.results.force_view",
    "FrameView": "mbsd.results.views",
    "FrictionView": "mbsd.results.friction",
    "GasCycle": "mbsd.model.cylinders.cycle",
    "GasView": "mbsd.results.fluids",
    "HydraulicView": "mbsd.results.fluids",
    "Happening": "mbsd.model.event",
    "Joint": "mbsd.mechanism",
    "JointView": "mbsd.results.views",
    "Linearisation": "mbsd.analyses.state_space",
    "Marker": "mbsd.mechanism",
    "Mechanism": "mbsd.mechanism",
    "Mobility": "mbsd.results.views",
    "Mode": "mbsd.analyses.modes",
    "Moment": "mbsd.dynamics.events.moment",
    "Motion": "mbsd.model.laws",
    "Optimum": "mbsd.synthesis.optimise",
    "PathFit": "mbsd.synthesis.fit_path",
    "Picture": "mbsd.pictures",
    "Sensitivities": "mbsd.derivatives.sensitivities",
    "Solution": "mbsd.results.solution",
    "Stats": "mbsd.results.views",
    "Svg": "mbsd.pictures",
    "SynthesisError": "mbsd.synthesis.fit_path",
    "Clearance": "mbsd.tolerancing.dimensions.clearance",
    "Normal": "mbsd.tolerancing.dimensions.spreads",
    "Tolerances": "mbsd.tolerancing.outcome",
    "Triangular": "mbsd.tolerancing.dimensions.spreads",
    "Uniform": "mbsd.tolerancing.dimensions.spreads",
    "balance": "mbsd.balancing.balance",
    "angle_reaches": "mbsd.model.event",
    "constant_rate": "mbsd.model.laws",
    "curve": "mbsd.model.laws.curve",
    "cycloidal": "mbsd.model.laws",
    "distance_reaches": "mbsd.model.event",
    "flywheel": "mbsd.balancing.flywheel",
    "fit_path": "mbsd.synthesis.fit_path",
    "four_stroke": "mbsd.model.cylinders.engine_cycles",
    "function": "mbsd.model.laws",
    "harmonic": "mbsd.model.laws",
    "optimise": "mbsd.synthesis.optimise",
    "polynomial": "mbsd.model.laws",
    "pressure_table": "mbsd.model.cylinders.engine_cycles",
    "recorded": "mbsd.model.laws",
    "speed_reaches": "mbsd.model.event",
    "Simulated": "mbsd.studies.simulated",
    "simulated": "mbsd.studies.simulated",
    "study": "mbsd.studies.study",
    "table": "mbsd.model.laws",
    "tolerances": "mbsd.tolerancing.tolerances",
    "two_stroke": "mbsd.model.cylinders.engine_cycles",
}
"""Where each name is; it is loaded when it is asked for, so that the stages can look at what changed without numpy."""


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
