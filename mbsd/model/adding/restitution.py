"""Impact losses of a contact by penalty: damping by its approach speed, from a restitution.

c = A(e) / v_0 in N = k d^n (1 + c d'), with the A(e) of a damping model; see mbsd/model/forces/contact.py.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from mbsd.base.errors import ModelError
from mbsd.base.names import no_such
from mbsd.model.adding.forces import above_zero
from mbsd.model.mechanism import Model, number_given

MODELS = {
    "hunt_crossley": lambda e: 1.5 * (1.0 - e),
    "lankarani_nikravesh": lambda e: 0.75 * (1.0 - e * e),
    "flores": lambda e: 1.6 * (1.0 - e) / e,
}
"""A(e) by the name of the damping model."""


def loss_of(params: Mapping[str, Any]) -> float:
    """A(e) of a force's params, 0 without a restitution."""
    restitution = params["restitution"]
    return 0.0 if restitution is None else MODELS[params["damping_model"]](restitution)


def restitution_given(
    m: Model, name: str, damping: float, restitution: float | None, damping_model: str, least_approach: float
) -> dict[str, float | str | None]:
    """Params of damping by approach speed. Raises ModelError."""
    what = f"{m.name}: force '{name}'"
    if damping_model not in MODELS:
        raise ModelError(f"{what}: {no_such('damping_model', damping_model, MODELS)}")
    least_approach = above_zero(m, name, "least_approach", least_approach)
    if restitution is not None:
        restitution = number_given(m, f"force '{name}': restitution", restitution)
        if not 0.0 <= restitution <= 1.0:
            raise ModelError(f"{what}: restitution is {restitution:g}; it must be within 0 .. 1")
        if restitution == 0.0 and damping_model == "flores":
            raise ModelError(
                f"{what}: restitution is 0, for which the damping of 'flores' is infinite; give a little more, or take "
                "damping_model='lankarani_nikravesh'"
            )
        if damping:
            raise ModelError(
                f"{what}: damping is {damping:g} s/m and restitution {restitution:g}; give one of them, as both say "
                "how much an impact loses"
            )
    return {"restitution": restitution, "damping_model": damping_model, "least_approach": least_approach}
