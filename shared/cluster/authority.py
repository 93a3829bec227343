"""Certificates for a cluster: an authority, and a certificate with its key for all machines."""

from __future__ import annotations

import datetime
import os
from pathlib import Path

from shared.stage.errors import UserError
from shared.stage.files import write_bytes

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
            raise UserError(f"{path} is there already; remove it or choose another folder")
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
