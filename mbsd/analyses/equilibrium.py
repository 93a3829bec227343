"""Static equilibrium: a pose where the loads do no work in any motion that the joints leave.

    Phi(q) = 0,   T^T Q(q) = 0        T: tangent basis, Q: weight, springs and other forces at rest, drivers hold

Stability by the eigenvalues of the symmetric part of K (Lagrange-Dirichlet): all positive stable, one negative
unstable, else neutral. The search is in balance.py. Source: Haug 1989, ch. 7.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from mbsd.analyses.balance import FLAT, NoneFound, descend, look, newton
from mbsd.analyses.statics import STEP, Independent, Statics, independent_coordinates, pose_step, statics
from mbsd.arrays.laws import refuse_bad_laws
from mbsd.arrays.packing import pack
from mbsd.arrays.reactions import wrenches
from mbsd.arrays.starts import held, started_at
from mbsd.base.errors import ModelError, SingularPoseError
from mbsd.base.names import Suggesting
from mbsd.equations.assembly import tabulate
from mbsd.kinematics.limits.contacts import refuse_resting
from mbsd.kinematics.pose.close import assemble
from mbsd.kinematics.pose.mobility import joint_mobility
from mbsd.model.mechanism import Model
from mbsd.results.force_view import ForceView
from mbsd.results.solution import Solution
from mbsd.results.views import DriverView, EnergyView, FrameView, JointView, Stats


@dataclass(frozen=True, eq=False)
class Equilibrium(Suggesting):
    """A pose at rest where everything balances; views give single numbers."""

    solution: Solution
    """The pose as a solution with one time."""
    stability: str
    """``stable``, ``unstable``, ``neutral`` (it may move without a change of loads), ``fixed`` (nothing can move)."""
    independent: Independent
    stiffness: np.ndarray
    """(f, f) against the independent coordinates: N/m, N, N m/rad."""
    model: Model
    """The mechanism that starts here, at rest, its drivers holding."""
    steps: int

    @property
    def stable(self) -> bool:
        """True if the mechanism comes back after every small disturbance."""
        return self.stability in ("stable", "fixed")

    @property
    def coordinates(self) -> tuple[str, ...]:
        """Names of the independent coordinates, as ``rod.theta``."""
        return self.independent.names

    def body(self, name: str) -> FrameView:
        """Pose of a body's frame: x, y (m), theta (rad)."""
        return _single(self.solution.body(name))

    def point(self, name: str) -> FrameView:
        """Place of a traced point."""
        return _single(self.solution.point(name))

    def joint(self, name: str) -> JointView:
        """Place and reaction of a joint (on its second body)."""
        return _single(self.solution.joint(name))

    def driver(self, name: str) -> DriverView:
        """Return the value that a driver holds, and its effort."""
        return _single(self.solution.driver(name))

    def force(self, name: str) -> ForceView:
        """Return a force in this pose, at rest; see :meth:`mbsd.results.solution.Solution.force`."""
        return _single(self.solution.force(name))

    @property
    def energy(self) -> EnergyView:
        """Potential energy (J); kinetic is zero."""
        return _single(self.solution.energy)

    def start(self, m: Model) -> None:
        """Let ``m`` start here: its ``start_near`` poses become those of this equilibrium."""
        for name in self.model.starts:
            m.known_body(name)
        m.starts.update(self.model.starts)
        for name, force in self.model.forces.items():
            if force.kind.ideal is not None and name in m.forces:
                m.forces[name] = force

    def __repr__(self) -> str:
        return (
            f"<Equilibrium {self.solution.mechanism.name}: {self.stability}, coordinates "
            f"{', '.join(self.coordinates) or 'none'}>"
        )


def _single(view):
    """A view of one time with numbers instead of arrays."""
    fields = {key: value[0] if isinstance(value, np.ndarray) else value for key, value in vars(view).items()}
    return type(view)(**fields)


def equilibrium(m: Model, time: float, nearest: bool) -> Equilibrium:
    """See :meth:`mbsd.mechanism.Mechanism.equilibrium`."""
    if len(m.bodies) < 2:
        raise ModelError(f"{m.name}: there is no body beside ground; add one with m.bar(...) or m.body(...)")
    check_no_states(m, "equilibrium()")
    if not math.isfinite(time):
        raise ModelError(f"{m.name}: time is {time} s; it must be finite")
    resting = held(m, time)
    packed = pack(resting)
    refuse_bad_laws(packed, time, time)
    start = assemble(resting, packed, time)
    ready = statics(packed, time)
    q, steps = start, 0
    try:
        for part in ready.groups:
            q, more = (newton if nearest else descend)(part, q)
            steps += more
    except NoneFound as error:
        refuse_resting(resting, packed, start, error.pose, f"{error.said} It went")
        raise
    refuse_resting(resting, packed, start, q)
    return _result(m, resting, ready, q, steps)


