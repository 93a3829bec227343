"""What a body rings with when it is struck: frequencies and decay of its main piece, from its size and material.

A piece is taken as a plate of length L, width w and height h, which follow from its volume V, its height and its moment
of inertia J of mass m about the normal:

    L w = V / h      L^2 + w^2 = 12 J / m

One that is longer than it is wide bends as a free beam, in its plane and out of it (t = w, h), Euler-Bernoulli:

    f_n = (b_n / L)^2 t sqrt(E / (12 rho)) / (2 pi)      cosh b cos b = 1:  b = 4.730, 7.853, (2 n + 1) pi / 2 ...

A compact one is a free disc of the same area, radius a:

    f_n = l_n h sqrt(E / (12 rho (1 - nu^2))) / (2 pi a^2)      l = 5.25, 9.08, 12.23, 20.52, 21.6, 33.1, 35.3, 38.5

Struck by an impulse it is h(t) = sum g_n sin(2 pi f_n t) exp(-pi eta f_n t). Each mode has the modal mass of half the
piece; what is heard of it at 1 m is that of a piston of its area A, as far as its waves in air are short enough:

    g_n = rho_0 f_n A / (2 r) / (m / 2) min(1, 2 pi f_n sqrt(A) / c)

Sources: Blevins, Formulas for Natural Frequency and Mode Shape, 1979, tables 8-1 and 11-1; Fahy, Gardonio, Sound and
Structural Vibration, 2007, chapter 3.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from render.sound.solid_matter import Matter, matter
from shared.contract import BodyParts, Piece

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
    """What a body rings with: frequencies (Hz), decay (1/s) and strength (Pa at 1 m for a N s), (n,) each."""

    frequency: Array
    decay: Array
    gain: Array
    mass: float
    """kg"""
    size: float
    """About its largest extent (m)."""
    matter: Matter

    def response(self, count: int, rate: float) -> Array:
        """(count,) what is heard at ``rate`` samples a second after a N s at sample 0; what is longer is folded in."""
        length = max(count, math.ceil(rate * 7.0 / float(self.decay.min())))
        t = np.arange(length) / rate
        sound = np.zeros(-(-length // count) * count)
        for f, d, g in zip(self.frequency, self.decay, self.gain, strict=True):
            long = min(length, math.ceil(rate * 10.0 / d))
            sound[:long] += g * np.exp(-d * t[:long]) * np.sin(math.tau * f * t[:long])
        return sound.reshape(-1, count).sum(axis=0)


def modes_of(body: BodyParts) -> Modes | None:
    """What a body rings with; None where it has no piece of its own."""
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
    """Modes at these frequencies (Hz) of a body of that mass (kg) and area (m^2), as far as they are heard.

    One that is too small or too large to ring where one hears it keeps its lowest or highest, at the end of the range.
    """
    heard = frequency[(frequency >= LOWEST) & (frequency <= HIGHEST)]
    if not len(heard):
        heard = np.clip(frequency[:1] if frequency[0] > HIGHEST else frequency[-1:], LOWEST, HIGHEST)
    short = np.minimum(1.0, math.tau * heard * math.sqrt(area) / SPEED_OF_SOUND)
    gain = AIR * heard * area / mass * short
    return Modes(heard, np.maximum(math.pi * made_of.loss * heard, 4.0), gain, mass, size, made_of)
