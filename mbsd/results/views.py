"""Views of a solution: a frame, a joint, a driver, energy and mobility, and how they show themselves.

Arrays are (T,) in SI units. A view shows a few lines in a terminal and a small table in a notebook. The motion of a
frame of a body follows from that of its centre of mass:

    p = r + s,   p' = r' + omega s_perp,   p'' = r'' + alpha s_perp - omega^2 s;   s_perp = (-s_y, s_x)
"""

from __future__ import annotations

import html
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, fields
from html import escape
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np

from mbsd.base.errors import ModelError
from mbsd.base.names import Suggesting
from mbsd.base.quantity import counted

if TYPE_CHECKING:
    from mbsd.arrays.packing import Packed


UNITS = {
    "x": "m", "y": "m", "theta": "rad", "vx": "m/s", "vy": "m/s", "omega": "rad/s",
    "ax": "m/s^2", "ay": "m/s^2", "alpha": "rad/s^2", "fx": "N", "fy": "N", "torque": "N m",
    "kinetic": "J", "potential": "J", "total": "J", "power": "W",
}  # fmt: skip
"""Units of fields that always have the same."""


class ShownView(Suggesting):
    """A dataclass of arrays over time that shows how each begins and ends, and how far it goes."""

    other_words = MappingProxyType(
        {
            "angle": "theta",
            "position": "x",
            "velocity": "vx",
            "speed": "omega",
            "acceleration": "ax",
            "force_x": "fx",
            "force_y": "fy",
            "moment": "torque",
            "kinetic_energy": "kinetic",
            "potential_energy": "potential",
        }
    )

    def __repr__(self) -> str:
        rows = list(self._rows())
        outputs = next((len(array) for _, _, array in rows), 0)
        lines = [f"<{type(self).__name__}: {outputs} outputs"]
        for name, unit, array in rows:
            first, least, most, last = _numbers(array)
            lines.append(f"  {name:<13} {first:>10} .. {last:<10} least {least:>10}, most {most:>10} {unit}".rstrip())
        return "\n".join(lines) + ">"

    def _repr_html_(self) -> str:
        """The table of a notebook: a row for each quantity."""
        head = "".join(f"<th>{word}</th>" for word in ("", "unit", "first", "least", "most", "last"))
        body = "".join(
            f"<tr><th>{escape(name)}</th><td>{escape(unit)}</td>"
            + "".join(f"<td>{number}</td>" for number in _numbers(array))
            + "</tr>"
            for name, unit, array in self._rows()
        )
        return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"

    def _rows(self) -> Iterator[tuple[str, str, np.ndarray]]:
        """Name, unit and values of each array over time."""
        turning = getattr(self, "angular", None)
        for field in fields(self):  # type: ignore[arg-type]
            value: Any = getattr(self, field.name)
            if isinstance(value, np.ndarray) and value.ndim == 1 and len(value):
                yield field.name, UNITS.get(field.name) or _driven(field.name, turning), value


def _driven(name: str, angular: bool | None) -> str:
    """Units of a driver's numbers, which depend on what it drives."""
    if angular is None:
        return ""
    length = "rad" if angular else "m"
    return {"value": length, "rate": f"{length}/s", "acceleration": f"{length}/s^2",
            "effort": "N m" if angular else "N"}.get(name, "")  # fmt: skip


def _numbers(array: np.ndarray) -> list[str]:
    return [f"{number + 0.0:.4g}" for number in (array[0], np.nanmin(array), np.nanmax(array), array[-1])]


LEFT_OUT = (".ax [m/s^2]", ".ay [m/s^2]", ".vx [m/s]", ".vy [m/s]")
"""Ends of the names of results that the table does not show."""


