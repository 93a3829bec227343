"""The author's mechanism: loaded once, solved with any numbers of its Params."""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mbsd import Mechanism, Solution
from mechanisms.stages.loading import loading
from mechanisms.stages.loading.inputs import author_files, path_of, recording
from mechanisms.stages.solve import solving
from mechanisms.stages.solve.masses import bodies_of, give_masses
from render.view.document import encode
from shared import contract
from shared.contract.shot import Shot
from shared.stage import console
from shared.stage.errors import UserError
from shared.stage.paths import Out, mechanism_file, mechanism_folder, shown_file
from studio.live.child.shown import Shown
from studio.live.child.stops import Stop, until_it_stops
from studio.live.numbers import changed


@dataclass
class Answer:
    """Solved motion with what the page shows beside it."""

    payload: bytes
    stop: Stop | None


class Author:
    """Files mechanism.py and shot.py of one mechanism or variant.

    Raises UserError if they cannot be loaded.
    """

    def __init__(self, name: str, tell_files: Callable[[list[Path]], None]) -> None:
        self.name = name
        self.folder = mechanism_folder(name)
        with recording() as recorder:
            try:
                self.module: Any = loading.load(name, "mechanism")
                self.params: Any = loading.params(name)
                self.shot = self._shot()
            finally:  # what cannot be loaded is looked at again when one of its files changes
                tell_files(self._files(recorder.files))
        self.parts = self._parts()
        self._shown, self._told = Shown(), set[str]()
        self.steady: list[str] | None = None
        """Numbers of Params that move no driver, once they are known."""

    def changed(self, values: dict[str, float]) -> Any:
        """Return Params with these numbers."""
        with loading.author_code(self.name):
            return changed(self.params, values)

    def build(self, p: Any) -> Mechanism:
        """Return the mechanism of these Params."""
        return solving.build(self.name, self.module, p)

    def answer(self, values: dict[str, float], quick: bool = False, arrows: bool = True) -> Answer:
        """Solve with these numbers; ``quick`` for a slider in motion, with ``arrows`` if wanted.

        Raises UserError.
        """
        p = self.changed(values)
        m = self.build(p)
        sources, sentences = give_masses(m, self._fitting(m))
        for sentence in sentences:
            if sentence not in self._told and not values:
                self._told.add(sentence)
                console.say("solve", f"{self.name}: {sentence}")
        solution, stop = until_it_stops(self.name, self.module, m, lambda: self._motion(m, p))
        shown = self._shown.payload(solution, self._fitting(m), sources, self._shot_of(m), quick, arrows)
        return Answer(encode(shown, compress=False), stop)

    def payload(self, values: dict[str, float], quick: bool = False) -> dict[str, Any]:
        """Return the page's payload of the motion with these numbers.

        Raises UserError, also if the motion does not reach its end.
        """
        p = self.changed(values)
        m = self.build(p)
        sources, _ = give_masses(m, self._fitting(m))
        solution = self._motion(m, p)
        return self._shown.payload(solution, self._fitting(m), sources, self._shot_of(m), quick)

    def solid(self) -> bytes | None:
        """Return the payload of the parts of the last motion as the file has it; None without parts."""
        m = self.build(self.params)
        parts = self._fitting(m)
        return None if parts is None else self._shown.solid(parts, self._shot_of(m), Out(self.name).parts_folder)

    def _motion(self, m: Mechanism, p: Any) -> Solution:
        return solving.motion_of(self.name, self.module, m, p)

    def _parts(self) -> contract.Parts | None:
        """Return the readable parts, if any; they are rebuilt meanwhile."""
        out = Out(self.name)
        try:
            return contract.read_parts(out.parts, out.name) if out.parts.is_file() else None
        except UserError:
            return None

    def _fitting(self, m: Mechanism) -> contract.Parts | None:
        """Return the parts if they have the bodies of ``m``; after an edit they may be outdated."""
        if self.parts is None:
            return None
        solids = {*bodies_of(self.parts), *self.parts.without_solids} - {"ground"}
        return self.parts if solids == set(m.bodies) - {"ground"} else None

    def _shot(self) -> Shot | None:
        """Return the shot of shot.py; an error in it is reported and leaves the motion as it is."""
        if not loading.has(self.name, "shot"):
            return None
        return said(lambda: self._checked(loading.load(self.name, "shot").shot))

    def _checked(self, shot: Any) -> Shot:
        if not isinstance(shot, Shot):
            file = shown_file(self.name, "shot")
            raise UserError(f"{self.name}: {file}: 'shot' is a {type(shot).__name__}; write shot = Shot(...)")
        return shot

    def _shot_of(self, m: Mechanism) -> Shot | None:
        """Return the shot if the points whose trails it shows exist."""
        named = [trail.point for trail in self.shot.trails] if self.shot is not None and self.shot.trails else []
        return self.shot if all(point in m.traces for point in named) else None

    def _files(self, read: dict[str, str]) -> list[Path]:
        """Return the author's own files that were loaded or read."""
        files = {path_of(name) for name in read}
        package = loading.package_of(self.name)
        for file in ("mechanism", "shot"):
            if f"{package}.{file}" in sys.modules:
                files |= {path for path, _ in author_files(mechanism_file(self.name, file), package, Path())}
        return sorted(files)


def said(function: Callable[[], Any]) -> Any:
    """Return the result of ``function``; None after a UserError, which is reported."""
    try:
        return function()
    except UserError as error:
        console.warn("shot", str(error))
        return None
