"""The exploded view as a picture: made once, with names over it, and refused where nothing can be taken apart."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from render.film import exploded
from render.frames.story import apart
from render.presets import Preset
from shared.contract.shot import Shot
from shared.stage.errors import UserError
from tools.fixtures import film_fixture

TINY = Preset("draft", 192, 108, 1, poster=1)


def test_it_shows_the_parts_apart_with_their_names(out_root: Path, capsys: pytest.CaptureFixture[str]) -> None:
    from PIL import Image

    out = film_fixture.write(Shot(seconds_per_turn=0.3))
    apart.run("four_bar", TINY)
    target = out.folder / "exploded.png"
    with Image.open(target) as picture:
        assert picture.size == (192, 108)
        page = np.asarray(picture.convert("RGB"), float)
    (frame,) = (out.frames("draft_poster-story")).glob("[!.]*.png")
    with Image.open(frame) as rendered:
        bare = np.asarray(rendered.convert("RGB"), float)
    assert (np.abs(page - bare).max(axis=2) > 30).mean() > 0.01, "names lie over the picture"
    content = target.read_bytes()
    capsys.readouterr()
    apart.run("four_bar", TINY)
    assert "nothing to do" in capsys.readouterr().out
    target.unlink()
    apart.run("four_bar", TINY)
    assert "0 of 1 pictures" in capsys.readouterr().out
    assert target.read_bytes() == content


def test_a_machine_of_one_layer_is_refused(out_root: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    film_fixture.write()
    every = exploded.exploded
    monkeypatch.setattr(
        exploded, "exploded", lambda parts, size: [lift._replace(distance=0.0) for lift in every(parts, size)]
    )
    with pytest.raises(UserError, match="all its parts lie in one layer"):
        apart.run("four_bar", TINY)