def html_of(name: str, about: str, columns: Mapping[str, np.ndarray], moving: str) -> str:
    """Return HTML: a mechanism's name, text ``about`` it, its skeleton ``moving``, and its results."""
    rows = [
        (column, *(f"{end(values, initial=np.nan):.6g}" for end in (np.fmin.reduce, np.fmax.reduce)))
        for column, values in columns.items()
        if not column.endswith(LEFT_OUT)
    ]
    body = "".join("<tr>" + "".join(f"<td>{html.escape(cell)}</td>" for cell in row) + "</tr>" for row in rows)
    return (
        f"<p><b>{html.escape(name)}</b>: {html.escape(about)}</p>{moving}"
        "<details><summary>Least and largest values</summary>"
        "<table><tr><th>quantity</th><th>min</th><th>max</th></tr>"
        f"{body}</table></details>"
    )


@dataclass(frozen=True, repr=False)
class FrameView(ShownView):
    """Motion of a frame: (T,) arrays, m and rad by s."""

    x: np.ndarray
    y: np.ndarray
    theta: np.ndarray
    vx: np.ndarray
    vy: np.ndarray
    omega: np.ndarray
    ax: np.ndarray
    ay: np.ndarray
    alpha: np.ndarray


@dataclass(frozen=True, repr=False)
class Wrench(ShownView):
    """A force and a torque on a body, (T,) arrays: N along the world's axes, N m about the point (m)."""

    x: np.ndarray
    y: np.ndarray
    fx: np.ndarray
    fy: np.ndarray
    torque: np.ndarray

    @property
    def force(self) -> np.ndarray:
        """(T, 2) world axes (N)."""
        return np.stack([self.fx, self.fy], axis=-1)

    @property
    def magnitude(self) -> np.ndarray:
        """(T,) of the force (N), never negative."""
        return np.hypot(self.fx, self.fy)


@dataclass(frozen=True, repr=False)
class JointView(Wrench):
    """The wrench of a joint on its second body, at its second marker."""

    acts: Wrench
    """The same at the place where it acts: beside the marker where wheels, cams or curves touch; the torque is that
    about this place."""

    @property
    def place(self) -> np.ndarray:
        """(T, 2) where it acts, world (m)."""
        return np.stack([self.acts.x, self.acts.y], axis=-1)

    @property
    def reaction(self) -> np.ndarray:
        """(T, 2) force on the second body, world axes (N)."""
        return self.force


@dataclass(frozen=True, repr=False)
class DriverView(ShownView):
    """A driver: imposed value and its rates (m or rad by s), effort (N or N m), power (W), (T,) arrays."""

    name: str
    angular: bool
    value: np.ndarray
    rate: np.ndarray
    acceleration: np.ndarray
    effort: np.ndarray

    @property
    def power(self) -> np.ndarray:
        """(T,) effort times rate: what the driver puts into the mechanism."""
        return self.effort * self.rate

    @property
    def torque(self) -> np.ndarray:
        """(T,) the effort of an angle driver (N m)."""
        if not self.angular:
            raise ModelError(f"driver '{self.name}' imposes a length: it has a force, not a torque")
        return self.effort

    @property
    def force(self) -> np.ndarray:
        """(T,) the effort of a length driver (N)."""
        if self.angular:
            raise ModelError(f"driver '{self.name}' imposes an angle: it has a torque, not a force")
        return self.effort


@dataclass(frozen=True, repr=False)
class EnergyView(ShownView):
    """(T,) J."""

    kinetic: np.ndarray
    potential: np.ndarray

    @property
    def total(self) -> np.ndarray:
        """(T,) J."""
        return self.kinetic + self.potential


@dataclass(frozen=True)
class Stats(Suggesting):
    """How well the motion fulfils its equations: largest residuals over all times and rows."""

    position_residual: float
    """|Phi| of joints, drivers and closed contacts (m or rad); what sticks by friction has no position to keep."""
    velocity_residual: float
    """|J v - nu| (m/s or rad/s)."""
    acceleration_residual: float
    """|J a - gamma| (m/s^2 or rad/s^2)."""
    power_residual: float
    """|d(T + V)/dt - power of the drivers| (W)."""
    steps: int
    inserted_steps: int
    """Steps added between outputs to stay on the branch."""
    independent: bool = False
    """True if a simulation was integrated in independent coordinates (mbsd/dynamics/independent)."""


