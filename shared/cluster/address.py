"""Address of the cluster, ``CLUSTER=tcp://scheduler:8786``, and the certificates that protect it."""

from __future__ import annotations

import datetime
import os
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from mbsd.dealing.manner import Voice
from shared.stage.console import duration, say, warn
from shared.stage.errors import UserError
from shared.stage.face import to_run
from shared.stage.files import write_bytes

if TYPE_CHECKING:
    from distributed import Client


# Messages of a stage on its workers: lines on the console, and UserError.


def stage_voice() -> Voice:
    """Return the messages, with commands of the program through which the stage was called."""
    return Voice(
        say=partial(say, "cluster"),
        warn=partial(warn, "cluster"),
        error=UserError,
        duration=duration,
        no_scheduler=(
            f"no scheduler answers at CLUSTER={{where}} ({{problem}}); start one with {to_run('scheduler')}, or leave "
            "CLUSTER out to work on this machine alone"
        ),
        gone="the scheduler has gone; nothing was lost, the same command goes on",
        silent=(
            "the scheduler has been silent for {time}; nothing was lost, start it again "
            f"({to_run('scheduler')}), and then the same command"
        ),
        nobody=(
            "no worker of the cluster can do this{shown}; start workers with the same lock file and sources "
            f"({to_run('worker')}), or leave CLUSTER out"
        ),
        without="there is no worker that can do this",
        one_comes=f"one is given {{time}} to come ({to_run('worker')})",
        lied="worker {worker} sent a wrong answer: {reason}; it is left out, others do its work",
        failed="worker {worker}: {reason}",
        left_out="worker {worker}: {reason}; it is left out",
    )


# Address of the cluster: ``CLUSTER=tcp://scheduler:8786``, and the certificates that protect it.
#
# What deals work out is mbsd/dealing; it is loaded where there is something to deal.


VARIABLE = "CLUSTER"
"""Environment variable with the address of the scheduler; empty: this machine alone."""


def address() -> str:
    """Return the scheduler's address, empty if none is given. Raises UserError for an invalid one."""
    given = os.environ.get(VARIABLE, "").strip()
    scheme, _, rest = given.partition("://")
    if given and (scheme not in ("tcp", "tls") or ":" not in rest):
        raise UserError(f"CLUSTER={given} is not the address of a scheduler; write tcp://name:8786, or tls://name:8786")
    if scheme == "tls":
        certificates()
    return given


def certificates() -> tuple[str, str, str] | None:
    """Return the paths of the authority's certificate, our own and its key; None without them.

    Raises UserError if one is missing.
    """
    from mbsd.dealing.connection import certificates

    return certificates(os.environ.get(VARIABLE, ""), stage_voice())


@contextmanager
def connected(where: str = "") -> Iterator[Client]:
    """Yield a client of the scheduler at ``where``, by default that of the environment.

    Raises UserError if none answers.
    """
    from mbsd.dealing import connection

    with connection.connected(where or address(), stage_voice()) as client:
        yield client


# Certificates for a cluster: an authority, and a certificate with its key for all machines.


DAYS = 3650
NAME = "mbsd cluster"


def make(folder: Path) -> None:
    """Write ca.pem, cert.pem and key.pem.

    The authority's own key is not kept, so that nobody signs more.

    Raises UserError if one of the files is there already.
    """
    try:
        from cryptography import x509
        from cryptography.hazmat.primitives import hashes, serialization
        from cryptography.hazmat.primitives.asymmetric import ec
        from cryptography.x509.oid import ExtendedKeyUsageOID, NameOID
    except ImportError as error:
        raise UserError("certificates need cryptography: install mbsd[cluster]") from error
    files = {name: folder / name for name in ("ca.pem", "cert.pem", "key.pem")}
    for path in files.values():
        if path.exists():
            raise UserError(f"{path} exists already; remove it or choose another folder")
    authority, key = ec.generate_private_key(ec.SECP256R1()), ec.generate_private_key(ec.SECP256R1())
    issuer = x509.Name([x509.NameAttribute(NameOID.COMMON_NAME, f"{NAME} authority")])
    subject = x509.Name([x509.NameAttribute(NameOID.COMMON_NAME, NAME)])
    now = datetime.datetime.now(datetime.UTC)

    def signed(name: x509.Name, public: ec.EllipticCurvePublicKey, *extensions: x509.ExtensionType) -> bytes:
        built = x509.CertificateBuilder().subject_name(name).issuer_name(issuer).public_key(public)
        built = built.serial_number(x509.random_serial_number()).not_valid_before(now - datetime.timedelta(days=1))
        built = built.not_valid_after(now + datetime.timedelta(days=DAYS))
        for extension in extensions:
            built = built.add_extension(extension, critical=isinstance(extension, x509.BasicConstraints))
        return built.sign(authority, hashes.SHA256()).public_bytes(serialization.Encoding.PEM)

    known = x509.SubjectKeyIdentifier.from_public_key(authority.public_key())
    by = x509.AuthorityKeyIdentifier.from_issuer_public_key(authority.public_key())
    uses = x509.ExtendedKeyUsage([ExtendedKeyUsageOID.SERVER_AUTH, ExtendedKeyUsageOID.CLIENT_AUTH])
    signs = x509.KeyUsage(False, False, False, False, False, True, True, False, False)
    write_bytes(files["ca.pem"], signed(issuer, authority.public_key(), x509.BasicConstraints(True, 0), known, signs))
    write_bytes(files["cert.pem"], signed(subject, key.public_key(), x509.BasicConstraints(False, None), by, uses))
    plain = key.private_bytes(
        serialization.Encoding.PEM, serialization.PrivateFormat.PKCS8, serialization.NoEncryption()
    )
    write_bytes(files["key.pem"], plain)
    os.chmod(files["key.pem"], 0o600)
