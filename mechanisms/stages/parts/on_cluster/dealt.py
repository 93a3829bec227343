"""The parts of a mechanism, asked of the cluster's workers.

What none of them can answer is left to this machine.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable

import msgspec

from mechanisms.stages.loading.inputs import name_of
from mechanisms.stages.loading.loading import has
from mechanisms.stages.parts.on_cluster import answer, built
from mechanisms.stages.parts.on_cluster.answer import WorkerParts
from mechanisms.stages.parts.on_cluster.built import Order, by_content, collected
from shared.cluster.address import connected
from shared.cluster.deal import Deal, Work, content_hash
from shared.cluster.preload import OF_PARTS, PARTS, identity
from shared.stage import paths
from shared.stage.console import say, warn
from shared.stage.paths import Out
from shared.stage.scale import Scale
from shared.stage.signals import terminable

PATIENCE = 600.0
"""Seconds in which a worker must have made the parts of a mechanism, or counts as stalled."""
GRACE = 120.0
"""Seconds after which a worker that has nothing to do makes them too; the first answer counts."""


def made_elsewhere(name: str, scale: Scale | None, machine: bytes, before: Iterable[str]) -> WorkerParts | None:
    """Return the parts of ``name`` as a worker made them.

    None where the stage there refused, which is reported from here.

    The rejection is reported from here. ``machine`` is the parts.json of the machine itself, where its model at
    ``scale`` needs it; ``before`` are names of files from which the parts were made before. Raises UserError if no
    scheduler answers, no worker is fit, or several workers fail.
    """
    files = collected(name, before)
    contents = by_content({**files, "": machine} if machine else files)
    order = Order(
        name=name,
        files={path: content_hash(content) for path, content in files.items()},
        program=identity(PARTS, OF_PARTS),
        folder=paths.MECHANISMS.name if paths.in_workshop() else "",
        scale=str(scale or ""),
        machine=content_hash(machine) if machine else "",
    )
    common = msgspec.json.encode(order)
    contents[content_hash(common)] = common
    needed = {key: _given(content) for key, content in contents.items()}
    own_file = name_of(paths.mechanism_file(name, "parts" if has(name, "parts") else "mechanism"))
    title = Out(name, scale).title

    def read(_: str, content: bytes) -> WorkerParts:
        return answer.read(name, content, own_file, order.program)

    with terminable(), connected() as client:
        work = Work(built.parts, read, answer.MOST)
        deal = Deal(client, work, content_hash(common), needed, {name: name}, PARTS, PATIENCE, OF_PARTS, GRACE)
        for _, made, worker in deal.results():
            if not made.refusal:
                say("parts", f"{title}: made by worker {worker}")
                return made
            warn("parts", f"{title}: worker {worker}: {made.refusal}; it is tried here")
    return None


def _given(content: bytes) -> Callable[[], bytes]:
    return lambda: content
