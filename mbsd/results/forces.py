"""The view of a force (force_view.py) from a motion.

The wrenches are the generalised forces of the compiled loops themselves, moved from the centres of mass to the points
of action. A pair of bodies feels the same force with opposite signs at one point, or on one line.

Potential energy of the forces that have one: springs, elastic curves, gas, attraction, contacts, a turning frame.

    LINEAR      a (x - b)^2 / 2
    POWER       -a (x + b)^(c + 1) / (c + 1);   for c = -1  -a log(x + b)
    LAW_VALUE   -a int law dx

x: what the element measures (see forces/kind.py). Constants and laws of time and of rates do work instead.
Interactions bring their own.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from mbsd.arrays.directory import directory, slice_of
from mbsd.arrays.laws import compiled_laws
from mbsd.arrays.loads import pack_loads
from mbsd.arrays.packing import Packed
from mbsd.arrays.reactions import marker_axes, marker_places, relative_velocity
from mbsd.arrays.states import own_states, widened, with_states
from mbsd.base.codes import AXIS, LAW_VALUE, LINE, LINEAR, POTENTIAL_TERMS, POWER, PUSH, TURN
from mbsd.equations.loads import stretches, tabulate_loads
from mbsd.model.force import Element, Force, Term
from mbsd.model.laws.curve import Curve
from mbsd.results.fluids import gas_view, hydraulic_view, valved_view
from mbsd.results.force_view import ForceView
from mbsd.results.friction import friction_view
from mbsd.results.measured import Moved, depths, foot_of, measured

if TYPE_CHECKING:
    from mbsd.arrays.packing import Packed
    from mbsd.model.body import Marker
    from mbsd.model.force import Force


MEASURES = {LINE: "length", TURN: "angle", AXIS: "coordinate"}


def force_view(moved: Moved, name: str, effort: np.ndarray | None = None) -> ForceView:
    """Return the view of force ``name``; ``effort`` (T,) replaces its own law's.

    Raises ModelError for a failing law.
    """
    packed = moved.packed
    k = [force.name for force in packed.forces].index(name)
    force, markers = packed.forces[k], (int(packed.force_markers[k, 0]), int(packed.force_markers[k, 1]))
    way = _way(moved, force, *markers)
    if force.kind.of_reactions:
        effort = friction_view(packed, name, moved.q, moved.v, moved.lam, moved.held, moved.pairs).force
    if effort is None:
        load, power = loads_of(moved, k)
        places = _places(moved, force, *markers)
        wrenches = np.stack([_wrench(load, moved.q, b, point) for b, point in places], axis=1)
        effort = None if way is None else way.effort(wrenches[:, -1])
    else:
        assert way is not None, "friction and efforts have one direction"
        assert way.rate is not None
        places, power = _places(moved, force, *markers), effort * way.rate
        wrenches = np.stack([sign * way.wrench(effort) for sign in (-1.0, 1.0)][-len(places) :], axis=1)
    chamber = force.kind.chamber
    view = ForceView(
        name=name,
        kind=force.kind.name,
        bodies=tuple(packed.body_names[b] for b, _point in places),
        points=np.stack([point for _b, point in places], axis=1),
        wrenches=wrenches,
        power=power,
        potential=potential_of(packed, force, moved.q),
        measures=None if way is None else way.measures,
        value=None if way is None else way.value,
        rate=None if way is None else way.rate,
        effort=effort,
        several=force.kind.outside and len(places) > 1,
    )
    if force.kind.oil is not None:
        return hydraulic_view(moved, view, force)
    if force.kind.valved is not None:
        return valved_view(moved, view, force)
    if chamber is None:
        return view
    return gas_view(moved, view, chamber(force, packed.masses), lambda at: loads_of(at, k)[1])


@dataclass(frozen=True)
class _Way:
    """The one direction of a force: a unit vector on its second body, or its turning."""

    measures: str | None
    value: np.ndarray | None
    rate: np.ndarray
    unit: np.ndarray | None
    """(T, 2); None: it turns."""

    def effort(self, wrench: np.ndarray) -> np.ndarray:
        """(T,) of a wrench (T, 3) on the second body."""
        return wrench[:, 2].copy() if self.unit is None else (wrench[:, :2] * self.unit).sum(axis=1)

    def wrench(self, effort: np.ndarray) -> np.ndarray:
        """(T, 3) on the second body, of an effort (T,)."""
        out = np.zeros((len(effort), 3))
        if self.unit is None:
            out[:, 2] = effort
        else:
            out[:, :2] = effort[:, None] * self.unit
        return out


def _way(moved: Moved, force: Force, i: int, j: int) -> _Way | None:
    """None where several elements, or none, make up the force."""
    packed, q, v = moved.packed, moved.q, moved.v
    if _touches(force):
        foot = foot_of(packed, force, q)
        return _Way("gap", foot.gap, (foot.normal * relative_velocity(packed, q, v, i, j)).sum(axis=1), foot.normal)
    elements = _elements(packed, force)
    if len(elements) != 1:
        return None
    [element] = elements
    if element.kind == TURN:
        bi, bj = 3 * packed.system.marker_body[[i, j]]
        return _Way("angle", measured(packed, element, i, j, q), v[:, bj + 2] - v[:, bi + 2], None)
    speed = relative_velocity(packed, q, v, None if element.kind == PUSH else i, j)
    if element.kind == LINE:
        gap = marker_places(packed, q, j) - marker_places(packed, q, i)
        length = np.hypot(*gap.T)[:, None]
        unit = np.divide(gap, length, out=np.zeros_like(gap), where=length > 0.0)
    else:
        unit = marker_axes(packed, q, i, element.turned)
    value = None if element.kind == PUSH else measured(packed, element, i, j, q)
    return _Way(MEASURES.get(element.kind), value, (unit * speed).sum(axis=1), unit)


def _touches(force: Force) -> bool:
    """Return True if it acts where surfaces touch."""
    return force.kind.surface is not None or force.kind.journal is not None


def _elements(packed: Packed, force: Force) -> tuple[Element, ...]:
    """Return the elements of a force; a friction has that along which its joint moves."""
    if force.kind.along is not None:
        return (force.kind.along(force),)
    if not force.kind.of_reactions:
        return force.kind.elements(force)
    [joint] = [joint for joint in packed.joints if joint.name == force.params["joint"]]
    return (Element(TURN if joint.kind.pair == "pin" else AXIS, ()),)


def _places(moved: Moved, force: Force, i: int, j: int) -> list[tuple[int, np.ndarray]]:
    """Each body that feels the force, by number, and where (T, 2), world (m); the second body is the last."""
    packed, q = moved.packed, moved.q
    if "bodies" in force.params:
        return [(b, _place(packed, q, b, (0.0, 0.0))) for b in map(packed.body_names.index, force.params["bodies"])]
    others = [interaction.j for interaction in force.kind.interactions(force, packed.masses)]
    if force.kind.outside and others:
        return [(b, _place(packed, q, b, (marker.x, marker.y))) for marker in others for b in [_number(packed, marker)]]
    bi, bj = (int(b) for b in packed.system.marker_body[[i, j]])
    second = marker_places(packed, q, j)
    if force.kind.outside:
        return [(bj, second)]
    if _touches(force):
        foot = foot_of(packed, force, q).place
        return [(bi, foot), (bj, foot)]
    if force.kind.mesh is not None:
        first = marker_places(packed, q, i)
        pitch_point = first + force.kind.mesh.pitch(force) * (second - first)
        return [(bi, pitch_point), (bj, pitch_point)]
    elements = _elements(packed, force)
    on_line = bool(elements) and all(element.kind in (LINE, TURN) for element in elements)
    return [(bi, marker_places(packed, q, i) if on_line else second), (bj, second)]


def _number(packed: Packed, marker: Marker) -> int:
    return packed.body_names.index(marker.body.name)


def _place(packed: Packed, q: np.ndarray, b: int, place: tuple[float, float]) -> np.ndarray:
    """(T, 2) of a place in the author's frame of body b."""
    x, y = np.array(place) - packed.com[b]
    c, s = np.cos(q[:, 3 * b + 2]), np.sin(q[:, 3 * b + 2])
    return q[:, 3 * b : 3 * b + 2] + np.stack([c * x - s * y, s * x + c * y], axis=1)


