"""Where the cluster is: ``CLUSTER=tcp://scheduler:8786``, and the certificates that keep others out of it."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from shared.stage.errors import UserError
from shared.stage.face import to_run

if TYPE_CHECKING:
    from distributed import Client, Security

VARIABLE = "CLUSTER"
"""Environment variable with the address of the scheduler; empty: this machine alone."""
TLS = "CLUSTER_TLS"
"""Environment variable with the folder of certificates: ca.pem, cert.pem, key.pem."""
FILES = ("ca.pem", "cert.pem", "key.pem")
TIMEOUT = 10.0
"""Seconds in which a scheduler must answer."""


def address() -> str:
    """The scheduler's address; empty where none is given. Raises UserError if it is no address."""
    given = os.environ.get(VARIABLE, "").strip()
    scheme, _, rest = given.partition("://")
    if given and (scheme not in ("tcp", "tls") or ":" not in rest):
        raise UserError(f"CLUSTER={given} is no address of a scheduler; write tcp://name:8786, or tls://name:8786")
    if scheme == "tls":
        certificates()
    return given


def certificates() -> tuple[str, str, str] | None:
    """Paths of the authority's certificate, our own and its key; None where none are given.

    Raises UserError if one is missing.
    """
    folder = os.environ.get(TLS, "")
    if not folder:
        if os.environ.get(VARIABLE, "").startswith("tls://"):
            raise UserError("CLUSTER is a tls:// address; give the folder of the certificates as CLUSTER_TLS=folder")
        return None
    ca, cert, key = (Path(folder).expanduser() / name for name in FILES)
    for path in (ca, cert, key):
        if not path.is_file():
            raise UserError(
                f"CLUSTER_TLS={folder}: {path.name} is missing; make certificates CLUSTER_TLS={folder} makes all"
            )
    return str(ca), str(cert), str(key)


def security() -> Security | None:
    """What a client needs to speak TLS; None where no certificates are given."""
    files = certificates()
    if files is None:
        return None
    from distributed import Security

    ca, cert, key = files
    return Security(tls_ca_file=ca, tls_client_cert=cert, tls_client_key=key, require_encryption=True)


@contextmanager
def connected(where: str = "") -> Iterator[Client]:
    """A client of the scheduler at ``where``, by default that of the environment. Raises UserError if none answers."""
    where = where or address()
    from distributed import Client

    try:
        client = Client(where, security=security(), timeout=TIMEOUT, set_as_default=False)
    except (OSError, ValueError, TypeError, RuntimeError) as error:
        raise UserError(
            f"no scheduler answers at CLUSTER={where} ({error}); start one with {to_run('scheduler')}, or leave "
            "CLUSTER out to work on this machine alone"
        ) from error
    try:
        yield client
    finally:
        client.close(timeout=2)


def workers_of(client: Client) -> dict[str, Any] | None:
    """All workers that the scheduler knows now, by address; None if it does not answer.

    The scheduler is asked itself: what the client keeps is replaced now and then by a list without workers.
    """
    scheduler: Any = client.scheduler
    try:
        answer: Any = client.sync(scheduler.identity, n_workers=-1, callback_timeout=TIMEOUT)
    except (OSError, RuntimeError):  # the latter where the client gives up while it asks
        return None
    return {name: worker for name, worker in answer["workers"].items() if _is_fit_to_print(name)}


def tasks_of(client: Client) -> dict[str, int]:
    """Tasks that each worker has, of all clients, by address; none where the scheduler does not answer."""
    scheduler: Any = client.scheduler
    try:
        answer: Any = client.sync(scheduler.processing, workers=None, callback_timeout=TIMEOUT)
    except (OSError, RuntimeError):
        return {}
    return {worker: len(tasks) for worker, tasks in answer.items()}


def size_of(client: Client, key: str) -> int:
    """Bytes of a result, as its worker reported; 0 where there is none or the scheduler does not answer."""
    try:
        answer: Any = client.nbytes(keys=[key], summary=False)
    except (OSError, KeyError, RuntimeError):
        return 0
    return int(answer.get(key, 0) or 0)


def _is_fit_to_print(name: str) -> bool:
    """A worker chooses its address itself, and messages name it."""
    return len(name) < 200 and name.isascii() and name.isprintable() and " " not in name
