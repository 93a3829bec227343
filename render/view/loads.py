"""Arrows, arcs and clearances of the page: the same ones and the same scales as in the film.

arrows    full: length of the largest (m); longest: cut at so many of it; tiny: left out below this part of it;
          scales {unit: {largest, reference, cut, words}}; list [{quantity, row, name, unit, place, value (2 T,), z}];
          row: of the legend, which has the colour and the head (shared/contract/signals.py)
arcs      full: sweep of the largest (rad); scale as above or null; list [{quantity, row, name, place (2 T,),
          value (T,), radius, z}]
clearance limit (m), pairs [{bodies, pieces, gap (as proven), time, at, on}] nearest first; at (m) is where,
              in the frame of the body `on` or in the world, or null
"""

from __future__ import annotations

from typing import Any

import numpy as np

from render.film.arrows.arcs import FULL_TURN, SIGNAL, Arcs
from render.film.arrows.arrows import FULL, Arrows
from render.film.arrows.scales import LONGEST, TINY, Scale
from render.film.arrows.torques import rounding, torques
from render.film.arrows.vectors import vectors
from render.film.film import Film
from render.film.heights import Heights
from render.view.gaps import gap_places
from shared.contract import Motion
from shared.contract.clearance import Clearance
from shared.contract.quantity import written
from shared.contract.shot import Quantity

ALL: tuple[Quantity, ...] = ("velocities", "accelerations", "forces", "reactions")
PAIRS = 60
"""Number of pairs of the clearance, at most."""


def arrows_of(motion: Motion, size: float, heights: Heights | None = None) -> dict[str, Any]:
    """Straight arrows of all quantities; ``size`` (m) of the machine, ``heights`` where it has parts."""
    arrows = Arrows(np.asarray(motion.time), vectors(motion, ALL), size)
    return {
        "full": FULL * size,
        "longest": LONGEST,
        "tiny": TINY,
        "scales": {unit: _scale(scale) for unit, scale in arrows.scales.items()},
        "list": [
            {
                "quantity": vector.quantity,
                "row": vector.row,
                "name": vector.name,
                "unit": vector.unit,
                "bodies": list(vector.bodies),
                "place": vector.place.astype(np.float32),
                "value": vector.value.astype(np.float32),
                "z": heights.arrow(vector.bodies, *map(float, vector.place[0])) if heights else 0.0,
            }
            for vector in arrows.vectors
        ],
    }


def arcs_of(motion: Motion, size: float, heights: Heights | None = None) -> dict[str, Any]:
    """Curved arrows: torques of joints, drivers, springs, loads."""
    least = rounding(vectors(motion, ("forces", "reactions")), size)
    arcs = Arcs(np.asarray(motion.time), torques(motion, ALL), size, least)
    return {
        "full": FULL_TURN,
        "scale": _scale(arcs.scale) if arcs.scale else None,
        "list": [
            {
                "quantity": torque.quantity,
                "row": SIGNAL[torque.quantity],
                "name": torque.name,
                "bodies": list(torque.bodies),
                "place": torque.place.astype(np.float32),
                "value": torque.value.astype(np.float32),
                "radius": spec.radius,
                "z": heights.arrow(torque.bodies, *map(float, torque.place[0])) if heights else 0.0,
            }
            for torque, spec in zip(arcs.torques, arcs.specs(), strict=True)
        ],
    }


def clearance_of(clearance: Clearance, film: Film | None = None) -> dict[str, Any]:
    """The nearest pairs; with their places where the machine has parts."""
    places = gap_places(film, clearance) if film else [None] * len(clearance.pairs)
    return {
        "limit": clearance.limit,
        "pairs": [
            {
                "bodies": list(pair.bodies),
                "pieces": list(pair.pieces),
                "gap": pair.proven,
                "time": pair.time,
                "at": list(place.at) if place else None,
                "on": place.body if place else None,
            }
            for pair, place in zip(clearance.pairs[:PAIRS], places[:PAIRS], strict=True)
        ],
    }


def _scale(scale: Scale) -> dict[str, Any]:
    return {
        "largest": scale.largest,
        "reference": scale.reference,
        "cut": scale.cut,
        "words": written(scale.reference, scale.unit),
    }
