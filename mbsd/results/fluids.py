"""Views of the gas behind a piston and of the oil in a hydraulic cylinder, with their work.

    W = int (p - p_outside) dV over a cycle        indicated work;  over the displaced volume: mean effective pressure

It is the integral of the force's power, by Gauss and Legendre on the quintics through the rows of the motion, in pieces
that end where one phase of the cycle follows another. Over whole cycles the pressure outside does no work.

Oil, and where the power of its supply goes:

    p_s Q_s + p_t Q_t = valve + leak + oil + piston      Q_s, Q_t: taken from supply and tank
    valve   sum of d Q over both edges;   leak   (p_a - p_b) q,   q = g (p_a - p_b)
    oil     p_a (Q_a - A_a l' - q) + p_b (Q_b + A_b l' + q), what compresses it
    piston  (p_a A_a - p_b A_b) l'

The balance holds at every moment, because each chamber's flow is counted with its own pressure.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields, replace

import numpy as np

from mbsd.arrays.laws import compiled_laws, law_values
from mbsd.arrays.reactions import marker_axes, marker_places
from mbsd.arrays.states import own_states
from mbsd.model.force import Chamber, CrankCycle, Force
from mbsd.model.laws.numbers import hermite_coefficients
from mbsd.results.force_view import ForceView
from mbsd.results.measured import Moved

POINTS = 6
"""Number of points of the quadrature between two rows."""
WHOLE = 1e-9
"""Part of a cycle by which a motion may miss a whole number of cycles."""
HALVINGS = 48
"""Number of halvings of a step, to find where a phase ends."""


@dataclass(frozen=True, kw_only=True)
class GasView(ForceView):
    """Force of gas on a piston, with (T,) pressure and volume; cycles count from the first row on."""

    pressure: np.ndarray
    """(T,) absolute (Pa)."""
    volume: np.ndarray
    """(T,) of the gas (m^3)."""
    crank_angle: np.ndarray | None = None
    """(T,) how far the crank has turned, in its own direction, since a top dead centre at which the cylinder fires
    (rad, never wrapped); None of gas without a cycle."""
    cycle_angle: float | None = None
    """Angle of the crank after which the pressure repeats (rad)."""
    displaced: float | None = None
    """Volume between the dead centres (m^3)."""
    indicated_work: np.ndarray | None = None
    """(C,) what the gas gives to the piston in each whole cycle of the motion (J), gas exchange included. Empty where
    the motion has no whole cycle, or its crank turns back."""

    @property
    def mean_effective_pressure(self) -> np.ndarray | None:
        """(C,) indicated work over displaced volume of each cycle (Pa)."""
        return None if self.indicated_work is None or self.displaced is None else self.indicated_work / self.displaced

    def columns(self, title: str) -> dict[str, np.ndarray]:
        """Return the columns of a force, with pressure and volume."""
        out = super().columns(title)
        return out | {f"{title}.pressure [Pa]": self.pressure, f"{title}.volume [m^3]": self.volume}


def gas_view(moved: Moved, view: ForceView, chamber: Chamber, power: Callable[[Moved], np.ndarray]) -> GasView:
    """The view of a force with what its chamber tells; ``power`` (T,) of the force along another motion."""
    assert view.effort is not None, "gas acts along one direction"
    assert view.value is not None
    own = {field.name: getattr(view, field.name) for field in fields(ForceView)}
    own["pressure"] = view.effort / chamber.area + chamber.outside
    own["volume"] = chamber.area * (view.value + chamber.shift)
    if chamber.cycle is None:
        return GasView(**own)
    cycle = chamber.cycle
    return GasView(
        **own,
        crank_angle=_turned(moved, moved.q, cycle, view) - cycle.sense * cycle.fires_at,
        cycle_angle=cycle.period,
        displaced=cycle.displaced,
        indicated_work=_works(moved, view, cycle, power),
    )


def _turned(moved: Moved, state: np.ndarray, cycle: CrankCycle, view: ForceView) -> np.ndarray:
    """Return (T,) of q or v (T, 3 nb): the crank's turn against the cylinder, in its own direction."""
    crank, frame = (3 * moved.packed.body_names.index(name) + 2 for name in (cycle.crank, view.bodies[0]))
    return cycle.sense * (state[:, crank] - state[:, frame])


