"""An sshd on loopback with keys of its own in a temporary folder; nothing of the user's is read or written."""

from __future__ import annotations

import fcntl
import os
import shlex
import shutil
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path

from shared.system.missing import program
from tests.running.processes import ends_with_us

RELAY = Path(__file__).with_name("relay.py")
PRIVILEGE_SEPARATION = Path("/run/sshd")
"""sshd wants it where it runs as root; a system without sshd's service has none."""
MADE = Path("/run/sshd-of-tests")
"""Locked by each of the processes that made it."""


@dataclass(frozen=True)
class Machine:
    """The other machine: this one."""

    folder: Path
    port: int

    @property
    def counted(self) -> Path:
        return self.folder / "counted"

    def shell(self, most: int = 0, port: int = 0) -> str:
        """For $RSYNC_RSH; ``most``: bytes after which the line hangs; ``port``: another one than sshd's."""
        relay = shlex.join([sys.executable, str(RELAY), str(port or self.port), str(self.counted), str(most)])
        options = [
            f"IdentityFile={self.folder / 'key'}",
            f"UserKnownHostsFile={self.folder / 'known'}",
            "IdentitiesOnly=yes",
            "StrictHostKeyChecking=accept-new",
            "BatchMode=yes",
            "LogLevel=ERROR",
            f"ProxyCommand={relay}",
        ]
        words = ["ssh", "-F", "/dev/null", *(word for option in options for word in ("-o", option))]
        return " ".join(f"'{word}'" if " " in word else word for word in words)  # as rsync takes words apart


@contextmanager
def machine(folder: Path) -> Iterator[Machine]:
    """Start it; it ends with the block."""
    with _privilege_separation():
        yield from _started(folder)


@contextmanager
def _privilege_separation() -> Iterator[None]:
    """Make sshd's folder where root has none, and remove it with the last of those that made it."""
    if os.getuid() != 0 or (PRIVILEGE_SEPARATION.exists() and not MADE.exists()):
        yield
        return
    handle = os.open(MADE, os.O_RDWR | os.O_CREAT, 0o600)
    fcntl.flock(handle, fcntl.LOCK_SH)
    PRIVILEGE_SEPARATION.mkdir(mode=0o755, exist_ok=True)
    try:
        yield
    finally:
        with suppress(OSError):
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
            PRIVILEGE_SEPARATION.rmdir()
            MADE.unlink()
        os.close(handle)


def _started(folder: Path) -> Iterator[Machine]:
    folder.mkdir(mode=0o700)
    for name in ("host", "key"):
        subprocess.run(["ssh-keygen", "-q", "-t", "ed25519", "-N", "", "-f", str(folder / name)], check=True)
    shutil.copy(folder / "key.pub", folder / "authorized")
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    settings = {
        "Port": port,
        "ListenAddress": "127.0.0.1",
        "HostKey": folder / "host",
        "AuthorizedKeysFile": folder / "authorized",
        "PidFile": "none",
        "StrictModes": "no",
        "UsePAM": "no",
        "PasswordAuthentication": "no",
        "PermitRootLogin": "yes",
    }
    (folder / "config").write_text("".join(f"{name} {value}\n" for name, value in settings.items()))
    server = program("sshd")
    assert server is not None, "who calls this asks first whether sshd is there"
    with (folder / "log").open("wb") as log:
        process = subprocess.Popen(
            [server, "-D", "-e", "-f", str(folder / "config")], stdout=log, stderr=log, preexec_fn=ends_with_us
        )
    try:
        _wait(process, port, folder / "log")
        yield Machine(folder, port)
    finally:
        process.terminate()
        process.wait()


def _wait(process: subprocess.Popen[bytes], port: int, log: Path) -> None:
    for _ in range(200):
        with suppress(OSError), socket.create_connection(("127.0.0.1", port), timeout=1):
            return
        assert process.poll() is None, log.read_text()
        time.sleep(0.05)
    raise AssertionError(log.read_text())
