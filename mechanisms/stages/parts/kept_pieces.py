"""Pieces that are meshed, weighed and written, kept while the stage has not ended: what was stopped goes on from there.

A piece is known by the bytes of its shape and all else that its files follow from. The folder is removed when the stage
ends. Of a stage that ends soon nothing is written.
"""

from __future__ import annotations

import io
import os
import shutil
import time
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Any

import msgspec

from shared.contract import Piece
from shared.stage.paths import refuse_links
from shared.stage.stages import key_of

SOON = 10.0
"""Seconds after which pieces are written; those before are written then, too."""


class Kept(msgspec.Struct):
    """A piece with the bytes of its files."""

    piece: Piece
    stl: bytes
    step: bytes


class KeptPieces:
    """Those in ``folder`` that were made by the same program, whose hash is ``program``."""

    def __init__(self, folder: Path, program: str, soon: float = SOON) -> None:
        self.folder, self.program = folder, program
        self._begins = time.monotonic() + soon
        self._waiting: dict[str, Kept] = {}

    def key(self, shape: Any, solid: Any, along: bool) -> str:
        """What the piece of ``solid`` is known by; ``shape`` is its ``cadquery.Solid``, as yet without a mesh."""
        stream = io.BytesIO()
        shape.exportBin(stream)
        return key_of(self.program, stream.getvalue(), replace(solid, shape=None), along)

    def get(self, key: str) -> Kept | None:
        """The piece, if it is there whole."""
        try:
            return msgspec.msgpack.decode((self.folder / key).read_bytes(), type=Kept)
        except (OSError, msgspec.MsgspecError):
            return None

    def add(self, key: str, kept: Kept) -> None:
        """Keep a piece; a disk that takes none is left to who writes the files themselves."""
        self._waiting[key] = kept
        if time.monotonic() < self._begins:
            return
        with suppress(OSError):
            refuse_links(self.folder)
            self.folder.mkdir(parents=True, exist_ok=True)
            for name, waiting in self._waiting.items():
                self._write(name, msgspec.msgpack.encode(waiting))
        self._waiting = {}

    def _write(self, key: str, content: bytes) -> None:
        new = self.folder / f"{key}.{os.getpid()}"
        new.write_bytes(content)
        new.replace(self.folder / key)

    def clear(self) -> None:
        """Forget them all."""
        refuse_links(self.folder)
        shutil.rmtree(self.folder, ignore_errors=True)
