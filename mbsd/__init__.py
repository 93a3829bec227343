"""mbsd: planar multibody mechanisms. Numbers in SI, angles in radians, counter-clockwise.

    from mbsd import Mechanism, constant_rate

Kernels are compiled and scipy is loaded only when something is solved; this import stays light. The classes that
methods return are here, too, and are loaded when they are asked for.
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
from mbsd.mechanism import STANDARD_GRAVITY, Body, Force, Joint, Marker, Mechanism
from mbsd.model.event import Event, Happening, angle_reaches, distance_reaches, speed_reaches
from mbsd.model.laws import Motion, constant_rate, cycloidal, function, harmonic, polynomial, recorded, table
from mbsd.model.laws.curve import Curve, curve

if TYPE_CHECKING:
    from mbsd.analyses.efforts import ActuatedMotion
    from mbsd.analyses.equilibrium import Equilibrium
    from mbsd.analyses.modes import Mode
    from mbsd.analyses.state_space import Linearisation
    from mbsd.analyses.suspicious_units import Finding
    from mbsd.drawing.animation.animate import Animation
    from mbsd.drawing.picture import Picture, Svg
    from mbsd.dynamics.events.moment import Moment
    from mbsd.kinematics.batch import Batch
    from mbsd.results.contacts import ContactView
    from mbsd.results.force_view import ForceView
    from mbsd.results.friction import FrictionView
    from mbsd.results.mobility import Mobility
    from mbsd.results.solution import Solution
    from mbsd.results.views import DriverView, EnergyView, FrameView, JointView, Stats
    from mbsd.studies.study import study
    from mbsd.synthesis.fit_path import PathFit, SynthesisError, fit_path

__version__ = "0.1.0"

__all__ = [
    "STANDARD_GRAVITY",
    "ActuatedMotion",
    "Animation",
    "AssemblyError",
    "Batch",
    "Body",
    "BranchError",
    "ContactView",
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
    "Happening",
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
    "PathFit",
    "Picture",
    "SimulationError",
    "SingularPoseError",
    "Solution",
    "Stats",
    "Svg",
    "SynthesisError",
    "angle_reaches",
    "constant_rate",
    "curve",
    "cycloidal",
    "distance_reaches",
    "fit_path",
    "function",
    "harmonic",
    "polynomial",
    "recorded",
    "speed_reaches",
    "study",
    "table",
]

_LATER = {
    "ActuatedMotion": "mbsd.analyses.efforts",
    "Animation": "mbsd.drawing.animation.animate",
    "Batch": "mbsd.kinematics.batch",
    "ContactView": "mbsd.results.contacts",
    "DriverView": "mbsd.results.views",
    "EnergyView": "mbsd.results.views",
    "Equilibrium": "mbsd.analyses.equilibrium",
    "Finding": "mbsd.analyses.suspicious_units",
    "ForceView": "mbsd.results.force_view",
    "FrameView": "mbsd.results.views",
    "FrictionView": "mbsd.results.friction",
    "JointView": "mbsd.results.views",
    "Linearisation": "mbsd.analyses.state_space",
    "Mobility": "mbsd.results.mobility",
    "Mode": "mbsd.analyses.modes",
    "Moment": "mbsd.dynamics.events.moment",
    "PathFit": "mbsd.synthesis.fit_path",
    "Picture": "mbsd.drawing.picture",
    "Solution": "mbsd.results.solution",
    "Stats": "mbsd.results.views",
    "Svg": "mbsd.drawing.picture",
    "SynthesisError": "mbsd.synthesis.fit_path",
    "fit_path": "mbsd.synthesis.fit_path",
    "study": "mbsd.studies.study",
}
"""What methods return, and what loads more than this import should, and where it is."""


def __getattr__(name: str) -> Any:
    if name not in _LATER:
        raise AttributeError(f"module 'mbsd' has no attribute '{name}'")
    return getattr(importlib.import_module(_LATER[name]), name)
