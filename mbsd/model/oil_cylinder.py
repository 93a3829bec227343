"""Oil in both chambers of a hydraulic cylinder: volumes, flows, pressure rates, steady states.

    s = l - L                              how far the rod is out;  l: distance of the points, L where it is fully in
    V_a = D_a + A_a s,   V_b = D_b + A_b (S - s)
    r(d) = d / (d^2 + d_t^2)^(1/4)         sqrt(d) above the transition d_t, d / sqrt(d_t) below
    u > 0:  Q_a = K u r(p_s - p_a),  Q_b = K u r(p_t - p_b);   u < 0:  supply and tank change places,  K |u|
    E(p) = p (p + c) / (p^2 / E_0 + c),    c = part of air times 101325 Pa
    p_a' = E(p_a) / V_a (Q_a - A_a l' - g (p_a - p_b)),   p_b' = E(p_b) / V_b (Q_b + A_b l' + g (p_a - p_b))

All pressures are absolute. E is the bulk modulus of oil with air that is compressed at constant temperature. Without
air it is that of the oil at every pressure, also below zero, where real oil tears; with air the pressure falls towards
zero and never below. Below 1000 Pa, where oil boils, it is compressed as at 1000 Pa, so that its bubbles close again.

Sources: Merritt, Hydraulic Control Systems, ch. 1 to 3 and 6 (bulk modulus, orifices, chambers of a piston); Jelali,
Kroll, Hydraulic Servo-systems, ch. 4. The orifice's smooth passage through zero is that of Simscape's orifices.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple, TypeVar

import numpy as np

ATMOSPHERE = 101325.0
"""Pa, at which the part of air is given."""
LEAST = 1e3
"""Pressure (Pa) below which oil is as stiff as there while it is compressed; oil boils at about that pressure."""
HALVINGS = 100
"""Number of halvings of the bracket around the leak of a steady state."""

Number = TypeVar("Number", float, np.ndarray)


class Flows(NamedTuple):
    """Flows (m^3/s) through valve and leak, and where they come from."""

    into_a: np.ndarray
    """Flow from the valve into chamber A."""
    into_b: np.ndarray
    leak: np.ndarray
    """Leakage from A to B."""
    supply: np.ndarray
    """Taken from the supply."""
    tank: np.ndarray
    """Taken from the tank; negative where oil returns."""


@dataclass(frozen=True)
class OilCylinder:
    """A cylinder, its valve and its oil, by their numbers (SI)."""

    area_a: float
    area_b: float
    retracted: float
    stroke: float
    dead_a: float
    dead_b: float
    bulk_modulus: float
    air: float
    supply: float
    tank: float
    conductance: float
    """K (m^3/s/sqrt(Pa)) of each edge of the fully open valve."""
    transition: float
    leakage: float
    outside: float
    pressure_a: float | None
    pressure_b: float | None

    def volumes(self, length: Number) -> tuple[Number, Number]:
        """Volumes of both chambers (m^3) at a distance of the points (m)."""
        out_by = length - self.retracted
        return self.dead_a + self.area_a * out_by, self.dead_b + self.area_b * (self.stroke - out_by)

    def bulk(self, pressure: np.ndarray, flow: np.ndarray) -> np.ndarray:
        """Bulk modulus (Pa) at absolute pressures (Pa), where a flow (m^3/s) compresses the oil."""
        c = self.air * ATMOSPHERE
        p = np.maximum(pressure, np.where((flow > 0.0) | (c == 0.0), LEAST, 0.0))
        return (p + c) * p / (p * p / self.bulk_modulus + c)

    def orifice(self, drop: np.ndarray) -> np.ndarray:
        """r(d) (sqrt(Pa))."""
        return drop / np.sqrt(np.sqrt(drop * drop + self.transition**2))

    def flows(self, opening: np.ndarray, a: np.ndarray, b: np.ndarray) -> Flows:
        """At an opening of the valve and pressures (Pa), (T,) each."""
        opening = np.clip(opening, -1.0, 1.0)
        supplied = opening > 0.0
        way = self.conductance * np.abs(opening)
        into_a = way * self.orifice(np.where(supplied, self.supply, self.tank) - a)
        into_b = way * self.orifice(np.where(supplied, self.tank, self.supply) - b)
        supply, tank = np.where(supplied, into_a, into_b), np.where(supplied, into_b, into_a)
        return Flows(into_a, into_b, self.leakage * (a - b), supply, tank)

    def rates(
        self, opening: np.ndarray, length: np.ndarray, rate: np.ndarray, a: np.ndarray, b: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """p_a' and p_b' (Pa/s)."""
        volume_a, volume_b = self.volumes(length)
        into_a, into_b = self.compressing(self.flows(opening, a, b), rate)
        return self.bulk(a, into_a) / volume_a * into_a, self.bulk(b, into_b) / volume_b * into_b

    def compressing(self, flows: Flows, rate: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Flows (m^3/s) into both chambers beyond what the piston makes room for."""
        return flows.into_a - self.area_a * rate - flows.leak, flows.into_b + self.area_b * rate + flows.leak

    def drop(self, root: float) -> float:
        """The pressure drop d (Pa) at which r(d) is ``root`` (sqrt(Pa))."""
        fourth = root**4
        square = 0.5 * (fourth + math.sqrt(fourth * fourth + 4.0 * fourth * self.transition**2))
        return math.copysign(math.sqrt(square), root)

    def steady(self, opening: float, rate: float, effort: float) -> tuple[float, float]:
        """Pressures (Pa) at the start: given ones, else those at which what flows in flows out again.

        Behind a closed valve, one chamber stands at the pressure of the tank and the other carries ``effort`` (N), what
        oil and atmosphere must push outwards. Where the oil of a steady state would tear, it begins at ``LEAST``.
        """
        way = self.conductance * min(abs(opening), 1.0)
        if way > 0.0:
            a, b = self._flowing(way, opening > 0.0, rate)
        else:
            a, b = self._holding(effort)
        return (
            a if self.pressure_a is None else self.pressure_a,
            b if self.pressure_b is None else self.pressure_b,
        )

    def _flowing(self, way: float, supplied: bool, rate: float) -> tuple[float, float]:
        at_a, at_b = (self.supply, self.tank) if supplied else (self.tank, self.supply)

        def pressures(leak: float) -> tuple[float, float]:
            a = at_a - self.drop((self.area_a * rate + leak) / way)
            return a, at_b - self.drop((-self.area_b * rate - leak) / way)

        def beyond(leak: float) -> float:
            """Return the flow at the pressures that a leak leaves, less the leak: it falls as the leak grows."""
            a, b = pressures(leak)
            return self.leakage * (a - b) - leak

        low = high = 0.0
        step = self.leakage * self.supply
        while step > 0.0 and beyond(low) < 0.0:
            low, step = low - step, 2.0 * step
        while step > 0.0 and beyond(high) > 0.0:
            high, step = high + step, 2.0 * step
        for _ in range(HALVINGS):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if beyond(middle) > 0.0 else (low, middle)
        a, b = pressures(0.5 * (low + high))
        return max(a, LEAST), max(b, LEAST)

    def _holding(self, effort: float) -> tuple[float, float]:
        push = effort + self.outside * (self.area_a - self.area_b)
        given_a, given_b = self.pressure_a, self.pressure_b
        if given_a is not None:
            return given_a, max((given_a * self.area_a - push) / self.area_b, LEAST)
        least_b = self.tank if given_b is None else given_b
        a = (push + least_b * self.area_b) / self.area_a
        if a >= self.tank or given_b is not None:
            return max(a, LEAST), least_b
        return self.tank, max((self.tank * self.area_a - push) / self.area_b, LEAST)
