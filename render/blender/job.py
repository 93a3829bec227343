"""The job of a Blender process: what the parent asks, one JSON file; and the answers, one JSON line at a time."""

from __future__ import annotations

import msgspec

from render.film.scene import Scene, State


class Picture(msgspec.Struct, kw_only=True, frozen=True):
    """One picture to make: the state at an index of ``Job.states``, written whole into ``folder``.

    Its file is called ``<key>-<hash of key and bytes>.png``.
    """

    state: int
    folder: str
    key: str
    name: str
    """Name in messages: ``frame 12``."""


class Job(msgspec.Struct, kw_only=True, frozen=True):
    """Render ``pictures``, or save a .blend that plays all states."""

    scene: Scene
    states: list[State]
    """Consecutive frames; a blurred picture needs its neighbours."""
    pictures: list[Picture] = []
    waits: bool = False
    """Takes more pictures afterwards, a JSON line each on its standard input, until that closes."""
    blend: str | None = None
    width: int = 1280
    height: int = 720
    samples: int = 8
    motion_blur: bool = False
    flat: dict[str, tuple[float, float, float]] | None = None
    """Only these pieces (``body/piece``), as flat linear colours on black, sharp, without a view transform."""

    @property
    def drawn(self) -> bool:
        """True if the look draws lines instead of light."""
        return self.scene.studio.look.drawing is not None and self.flat is None


class Answer(msgspec.Struct, kw_only=True, frozen=True, omit_defaults=True):
    """One line from the Blender process: the device once, what it does, a line per picture; or an error."""

    device: str = ""
    doing: str = ""
    """Next step, in words after "Blender"."""
    path: str = ""
    """A file that is whole."""
    key: str = ""
    """Key of the picture in that file."""
    cycles: float = 0.0
    """Seconds inside Blender's renderer for this picture."""
    error: str = ""
