"""All kinds that are registered: those of mbsd, whose files are imported here, and those of the user."""

from __future__ import annotations

import importlib
import pkgutil
from types import ModuleType

import mbsd.dynamics.integrators
import mbsd.model.contacts
import mbsd.model.drivers
import mbsd.model.forces
import mbsd.model.joints
from mbsd.dynamics.integrators.kind import INTEGRATORS, Integrator
from mbsd.model.contact import CONTACT_KINDS, ContactKind
from mbsd.model.force import FORCE_KINDS, ForceKind
from mbsd.model.joint import KINDS, JointKind


def _load(package: ModuleType) -> None:
    for module in pkgutil.iter_modules(package.__path__):
        importlib.import_module(f"{package.__name__}.{module.name}")


def joint_kinds() -> list[JointKind]:
    """Kinds of joints and drivers."""
    _load(mbsd.model.joints)
    _load(mbsd.model.drivers)
    return list(KINDS.values())


def force_kinds() -> list[ForceKind]:
    """Kinds of forces."""
    _load(mbsd.model.forces)
    return list(FORCE_KINDS.values())


def contact_kinds() -> list[ContactKind]:
    """Kinds of rigid contacts."""
    _load(mbsd.model.contacts)
    return list(CONTACT_KINDS.values())


def integrators() -> list[Integrator]:
    """Methods of simulate(), those whose package is not installed included."""
    _load(mbsd.dynamics.integrators)
    return list(INTEGRATORS.values())
