"""Presets say how large a picture is and how many samples it gets. The active one is always printed."""

from __future__ import annotations

from dataclasses import dataclass

from shared.stage.errors import UserError


@dataclass(frozen=True)
class Preset:
    """Size in pixels, Cycles samples a pixel, whether the shutter blurs what moves."""

    name: str
    width: int
    height: int
    samples: int
    motion_blur: bool = False

    def __str__(self) -> str:
        blur = "motion blur" if self.motion_blur else "no blur"
        return f"{self.name} ({self.width}x{self.height}, {self.samples} samples, {blur})"

    @property
    def work(self) -> int:
        """Samples in one picture: what the render time is nearly proportional to."""
        return self.width * self.height * self.samples


PRESETS = {
    preset.name: preset
    for preset in (
        Preset("draft", 640, 360, 4),
        Preset("preview", 1280, 720, 8),
        Preset("production", 1920, 1080, 16),
        Preset("final", 3840, 2160, 64, motion_blur=True),
    )
}
ASPECT = 16 / 9
"""Width over height of every preset; the camera frames the motion for it."""


def preset_named(name: str) -> Preset:
    """The preset of that name; raises UserError with the known names."""
    try:
        return PRESETS[name]
    except KeyError:
        raise UserError(f"there is no preset '{name}'; there is: {', '.join(PRESETS)}") from None
