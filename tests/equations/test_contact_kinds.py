"""Every kind of contact: derivatives of its gap and way, and its file."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from mbsd import Mechanism, ModelError
from mbsd.arrays.packing import pack
from mbsd.equations.assembly import tabulate
from mbsd.model.contact import CONTACT_KINDS


def all_kinds() -> Mechanism:
    """Two free bodies, and every kind of contact between them."""
    m = Mechanism("kinds", gravity=None)
    first, second = m.body("first", 1.0, (0.1, 0.0), 0.2), m.body("second", 2.0, (0.0, 0.1), 0.3)
    i, j = first.at(0.1, 0.2, 0.3), second.at(-0.2, 0.1, 0.5)
    for name, kind in CONTACT_KINDS.items():
        kind.example(m, i, j)
        m.contacts[name] = m.contacts.pop("example")
    return m


def test_every_kind_of_contact_has_the_gradient_and_curvature_of_its_gap() -> None:
    packed = pack(all_kinds(), list(all_kinds().contacts.values()))
    rng = np.random.default_rng(5)
    q, v = rng.normal(size=9), rng.normal(size=9)
    q[:3] = v[:3] = 0.0
    h = 1e-5
    at = [q - h * v, q, q + h * v]
    rows = packed.first_row[-1]
    phi, gamma, compact = np.zeros((3, rows)), np.zeros((3, rows)), np.zeros((3, rows, 6))
    tabulate(packed.system, np.zeros((3, 1, 3)), np.array(at), np.array([v] * 3), packed.ws, phi, compact, gamma)
    rates = packed.spread(compact[1]) @ v[3:]
    np.testing.assert_allclose((phi[2] - phi[0]) / (2 * h), rates, atol=1e-8)
    np.testing.assert_allclose((phi[2] - 2 * phi[1] + phi[0]) / h**2, -gamma[1], atol=1e-4)
    assert {name for joint in packed.joints for name in joint.kind.constraints} == {
        "linear",
        "turn",
        "radial",
        "gear",
        "curve",
        "curve_rolling",
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