def _works(moved: Moved, view: ForceView, cycle: CrankCycle, power: Callable[[Moved], np.ndarray]) -> np.ndarray:
    """(C,) of the whole cycles from the first row on."""
    angle = _turned(moved, moved.q, cycle, view) - cycle.sense * cycle.fires_at
    way = 1.0 if angle[-1] >= angle[0] else -1.0
    covered = way * (angle - angle[0])
    count = int(covered[-1] / cycle.period + WHOLE)
    if not count or (np.diff(covered) < 0.0).any():
        return np.zeros(0)
    left = np.flatnonzero(np.diff(moved.t) > 0.0)
    samples = np.stack([moved.q, moved.v, moved.a], axis=-1)
    quintics = hermite_coefficients(np.diff(moved.t)[left], samples[left], samples[left + 1])
    begins, lasts = moved.t[left], float(moved.t[left[-1] + 1])

    def states(at: np.ndarray) -> Moved:
        """The motion at times within it."""
        step = np.clip(np.searchsorted(begins, at, side="right") - 1, 0, len(begins) - 1)
        ahead = (at - begins[step])[:, None] ** np.arange(6)
        q = np.einsum("sp,scp->sc", ahead, quintics[step])
        v = np.einsum("sp,scp->sc", ahead[:, :5] * np.arange(1, 6), quintics[step][..., 1:])
        return replace(moved, t=at, q=q, v=v, a=np.zeros_like(q), approached=None)

    def covered_at(at: np.ndarray) -> np.ndarray:
        return way * (_turned(moved, states(at).q, cycle, view) - cycle.sense * cycle.fires_at - angle[0])

    ways = [cycle.period * np.arange(1, count + 1)]
    for change in cycle.changes:
        first = (way * (change - angle[0])) % cycle.period
        ways.append(first + cycle.period * np.arange(count))
    wanted = np.concatenate(ways)
    wanted = wanted[(wanted > 0.0) & (wanted < covered[-1])]
    rows = np.clip(np.searchsorted(covered, wanted, side="right") - 1, 0, len(covered) - 2)
    low, high = moved.t[rows], moved.t[rows + 1]
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        before = covered_at(middle) < wanted
        low, high = np.where(before, middle, low), np.where(before, high, middle)
    times = np.unique(np.concatenate([begins, [lasts], low]))
    half, middle = 0.5 * np.diff(times), 0.5 * (times[1:] + times[:-1])
    node, weight = np.polynomial.legendre.leggauss(POINTS)
    at = (middle[:, None] + half[:, None] * node).ravel()
    given = (power(states(at)).reshape(-1, POINTS) * weight).sum(axis=1) * half
    number = np.floor(covered_at(middle) / cycle.period).astype(int)
    inside = (number >= 0) & (number < count)
    return np.bincount(number[inside], weights=given[inside], minlength=count)


@dataclass(frozen=True, kw_only=True)
class HydraulicView(ForceView):
    """Results of a hydraulic cylinder, (T,) arrays. Chamber A is the whole piston's.

    Pressures are absolute.
    """

    pressure_a: np.ndarray
    """Pa"""
    pressure_b: np.ndarray
    flow_a: np.ndarray
    """Flow from the valve into chamber A (m^3/s)."""
    flow_b: np.ndarray
    leak: np.ndarray
    """Past the piston, from A to B (m^3/s)."""
    volume_a: np.ndarray
    """m^3"""
    volume_b: np.ndarray
    valve: np.ndarray
    """Opening of the valve, -1 .. 1."""
    supply_flow: np.ndarray
    """Taken from the supply (m^3/s)."""
    tank_flow: np.ndarray
    """Given back to the tank (m^3/s)."""
    supply_power: np.ndarray
    """Power that supply and tank give to the oil together (W): it is the sum of the four below."""
    valve_loss: np.ndarray
    """Lost in the valve (W)."""
    leak_loss: np.ndarray
    """Lost past the piston (W)."""
    oil_power: np.ndarray
    """Power that compresses the oil (W); negative where it expands."""
    piston_power: np.ndarray
    """Power that the oil gives to the piston (W), before friction, stops and the atmosphere."""

    def columns(self, title: str) -> dict[str, np.ndarray]:
        """Return the columns of a force, with pressures, flows, the valve and the power of the supply."""
        return super().columns(title) | {
            f"{title}.pressure_a [Pa]": self.pressure_a,
            f"{title}.pressure_b [Pa]": self.pressure_b,
            f"{title}.flow_a [m^3/s]": self.flow_a,
            f"{title}.flow_b [m^3/s]": self.flow_b,
            f"{title}.valve [1]": self.valve,
            f"{title}.supply_power [W]": self.supply_power,
        }


