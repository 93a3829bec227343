"""Address of the cluster: ``CLUSTER=tcp://scheduler:8786``, and the certificates that protect it.

What deals work out is mbsd/dealing; it is loaded where there is something to deal.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from shared.stage.errors import UserError

if TYPE_CHECKING:
    from distributed import Client

VARIABLE = "CLUSTER"
"""Environment variable with the address of the scheduler; empty: this machine alone."""


def address() -> str:
    """Return the scheduler's address, empty if none is given. Raises UserError for an invalid one."""
    given = os.environ.get(VARIABLE, "").strip()
    scheme, _, rest = given.partition("://")
    if given and (scheme not in ("tcp", "tls") or ":" not in rest):
        raise UserError(f"CLUSTER={given} is no address of a scheduler; write tcp://name:8786, or tls://name:8786")
    if scheme == "tls":
        certificates()
    return given


def certificates() -> tuple[str, str, str] | None:
    """Return the paths of the authority's certificate, our own and its key; None without them.

    Raises UserError if one is missing.
    """
    from mbsd.dealing.connection import certificates
    from shared.cluster.voice import stage_voice

    return certificates(os.environ.get(VARIABLE, ""), stage_voice())


@contextmanager
def connected(where: str = "") -> Iterator[Client]:
    """Yield a client of the scheduler at ``where``, by default that of the environment.

    Raises UserError if none answers.
    """
    from mbsd.dealing import connection
    from shared.cluster.voice import stage_voice

    with connection.connected(where or address(), stage_voice()) as client:
        yield client