def _result(m: Model, resting: Model, ready: Statics, q: np.ndarray, steps: int) -> Equilibrium:
    packed = ready.packed
    here = look(ready, q)
    mobility = joint_mobility(packed, q)
    drivers = len(packed.ws.phi) - packed.driver_rows
    if here.basis.shape[1] > max(mobility.dof - drivers, 0):
        raise SingularPoseError(
            f"{packed.name}: the pose that balances is singular (a toggle or change point). The links can go on in "
            f"more ways than the {max(mobility.dof - drivers, 0)} of their mobility, so its stability is "
            "unknown. Change a length a little, or start so that another equilibrium is nearer."
        )
    stiffness = ready.stiffness(q, here.lam, here.basis, pose_step(packed, q, STEP))
    independent = independent_coordinates(packed, here.basis)
    change = np.linalg.lstsq(here.basis * packed.column_scale()[:, None], independent.basis, rcond=None)[0]
    return Equilibrium(
        solution=_solution(m, ready, q, here.lam, mobility),
        stability=_stability(ready, q, stiffness, here.largest),
        independent=independent,
        stiffness=change.T @ stiffness @ change,
        model=started_at(resting, packed, q, np.zeros_like(q)),
        steps=steps,
    )


def _stability(ready: Statics, q: np.ndarray, stiffness: np.ndarray, load: float) -> str:
    """Return the stability of the least stable group; ``stiffness`` (f, f) and ``load`` are of all."""
    if len(ready.groups) == 1:
        return _stability_of(stiffness, load)
    words = set()
    for part in ready.groups:
        here = look(part, q)
        own = part.stiffness(q, here.lam, here.basis, pose_step(ready.packed, q, STEP))
        words.add(_stability_of(own, here.largest))
    return next(word for word in ("unstable", "neutral", "stable", "fixed") if word in words)


def _stability_of(stiffness: np.ndarray, load: float) -> str:
    if not len(stiffness):
        return "fixed"
    value = np.linalg.eigvalsh(0.5 * (stiffness + stiffness.T))
    zero = max(FLAT * float(np.abs(value).max()), 1e-9 * load)
    if value[0] < -zero:
        return "unstable"
    return "stable" if value[0] > zero else "neutral"


def _solution(m: Model, ready: Statics, q: np.ndarray, lam: np.ndarray, mobility) -> Solution:
    packed, rows = ready.packed, len(lam)
    phi, gamma, compact = np.zeros((1, rows)), np.zeros((1, rows)), np.zeros((1, rows, 6))
    rest = np.zeros((1, len(q)))
    tabulate(packed.system, ready.drive[None], q[None], rest, packed.ws, phi, compact, gamma)
    scaled = packed.jacobian() * packed.row_scale()[:, None] * packed.column_scale()
    singular = np.linalg.svd(scaled, compute_uv=False) if rows else np.ones(1)
    shape = (1, -1, 3)
    return Solution(
        mechanism=m,
        packed=packed,
        t=np.array([ready.time]),
        q=q.reshape(shape),
        v=rest.reshape(shape),
        a=np.zeros_like(rest).reshape(shape),
        wrench=wrenches(packed, compact, q[None], lam[None]),
        lam=lam[None],
        drives=ready.drive[None],
        margin=np.array([singular[-1] / singular[0]]),
        stats=Stats(float(np.abs(phi).max(initial=0.0)), 0.0, 0.0, 0.0, steps=1, inserted_steps=0),
        mobility=mobility,
        route="equilibrium",
    )


def check_no_states(m: Model, what: str) -> None:
    """Raise ModelError where a force carries states, such as pressures, which no pose gives to ``what``."""
    for force in m.forces.values():
        if force.kind.states is not None:
            raise ModelError(
                f"{m.name}: force '{force.name}' ({force.kind.name}) carries {' and '.join(force.kind.states.names)}, "
                f"which no pose tells, and {what} looks at poses alone. Simulate until it rests, or put "
                f"m.distance(...) of its length or m.actuator(...) of its force in its place"
            )