def hydraulic_view(moved: Moved, view: ForceView, force: Force) -> HydraulicView:
    """The view of a force with what its oil tells."""
    assert force.kind.oil is not None
    assert view.value is not None
    assert view.rate is not None
    oil = force.kind.oil(force)
    own = {field.name: getattr(view, field.name) for field in fields(ForceView)}
    states = np.zeros((len(moved.t), 2))
    if moved.states is not None:
        states = moved.states[:, own_states(moved.packed.forces, force.name)]
    a, b = states.T
    laws = law_values(moved.packed, compiled_laws(moved.packed, *moved.span), force, moved.t)
    opening = np.clip(laws.get("valve", np.full(len(moved.t), force.params.get("valve", 0.0))), -1.0, 1.0)
    flows, (volume_a, volume_b) = oil.flows(opening, a, b), oil.volumes(view.value)
    squeezed_a, squeezed_b = oil.compressing(flows, view.rate)
    given = oil.supply * flows.supply + oil.tank * flows.tank
    return HydraulicView(
        **own,
        pressure_a=a.copy(),
        pressure_b=b.copy(),
        flow_a=flows.into_a,
        flow_b=flows.into_b,
        leak=flows.leak,
        volume_a=volume_a,
        volume_b=volume_b,
        valve=opening,
        supply_flow=flows.supply,
        tank_flow=-flows.tank,
        supply_power=given,
        valve_loss=given - a * flows.into_a - b * flows.into_b,
        leak_loss=(a - b) * flows.leak,
        oil_power=a * squeezed_a + b * squeezed_b,
        piston_power=(a * oil.area_a - b * oil.area_b) * view.rate,
    )


@dataclass(frozen=True, kw_only=True)
class ValvedView(ForceView):
    """Results of a double-acting cylinder, (T,) arrays; pressures are absolute. Chamber A has no rod."""

    pressure_a: np.ndarray
    """Pa"""
    pressure_b: np.ndarray
    volume_a: np.ndarray
    """m^3"""
    volume_b: np.ndarray
    valve: np.ndarray
    """Travel of the valve from its middle, positive where it leads the supply into chamber A (m)."""
    valve_events: tuple[tuple[float, str], ...]
    """Times (s) and names: admission, cut-off, release, compression, of A or B."""

    @property
    def work(self) -> tuple[float, float]:
        """Work of the gas in chambers A and B over the motion (J), integrals of p dV by the trapezium rule."""
        a, b = (
            float((0.5 * (p[1:] + p[:-1]) * np.diff(volume)).sum())
            for p, volume in ((self.pressure_a, self.volume_a), (self.pressure_b, self.volume_b))
        )
        return a, b

    def columns(self, title: str) -> dict[str, np.ndarray]:
        """Return the columns of a force, with pressures, volumes and the valve."""
        return super().columns(title) | {
            f"{title}.pressure_a [Pa]": self.pressure_a,
            f"{title}.pressure_b [Pa]": self.pressure_b,
            f"{title}.volume_a [m^3]": self.volume_a,
            f"{title}.volume_b [m^3]": self.volume_b,
            f"{title}.valve [m]": self.valve,
        }


def valved_view(moved: Moved, view: ForceView, force: Force) -> ValvedView:
    """Return the view of a force with what its chambers and its valve tell."""
    valved, packed = force.kind.valved, moved.packed
    assert valved is not None
    assert view.value is not None
    own = {field.name: getattr(view, field.name) for field in fields(ForceView)}
    states = np.zeros((len(moved.t), 2))
    if moved.states is not None:
        states = moved.states[:, own_states(packed.forces, force.name)]
    body, along, across, begin = valved.valve(force, packed.masses)
    i, _ = packed.markers_of(force)
    b = 3 * packed.body_names.index(body)
    away = moved.q[:, b : b + 2] - marker_places(packed, moved.q, i)
    x, y = ((marker_axes(packed, moved.q, i, turned) * away).sum(axis=1) for turned in (False, True))
    travel = (along * x + across * y + begin) * (-1.0 if force.params["inside"] else 1.0)
    volume_a, volume_b = valved.volumes(force, view.value)
    events = _valve_events(moved.t, travel, force.params["lap"], force.params["exhaust_lap"])
    return ValvedView(
        **own, pressure_a=states[:, 0].copy(), pressure_b=states[:, 1].copy(), volume_a=volume_a, volume_b=volume_b,
        valve=travel, valve_events=events,
    )  # fmt: skip


def _valve_events(t: np.ndarray, travel: np.ndarray, lap: float, exhaust_lap: float) -> tuple[tuple[float, str], ...]:
    """Return when ports open and close along a travel (T,), between rows by straight lines."""
    out: list[tuple[float, str]] = []
    for chamber, own in (("A", travel), ("B", -travel)):
        for opens, closes, beyond in (
            ("admission", "cut-off", own - lap), ("release", "compression", -own - exhaust_lap),
        ):  # fmt: skip
            for k in np.flatnonzero((beyond[1:] > 0.0) != (beyond[:-1] > 0.0)):
                part = beyond[k] / (beyond[k] - beyond[k + 1])
                name = opens if beyond[k + 1] > 0.0 else closes
                out.append((float(t[k] + part * (t[k + 1] - t[k])), f"{name} {chamber}"))
    return tuple(sorted(out))
