"""mbsd: planar multibody mechanisms. Numbers in SI, angles in radians, counter-clockwise.

    from mbsd import Mechanism, constant_rate

Kernels are compiled and scipy is loaded only when something is solved; this import stays light.
"""

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
from mbsd.mechanism import STANDARD_GRAVITY, Body, Joint, Marker, Mechanism
from mbsd.model.event import angle_reaches, distance_reaches, speed_reaches
from mbsd.model.laws import Motion, constant_rate, cycloidal, function, harmonic, polynomial, recorded, table
from mbsd.model.laws.curve import Curve, curve

__version__ = "0.1.0"

__all__ = [
    "STANDARD_GRAVITY",
    "AssemblyError",
    "Body",
    "BranchError",
    "Curve",
    "EquilibriumError",
    "InitialConditionWarning",
    "Joint",
    "LimitError",
    "Marker",
    "Mechanism",
    "MechanismError",
    "MobilityError",
    "ModelError",
    "ModelWarning",
    "Motion",
    "SimulationError",
    "SingularPoseError",
    "angle_reaches",
    "constant_rate",
    "curve",
    "cycloidal",
    "distance_reaches",
    "function",
    "harmonic",
    "polynomial",
    "recorded",
    "speed_reaches",
    "table",
]
