"""Results by name: arrays over time in the author's body frames, SI units.

sol.t                              (T,) s
sol.body("coupler").theta          also x, y, vx, vy, omega, ax, ay, alpha
sol.joint("B").reaction            (T, 2) force on the joint's second body; fx, fy, torque, x, y, place, magnitude
sol.driver("motor").torque         also effort, force, value, rate, power
sol.force("spring").force          (T, 2) on its second body; torque, length, rate, effort, power and more
sol.force("gas_1").pressure        of gas, with volume, indicated_work of each cycle, mean_effective_pressure
sol.force("boom").pressure_a       of hydraulic cylinders, with pressure_b, flows, volumes, supply_power and losses
sol.friction("bearing").force          of joints, with normal and rate; sol.contact("floor").normal and more
sol.point("P").x                   of traced points
sol.energy.kinetic, .potential
sol.centre_of_mass()               of all bodies; sol.shaking() force, moment, couples of inertia on the frame
sol.orders(sol.shaking().force)    harmonics against the crank
"""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from types import MappingProxyType
from typing import TYPE_CHECKING, Generic

import numpy as np

from mbsd.arrays.starts import AnyModel
from mbsd.base.arguments import finite_number, number_array, number_pair
from mbsd.base.errors import ModelError
from mbsd.base.names import Named, Suggesting, no_such, shown
from mbsd.base.quantity import counted
from mbsd.model.event import Happening
from mbsd.results.acting import acting
from mbsd.results.columns import columns
from mbsd.results.drawer import drawer_of
from mbsd.results.force_view import ForceView
from mbsd.results.forces import force_view, potential_of
from mbsd.results.friction import FrictionView, friction_view
from mbsd.results.measured import Moved
from mbsd.results.orders import Orders, crank_of, orders
from mbsd.results.shaking import Planes, PointView, Shaking, centre_of_mass, planes_of, shaking
from mbsd.results.views import (
    ContactView,
    DriverView,
    EnergyView,
    FrameView,
    JointView,
    Stats,
    contact_view,
    html_of,
    moved_frame,
)

if TYPE_CHECKING:
    import pandas
    from matplotlib.axes import Axes

    from mbsd.arrays.efforts_beside import Side
    from mbsd.arrays.packing import Packed
    from mbsd.model.body import Marker
    from mbsd.pictures import Animation, Picture, View
    from mbsd.results.views import Mobility

SHOWN = 40
"""Bodies: a notebook shows no larger mechanism in motion unasked."""


RETURNED = 1e-7
"""Largest difference between both ends of a period: m, rad and their rates, relative above 1."""


Ends = tuple[tuple[np.ndarray, np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray, np.ndarray]]


def returned(ends: Ends) -> bool:
    """Return True if both ends have the same pose and rates (nb, 3) but for whole turns.

    Rates are velocities and accelerations.
    """
    first, last = ends
    for order, (start, end) in enumerate(zip(first, last, strict=True)):
        gap = end - start
        if order == 0:
            gap[:, 2] -= 2 * math.pi * (gap[:, 2] / 2 / math.pi).round()
        if np.abs(gap).max() > RETURNED * max(1.0, float(np.abs(start).max())):
            return False
    return True


