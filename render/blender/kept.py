"""A Blender process that keeps its scene and makes pictures one after the other, as they are asked for."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path

import msgspec

from render.blender.child import Child
from render.blender.ending import Silent
from render.blender.job import Answer, Job, Picture
from render.blender.memory import Grown
from render.blender.patience import Patience
from render.blender.scratch import scratch_folder
from shared.stage.errors import UserError
from shared.stage.paths import out_root, refuse_links


class KeptBlender:
    """Starts with the first picture, and again after one that failed; one that grew too large is replaced.

    ``job`` says the scene, its pictures do not count.
    """

    def __init__(self, job: Job) -> None:
        self.job = msgspec.structs.replace(job, pictures=[], waits=True)
        self.device = ""
        self._folder = ""
        self._stack = ExitStack()
        self._child: Child | None = None
        self._answers: Iterator[Answer] = iter(())

    def make(self, state: int, key: str, name: str) -> Answer:
        """Render one picture; the answer has its path, which the next picture may remove.

        Raises UserError with the reason if Blender cannot.
        """
        try:
            try:
                return self._ordered(state, key, name)
            except Grown:
                self.stop()
                return self._ordered(state, key, name)
        except (Silent, Grown) as failure:
            self.stop()
            raise UserError(str(failure)) from failure
        except BaseException:
            self.stop()
            raise

    def stop(self) -> None:
        """End the process and remove what it left."""
        if self._child is not None:
            self._child.stop()
            self._child = None
        self._stack.close()

    def _ordered(self, state: int, key: str, name: str) -> Answer:
        if self._child is None:
            self._start()
        for path in Path(self._folder).glob("*.png"):
            path.unlink()
        picture = Picture(state=state, folder=self._folder, key=key, name=name)
        assert self._child is not None
        assert self._child.process is not None
        assert self._child.process.stdin is not None
        try:
            self._child.process.stdin.write(msgspec.json.encode(picture) + b"\n")
            self._child.process.stdin.flush()
        except BrokenPipeError:
            pass  # its last answer, or how it ended, tells why
        for answer in self._answers:
            if answer.key == picture.key:
                return answer
        raise UserError(f"Blender ended before {picture.name} was made")

    def _start(self) -> None:
        home = out_root() / ".blender"
        for folder in (home / "user", home / "cache"):
            refuse_links(folder)
        scratch = self._stack.enter_context(scratch_folder(home))
        self._folder = str(scratch.resolve())
        self._child = Child(home, scratch, Patience())
        self._answers = self._child.attempt(self.job)
        for answer in self._answers:
            if answer.device:
                self.device = answer.device
                return
