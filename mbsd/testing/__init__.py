"""Checks of user-defined joints, drivers, contacts, forces and integrators, by differences.

    check_joint(PARALLEL_ARM)         Phi, J, nu, gamma of a joint, driver or contact
    check_force(STIFFENING_SPRING)    power, action and reaction, potential
    check_integrator(MIDPOINT)        its order, and closed constraints at outputs
    check_derivatives(m, "P.x", ["crank.length"])   m.sensitivities() against differences of whole motions

Each raises an AssertionError that names the kind, the row or coordinate, the number and what it should be, as
functions of numpy.testing do. The project's own tests call these for every kind that is registered.
"""

from mbsd.testing.derivatives import check_derivatives
from mbsd.testing.forces import check_force
from mbsd.testing.integrators import check_integrator, measured_order
from mbsd.testing.joints import check_joint
from mbsd.testing.kinds import contact_kinds, force_kinds, integrators, joint_kinds

__all__ = [
    "check_derivatives",
    "check_force",
    "check_integrator",
    "check_joint",
    "contact_kinds",
    "force_kinds",
    "integrators",
    "joint_kinds",
    "measured_order",
]
