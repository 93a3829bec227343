"""The view of a hydraulic cylinder: pressures, flows, and where the power of its supply goes.

    p_s Q_s + p_t Q_t = valve + leak + oil + piston      Q_s, Q_t: taken from supply and tank
    valve   sum of d Q over both edges;   leak   (p_a - p_b) q,   q = g (p_a - p_b)
    oil     p_a (Q_a - A_a l' - q) + p_b (Q_b + A_b l' + q), what compresses it
    piston  (p_a A_a - p_b A_b) l'

The balance holds at every moment, because each chamber's flow is counted with its own pressure.
"""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from mbsd.arrays.laws import compiled_laws, law_values
from mbsd.arrays.states import own_states
from mbsd.model.force import Force
from mbsd.results.force_view import ForceView
from mbsd.results.moved import Moved


@dataclass(frozen=True, kw_only=True)
class HydraulicView(ForceView):
    """Results of a hydraulic cylinder, (T,) arrays. Chamber A is the whole piston's.

    Pressures are absolute.
    """

    pressure_a: np.ndarray
    """Pa"""
    pressure_b: np.ndarray
    flow_a: np.ndarray
    """From the valve into chamber A (m^3/s)."""
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
    """What supply and tank give to the oil together (W): it is the sum of the four below."""
    valve_loss: np.ndarray
    """Lost in the valve (W)."""
    leak_loss: np.ndarray
    """Lost past the piston (W)."""
    oil_power: np.ndarray
    """What compresses the oil (W); negative where it expands."""
    piston_power: np.ndarray
    """What the oil gives to the piston (W), before friction, stops and the atmosphere."""

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
