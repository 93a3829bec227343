"""Orders of a stage for the workers of a cluster: the files that they need are sent by content."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from mbsd.dealing import deal
from mbsd.dealing.identity import Trust, asker
from mbsd.dealing.manner import Kind, Manner
from mbsd.dealing.pools import Dask
from shared.cluster.hands import Work, perform
from shared.cluster.identity import PACKAGES, identity
from shared.cluster.voice import stage_voice

if TYPE_CHECKING:
    from distributed import Client


class Deal(deal.Deal):
    """One kind of work for all workers of a cluster.

    ``work`` says what a worker does and what its answer has to be, ``common`` is the name of the content that all
    orders share, ``needed`` all contents by name as functions that give their bytes, ``orders`` what is to be done by
    key. Workers whose sources of ``rooms`` differ are refused by name. ``patience`` (s) is a silence that is never too
    long; for ``grace`` (s) no worker whose pace is unknown is helped by others that have nothing to do.
    """

    def __init__(
        self,
        client: Client,
        work: Work,
        common: str,
        needed: Mapping[str, Callable[[], bytes]],
        orders: Mapping[str, Any],
        rooms: Sequence[str],
        patience: float = 300.0,
        packages: Sequence[str] = PACKAGES,
        grace: float = 0.0,
    ) -> None:
        which = tuple(rooms), tuple(packages)
        given = work.do, common, list(needed)
        super().__init__(
            Dask(client),
            Kind(perform, given, work.read, work.most, needed=needed, salt=common),
            orders,
            stage_voice(),
            Manner(patience=patience, grace=grace),
            Trust(identity(*which), asker("shared.cluster.identity", "identity", *which)),
        )
