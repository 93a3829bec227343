"""Signal colours: one table in films, drawings and the page; told apart by every eye, in the light and in the dark."""

from __future__ import annotations

import itertools
import json
import subprocess

import numpy as np
import pytest

from mbsd.drawing.animation.words import QUANTITIES, TRAIL, WEIGHTS
from mbsd.drawing.look import INKS, apart, neutral_inks, on_dark
from render.film.pieces import neutral
from render.film.scene import SurfaceSpec
from render.view.bundle import PAGE, node
from shared.contract.materials import MATERIALS
from shared.contract.shot import Trail
from shared.contract.signals import SIGNALS, linear

PAPER = {"light": "#ffffff", "dark": "#10141b"}
EYES = {
    "trichromat": np.eye(3),
    "protanope": np.array([
        [0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998],
    ]),
    "deuteranope": np.array([
        [0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881],
    ]),
}  # fmt: skip
"""Linear RGB as they see it: G. M. Machado, M. M. Oliveira, L. A. F. Fernandes, "A physiologically-based model for
simulation of color vision deficiency", IEEE TVCG 15 (2009) 1291-1298, severity 1."""
LMS = np.array([
    [0.4122214708, 0.5363325363, 0.0514459929],
    [0.2119034982, 0.6806995451, 0.1073969566],
    [0.0883024619, 0.2817188376, 0.6299787005],
])  # fmt: skip
LAB = np.array([
    [0.2104542553, 0.7936177850, -0.0040720468],
    [1.9779984951, -2.4285922050, 0.4505937099],
    [0.0259040371, 0.7827717662, -0.8086757660],
])  # fmt: skip
"""OKLab: B. Ottosson, 2020."""


def seen(colour: str, eye: np.ndarray) -> np.ndarray:
    return LAB @ np.cbrt(LMS @ np.clip(eye @ np.array(linear(colour)), 0.0, 1.0))


def contrast(ink: str, paper: str) -> float:
    """Return the contrast after WCAG 2."""
    high, low = sorted((float(np.array([0.2126, 0.7152, 0.0722]) @ linear(c)) for c in (ink, paper)), reverse=True)
    return (high + 0.05) / (low + 0.05)


@pytest.mark.parametrize("eye", EYES)
@pytest.mark.parametrize(("paper", "apart_by"), [("light", 0.08), ("dark", 0.13)])
def test_any_two_signals_differ_for_every_eye(eye: str, paper: str, apart_by: float) -> None:
    places = {name: seen(getattr(signal, paper), EYES[eye]) for name, signal in SIGNALS.items()}
    for left, right in itertools.combinations(places, 2):
        assert np.linalg.norm(places[left] - places[right]) > apart_by, (left, right)


def test_arrows_that_are_shown_together_differ_in_their_heads_too() -> None:
    heads = [SIGNALS[name].head for name in ("velocities", "accelerations", "forces", "reactions")]
    assert len(set(heads)) == 4


@pytest.mark.parametrize("paper", PAPER)
def test_signals_stand_out_from_their_paper(paper: str) -> None:
    for name, signal in SIGNALS.items():
        assert contrast(getattr(signal, paper), PAPER[paper]) > 3.0, name


def test_drawings_and_the_page_have_the_same_table() -> None:
    for name, quantity in QUANTITIES.items():
        if name in SIGNALS:
            assert (quantity.colour, quantity.head) == (SIGNALS[name].light, SIGNALS[name].head)
    assert QUANTITIES["forces"].arcs == SIGNALS["torques"].light
    assert (SIGNALS["weights"].light, SIGNALS["trails"].light) == (WEIGHTS, TRAIL)
    assert Trail(point="P").colour is None  # as the look asks for
    inks = (PAGE / "src" / "view2d" / "inks.js").as_uri()
    script = f"import * as inks from {json.dumps(inks)}; console.log(JSON.stringify([inks.QUANTITIES, inks.HEADS]))"
    done = subprocess.run(
        [str(node()), "--input-type=module", "-e", script],
        capture_output=True, text=True, timeout=60, check=True,
    )  # fmt: skip
    quantities, heads = json.loads(done.stdout)
    for paper in PAPER:
        assert quantities[paper] == {name: getattr(signal, paper) for name, signal in SIGNALS.items()}
    assert heads == {name: signal.head for name, signal in SIGNALS.items() if name != "trails"}


def test_inks_of_materials_are_those_of_drawings_and_dark_enough_for_text() -> None:
    for word, ink in INKS.items():
        assert MATERIALS["aluminium" if word == "silver" else f"aluminium_{word}"].ink == ink
    for ink in (*INKS.values(), *(material.ink for material in MATERIALS.values())):
        assert contrast(ink, "#ffffff") > 4.5, ink
        assert contrast(on_dark(ink), PAPER["dark"]) > 4.5, ink


def test_bodies_of_one_material_have_shades_that_differ() -> None:
    for ink in INKS.values():
        shades = apart({f"body {k}": ink for k in range(12)})
        assert len(set(shades.values())) == 12
        assert shades["body 0"] == ink
        first = [seen(shade, EYES["trichromat"]) for shade in list(shades.values())[:4]]
        for left, right in itertools.combinations(first, 2):
            assert np.linalg.norm(left - right) > 0.03
        assert all(contrast(shade, "#ffffff") > 4.0 for shade in shades.values())


def test_beside_arrows_no_body_has_a_colour() -> None:
    for ink in neutral_inks([f"body {k}" for k in range(9)]).values():
        rgb = [int(ink[k : k + 2], 16) for k in (1, 3, 5)]
        assert max(rgb) - min(rgb) < 48
    for name, material in MATERIALS.items():
        surface = neutral(SurfaceSpec(colour=material.colour, finish=material.finish, roughness=material.roughness))
        assert max(surface.colour) - min(surface.colour) < 0.06, name
        assert surface.finish == material.finish
