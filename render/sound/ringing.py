"""Bodies that ring: their modes, what matter damps, and what is radiated."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from shared.contract import BodyParts, Piece
from shared.contract.materials import MATERIALS

# How materials ring: Young's modulus, density and loss factor by the names of shared/contract/materials.py.
#
# Handbook values; the loss factor is that of a part in a machine, whose joints take more than the material does.
# Sources: Cremer, Heckl, Petersson, Structure-Borne Sound, 2005; Ashby, Materials Selection in Mechanical Design, 2011.


@dataclass(frozen=True)
class Matter:
    """Material constants that a part rings by."""

    modulus: float
    """Young's modulus (Pa)."""
    density: float
    """kg/m^3"""
    loss: float
    """Loss factor: the part of the energy that goes in a radian."""


_FAMILIES = {
    "aluminium": (70e9, 0.008),
    "steel": (205e9, 0.006),
    "brass": (100e9, 0.006),
    "bronze": (105e9, 0.007),
    "cast_iron": (110e9, 0.012),
    "pla": (3.3e9, 0.03),
    "petg": (2.0e9, 0.04),
    "beech": (12e9, 0.025),
    "plywood": (8e9, 0.03),
    "leather": (0.2e9, 0.2),
    "concrete": (28e9, 0.02),
    "asphalt": (5e9, 0.2),
    "glass": (65e9, 0.004),
    "acrylic": (3.2e9, 0.06),
    "paper": (3e9, 0.1),
    "sand": (0.1e9, 0.4),
    "rubber": (0.02e9, 0.25),
}
"""Modulus and loss factor of a family; its materials begin with the word."""
OTHER = (70e9, 0.01)


def matter(material: str) -> Matter:
    """Return how a material rings.

    One that is in no family rings as aluminium does, with its own density where it has one.
    """
    modulus, loss = next((numbers for word, numbers in _FAMILIES.items() if material.startswith(word)), OTHER)
    known = MATERIALS.get(material)
    return Matter(modulus, known.density if known else 2700.0, loss)


# Modes of a body that is struck: frequencies and decay of its main piece, from its size and material.
#
# A piece is taken as a plate of length L, width w and height h, which follow from its volume V, its height and its
# moment of inertia J of mass m about the normal:
#
#     L w = V / h      L^2 + w^2 = 12 J / m
#
# One that is longer than it is wide bends as a free beam, in its plane and out of it (t = w, h), Euler-Bernoulli:
#
#     f_n = (b_n / L)^2 t sqrt(E / (12 rho)) / (2 pi)      cosh b cos b = 1:  b = 4.730, 7.853, (2 n + 1) pi / 2 ...
#
# A compact one is a free disc of the same area, radius a:
#
#     f_n = l_n h sqrt(E / (12 rho (1 - nu^2))) / (2 pi a^2)      l = 5.25, 9.08, 12.23, 20.52, 21.6, 33.1, 35.3, 38.5
#
# Struck by an impulse it is h(t) = sum g_n sin(2 pi f_n t) exp(-pi eta f_n t). Each mode has the modal mass of half the
# piece; what is heard of it at 1 m is that of a piston of its area A, as far as its waves in air are short enough:
#
#     g_n = rho_0 f_n A / (2 r) / (m / 2) min(1, 2 pi f_n sqrt(A) / c)
#
# Sources: Blevins, Formulas for Natural Frequency and Mode Shape, 1979, tables 8-1 and 11-1; Fahy, Gardonio, Sound and
# Structural Vibration, 2007, chapter 3.

Array = NDArray[np.float64]
AIR, SPEED_OF_SOUND = 1.2, 343.0
"""Density (kg/m^3) and speed of sound (m/s) of air."""
LOWEST, HIGHEST = 40.0, 15_000.0
"""Frequencies that count (Hz)."""
BENDING = (4.730, 7.853, *((2 * n + 1) * math.pi / 2 for n in range(3, 8)))
DISC = (5.25, 9.08, 12.23, 20.52, 21.6, 33.1, 35.3, 38.5)
POISSON = 0.3
SLENDER = 2.2
"""L^2 + w^2 over L w of a piece that is a disc, at most; a square has 2."""


