"""Derivatives of simulations in which outlines meet, slide to their tips and rest, beside differences of whole runs."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from mbsd import Mechanism
from mbsd.numbers.names import number_named, with_values
from mechanisms.escapement import mechanism as escapement
from mechanisms.ratchet import mechanism as ratchet


def differences(m: Mechanism, labels: list[str], name: str, step: float, times: np.ndarray) -> np.ndarray:
    """Return (T, labels) central differences by a number, of simulations that meet the same events."""
    number, runs, met = number_named(m, name), [], []
    for sign in (1.0, -1.0):
        sol = with_values(m, [number], [number.value + sign * step]).simulate(times=times, tolerance=1e-12)
        met.append([(event.name, event.what) for event in sol.events])
        bodies = [label.split(".") for label in labels]
        runs.append(np.stack([getattr(sol.body(body), part) for body, part in bodies], axis=-1))
    assert met[0] == met[1]
    assert len(met[0]) >= 7
    return (runs[0] - runs[1]) / (2 * step)


@pytest.mark.parametrize(
    ("machine", "end", "name", "step"),
    [
        # a tooth drops off the tip of a pallet: its time is that at which its foot comes to the end of the face
        (escapement, 0.6, "pivot.x", 1e-7),
        (escapement, 0.6, "pendulum.mass", 1e-4),
        # the pusher strikes the wheel, which passes that on to the catch at rest on it
        (ratchet, 0.16, "pusher.mass", 1e-5),
        (ratchet, 0.16, "pusher_pin.x", 1e-7),
    ],
    ids=lambda value: value.__name__.split(".")[1] if hasattr(value, "__name__") else str(value),
)
def test_derivatives_go_through_the_ends_of_faces_and_impacts_passed_on(
    machine: Any, end: float, name: str, step: float
) -> None:
    m, times = machine.build(machine.Params()), np.linspace(0.0, end, 7)
    labels = [f"{body}.{part}" for body in list(m.bodies)[1:] for part in ("theta", "omega")]
    expected = differences(m, labels, name, step, times)
    made = m.sensitivities(labels, [name], times=times)
    given = np.stack([made.of(label, name) for label in labels], axis=-1)
    np.testing.assert_allclose(given, expected, atol=2e-6 * np.abs(expected).max(), rtol=2e-6)
