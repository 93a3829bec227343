"""Results that are kept: files of many points each, every one whole, named by a hash of its bytes.

The first line of a file says what its results depend on beside the content of build and measure: modules, files,
folders, variables and packages, each in the state that it had. Only where all of them are in this state are they used.
"""

from __future__ import annotations

import hashlib
import json
import os
import time
from contextlib import suppress
from pathlib import Path

from mbsd.base.errors import ModelError
from mbsd.base.files import write_whole
from mbsd.dependencies.inputs import Inputs, Places
from mbsd.studies.work import Result

EVERY = 5.0
"""Seconds after which what was computed is written; a kill loses as much at most."""
MOST_FILES = 32
"""More than these become one when a study is opened."""


class Store:
    """Results of one build and measure by the key of their point.

    Raises ModelError if the folder cannot be used. ``inputs`` are those that are known before anything is computed.
    """

    def __init__(self, folder: str | os.PathLike[str], study: str, places: Places, inputs: Inputs) -> None:
        self.folder = Path(folder) / study[:32]
        self.inputs = inputs
        self._places = places
        self._states: dict[tuple[str, str], str] = {}
        self.known: dict[str, Result] = {}
        self._fresh: dict[str, Result] = {}
        self._written = time.monotonic()
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
        except (OSError, ValueError) as error:
            raise ModelError(f"study: cannot use the folder {folder} ({error}); give another or folder=None") from error
        files = self._read()
        if len(files) > MOST_FILES:
            self._last = ""
            self._write(self.known)
            for file in files:
                if file.name != self._last:
                    file.unlink(missing_ok=True)

    def depend(self, inputs: Inputs) -> None:
        """Add inputs on which results depend from now on."""
        self.inputs = self.inputs.merged(inputs)

    def keep(self, key: str, result: Result) -> None:
        """Keep a result, in a file now and then."""
        self._fresh[key] = result
        if time.monotonic() - self._written > EVERY:
            self.flush()

    def flush(self) -> None:
        """Write what is not in a file yet. Raises ModelError if the disk has no room."""
        self._write(self._fresh)
        self.known.update(self._fresh)
        self._fresh, self._written = {}, time.monotonic()

    def _write(self, results: dict[str, Result]) -> None:
        if not results:
            return
        lines = [_line(self.inputs.states())]
        lines += [_line([key, result.values, result.reason]) for key, result in results.items()]
        content = "\n".join(lines).encode()
        self._last = f"{hashlib.sha256(content).hexdigest()[:32]}.jsonl"
        write_whole(self.folder / self._last, content)

    def _read(self) -> list[Path]:
        """Read all files; a damaged one is deleted, and its points are computed again.

        Those of other inputs stay, in case these come back, but for those that are too many.
        """
        read = []
        for file in sorted(self.folder.glob("*.jsonl")):
            if file.name.startswith("."):
                continue  # another study writes it now
            with suppress(FileNotFoundError):  # another study made one of many
                content = file.read_bytes()
                if file.stem != hashlib.sha256(content).hexdigest()[:32]:
                    file.unlink(missing_ok=True)
                    continue
                first, *lines = content.splitlines()
                read.append(file)
                inputs = Inputs(**json.loads(first))
                if not self._are_as_now(inputs):
                    continue
                self.inputs = self.inputs.joined(inputs)
                for line in lines:
                    key, values, reason = json.loads(line)
                    self.known[key] = Result(values, reason)
        return read

    def _are_as_now(self, inputs: Inputs) -> bool:
        return all(
            self._state(kind, name) == state
            for kind, states in inputs.states().items()
            for name, state in states.items()
        )

    def _state(self, kind: str, name: str) -> str:
        """Return the present state of an input; each is looked at once."""
        if (kind, name) not in self._states:
            self._states[kind, name] = self._places.state(kind, name)
        return self._states[kind, name]


def _line(value: object) -> str:
    return json.dumps(value, separators=(",", ":"))
