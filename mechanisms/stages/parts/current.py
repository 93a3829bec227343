"""The parts of a mechanism, for stages that take their masses and colours but go on without them."""

from __future__ import annotations

from shared import contract
from shared.contract import Parts
from shared.stage import console
from shared.stage.face import to_run
from shared.stage.paths import Out


def current_parts(out: Out, stage: str) -> Parts | None:
    """Return the parts that are there, unless what they follow from has changed since, which ``stage`` says."""
    from mechanisms.stages.parts.stage import are_current

    if not out.parts.is_file():
        return None
    if are_current(out.name):
        return contract.read_parts(out.parts, out.name)
    remedy = to_run("parts", out.name)
    console.say(stage, f"{out.name}: the parts are of an older state, so their masses do not count; {remedy}")
    return None
