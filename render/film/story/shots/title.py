"""The title: name and what it is, over the first picture of what follows, dark and out of focus."""

from __future__ import annotations

from render.film.story.frame import Over, Shot, shown_in
from render.film.story.ramp import eased
from render.film.story.scenery import Scenery

SECONDS, FADE = 3.0, 0.5


def title(scenery: Scenery, after: Shot | None) -> Shot | None:
    """The title before a shot, whose first picture it shows; None where no shot follows."""
    if after is None:
        return None
    first = after.picture(0.0)

    def over(s: float) -> Over:
        return Over(title=shown_in(s, -FADE, SECONDS - FADE, FADE), focus=eased((s - SECONDS + FADE) / FADE))

    return Shot("title", scenery.say("title"), SECONDS, lambda s: first, over, lambda s: after.model(0.0))