def loads_of(moved: Moved, k: int) -> tuple[np.ndarray, np.ndarray]:
    """(T, 3 nb) generalised forces of force number k alone, those on ground too, and its power (T,)."""
    packed = moved.packed
    alone = replace(packed, forces=[packed.forces[k]], force_markers=packed.force_markers[k : k + 1], motions=[])
    q, v = moved.q, moved.v
    if moved.states is not None and packed.forces[k].kind.states is not None:
        alone = with_states(alone)
        own = moved.states[:, own_states(packed.forces, packed.forces[k].name)]
        q, v = widened(alone, q), widened(alone, v, own)
    loads, laws = pack_loads(alone), compiled_laws(alone, *moved.span)
    load, power = np.zeros_like(q), np.zeros(len(moved.t))
    none = np.zeros(0, np.int64)  # loads look at no markers
    system = packed.system.changed(moving=none, directed=none)
    approached = None
    if moved.approached is not None:
        approached = moved.approached[:, slice_of(directory(packed)[packed.forces[k].name].interaction)]
    for at in stretches(loads, approached, len(moved.t)):
        motion = moved.t[at], q[at], v[at]
        tabulate_loads(system, loads, laws, *motion, packed.ws, load[at], power[at])
    packed.specials.check()
    return load[:, : moved.q.shape[1]], power


def _wrench(load: np.ndarray, q: np.ndarray, b: int, point: np.ndarray) -> np.ndarray:
    """(T, 3) of body b, moved from its centre of mass to a point (T, 2)."""
    out = load[:, 3 * b : 3 * b + 3].copy()
    arm = point - q[:, 3 * b : 3 * b + 2]
    out[:, 2] -= arm[:, 0] * out[:, 1] - arm[:, 1] * out[:, 0]
    return out


def potential_of(packed: Packed, force: Force, q: np.ndarray) -> np.ndarray:
    """(T,) potential energy (J) of one force along poses q (T, 3 nb)."""
    i, j = packed.markers_of(force)
    out = np.zeros(len(q))
    for element in force.kind.elements(force):
        terms = [term for term in element.terms if term.kind in POTENTIAL_TERMS]
        if terms:
            x = measured(packed, element, i, j, q)
            out += sum(_term(force, term, x) for term in terms)
    if force.kind.potential is not None:
        out += force.kind.potential(force, packed.masses, q)
    if force.kind.depth_potential is not None:
        out += force.kind.depth_potential(force, depths(packed, force, q)).sum(axis=0)
    return out


def _term(force: Force, term: Term, x: np.ndarray) -> np.ndarray:
    if term.kind == LINEAR:
        return 0.5 * term.a * (x - term.b) ** 2
    if term.kind == POWER:
        if term.c == -1.0:
            return -term.a * np.log(x + term.b)
        return -term.a * (x + term.b) ** (term.c + 1.0) / (term.c + 1.0)
    assert term.kind == LAW_VALUE
    assert term.law is not None
    law = force.laws[term.law]
    assert isinstance(law, Curve), "laws of a length or an angle are curves"
    return -term.a * law.integral(x)
