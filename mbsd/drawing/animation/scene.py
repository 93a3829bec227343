"""Scene of an animation, prepared before the first picture: symbols, arrows, scales, traces, impacts."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from mbsd.drawing.animation.arrows import Arc, Arrow, force_arrows, motion_arrows, reaction_arrows
from mbsd.drawing.animation.brush import Brush, Mark, View, fresh
from mbsd.drawing.animation.clip import Clip, at_times
from mbsd.drawing.animation.flow import Balance, balance_of, flow_arrows
from mbsd.drawing.look import body_inks
from mbsd.drawing.pose import Tracks, tracks_of
from mbsd.drawing.skeleton import Steady, draw_on, steady_of
from mbsd.results.solution import Solution

LOOKED_AT = 24
"""Poses from which extent, sides and names are found."""
LENGTH = 0.22
"""Length of the largest arrow, as a fraction of the larger side of the machine."""


@dataclass(frozen=True)
class Drawn:
    """The machine in one picture, the world's origin at pixel 0, 0."""

    marks: list[Mark]
    anchors: np.ndarray
    """(k, 2) pixels, of its names."""


@dataclass(frozen=True, eq=False)
class Scene:
    """One mechanism over one clip."""

    clip: Clip
    whole: Solution
    """At its own outputs."""
    sol: Solution
    """At the times of the pictures."""
    tracks: Tracks
    steady: Steady
    """Extent and symbols."""
    inks: dict[str, str]
    """Colours of moving bodies where no arrows are."""
    _drawn: dict[tuple[int, float], Drawn] = field(default_factory=dict)

    @property
    def size(self) -> float:
        """Larger side of the machine over the whole motion (m)."""
        return float((self.steady.high - self.steady.low).max())

    @property
    def length(self) -> float:
        """Length of the largest arrow (m)."""
        return LENGTH * max(self.size, 10 * self.steady.unit)

    def draw(self, brush: Brush, k: int, colours: dict[str, str]) -> None:
        """Draw the mechanism at picture ``k``.

        Springs keep their turns, ground its signs, teeth turn with wheels.
        """
        self.steady.ready(
            brush, {name: float(view.theta[k] - view.theta[0]) for name, view in self.tracks.views.items()}
        )
        draw_on(brush, self.sol.mechanism, self.tracks.pose(k), colours, False, self.steady.sides)

    def drawn(self, brush: Brush, k: int, colours: dict[str, str]) -> Drawn:
        """Return the mechanism as marks in the scale of ``brush``.

        Panels of one scale share them, unless bodies glow.
        """
        key = k, brush.view.scale
        if key in self._drawn and not brush.tints:
            return self._drawn[key]
        own = fresh(brush, wheels={}, turned={}, coils={}, view=View(brush.view.scale, 0.0, 0.0))
        self.draw(own, k, colours)
        anchors = own.view.pixels([label.anchor for label in own.labels]).reshape(-1, 2)
        out = Drawn(own.marks, anchors)
        if not brush.tints:
            self._drawn.clear()
            self._drawn[key] = out
        return out

    def looked_at(self) -> np.ndarray:
        """Return the numbers of some pictures over the whole clip."""
        return np.unique(np.linspace(0, len(self.clip.times) - 1, LOOKED_AT).round().astype(int))

    @cached_property
    def balance(self) -> Balance:
        """Energies and powers."""
        return balance_of(self.sol)

    def marks(self, quantities: Sequence[str]) -> list[Arrow | Arc]:
        """Return arrows and arcs of these words of ``show``."""
        out: list[Arrow | Arc] = []
        for quantity in quantities:
            out += self._all[quantity]
        return out

    @cached_property
    def _all(self) -> dict[str, list[Arrow | Arc]]:
        m, tracks = self.sol.mechanism, self.tracks
        return {
            "velocities": motion_arrows(m, tracks, "velocities"),
            "accelerations": motion_arrows(m, tracks, "accelerations"),
            "forces": force_arrows(self.sol, tracks),
            "reactions": reaction_arrows(self.sol),
            "energy": list(flow_arrows(self.sol, tracks)),
        }

    @cached_property
    def floor(self) -> dict[str, float]:
        """By unit, what is nothing but rounding."""
        size, time = max(self.size, 1e-12), float(np.ptp(self.clip.times))
        spins = [float(np.abs(view.omega).max()) for view in self.tracks.views.values()]
        speeds = [float(np.hypot(view.vx, view.vy).max()) for view in self.tracks.views.values()]
        spin = max(*spins, 1 / time)
        speed = max(*speeds, size * spin)
        loads = [float(mark.size.max()) for mark in self.marks(("forces", "reactions")) if isinstance(mark, Arrow)]
        force = 1e-9 * max(loads, default=0.0)
        mass = sum(body.mass for body in self.sol.mechanism.bodies.values())
        force = max(force, 1e-9 * mass * size / time**2, 1e-15)
        return {
            "m/s": 1e-9 * speed,
            "m/s²": 1e-8 * speed * spin,
            "rad/s": 1e-9 * spin,
            "rad/s²": 1e-8 * spin**2,
            "N": force,
            "N m": 1e-3 * force * size,
            "W": 1e-3 * force * size / time,
        }


def scene_of(sol: Solution, clip: Clip, inks: Mapping[str, str] | None = None) -> Scene:
    """Return the scene of a whole solution, with the same symbols and extent in all pictures.

    ``inks``: colours of bodies, by default those of their roles.
    """
    m = sol.mechanism
    here = at_times(sol, clip.times)
    whole = tracks_of(sol)
    tracks = replace(tracks_of(here), travel=whole.travel, aside=whole.aside, paths=whole.paths)
    some = [tracks.pose(k) for k in np.unique(np.linspace(0, len(clip.times) - 1, LOOKED_AT).round().astype(int))]
    inks = dict(inks) if inks else body_inks(m)
    return Scene(clip, sol, here, tracks, steady_of(m, some, inks, Brush), inks)
