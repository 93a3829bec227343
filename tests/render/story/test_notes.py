"""Numbers beside arrows: where there is no room beyond a tip they stand beside the arrow, not on it."""

from __future__ import annotations

import numpy as np
import pytest

from render.film.story.frame import Note, Over
from render.frames.story.drawing import Drawing, _on_arrow

WIDE, HIGH = 640, 360


def dark(note: Note) -> np.ndarray:
    """Where the card of a note is, as pixels (n, 2) of x and y."""
    layer = Drawing(WIDE, HIGH, "", (), "", None)._layer(Over(notes=(note,), notes_shown=1.0))
    rows, columns = np.nonzero(np.asarray(layer)[..., 3] > 100)
    return np.stack([columns, rows], axis=1)


@pytest.mark.parametrize("x", [0.2, 0.8])
def test_a_number_at_the_upper_edge_is_beside_its_arrow(x: float) -> None:
    note = Note(x, 0.03, 0.0, -1.0, "O  1.37 N", "#5aa9ff")
    card = dark(note)
    assert (card[:, 0] > x * WIDE + 3).all() if x < 0.5 else (card[:, 0] < x * WIDE - 3).all()
    assert card.min() >= 0


def test_it_is_on_the_side_to_which_the_arrow_leans() -> None:
    note = Note(0.3, 0.03, -0.35, -0.94, "O  1.37 N", "#5aa9ff")
    card = dark(note)
    tip = 0.3 * WIDE
    assert card[:, 0].max() < tip, "the shaft goes to the right from here"


def test_a_number_with_room_is_beyond_the_tip() -> None:
    note = Note(0.5, 0.5, 0.0, -1.0, "O  1.37 N", "#5aa9ff")
    card = dark(note)
    assert card[:, 1].max() < 0.5 * HIGH
    assert card[:, 0].mean() == pytest.approx(0.5 * WIDE, abs=1.0)
    assert not _on_arrow((300.0, 100.0, 340.0, 170.0), note, WIDE, HIGH)
    assert _on_arrow((300.0, 185.0, 340.0, 200.0), note, WIDE, HIGH)