@dataclass(frozen=True)
class ContactView(Suggesting):
    """A contact, (T,) arrays: m and N, or rad and N m for stops of angles."""

    gap: np.ndarray
    rate: np.ndarray
    """Rate of the gap, by s."""
    normal: np.ndarray
    """Force that pushes the gap open, never negative."""
    friction: np.ndarray
    """Force along the sliding way."""

    @property
    def closed(self) -> np.ndarray:
        """(T,) where it pushes."""
        return self.normal > 0.0


def contact_view(
    packed: Packed, row: int, q: np.ndarray, v: np.ndarray, lam: np.ndarray, pairs: np.ndarray | None = None
) -> ContactView:
    """View of the contact whose gap is ``row``; q, v (T, nb, 3), lam (T, m), ``pairs`` of outlines (T, o)."""
    from mbsd.arrays.curve_branches import tabulate_along
    from mbsd.arrays.reactions import times_compact

    count, rows = len(lam), len(packed.ws.phi)
    flat_q, flat_v = q.reshape(count, -1), v.reshape(count, -1)
    phi, gamma, compact = np.zeros((count, rows)), np.zeros((count, rows)), np.zeros((count, rows, 6))
    drives = np.zeros((count, len(packed.motions) + 1, 3))
    tabulate_along(packed, drives, flat_q, flat_v, phi, compact, gamma, pairs)
    joint = packed.joint_of_row(row)
    friction = -lam[:, row + 1] if len(joint.kind.constraints) > 1 else np.zeros(count)
    return ContactView(phi[:, row], times_compact(packed, compact, flat_v)[:, row], -lam[:, row], friction)


def moved_frame(q: np.ndarray, v: np.ndarray, a: np.ndarray, local: np.ndarray, turned: float = 0.0) -> FrameView:
    """Return a frame at ``local`` (2,) from the centre of mass, from q, v, a (T, 3) of the latter.

    ``local`` is in body axes (m), and the frame is turned by the angle ``turned``.
    """
    c, s = np.cos(q[:, 2]), np.sin(q[:, 2])
    arm_x, arm_y = c * local[0] - s * local[1], s * local[0] + c * local[1]
    omega, alpha = v[:, 2], a[:, 2]
    return FrameView(
        x=q[:, 0] + arm_x,
        y=q[:, 1] + arm_y,
        theta=q[:, 2] + turned,
        vx=v[:, 0] - omega * arm_y,
        vy=v[:, 1] + omega * arm_x,
        omega=omega,
        ax=a[:, 0] - alpha * arm_y - omega**2 * arm_x,
        ay=a[:, 1] + alpha * arm_x - omega**2 * arm_y,
        alpha=alpha,
    )


@dataclass(frozen=True)
class Mobility(Suggesting):
    """Freedoms that the joints leave."""

    nominal: int
    """Degrees of freedom by counting rows."""
    dof: int
    """Degrees of freedom by rank."""
    redundant_rows: int
    """Number of rows that repeat others: the nominal count is wrong by this many."""
    redundant: tuple[str, ...]
    """Joints those rows belong to: one removable set."""
    singular: bool
    """The start pose has a lower rank than poses near it."""
    free_bodies: tuple[str, ...]
    """Bodies that can move."""

    def __str__(self) -> str:
        text = f"{counted(self.dof, 'degree')} of freedom ({self.nominal} nominal)"
        if self.redundant:
            rows = counted(self.redundant_rows, "redundant row")
            text += f", {rows}, removable at {', '.join(self.redundant)}"
        return text + (", start pose singular" if self.singular else "")
