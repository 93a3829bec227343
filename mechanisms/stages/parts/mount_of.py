"""How a machine stands, from what ``parts()`` says, shot.py wishes and the model has."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import msgspec

from mechanisms.stages.loading.loading import load, params
from mechanisms.stages.solve.solving import build
from shared.contract import Mount, consistency, mounted
from shared.stage.errors import UserError

if TYPE_CHECKING:
    from shared.contract.mount import Kind


def follows_gravity(bodies: Any, wish: Kind | None) -> bool:
    """Whether solids by hand, which say nothing of it, stand because shot.py says so."""
    return getattr(bodies, "mount", None) is None and wish not in (None, "desk")


def mount_of(name: str, bodies: Any, wish: Kind | None) -> Mount:
    """The mount of what ``parts()`` returned; solids by hand lie on a desk unless shot.py says otherwise.

    Raises UserError for one that parts() says and that cannot be.
    """
    if follows_gravity(bodies, wish):
        m = build(name, load(name, "mechanism"), params(name))
        return mounted(m.gravity or (0.0, 0.0), wish)
    said = getattr(bodies, "mount", None)
    if said is None:
        return Mount()
    where = f"{name}: parts(): mount is {said!r}"
    try:
        mount = msgspec.convert(dict(zip(("kind", "up"), said, strict=True)), Mount)
    except (msgspec.ValidationError, TypeError, ValueError) as error:
        raise UserError(f'{where}; write made.mount = "stand", (0.0, 1.0, 0.0) ({error})') from error
    consistency.refuse_wrong_mount(mount, where)
    return mount