@dataclass(frozen=True, eq=False)
class Solution(Suggesting, Generic[AnyModel]):
    """Motion of one mechanism. q, v, a hold centres of mass, (T, nb, 3); views have the author's frames."""

    other_words = MappingProxyType(
        {
            "bodies": "body",
            "joints": "joint",
            "drivers": "driver",
            "points": "point",
            "contacts": "contact",
            "time": "t",
            "times": "t",
            "plot": "draw",
            "kinetic": "energy",
            "potential": "energy",
        }
    )
    mechanism: AnyModel
    """The solved model: a Mechanism, if it was solved by one of its methods."""
    packed: Packed
    t: np.ndarray
    q: np.ndarray
    v: np.ndarray
    a: np.ndarray
    wrench: np.ndarray
    lam: np.ndarray
    drives: np.ndarray
    margin: np.ndarray | Callable[[], np.ndarray] = field(repr=False)
    """``singularity_margin``, or what finds it when it is asked for."""
    stats: Stats
    mobility: Mobility
    route: str = "integration"
    """Method that found the positions: in closed form group by group, by Newton-Raphson, or by integration."""
    work: np.ndarray | None = None
    """(T,) of forces and drivers since the start (J), gravity left out, of a simulation."""
    changes: tuple[str, ...] = ()
    """Changes of the given start that made a simulation consistent."""
    events: tuple[Happening, ...] = ()
    """Events of a simulation: of contacts, stops and user events."""
    held: np.ndarray | None = field(default=None, repr=False)
    """(T, m) which rows of J held, of a simulation; None: all."""
    pairs: np.ndarray | None = field(default=None, repr=False)
    """(T, o) pairs of outlines that touched, of a simulation; None without outlines."""
    span: tuple[float, float] | None = None
    """Times (s) over which a simulation prepared the laws of its forces; None: those of ``t``."""
    law_times: np.ndarray | None = field(default=None, repr=False)
    """(T,) times (s) at which laws are evaluated: ``t``, but for rows beside a jump of a force; None: ``t``."""
    approached: np.ndarray | None = field(default=None, repr=False)
    """(T, n) how fast each contact by penalty approached when it began (m/s), where one asks for it; NaN: not yet."""
    states: np.ndarray | None = field(default=None, repr=False)
    """(T, n) of all forces that carry states, such as pressures (Pa), in the order of the forces; None: none does."""
    efforts: Mapping[str, np.ndarray] = field(default_factory=dict, repr=False)
    """(T,) of forces that act by these instead of by their own laws (inverse dynamics)."""
    between: Callable[[np.ndarray], Solution] | None = field(default=None, repr=False)
    """Motion of a simulation at other times; see :meth:`at`."""
    beside: tuple[Beside, ...] = field(default=(), repr=False)
    """Motions beside change points, from which efforts at outputs near these follow."""
    traces: Mapping[str, Marker] | None = field(default=None, repr=False)
    """Traced points as they were when this was solved."""
    planes: Planes | None = field(default=None, repr=False)
    """Places of the bodies along the normal of the plane, as they were then."""

    def __post_init__(self) -> None:
        if self.traces is None:
            object.__setattr__(self, "traces", dict(self.mechanism.traces))
        if self.planes is None:
            object.__setattr__(self, "planes", planes_of(self.mechanism.bodies.values()))

    @cached_property
    def singularity_margin(self) -> np.ndarray:
        """(T,) smallest over largest singular value of the scaled Jacobian; 0 at a singular pose."""
        return self.margin() if callable(self.margin) else self.margin

    def at(self, times: float | Sequence[float] | np.ndarray) -> Solution:
        """Return a simulation at rising times (s), as exact as at its outputs.

        At the time of an event it is the motion after it.

        Raises ModelError for a sweep and for times outside.
        """
        wanted = np.atleast_1d(number_array(f"{self.mechanism.name}: times", times))
        if self.between is None:
            raise ModelError(f"{self.mechanism.name}: only a simulation goes on to other times; sweep(times=...)")
        if wanted.ndim != 1 or not len(wanted) or not (np.diff(wanted) > 0).all():
            raise ModelError(f"{self.mechanism.name}: times must be rising numbers, got {shown(times)}")
        if not (self.t[0] <= wanted[0] and wanted[-1] <= self.t[-1]):
            raise ModelError(
                f"{self.mechanism.name}: the simulation covers {self.t[0]:g} .. {self.t[-1]:g} s, "
                f"not {wanted[0]:g} .. {wanted[-1]:g} s; simulate longer"
            )
        return self.between(wanted)

    def only(self, rows: np.ndarray) -> Solution[AnyModel]:
        """Return the motion at some of its outputs alone, by a mask ``rows`` (T,) of bool."""
        margin = self.margin
        arrays = ("work", "held", "pairs", "law_times", "approached", "states")
        known = {name: part[rows] for name in arrays if (part := getattr(self, name)) is not None}
        return replace(
            self,
            t=self.t[rows],
            q=self.q[rows],
            v=self.v[rows],
            a=self.a[rows],
            wrench=self.wrench[rows],
            lam=self.lam[rows],
            drives=self.drives[rows],
            margin=partial(_rows_of, margin, rows) if callable(margin) else margin[rows],
            efforts={name: effort[rows] for name, effort in self.efforts.items()},
            **known,
        )

    @property
    def is_defined(self) -> np.ndarray:
        """(T,) of bool: whether all reactions and efforts exist; see ``notes`` for where they do not."""
        return ~(np.isnan(self.lam).any(axis=1) | np.isnan(self.wrench).any(axis=(1, 2)))

    @cached_property
    def notes(self) -> tuple[str, ...]:
        """A sentence for each output at which reactions or efforts do not exist: there they are NaN."""
        packed, out = self.packed, []
        joints = packed.passive_joints
        for row in np.flatnonzero(~self.is_defined).tolist():
            lost = {
                "reactions of": [j.name for k, j in enumerate(joints) if np.isnan(self.wrench[row, k]).any()],
                "efforts of": [
                    name
                    for k, name in enumerate(packed.driver_names)
                    if np.isnan(self.lam[row, packed.driver_rows + k])
                ],
            }
            words = " and ".join(f"{what} {', '.join(names)}" for what, names in lost.items() if names)
            out.append(
                f"row {row}, t = {self.t[row]:.9g} s: the pose is a change point, at which some efforts do not exist "
                f"(they grow without bound, or velocities jump); NaN: {words or 'multipliers'}"
            )
        return tuple(out)

    def contact(self, name: str) -> ContactView:
        """Gap and forces of a contact, stop or rope of a simulation."""
        rows = self.packed.contact_gaps()
        self._index(name, list(rows), "contact of a simulation")
        return contact_view(self.packed, rows[name], self.q, self.v, self.lam, self.pairs)

    def friction(self, name: str) -> FrictionView:
        """Friction of a joint, by the name that ``m.friction`` gave it."""
        names = [force.name for force in self.packed.forces if force.kind.of_reactions]
        self._index(name, names, "friction of a joint")
        return friction_view(self.packed, name, self.q, self.v, self.lam, self.held, self.pairs)

    def force(self, name: str) -> ForceView:
        """Return the results of a force: force, torque and point on each body, what it measures, its power.

        Of every force of ``m.forces``: springs, contacts by penalty, friction, functions of the user. A contact
        without give is ``contact(name)``, a joint ``joint(name)``. Raises ModelError where a user's function fails.
        """
        self._index(name, [force.name for force in self.packed.forces], "force")
        flat_q, flat_v, flat_a = (
            np.ascontiguousarray(part.reshape(len(self.t), -1)) for part in (self.q, self.v, self.a)
        )
        span = self.span or (float(self.t[0]), float(self.t[-1]))
        times = self.t if self.law_times is None else self.law_times
        moved = Moved(
            self.packed, times, flat_q, flat_v, self.lam, self.held, span, flat_a, self.approached, self.states,
            self.pairs,
        )  # fmt: skip
        return force_view(moved, name, self.efforts.get(name))

    @property
    def forces(self) -> dict[str, ForceView]:
        """All forces by name, in the order they were added."""
        return Named("force", {force.name: self.force(force.name) for force in self.packed.forces})

    def body(self, name: str) -> FrameView:
        """Motion of a body's frame."""
        return self._frame(self._index(name, self.packed.body_names, "body"), (0.0, 0.0))

    def point(self, name: str) -> FrameView:
        """Motion of a traced point (and of its marker's direction)."""
        traces = {**self.mechanism.traces, **(self.traces or {})}
        self._index(name, list(traces), "traced point")
        marker = traces[name]
        return self._frame(self.packed.body_names.index(marker.body.name), (marker.x, marker.y), marker.angle)

    def place(self, marker: Marker) -> FrameView:
        """Motion of a marker of the mechanism, also of one that is not traced."""
        self._index(marker.body.name, self.packed.body_names, "body")
        return self._frame(self.packed.body_names.index(marker.body.name), (marker.x, marker.y), marker.angle)

    def joint(self, name: str) -> JointView:
        """Place and reaction of a joint."""
        joints = self.packed.passive_joints
        k = self._index(name, [joint.name for joint in joints], "joint")
        marker = joints[k].j  # as solved, whatever was changed since
        place = self._frame(self.packed.body_names.index(marker.body.name), (marker.x, marker.y))
        fx, fy, torque = self.wrench[:, k].T
        return JointView(place.x, place.y, fx, fy, torque, acting(self.packed, self.q, self.wrench, k))

    def tension(self, name: str) -> np.ndarray:
        """Return the pull (N) of a cable in each of its spans, (T, spans), or of one span or rod by its name, (T,).

        It is negative where a taut cable or a rod pushes.
        """
        pulling = [("distance",), ("span",)]
        rows = {
            joint.name: self.packed.rows_of(k).start
            for k, joint in enumerate(self.packed.joints)
            if joint.kind.constraints in pulling and joint.motion is None
        }
        if name in rows:
            return self._pull(rows[name])
        spans = [rows[f"{name} {k + 1}"] for k in range(len(rows)) if f"{name} {k + 1}" in rows]
        self._index(name, [*rows, *([name] if spans else [])], "cable, span or rod")
        return np.stack([self._pull(row) for row in spans], axis=1)

    def _pull(self, row: int) -> np.ndarray:
        """Return the multiplier (T,) of a row whose coordinate is a length, positive where it pulls."""
        return self.lam[:, row] if row < self.packed.contact_rows else -self.lam[:, row]

    def driver(self, name: str) -> DriverView:
        """Value, effort and power of a driver."""
        k = self._index(name, list(self.mechanism.drivers), "driver")
        row = self.packed.driver_rows + k
        value, rate, acceleration = self.drives[:, k + 1].T
        angular = self.mechanism.drivers[name].kind.angular
        return DriverView(name, angular, value, rate, acceleration, -self.lam[:, row])

    @cached_property
    def energy(self) -> EnergyView:
        """Kinetic and potential energy of the mechanism, springs included; weight counts from the origin."""
        mass, inertia, gravity = self.packed.system.mass, self.packed.system.inertia, self.packed.system.gravity
        kinetic = 0.5 * (mass * (self.v[..., 0] ** 2 + self.v[..., 1] ** 2) + inertia * self.v[..., 2] ** 2).sum(axis=1)
        potential = -(mass[:, None] * self.q[..., :2] @ gravity[:, None]).sum(axis=(1, 2))
        for force in self.packed.forces:
            potential = potential + potential_of(self.packed, force, self.q.reshape(len(self.t), -1))
        return EnergyView(kinetic, potential)

    def centre_of_mass(self) -> PointView:
        """Motion of the centre of mass of all moving bodies. Raises ModelError where none has mass."""
        return centre_of_mass(self.packed, self.q, self.v, self.a)

    def shaking(self, about: tuple[float, float] = (0.0, 0.0), z: float = 0.0) -> Shaking:
        """Return force (N), moment and couples (N m) of all bodies' inertia on the frame.

        They are about a place on ground (m).

        The moment is about the axis through ``about``, normal to the plane; the couples mx and my, of bodies in
        different places z, about axes through ``z``. Weight, springs, gas and other forces are not in it. Raises
        ModelError for what is no place.
        """
        what = f"{self.mechanism.name}: shaking"
        place = *number_pair(f"{what}: about", about), finite_number(f"{what}: z", z)
        assert self.planes is not None
        return shaking(self.packed, self.planes, self.q, self.v, self.a, place)

    def orders(self, quantity: np.ndarray, crank: str | None = None, turns: int | None = None) -> Orders:
        """Return harmonics of a (T,) or (T, 2) result against the angle of ``crank``.

        Such a result is ``sol.shaking().force``.

        ``crank``: a body that turns one way; by default the one that a driver turns, else the first on a pin of ground
        that makes a whole turn. ``turns``: whole turns of a cycle; by default as many as it takes to repeat. Raises
        ModelError where there is no crank, for less than a cycle and for a quantity of another shape.
        """
        name = crank_of(self) if crank is None else crank
        angle = self.body(name).theta
        values = number_array(f"{self.mechanism.name}: orders: the quantity", quantity)
        try:
            return orders(name, angle, values, turns)
        except ModelError as error:
            raise ModelError(f"{self.mechanism.name}: {error}") from None

    @cached_property
    def audit(self) -> np.ndarray | None:
        """(T,) T + V - work without potential (J) of a simulation: constant but for integration errors.

        V holds gravity, springs and other forces with a potential; drivers, dampers and loads from outside do work.
        """
        if self.work is None:
            return None
        elastic = np.zeros(len(self.t))
        for force in self.packed.forces:
            elastic = elastic + potential_of(self.packed, force, self.q.reshape(len(self.t), -1))
        return self.energy.total - (self.work + elastic - elastic[0])

    @cached_property
    def period(self) -> float | None:
        """The time spanned (s) if pose, velocity and acceleration return to those of the start; else None."""
        ends = ((part[0], part[-1]) for part in (self.q, self.v, self.a))
        first, last = zip(*ends, strict=True)
        return float(self.t[-1] - self.t[0]) if returned((first, last)) else None

    def to_frame(self) -> pandas.DataFrame:
        """Return all results as a pandas DataFrame indexed by time; columns name their units.

        It needs the extra ``pandas``.
        """
        try:
            import pandas
        except ImportError as error:
            raise ModelError("to_frame needs pandas: install mbsd[pandas]") from error
        return pandas.DataFrame(self.columns(), index=pandas.Index(self.t, name="t [s]"))

    def columns(self) -> dict[str, np.ndarray]:
        """All results as (T,) arrays, named ``coupler.theta [rad]``.

        Where a trace, joint, driver or force has the name of something else, its columns say what it is:
        ``joint A.fx [N]``.
        """
        return columns(self)

    def draw(
        self,
        t: float | None = None,
        step: int | None = None,
        ax: Axes | None = None,
        frames: bool = False,
        names: bool = True,
    ) -> Picture:
        """Draw the skeleton at time ``t`` (s, nearest output) or output ``step``, with traced paths.

        See :meth:`mbsd.mechanism.Mechanism.draw`.
        """
        return drawer_of(self.mechanism).draw(self, t, step, ax, frames, names)

    def animate(
        self,
        path: str | os.PathLike[str],
        show: str | Sequence[str] = "all",
        rate: float | None = None,
        fps: float = 30.0,
        size: tuple[int, int] | None = None,
        names: bool | str = True,
        progress: Callable[[int, int], object] | None = None,
    ) -> Animation:
        """The moving skeleton as a film, MP4 or GIF by the path's ending; traced points leave trails.

        ``show``: one or more of ``velocities``, ``accelerations``, ``forces``, ``reactions`` and ``energy`` over one
        another, ``()`` for the machine alone, or ``"all"``: each in a picture of its own, side by side. Arrows have one
        scale for the whole film, shown by one of a round number. ``rate``: seconds of the motion in a second of the
        film; by default real time, or a round part or multiple of it, stated in the picture, where that would be too
        short or too long to see. ``fps``: pictures a second; ``size``: pixels, (1280, 720) by default, (800, 450) of a
        GIF. ``names``: True for three that matter, ``"all"``, or False. A motion that repeats (``period``) loops;
        others play once. ``progress`` is called with the number of pictures drawn, and of all. Needs the extra
        ``animate``; raises ModelError for what cannot be drawn or written.
        """
        return drawer_of(self.mechanism).animate(self, path, show, rate, fps, size, names, progress)

    def view(self, path: str | os.PathLike[str] | None = None, height: float = 380.0) -> View:
        """The skeleton in motion as a small page that plays by itself, ``height`` pixels high in a notebook.

        With ``path`` it is written there as an HTML file, too, which needs no network. A motion that repeats
        (``period``) loops; others begin anew. Raises ModelError for what cannot be shown or written.
        """
        return drawer_of(self.mechanism).view(self, path, height)

    def __repr__(self) -> str:
        return (
            f"<Solution {self.mechanism.name}: {counted(len(self.t), 'time')}, t = {self.t[0]:g} .. {self.t[-1]:g} s, "
            f"largest residual {self.stats.position_residual:.1e}{self._noted()}>"
        )

    def _noted(self) -> str:
        return f"; {len(self.notes)} with efforts that do not exist: see notes" if self.notes else ""

    def _repr_html_(self) -> str:
        moving = self.view()._repr_html_() if len(self.mechanism.bodies) <= SHOWN and len(self.t) > 1 else ""
        span = f"{counted(len(self.t), 'time')} from {self.t[0]:g} to {self.t[-1]:g} s"
        about = f"{self.mobility}; {span}; largest residual {self.stats.position_residual:.1e}{self._noted()}"
        return html_of(self.mechanism.name, about, self.columns(), moving)

    def _frame(self, b: int, place: tuple[float, float], turned: float = 0.0) -> FrameView:
        """The frame at ``place`` of body b's author frame."""
        local = np.array(place) - self.packed.com[b]
        return moved_frame(self.q[:, b], self.v[:, b], self.a[:, b], local, turned)

    def _index(self, name: str, names: list[str], what: str) -> int:
        if not isinstance(name, str) or name not in names:
            raise ModelError(f"{self.mechanism.name}: {no_such(what, name, names)}")
        return names.index(name)


@dataclass(frozen=True, eq=False)
class Beside:
    """A motion at poses beside a change point."""

    side: Side
    factor: np.ndarray
    """(N + R,) the determinant of J there, then at the outputs near the change point."""
    motion: Solution


def _rows_of(whole: Callable[[], np.ndarray], rows: np.ndarray) -> np.ndarray:
    return whole()[rows]
