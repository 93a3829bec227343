"""Scheduler and worker as they are started by hand, with certificates; addresses that are refused."""

from __future__ import annotations

import os
import socket
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import psutil
import pytest

from shared.cluster.__main__ import is_loopback, refuse_open
from shared.cluster.address import address, connected, make
from shared.cluster.deal import Contents, Deal, content_hash
from shared.stage.errors import UserError
from shared.stage.paths import ROOT
from tests.running.processes import ends_with_us, until
from tests.shared.cluster import acting

HOST, OTHER_HOST = ("127.0.0.2", "127.0.0.3") if sys.platform == "linux" else ("127.0.0.1", "127.0.0.1")
"""Addresses of scheduler and worker; systems other than Linux have one address of loopback."""


@contextmanager
def started(*words: str, log: Path) -> Iterator[subprocess.Popen[bytes]]:
    """Yield a scheduler or worker until the block ends."""
    with log.open("w") as said:
        process = subprocess.Popen(
            [sys.executable, "-m", "shared.cluster", *words], cwd=ROOT, stdout=said, stderr=said,
            preexec_fn=ends_with_us,
        )  # fmt: skip
        try:
            yield process
        finally:
            process.terminate()
            process.wait(timeout=20)


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def answers_at(port: int) -> bool:
    with suppress(OSError):
        socket.create_connection((HOST, port), 1).close()
        return True
    return False


def listening(process: subprocess.Popen[bytes]) -> list[tuple[str, int]]:
    """Return the addresses on which the process and its descendants listen."""
    family = [psutil.Process(process.pid), *psutil.Process(process.pid).children(recursive=True)]
    connections = [connection for member in family for connection in member.net_connections("inet")]
    return [
        (str(connection.laddr[0]), int(connection.laddr[1]))
        for connection in connections
        if connection.status == psutil.CONN_LISTEN
    ]


def test_a_cluster_with_certificates_does_work_and_lets_nobody_else_in(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its worker outlives the scheduler, and ends when the process that keeps it is killed. Both listen on the address
    of their HOST alone.
    """
    make(tmp_path / "certificates")
    assert (tmp_path / "certificates" / "key.pem").stat().st_mode & 0o077 == 0
    with pytest.raises(UserError, match="exists already"):
        make(tmp_path / "certificates")
    port = free_port()
    monkeypatch.setenv("CLUSTER_TLS", str(tmp_path / "certificates"))
    monkeypatch.setenv("MBSD_OUT", str(tmp_path / "out"))
    monkeypatch.setenv("CLUSTER", f"tls://{HOST}:{port}")
    monkeypatch.setenv("PYTHONPATH", str(ROOT))
    content = b"in common"
    name = content_hash(content)
    with started("worker", f"tls://{HOST}:{port}", "--host", OTHER_HOST, log=tmp_path / "worker.log") as worker:
        for life in ("first", "second"):
            with started("scheduler", "--host", HOST, "--port", str(port), log=tmp_path / f"{life}.log") as scheduler:
                until(lambda: answers_at(port))
                with connected() as client:
                    inputs = {name: lambda: content}
                    doubled = acting.work(acting.doubled)
                    work = Deal(client, doubled, name, inputs, {"a": 1, "b": 2}, ("shared/cluster",))
                    answers = {key: value for key, value, _ in work.results()}
                    assert answers == {"a": "in common11", "b": "in common22"}
                assert listening(scheduler) == [(HOST, port)]
                assert {host for host, _ in listening(worker)} == {OTHER_HOST}
                assert len(listening(worker)) == 2  # the worker and its nanny, no HTTP server
                if life == "second":
                    monkeypatch.setattr("mbsd.dealing.connection.TIMEOUT", 1.0)
                    other = tmp_path / "others"
                    make(other)
                    monkeypatch.setenv("CLUSTER_TLS", str(other))
                    with pytest.raises(UserError, match="no scheduler answers"), connected():
                        pass
                    below = psutil.Process(worker.pid).children(recursive=True)
                    assert below
                    worker.kill()
                    assert psutil.wait_procs(below, timeout=20)[1] == []
    assert "this worker waits until it is back" in (tmp_path / "worker.log").read_text()


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ("server", "is not the address"),
        ("tcp://server", "is not the address"),
        ("http://server:1", "is not the address"),
        ("tls://a:1", "CLUSTER_TLS"),
    ],
)
def test_invalid_addresses_are_refused(given: str, said: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("CLUSTER_TLS", raising=False)
    monkeypatch.setenv("CLUSTER", given)
    with pytest.raises(UserError, match=said):
        address()


def test_a_missing_certificate_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("CLUSTER_TLS", str(tmp_path))
    monkeypatch.setenv("CLUSTER", "tls://a:1")
    with pytest.raises(UserError, match=r"ca\.pem is missing"):
        address()


def test_others_reach_nothing_without_certificates(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("CLUSTER_TLS", raising=False)
    monkeypatch.delenv("CLUSTER", raising=False)
    for host in ("127.0.0.1", "localhost", "::1"):
        assert is_loopback(host)
        refuse_open(host, plain=False)
    for host in ("0.0.0.0", "192.0.2.1", "server"):
        with pytest.raises(UserError, match="runs what it is sent"):
            refuse_open(host, plain=False)
        refuse_open(host, plain=True)


def test_contents_are_whole_and_the_longest_unused_go(tmp_path: Path) -> None:
    kept = Contents(tmp_path, limit=2500)
    parts = [os.urandom(1000) for _ in range(3)]
    names = [content_hash(part) for part in parts]
    for name, part in zip(names[:2], parts[:2], strict=True):
        kept.keep({name: part})
    os.utime(tmp_path / names[0], (1e9, 2e9))
    os.utime(tmp_path / names[1], (1e9, 1e9))
    kept.keep({names[2]: parts[2]})
    assert kept.lacking(names) == [names[1]]
    (tmp_path / names[0]).write_bytes(parts[0][:-1])
    assert Contents(tmp_path).lacking(names) == names[:2]
    kept.keep({names[1]: b"other bytes"})
    assert names[1] in kept.lacking(names)
