"""The connection with a Dask cluster, its certificates, and facts that its scheduler knows."""

from __future__ import annotations

import logging
import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mbsd.dealing.manner import Voice

if TYPE_CHECKING:
    from distributed import Client, Security

TLS = "CLUSTER_TLS"
"""Environment variable with the folder of certificates: ca.pem, cert.pem, key.pem."""
FILES = ("ca.pem", "cert.pem", "key.pem")
TIMEOUT = 10.0
"""Seconds in which a scheduler must answer."""


@contextmanager
def connected(where: str, voice: Voice) -> Iterator[Client]:
    """Return a client of the scheduler at ``where``, closed afterwards.

    Raises the voice's error if none answers.
    """
    try:
        from distributed import Client
    except ImportError as error:
        raise voice.error("a cluster needs distributed: install mbsd[cluster]") from error
    try:
        client = Client(where, security=_security(where, voice), timeout=TIMEOUT, set_as_default=False)
    except (OSError, ValueError, TypeError, RuntimeError) as error:
        raise voice.error(voice.no_scheduler.format(where=where, problem=error)) from error
    try:
        yield client
    finally:
        if client.status != "running":  # what Dask logs of that is said already
            logging.getLogger("distributed.client").setLevel(logging.CRITICAL)
        with suppress(Exception):
            client.close(timeout=2)


def certificates(where: str, voice: Voice) -> tuple[str, str, str] | None:
    """Return paths of the authority's certificate, our own and its key; None where none are given.

    Raises the voice's error if one is missing.
    """
    folder = os.environ.get(TLS, "")
    if not folder:
        if where.startswith("tls://"):
            raise voice.error("CLUSTER is a tls:// address; give the folder of the certificates as CLUSTER_TLS=folder")
        return None
    ca, cert, key = (Path(folder).expanduser() / name for name in FILES)
    for path in (ca, cert, key):
        if not path.is_file():
            raise voice.error(
                f"CLUSTER_TLS={folder}: {path.name} is missing; make certificates CLUSTER_TLS={folder} makes all"
            )
    return str(ca), str(cert), str(key)


def _security(where: str, voice: Voice) -> Security | None:
    """Return the TLS settings of a client; None where no certificates are given."""
    files = certificates(where, voice)
    if files is None:
        return None
    from distributed import Security

    ca, cert, key = files
    return Security(tls_ca_file=ca, tls_client_cert=cert, tls_client_key=key, require_encryption=True)


def workers_of(client: Client) -> dict[str, Any]:
    """Return all workers that the scheduler knows, by address.

    Raises OSError or RuntimeError without an answer. The scheduler is asked itself: what the client keeps is replaced
    now and then by a list without workers.
    """
    scheduler: Any = client.scheduler
    answer: Any = client.sync(scheduler.identity, n_workers=-1, callback_timeout=TIMEOUT)
    return {name: worker for name, worker in answer["workers"].items() if _is_fit_to_print(name)}


def tasks_of(client: Client) -> dict[str, int]:
    """Return tasks of each worker, of all clients, by address; none if the scheduler does not answer."""
    scheduler: Any = client.scheduler
    try:
        answer: Any = client.sync(scheduler.processing, workers=None, callback_timeout=TIMEOUT)
    except (OSError, RuntimeError):
        return {}
    return {worker: len(tasks) for worker, tasks in answer.items()}


def size_of(client: Client, key: str) -> int:
    """Return the bytes of a result, as its worker reported; 0 if that is unknown.

    It is unknown where there is no result or the scheduler does not answer.
    """
    try:
        answer: Any = client.nbytes(keys=[key], summary=False)
    except (OSError, KeyError, RuntimeError):
        return 0
    return int(answer.get(key, 0) or 0)


def _is_fit_to_print(name: str) -> bool:
    """Return a worker chooses its address itself, and messages name it."""
    return len(name) < 200 and name.isascii() and name.isprintable() and " " not in name
