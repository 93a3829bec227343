"""Gas behind a piston, and gas struts.

Gas behind a piston: polytropic pressure against the air outside.

    F = A (p - p_air),   p = p_0 ((x_0 + c) / (x + c))^gamma        element AXIS

x is how far marker j lies along the x axis of marker i, x_0 where the pressure is p_0, c the length of the dead space.
Positive F pushes j away. Source: Heywood, Internal Combustion Engine Fundamentals, ch. 4 (polytropic compression).

Gas strut, as of tailgates and bonnets: a rod pushed into a cylinder of compressed nitrogen.

    s = L - l                                 how far the rod is pushed in;  l: distance of the points, L extended
    F = F_1 (g / (g - s))^n - c l' - F_R tanh(l' / v_0) + stops
    g = S / (1 - 1 / X)                       length of the gas in bores of the rod;  X = F_2 / F_1 at s = S, n = 1
    c = c_in + (1 + tanh(l' / v_0)) (c_out - c_in) / 2: in shorter, out longer; c_out rises to c_end in the last way w
    stops   -k d (1 + e l') beyond L,  k d (1 - e l') below L - S;  d: how far beyond, never pulling back

The rod alone takes volume from the gas, since the piston is open on both sides, so the force depends on the area of the
rod and hardly rises: X is 1.2 to 1.4. Makers measure F_1 and F_2 slowly and 5 mm before either end, when the gas is
as warm as the air; in fast motion n is up to 1.4. Positive F pushes the points apart. Gas and stops have a potential
energy. At 50 to 150 bar the air outside is left out.

Source: data sheets of makers, which give F_1, F_2, X, friction and the damping of both ways; polytropic gas.
"""

from __future__ import annotations

import numpy as np

from mbsd.base.codes import AXIS, CONSTANT, LINE, POWER
from mbsd.base.errors import ModelError
from mbsd.model.body import Marker
from mbsd.model.entries import (
    above_zero,
    add_force,
    amounts_given,
    exponent_given,
)
from mbsd.model.force import Chamber, Element, Force, ForceKind, Interaction, Masses, Term, marker_place, register_force
from mbsd.model.mechanism import Model


def _elements(force):
    p = force.params
    gamma = p["exponent"]
    factor = p["area"] * p["pressure"] * (p["at"] + p["clearance"]) ** gamma
    terms = Term(POWER, factor, p["clearance"], -gamma), Term(CONSTANT, -p["area"] * p["outside"])
    return (Element(AXIS, terms),)


GAS = register_force(
    ForceKind(
        "gas",
        _elements,
        chamber=lambda force, masses: Chamber(*(force.params[key] for key in ("area", "clearance", "outside"))),
        look="cylinder",
        example=lambda m, i, j: m.gas("example", i, j, area=0.002, pressure=1.1e5, at=0.12, clearance=8.0),
    )
)


@GAS.adds
def gas(
    m: Model,
    name: str,
    cylinder: Marker,
    piston: Marker,
    area: float,
    pressure: float,
    at: float,
    clearance: float = 0.0,
    exponent: float = 1.3,
    outside: float = 101325.0,
) -> Force:
    """Gas between a cylinder's head and a piston, along the x axis of marker ``cylinder``.

    ``pressure`` (Pa, absolute) where the piston lies ``at`` (m) along that axis; ``clearance`` (m) is the length
    of the dead space before 0; ``outside`` is the pressure on the piston's other side.
    """
    params = amounts_given(
        m, name, area=area, pressure=pressure, clearance=clearance, exponent=exponent, outside=outside
    )
    params["at"] = at
    if at + clearance <= 0:
        raise ModelError(f"{m.name}: force '{name}': at + clearance is {at + clearance:g} m; it must be positive")
    return add_force(m, GAS, name, cylinder, piston, params)


