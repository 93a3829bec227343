"""The author's mechanism: loaded once, solved with any numbers of its Params."""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from mbsd import AssemblyError, BranchError, LimitError, Mechanism, MechanismError, SingularPoseError, Solution
from mbsd.drawing.moving_skeleton import Moving, moving, redrawn
from mechanisms.stages.loading import loading
from mechanisms.stages.loading.inputs import author_files, path_of, recording
from mechanisms.stages.solve import solving
from mechanisms.stages.solve.masses import bodies_of, give_masses
from mechanisms.stages.solve.motion_file import to_motion
from mechanisms.stages.solve.skeleton_file import moving_of
from render.view.document import encode
from render.view.payload import payload
from shared import contract
from shared.contract import Motion, Parts
from shared.contract.geometry import with_rods
from shared.contract.shot import Shot
from shared.contract.skeleton import Moving as Told
from shared.stage import console
from shared.stage.errors import UserError
from shared.stage.paths import Out, mechanism_file, mechanism_folder, shown_file
from studio.live.numbers import changed

# Solutions as the page shows them: the bytes of its payload.


class Shown:
    """Payloads of one mechanism; ``quick`` ones keep symbol size and extent of the last whole one."""

    def __init__(self) -> None:
        self._last: Moving | None = None
        self._motion: tuple[Motion, Told] | None = None

    def payload(
        self,
        solution: Solution,
        parts: Parts | None,
        sources: Mapping[str, Any],
        shot: Shot | None,
        quick: bool,
        arrows: bool = True,
    ) -> dict[str, Any]:
        """Return the payload without its parts.

        Raises UserError for a shot that names something missing.
        """
        skeleton = redrawn(solution, self._last) if quick and self._last is not None else None
        if skeleton is None:
            skeleton = moving(solution)
            self._last = skeleton
        motion = to_motion(solution, parts, "", {}, sources)
        skeleton_data = moving_of(solution, skeleton)
        self._motion = motion, skeleton_data
        return payload(motion, skeleton_data, shot, arrows or not quick)

    def solid(self, parts: Parts, shot: Shot | None, folder: Path) -> bytes:
        """Return the bytes of the last motion's payload with its parts. Raises UserError."""
        from render.film.film import Film
        from render.view.solid import with_parts

        assert self._motion is not None
        motion, skeleton_data = self._motion
        motion = with_rods(motion, parts)
        film = Film(motion, parts, shot or Shot(), folder)
        return encode(with_parts(payload(motion, skeleton_data, shot), film), compress=False)


# The stop of a driven motion: the last moment at which the links close, with the motion up to there.


STEPS = 360
FEWEST = 3
"""Moments of a motion that can be shown."""
FINER = 20
"""Halvings after the grid: the angle is known to a millionth of a step."""
OPENS = (AssemblyError, BranchError, LimitError, SingularPoseError)


@dataclass(frozen=True)
class Stop:
    """Place and reason of a stop."""

    time: float
    """s"""
    drivers: dict[str, float]
    """Their values there: rad, or m."""
    text: str
    """Message of the solver."""


def until_it_stops(name: str, module: Any, m: Mechanism, solve: Callable[[], Solution]) -> tuple[Solution, Stop | None]:
    """Return the solution of ``solve``, or the motion up to the moment when the links open.

    Raises UserError as ``solve`` does where there is no motion at all, or the author solves it himself.
    """
    try:
        return solve(), None
    except UserError as error:
        if not isinstance(error.__cause__, OPENS) or hasattr(module, "motion") or not m.drivers:
            raise
        longest = _longest(m, loading.constant(name, module, "DURATION"))
        if longest is None:
            raise
        values = {driver: float(longest.driver(driver).value[-1]) for driver in m.drivers}
        return longest, Stop(float(longest.t[-1]), values, str(error))


def _longest(m: Mechanism, duration: Any) -> Solution | None:
    from mbsd.kinematics.sweep import sweep_times

    try:
        grid = sweep_times(m, duration, STEPS, None)
    except MechanismError:
        return None

    def swept(times: np.ndarray) -> Solution | None:
        try:
            return m.sweep(times=times)
        except MechanismError:
            return None

    good, bad = 0, len(grid) - 1
    while bad - good > 1:
        middle = (good + bad) // 2
        good, bad = (middle, bad) if swept(grid[: middle + 1]) else (good, middle)
    if good < FEWEST - 1:
        return None
    last, beyond = float(grid[good]), float(grid[bad])
    for _ in range(FINER):
        middle = (last + beyond) / 2
        last, beyond = (middle, beyond) if swept(np.append(grid[: good + 1], middle)) else (last, middle)
    times = np.append(grid[: good + 1], last) if last > grid[good] else grid[: good + 1]
    return swept(times)


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
