"""A study over the gallery's Params, which are a frozen dataclass, is kept."""

from __future__ import annotations

from pathlib import Path

import mbsd
from mechanisms.four_bar.mechanism import Params, build


def test_params_of_the_gallery_are_kept(tmp_path: Path) -> None:
    def made(crank: float) -> mbsd.Mechanism:
        return build(Params(crank=crank))

    points = {"crank": [0.03, 0.04]}
    for _ in range(2):
        table = mbsd.study(made, points, lambda m: {"n": len(m.bodies)}, folder=tmp_path, processes=1, progress=False)
        assert list(table["n"]) == [4, 4]
    assert len(list(tmp_path.rglob("*.jsonl"))) == 1