OWN = (
    "exponent", "length", "stroke", "compression_damping", "extension_damping", "end_damping", "end_way", "friction",
    "slip_speed", "stop_stiffness", "stop_damping",
)  # fmt: skip
"""Numbers as mbsd/equations/interactions/gas_strut.py reads them, after the force and the length of the gas."""


def _gas_length(force: Force) -> float:
    return force.params["stroke"] / (1.0 - 1.0 / force.params["ratio"])


def _interactions(force, masses):
    p = force.params
    numbers = [p["force"], _gas_length(force), *(p[name] for name in OWN)]
    return (Interaction("gas_strut", force.i, force.j, numbers),)


def _potential(force: Force, masses: Masses, q: np.ndarray) -> np.ndarray:
    p, gas = force.params, _gas_length(force)
    gap = marker_place(force.j, masses, q) - marker_place(force.i, masses, q)
    pushed = p["length"] - np.hypot(gap[:, 0], gap[:, 1])
    left, n = 1.0 - pushed / gas, p["exponent"]
    held = -np.log(left) if n == 1.0 else (left ** (1.0 - n) - 1.0) / (n - 1.0)
    beyond = np.maximum(np.maximum(pushed - p["stroke"], -pushed), 0.0)
    return p["force"] * gas * held + 0.5 * p["stop_stiffness"] * beyond**2


GAS_STRUT = register_force(
    ForceKind(
        "gas_strut",
        interactions=_interactions,
        potential=_potential,
        along=lambda force: Element(LINE, ()),
        sign="strut",
        look="cylinder",
        example=lambda m, i, j: m.gas_strut(
            "example", i, j, 40.0, 1.3, length=4.0, stroke=3.5, compression_damping=2.0, extension_damping=9.0,
            end_damping=20.0, end_way=1.0, friction=3.0, slip_speed=5.0, stop_stiffness=50.0, stop_damping=0.1,
        ),
    )
)  # fmt: skip


@GAS_STRUT.adds
def gas_strut(
    m: Model,
    name: str,
    i: Marker,
    j: Marker,
    force: float,
    ratio: float,
    length: float,
    stroke: float,
    exponent: float = 1.0,
    compression_damping: float = 0.0,
    extension_damping: float = 0.0,
    end_damping: float | None = None,
    end_way: float = 0.0,
    friction: float = 0.0,
    slip_speed: float = 1e-3,
    stop_stiffness: float = 1e6,
    stop_damping: float = 1.0,
) -> Force:
    """Add a gas strut between two points, with ``force`` (N) at its full ``length`` (m).

    Pushed in by its ``stroke`` (m) it has ``ratio`` times that force.

    ``exponent``: 1 for slow motion, up to 1.4 for fast. Damping (N s/m) while it gets shorter and while it gets longer;
    in the last ``end_way`` (m) of extending it rises to ``end_damping``. ``friction`` (N) is reached at some
    ``slip_speed`` (m/s), within which damping passes from one way to the other, too. Beyond both ends stops push back
    with ``stop_stiffness`` (N/m), and with more by ``stop_damping`` (s/m) times the speed at which they are pressed.
    """
    params = amounts_given(
        m, name, compression_damping=compression_damping, extension_damping=extension_damping, end_way=end_way,
        friction=friction, stop_damping=stop_damping,
        end_damping=extension_damping if end_damping is None else end_damping,
    )  # fmt: skip
    params |= above_zero(
        m, name, force=force, length=length, stroke=stroke, slip_speed=slip_speed, stop_stiffness=stop_stiffness
    )
    params["ratio"] = ratio
    what = f"{m.name}: force '{name}'"
    if not ratio > 1.0:
        raise ModelError(
            f"{what}: ratio is {ratio:g}; it must be above 1, as the gas pushes harder when it is pushed in"
        )
    params |= exponent_given(m, name, exponent)
    if not stroke < length:
        raise ModelError(
            f"{what}: stroke is {stroke:g} m, but extended it is {length:g} m long; a strut is longer than its stroke"
        )
    return add_force(m, GAS_STRUT, name, i, j, params)
