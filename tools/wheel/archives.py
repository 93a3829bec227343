"""The archives: sources copied to a folder, an sdist of them, wheels of the unpacked sdist."""

from __future__ import annotations

import gzip
import io
import os
import shutil
import subprocess
import sys
import tarfile
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from importlib.metadata import distribution
from pathlib import Path

from shared.stage.errors import UserError
from shared.stage.files import write_bytes
from tools.wheel.kernels import compile_into, interpreter

BESIDE = ("pyproject.toml", "setup.py", "MANIFEST.in", "README.md", "LICENSE", "NOTICE.md")
EARLIEST = 315532800
"""s: 1980, before which zip files have no times."""
ROOMS = ("mechanisms", "render", "shared", "studio")
"""Rooms that the wheel brings besides the solver (setup.py)."""


def build(root: Path, out: Path) -> list[Path]:
    """The sdist and the wheel of the clone ``root``, written to ``out``."""
    with _unpacked(root) as (sdist, sources):
        wheel = _backend("build_wheel", sources)
        return [_move(file, out) for file in (sdist, wheel)]


def build_with_kernels(
    root: Path, out: Path, version: str = "", fill: Callable[[Path, Path, Path], None] = compile_into
) -> Path:
    """Build a wheel with compiled kernels, for one Python, this numba and processors of this kind.

    ``version``: of that Python, such as "3.12"; this one if it is not given. ``fill(folder, sources, python)`` puts the
    compiled kernels of the package below ``sources`` into ``folder``.
    """
    with _unpacked(root) as (_, sources), interpreter(version) as python:
        kernels = sources / "mbsd" / "kernels"
        fill(kernels, sources, python)
        (kernels / "made_for.json").write_text(_described(python, sources))
        settings = {"--build-option": [f"--plat-name={_platform()}"]}
        return _move(_backend("build_wheel", sources, settings, python), out)


@contextmanager
def _unpacked(root: Path) -> Iterator[tuple[Path, Path]]:
    """The sdist, and the folder that it unpacks to."""
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        copied = folder / "copied"
        copied.mkdir()
        for name in BESIDE:
            shutil.copy(root / name, copied)
        for room in ("mbsd", *ROOMS):
            shutil.copytree(root / room, copied / room, ignore=shutil.ignore_patterns("__pycache__"))
        for path in copied.rglob("*"):
            path.chmod(0o755 if path.is_dir() else 0o644)
        sdist = _backend("build_sdist", copied)
        _settle(sdist)
        with tarfile.open(sdist) as archive:
            archive.extractall(folder / "unpacked", filter="tar")
        (sources,) = (folder / "unpacked").iterdir()
        yield sdist, sources


def _settle(sdist: Path) -> None:
    """Write it again with its members in order and no word of when and by whom they were made."""
    plain = io.BytesIO()
    with tarfile.open(sdist) as old, tarfile.open(fileobj=plain, mode="w", format=tarfile.PAX_FORMAT) as new:
        for member in sorted(old.getmembers(), key=lambda entry: entry.name):
            member.mtime, member.uid, member.gid, member.uname, member.gname = _time(), 0, 0, "", ""
            member.mode, member.pax_headers = 0o755 if member.isdir() else 0o644, {}
            new.addfile(member, old.extractfile(member) if member.isfile() else None)
    sdist.write_bytes(gzip.compress(plain.getvalue(), mtime=_time()))


def _described(python: Path, sources: Path) -> str:
    """Return what code compiled by this Python depends on, as JSON."""
    code = "import json; from mbsd.compiling.kernel_files import here; print(json.dumps(here(), indent=1))"
    environment = os.environ | {"PYTHONPATH": str(sources)}
    return subprocess.run([str(python), "-c", code], env=environment, check=True, capture_output=True, text=True).stdout


def _time() -> int:
    return int(os.environ.get("SOURCE_DATE_EPOCH") or EARLIEST)


def _backend(
    hook: str, sources: Path, settings: dict[str, list[str]] | None = None, python: Path = Path(sys.executable)
) -> Path:
    """Return what a hook of the build backend makes in a process of its own, which sees no other source."""
    code = f"from setuptools.build_meta import *; print({hook}('dist', config_settings={settings!r}))"
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    environment["SOURCE_DATE_EPOCH"] = str(_time())
    command = [str(python), "-c", code]
    # A wheel keeps the modes of its files, and these follow the umask.
    done = subprocess.run(command, cwd=sources, env=environment, umask=0o022, capture_output=True, text=True)
    if done.returncode != 0:
        raise UserError(f"wheel: setuptools could not do {hook}: {done.stderr.strip()[-500:]}")
    return sources / "dist" / done.stdout.splitlines()[-1]


def _platform() -> str:
    """The platform of numba's own wheel: its machine code runs where this one's does."""
    lines = (distribution("numba").read_text("WHEEL") or "").splitlines()
    return next(line.rpartition("-")[2] for line in lines if line.startswith("Tag: "))


def _move(file: Path, out: Path) -> Path:
    write_bytes(out / file.name, file.read_bytes())
    return out / file.name