@dataclass(frozen=True)
class Modes:
    """Modes of a body: frequencies (Hz), decay (1/s) and strength (Pa at 1 m for a N s), (n,) each."""

    frequency: Array
    decay: Array
    gain: Array
    mass: float
    """kg"""
    size: float
    """Largest extent (m), about."""
    matter: Matter

    def response(self, count: int, rate: float) -> Array:
        """Return (count,) the wave that is heard at ``rate`` samples a second after a N s at sample 0.

        A longer wave is folded in.
        """
        length = max(count, math.ceil(rate * 7.0 / float(self.decay.min())))
        t = np.arange(length) / rate
        sound = np.zeros(-(-length // count) * count)
        for f, d, g in zip(self.frequency, self.decay, self.gain, strict=True):
            long = min(length, math.ceil(rate * 10.0 / d))
            sound[:long] += g * np.exp(-d * t[:long]) * np.sin(math.tau * f * t[:long])
        return sound.reshape(-1, count).sum(axis=0)


def modes_of(body: BodyParts) -> Modes | None:
    """Return the modes of a body; None if it has no piece of its own."""
    own = [piece for piece in body.pieces.values() if not piece.dressing and not piece.buy and piece.mass.mass > 0]
    return _of_piece(max(own, key=lambda piece: piece.mass.mass)) if own else None


def _of_piece(piece: Piece) -> Modes:
    made_of, mass = matter(piece.material), piece.mass.mass
    height = max(piece.z_range[1] - piece.z_range[0], 1e-4)
    area = max(piece.mass.volume / height, 1e-8)
    square = 12 * piece.mass.inertia / mass  # L^2 + w^2
    stiff = math.sqrt(made_of.modulus / (12 * made_of.density)) / math.tau
    if square < SLENDER * area:
        radius = math.sqrt(area / math.pi)
        frequency = np.array(DISC) * height / radius**2 * stiff / math.sqrt(1 - POISSON**2)
        length = 2 * radius
    else:
        plus, minus = math.sqrt(square + 2 * area), math.sqrt(square - 2 * area)
        length, width = (plus + minus) / 2, (plus - minus) / 2
        flat = (np.array(BENDING) / length) ** 2 * stiff
        frequency = np.sort(np.concatenate([flat * height, flat * width]))
    return modes(frequency, made_of, mass, area, length)


def modes(frequency: Array, made_of: Matter, mass: float, area: float, size: float) -> Modes:
    """Return audible modes at these frequencies (Hz) of a body of that mass (kg) and area (m^2).

    One that is too small or too large to ring where one hears it keeps its lowest or highest, at the end of the range.
    """
    heard = frequency[(frequency >= LOWEST) & (frequency <= HIGHEST)]
    if not len(heard):
        heard = np.clip(frequency[:1] if frequency[0] > HIGHEST else frequency[-1:], LOWEST, HIGHEST)
    short = np.minimum(1.0, math.tau * heard * math.sqrt(area) / SPEED_OF_SOUND)
    gain = AIR * heard * area / mass * short
    return Modes(heard, np.maximum(math.pi * made_of.loss * heard, 4.0), gain, mass, size, made_of)


# How loud a power or a force is heard at 1 m.
#
#     power P (W), of which a part eta leaves as sound:     p = sqrt(eta P rho_0 c / (4 pi r^2))
#     force F (N) at frequency f on a frame that is small beside the waves:   p = F f / (2 c r)      (a dipole)
#
# Source: Fahy, Gardonio, Sound and Structural Vibration, 2007, chapter 3.


def of_power(power: Array, efficiency: float) -> Array:
    """Return (n,) pressure (Pa) at 1 m of powers (W)."""
    return np.sqrt(efficiency * np.maximum(power, 0.0) * AIR * SPEED_OF_SOUND / (4 * np.pi))


def of_force(force: Array, frequency: Array) -> Array:
    """Return (n,) pressure (Pa) at 1 m of forces (N) that change at a frequency (Hz)."""
    return np.abs(force) * frequency / (2 * SPEED_OF_SOUND)
