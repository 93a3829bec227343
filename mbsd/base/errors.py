"""Errors: each message names the mechanism, the position, the number and the remedy."""

from __future__ import annotations

import os

PACKAGE = (os.path.dirname(os.path.dirname(__file__)) + os.sep,)
"""Files that warnings skip, to point at the line of the user."""


class MechanismError(Exception):
    """Base of every error that a model or its data can cause."""


class ModelError(MechanismError):
    """The model cannot be: a bad name, a NaN, a negative mass, a marker of another mechanism."""


class MobilityError(MechanismError):
    """Drivers and freedoms do not match: a driver is missing, or two drive one freedom."""


class AssemblyError(MechanismError):
    """The links cannot be closed at the start."""


class BranchError(MechanismError):
    """The motion would jump to the other assembly, and smaller steps do not cure it."""


class SimulationError(MechanismError):
    """The integration cannot go on: steps shrink to nothing, or numbers are no longer finite."""


class InitialConditionWarning(UserWarning):
    """Given start values do not fit the joints and were changed; the message says which and how."""


class LimitError(MechanismError):
    """A joint passes its limit."""


class SingularPoseError(MechanismError):
    """A toggle or a change point: the drivers no longer fix the motion here."""


class ModelWarning(UserWarning):
    """A number of the model looks as if a unit was mixed up; see :meth:`mbsd.mechanism.Mechanism.check`."""


class EquilibriumError(MechanismError):
    """No pose was found where everything balances."""
