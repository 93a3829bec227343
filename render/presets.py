"""Presets of pictures: size, quality and aspect; and the arrows that a picture shows."""

from __future__ import annotations

from dataclasses import dataclass, replace

from shared.stage.errors import UserError, did_you_mean
from shared.stage.face import said

# Presets say how large a picture is, in which aspect, and with how many samples. The active one is always printed.


@dataclass(frozen=True)
class Preset:
    """Size in pixels, Cycles samples a pixel, whether the shutter blurs what moves."""

    name: str
    width: int
    height: int
    samples: int
    motion_blur: bool = False
    poster: int = 128
    """Samples of a poster."""

    @property
    def of_poster(self) -> Preset:
        """The preset of this size's poster, which one looks at for long."""
        base, dash, shape = self.name.partition("-")
        return replace(self, name=f"{base}_poster{dash}{shape}", samples=max(self.samples, self.poster))

    def __str__(self) -> str:
        blur = "motion blur" if self.motion_blur else "no blur"
        return f"{self.name} ({self.width}x{self.height}, {self.samples} samples, {blur})"

    @property
    def aspect(self) -> float:
        """Width over height, for which the camera frames the machine."""
        return self.width / self.height

    @property
    def suffix(self) -> str:
        """Suffix of file names if the picture is not 16:9: ``-9x16``, else empty."""
        _, dash, shape = self.name.partition("-")
        return dash + shape

    @property
    def request(self) -> str:
        """The words that ask for it: ``PRESET=preview ASPECT=9:16`` of make, ``--preset preview`` of mbsd."""
        base, _, shape = self.name.partition("-")
        return said(preset=base, **({"aspect": shape.replace("x", ":")} if shape else {}))

    def framed(self, aspect: str) -> Preset:
        """Return the same in another aspect of :data:`ASPECTS`: its shorter side keeps its pixels.

        Raises UserError with the known aspects.
        """
        wide, high = _sides(aspect)
        if (wide, high) == ASPECTS[WIDE]:
            return self
        unit = self.height // min(wide, high)
        width, height = (self.height, unit * high) if wide <= high else (unit * wide, self.height)
        return replace(self, name=f"{self.name}-{wide}x{high}", width=width, height=height)

    @property
    def work(self) -> int:
        """Samples in one picture: what the render time is nearly proportional to."""
        return self.width * self.height * self.samples


PRESETS = {
    preset.name: preset
    for preset in (
        Preset("draft", 640, 360, 4, poster=16),
        Preset("preview", 1280, 720, 8),
        Preset("production", 1920, 1080, 16),
        Preset("final", 3840, 2160, 64, motion_blur=True),
    )
}
WIDE = "16:9"
ASPECTS = {WIDE: (16, 9), "1:1": (1, 1), "4:5": (4, 5), "9:16": (9, 16)}
"""Width and height of a picture, in small whole numbers; the first is that of the presets."""
ASPECT = 16 / 9
"""Width over height of a picture where nothing else is asked for."""


def preset_named(name: str, aspect: str = "") -> Preset:
    """Return the preset of that name, in an aspect of :data:`ASPECTS`, which the name may bring along:
    ``preview-9x16``.

    Raises UserError with the known names.
    """
    base, _, shape = name.partition("-")
    if base not in PRESETS:
        raise UserError(f"there is no preset '{name}'; there is: {', '.join(PRESETS)}")
    return PRESETS[base].framed(aspect or shape or WIDE)


def _sides(aspect: str) -> tuple[int, int]:
    """Return the width and height of an aspect that is written as ``9:16`` or ``9x16``."""
    try:
        return ASPECTS[aspect.strip().replace("x", ":")]
    except KeyError:
        raise UserError(f"there is no ASPECT={aspect}; there is: {', '.join(ASPECTS)}") from None


# Reads SHOW=...: the arrows and the title that a picture gets instead of those of the shot.

WORDS = ("velocities", "accelerations", "forces", "reactions", "title")
"""In the order in which they stand in the names of files."""


MEANT = {
    "forces": ("weights", "springs", "dampers", "contacts", "loads", "torques", "frictions"),
    "reactions": ("constraints", "joints", "contacts"),
    "velocities": ("speeds",),
    "title": ("titles", "names", "rates", "numbers"),
}
"""Other words of a request, by what they show."""


def show_words(text: str) -> str:
    """Return the words of SHOW in their order, each once, with commas.

    Raises UserError for an unknown word.
    """
    asked = [word.strip() for word in text.split(",") if word.strip()]
    for word in asked:
        if word not in WORDS:
            raise UserError(
                f"SHOW={text!r}: {word!r} is no quantity; choose of: {', '.join(WORDS)}; commas join several, and "
                f"without SHOW a picture has what the shot says{_meant(word)}"
            )
    return ",".join(word for word in WORDS if word in asked)


def _meant(word: str) -> str:
    """Return the word that shows what is asked for, or one that is alike."""
    meant = [shows for shows, others in MEANT.items() if word.lower().removesuffix("s") + "s" in others]
    if meant:
        return f"; these are among {' and '.join(meant)}"
    return did_you_mean(word, WORDS)


def has_sound(text: str) -> bool:
    """Return True if SOUND asks for a film with sound, as an empty one does.

    Raises UserError for another word.
    """
    if text not in ("", "on", "off"):
        raise UserError(f"SOUND={text!r} is neither on nor off; without SOUND a film has its sound")
    return text != "off"
