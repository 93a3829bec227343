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
    plate: int = -1
    """Index of its plate in ``Job.plates``; -1 for a picture that is rendered whole."""


class Plate(msgspec.Struct, kw_only=True, frozen=True):
    """The picture of what stands while the camera does: rendered once for all its frames."""

    key: str
    """Hash of what stands."""
    trial: str
    """Hash of that and of the frame that tries the plate."""
    state: int
    """Index of that frame's state."""
    moving: list[str]
    """Bodies, and pieces as ``body/piece``, that move or are lifted."""
    trails: list[int]
    tubes: list[int]
    labels: list[int]
    """Indices of those that change."""


class Job(msgspec.Struct, kw_only=True, frozen=True):
    """Render ``pictures``, or save a .blend that plays all states."""

    scene: Scene
    states: list[State]
    """Consecutive frames; a blurred picture needs its neighbours."""
    pictures: list[Picture] = []
    plates: list[Plate] = []
    plates_folder: str = ""
    """Folder in which plates are kept."""
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
    plates: float = 0.0
    """Seconds inside Blender's renderer for plates and the frames that try them."""
    note: str = ""
    """A sentence for the user."""
    error: str = ""


def times_smaller(width: int, height: int) -> int:
    """Return how many times the small picture of a frame is smaller; 0 where no such number divides both sides."""
    return next((times for times in (4, 5, 3) if width % times == height % times == 0), 0)
