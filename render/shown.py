"""Reads SHOW=...: the arrows and the title that a picture gets instead of those of the shot."""

from __future__ import annotations

from shared.stage.errors import UserError
from shared.stage.suggestions import did_you_mean

WORDS = ("velocities", "accelerations", "forces", "reactions", "title")
"""In the order in which they stand in the names of files."""


MEANT = {
    "forces": ("weights", "springs", "dampers", "contacts", "loads", "torques", "frictions"),
    "reactions": ("constraints", "joints", "contacts"),
    "velocities": ("speeds",),
    "title": ("titles", "names", "rates", "numbers"),
}
"""What else one may ask for, by the words that show it."""


def show_words(text: str) -> str:
    """The words of SHOW in their order, each once, commas between them; raises UserError for one that is none."""
    asked = [word.strip() for word in text.split(",") if word.strip()]
    for word in asked:
        if word not in WORDS:
            raise UserError(
                f"SHOW={text!r}: there is no word {word!r}; there is: {', '.join(WORDS)}; commas join several, and "
                f"without SHOW a picture has what the shot says{_meant(word)}"
            )
    return ",".join(word for word in WORDS if word in asked)


def _meant(word: str) -> str:
    """The word that shows what is asked for, or one that is alike."""
    meant = [shows for shows, others in MEANT.items() if word.lower().removesuffix("s") + "s" in others]
    if meant:
        return f"; these are among {' and '.join(meant)}"
    return did_you_mean(word, WORDS)


def has_sound(text: str) -> bool:
    """Whether SOUND, ``on`` if nothing is said, asks for a film with sound; raises UserError for another word."""
    if text not in ("", "on", "off"):
        raise UserError(f"SOUND={text!r} is neither on nor off; without SOUND a film has its sound")
    return text != "off"
