"""The exploded view: how a machine comes apart, and its picture with names."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from render.film import pieces
from render.film.inputs import read_film
from render.film.pieces import MOST, STEP, exploded
from render.frames.story import apart
from render.glb.exploded import exploded_glb, run
from render.presets import Preset
from shared.contract import read_parts
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


def test_the_glb_comes_apart_in_order_and_together_again(out_root: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = film_fixture.write(Shot(seconds_per_turn=0.3))
    film = read_film(out)
    run("four_bar")
    content = (out.folder / "exploded.glb").read_bytes()
    assert content == exploded_glb(film)
    capsys.readouterr()
    run("four_bar")
    assert "nothing to do" in capsys.readouterr().out
    length = int.from_bytes(content[12:16], "little")
    document, binary = json.loads(content[20 : 20 + length]), content[28 + length :]

    def values(number: int) -> np.ndarray:
        accessor = document["accessors"][number]
        start = document["bufferViews"][accessor["bufferView"]]["byteOffset"]
        wide = {"SCALAR": 1, "VEC3": 3}[accessor["type"]]
        return np.frombuffer(binary, "<f4", accessor["count"] * wide, start).reshape(-1, wide)

    (clip,) = document["animations"]
    assert clip["name"] == "exploded"
    lifts = {lift.name: lift for lift in pieces.exploded(film.parts, film.size)}
    heights = {}
    for channel in clip["channels"]:
        node, sampler = document["nodes"][channel["target"]["node"]], clip["samplers"][channel["sampler"]]
        ways, times = values(sampler["output"]), values(sampler["input"])[:, 0]
        heights[node["name"]] = ways[:, 2]
        assert ways[:, :2] == pytest.approx(np.tile(node["translation"][:2], (len(ways), 1)))
        assert ways[[0, -1], 2] == pytest.approx([0.0, 0.0])
        assert ways[len(times) // 2, 2] == pytest.approx(lifts[node["name"]].distance, rel=1e-6)
        assert (np.diff(ways[: len(times) // 2, 2]) >= 0).all()
    assert set(heights) == {name for name, lift in lifts.items() if lift.distance}
    begins = {name: int(np.argmax(height > 0)) for name, height in heights.items()}
    rows = sorted(begins, key=lambda name: -lifts[name].order)
    assert [begins[name] for name in rows] == sorted(begins.values()), "what came last goes first"
    moved = {node["name"]: node for node in document["nodes"]}["crank"]
    assert moved["translation"][:2] == pytest.approx(film.poses.body("crank", film.clock.moment(0))[:2])


def test_a_machine_of_one_layer_is_refused(out_root: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    film_fixture.write()
    every = pieces.exploded
    monkeypatch.setattr(
        pieces, "exploded", lambda parts, size: [lift._replace(distance=0.0) for lift in every(parts, size)]
    )
    with pytest.raises(UserError, match="all its parts lie in one layer"):
        apart.run("four_bar", TINY)


def test_layers_come_apart_in_the_order_of_their_middles(out_root) -> None:
    parts = read_parts(film_fixture.write().parts)
    lifts = exploded(parts, 0.2)
    assert len(lifts) == sum(len(body.pieces) for body in parts.bodies.values())
    middle = {lift.name: sum(parts.bodies[lift.body].pieces[lift.piece].z_range) / 2 for lift in lifts}
    assert [middle[lift.name] for lift in lifts] == sorted(middle.values())
    order = {lift.name: lift.order for lift in lifts}
    assert order["ground/base"] == 0
    assert order["crank/crank"] == order["rocker/rocker"] < order["crank/start"] < order["coupler/coupler"]
    distances = [lift.distance for lift in lifts]
    assert distances == [0.2 * STEP * lift.order for lift in lifts]
    assert max(distances) <= 0.2 * MOST
    assert {lift.axis for lift in lifts} == {(0.0, 0.0, 1.0)}


def test_no_pieces_come_apart_nowhere(out_root) -> None:
    parts = read_parts(film_fixture.write().parts)
    for body in parts.bodies.values():
        body.pieces.clear()
    assert exploded(parts, 0.2) == []
