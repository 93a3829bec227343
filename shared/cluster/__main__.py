"""``python -m shared.cluster scheduler | worker ADDRESS | certificates FOLDER``: parts of a cluster."""

from __future__ import annotations

import argparse
import ipaddress
import os
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Sequence
from contextlib import suppress
from functools import partial
from pathlib import Path

from shared.cluster import address
from shared.stage.console import run_cli, say
from shared.stage.errors import UserError
from shared.stage.paths import ROOT, out_root
from shared.stage.signals import end_with_parent, terminable

# Keeper of a worker: Dask's worker ends with its scheduler, and another one waits for the next.


PAUSE = 1.0
"""s between the end of a worker and its successor, which itself waits until a scheduler answers."""
END = 20.0
"""s in which a worker ends that was asked to."""


def keep(command: Sequence[str], scheduler: str) -> int:
    """Run Dask's worker by ``command`` again and again; return its exit code after an error.

    SIGTERM, SIGHUP or Ctrl-C end it, and the worker with it. The worker gets SIGTERM if this process is killed.
    """
    with terminable():
        while True:
            code = _run(command)
            if code != 0:
                return code if code > 0 else 128 - code
            say("cluster", f"the scheduler {scheduler} is gone; this worker waits until it is back (Ctrl-C ends it)")
            time.sleep(PAUSE)


def _run(command: Sequence[str]) -> int:
    process = subprocess.Popen(
        command,
        start_new_session=True,  # Ctrl-C on the terminal reaches us alone
        preexec_fn=partial(end_with_parent, signal.SIGTERM),
    )
    try:
        return process.wait()
    finally:
        if process.poll() is None:
            process.terminate()
            try:
                process.wait(END)
            except subprocess.TimeoutExpired:
                with suppress(ProcessLookupError):
                    os.killpg(process.pid, signal.SIGKILL)
                process.wait()


WITHOUT_HTTP = ("--no-dashboard", "--dashboard-address", "127.0.0.1:0", "--preload", "shared.cluster.preload")
"""Dask starts its HTTP server always, by default on all interfaces: it begins on loopback, and the preload ends it."""


def main() -> None:
    """Read the command line and run its command.

    The scheduler takes the place of this process; a worker is kept by this one, see :func:`keep`.
    """
    parser = argparse.ArgumentParser(prog="python -m shared.cluster", description="Scheduler, workers, certificates.")
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    scheduler = commands.add_parser("scheduler", help="the one that knows all workers")
    scheduler.add_argument("--port", type=int, default=8786)
    worker = commands.add_parser("worker", help="takes work; one for each machine, as Blender uses all its cores")
    worker.add_argument("address", help="of the scheduler: tcp://name:8786 or tls://name:8786")
    worker.add_argument("--name", default="", help="what it is called; the host's name and a number if not given")
    for command in (scheduler, worker):
        command.add_argument(
            "--host", default="", help="address of this machine that others reach; 127.0.0.1 if not given"
        )
        command.add_argument("--plain", action="store_true", help="without certificates though others reach it")
    made = commands.add_parser("certificates", help="an authority, a certificate and its key, for all machines")
    made.add_argument("folder")
    arguments = parser.parse_args()
    if arguments.command == "certificates":
        if not arguments.folder:
            raise UserError("give a folder for the certificates: make certificates CLUSTER_TLS=folder")
        address.make(Path(arguments.folder))
        say(
            "cluster",
            f"{arguments.folder}: ca.pem, cert.pem, key.pem; copy the folder to every machine, show key.pem to nobody",
        )
        return
    host = arguments.host or "127.0.0.1"
    refuse_open(host, arguments.plain)
    os.chdir(ROOT)
    os.environ["PYTHONPATH"] = os.pathsep.join(filter(None, [str(ROOT), os.environ.get("PYTHONPATH", "")]))
    if arguments.command == "scheduler":
        scheme = "tls" if address.certificates() else "tcp"
        say("cluster", f"CLUSTER={scheme}://{host}:{arguments.port}")
        sys.stdout.flush()
        os.execv(sys.executable, scheduler_command(host, arguments.port))
    if not arguments.address:
        raise UserError("give the address of the scheduler: make worker CLUSTER=tcp://127.0.0.1:8786")
    os.environ[address.VARIABLE] = arguments.address
    address.address()
    folder = out_root() / ".cluster" / "dask"
    folder.mkdir(parents=True, exist_ok=True)
    sys.exit(keep(worker_command(arguments.address, host, arguments.name, folder), arguments.address))


def scheduler_command(host: str, port: int) -> list[str]:
    """Return the command of Dask's scheduler, without its HTTP server, which has no password (preload.py)."""
    scheme = "tls" if address.certificates() else "tcp"
    program = [
        sys.executable,
        "-m",
        "distributed.cli.dask_scheduler",
        "--host",
        f"{scheme}://{host}",
        "--port",
        str(port),
    ]
    return [*program, *WITHOUT_HTTP, *_tls()]


def worker_command(scheduler: str, host: str, name: str, folder: Path) -> list[str]:
    """Return the command of Dask's worker.

    A nanny starts it again when it ends; ``folder`` is for its own files.
    """
    scheme = "tls" if address.certificates() else "tcp"
    program = [sys.executable, "-m", "distributed.cli.dask_worker", scheduler, "--host", f"{scheme}://{host}"]
    options = ["--nworkers", "1", "--nthreads", "1", "--memory-limit", "0", "--local-directory", str(folder)]
    called = ["--name", name or f"{socket.gethostname()}-{os.getpid()}"]
    return [*program, *options, *WITHOUT_HTTP, *called, *_tls()]


def refuse_open(host: str, plain: bool) -> None:
    """Raise UserError for an address that others reach without certificates: a worker runs any code."""
    if plain or address.certificates() or is_loopback(host):
        return
    raise UserError(
        f"HOST={host} can be reached by others, and a worker runs what it is sent. Make certificates and give their "
        "folder as CLUSTER_TLS=folder, or give --plain if nobody else can reach that network"
    )


def is_loopback(host: str) -> bool:
    """Return True if only this machine reaches the address."""
    if host == "localhost":
        return True
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False


def _tls() -> list[str]:
    files = address.certificates()
    if files is None:
        return []
    return [
        part for name, path in zip(("ca-file", "cert", "key"), files, strict=True) for part in (f"--tls-{name}", path)
    ]


if __name__ == "__main__":
    run_cli(main)
