"""Every kind of contact: derivatives of its gap and of how far it slides, and its file."""

from __future__ import annotations

from pathlib import Path

import pytest

from mbsd import Mechanism, ModelError
from mbsd.model.joint import CONTACT_KINDS, ContactKind
from mbsd.testing import check_joint, contact_kinds


def all_kinds() -> Mechanism:
    """Two free bodies, and every kind of contact between them."""
    m = Mechanism("kinds", gravity=None)
    first, second = m.body("first", 1.0, (0.1, 0.0), 0.2), m.body("second", 2.0, (0.0, 0.1), 0.3)
    i, j = first.at(0.1, 0.2, 0.3), second.at(-0.2, 0.1, 0.5)
    for name, kind in CONTACT_KINDS.items():
        kind.example(m, i, j)
        m.contacts[name] = m.contacts.pop("example")
    return m


@pytest.mark.parametrize("kind", contact_kinds(), ids=lambda kind: kind.name)
def test_gaps_and_sliding_agree_with_differences(kind: ContactKind) -> None:
    check_joint(kind)


def test_contacts_are_made_of_these_constraints() -> None:
    """Each must stand in the test above."""
    assert {name for kind in contact_kinds() for name in kind.constraints} == {
        "linear",
        "turn",
        "radial",
        "span",
        "gear",
        "curve",
        "curve_rolling",
        "outline",
        "outline_sliding",
    }


def test_every_kind_of_contact_is_saved(tmp_path: Path) -> None:
    m = all_kinds()
    m.save(tmp_path / "kinds.json")
    loaded = Mechanism.load(tmp_path / "kinds.json")
    assert {name: (c.kind, c.params) for name, c in loaded.contacts.items()} == {
        name: (c.kind, c.params) for name, c in m.contacts.items()
    }
    m.event("end", lambda t, moment: t - 1.0)
    with pytest.raises(ModelError, match="events of the model cannot be saved"):
        m.save(tmp_path / "kinds.json")
