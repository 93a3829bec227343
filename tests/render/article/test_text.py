"""The text of an article: numbers that follow from the motion, an author's words in place of its own, hostile names."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import pytest

from render import article
from render.article.markup import Markup, merged
from render.article.quantities import series_of
from render.article.sentences import Machine
from render.article.steps import markdown, steps_of
from render.view.payload import payload, read_payload
from shared.contract import Motion, read_motion, read_parts
from shared.contract.shot import Shot
from shared.stage.errors import UserError
from shared.stage.paths import Out
from tools.fixtures import film_fixture
from tools.models.motions import four_bar_motion, plain_skeleton

HOSTILE = '<img src=x onerror="alert(1)">*_`](javascript:alert(1))'
LINK = re.compile(r"\[((?:\\.|[^\]])*)\]\(<(\w+):([^>]*)>\)")


@pytest.fixture(scope="module")
def machine(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Machine]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("MBSD_OUT", str(tmp_path_factory.mktemp("article")))
        out = film_fixture.write(Shot())
        yield Machine("four_bar", "A four-bar.", read_motion(out.motion), read_payload(out), read_parts(out.parts))


def _number(words: str) -> float:
    """Return a number of a text in SI units, an angle in degrees."""
    match = re.match(r"([−\d.]+)\s*(µ|m|k|M)?(m|s|N|J|W|°|%|kg|g|rad/s)?", words)
    assert match is not None, words
    return float(match[1].replace("−", "-")) * {"µ": 1e-6, "m": 1e-3, "k": 1e3, "M": 1e6}.get(match[2] or "", 1.0)


def test_every_number_that_follows_the_machine_is_that_of_the_motion(machine: Machine) -> None:
    motion, text = machine.motion, markdown(machine, steps_of(machine))
    links = [link.groups() for link in LINK.finditer(text)]
    read = [(words, scheme, target.split("/")) for words, scheme, target in links if scheme in ("now", "most", "range")]
    assert {kind for _, _, (kind, *_) in read} >= {"body", "driver", "joint"}
    for words, scheme, (kind, name, series) in read:
        thing: Any = {"body": motion.bodies, "driver": motion.drivers, "joint": motion.joints}[kind][name]
        values = np.hypot(thing.fx, thing.fy) if series == "size" else np.asarray(getattr(thing, series))
        values = np.degrees(values) if series == "theta" else values
        wanted = {"now": values[0], "most": np.abs(values).max(), "range": np.ptp(values)}[scheme]
        assert _number(words) == pytest.approx(wanted, abs=0.51 if series == "theta" else 6e-3 * np.abs(values).max())
    moments = [(_number(words), float(target)) for words, scheme, target in links if scheme == "at" and "°" in words]
    assert len(moments) >= 3
    for angle, time in moments:
        crank = np.degrees(np.interp(time, motion.time, motion.drivers["motor"].value))
        assert abs((crank - angle + 180) % 360 - 180) < 0.51, "the angle of the crank at that time"


def test_steps_stand_in_order_and_no_sentence_is_said_twice(machine: Machine) -> None:
    steps = steps_of(machine)
    keys = [step.key for step in steps]
    assert keys == ["what", "parts", "turn", "trick", "forces", "limit", "variants", "print"]
    said = [row.split("\n{")[0] for step in steps for row in step.paragraphs]
    assert len(said) == len(set(said))
    assert all(row[-1] in ".:" for row in said)


def test_an_author_says_some_steps_in_his_own_words(machine: Machine) -> None:
    markup = Markup(machine.payload, [], "article")
    own = (
        "# My four-bar\n\n## Why *I* made it {#trick}\n\nIt carries [now](now:joint/B/size) and [so](turn:motor).\n"
        "{at=0.5 curve=joint/B/size near=joint/B arrows=reactions}\n\n## Thanks\n\nTo [my aunt](https://example.org).\n\n"
        "## Forces {#forces}\n"
    )
    text = merged(markup.text(markdown(machine, steps_of(machine))), markup.text(own))
    assert text.title == "My four-bar"
    assert [each.key for each in text.sections] == [
        "what", "parts", "turn", "trick", "thanks", "limit", "variants", "print"
    ]  # fmt: skip
    trick = next(each for each in text.sections if each.key == "trick")
    assert trick.title == "Why I made it"
    assert '<b class="now" data-measure="now" data-of="joint/B/size">now</b>' in trick.body
    assert "&quot;at&quot;: 0.5" in trick.body
    assert "{at=" not in trick.body


@pytest.mark.parametrize(
    ("own", "message"),
    [
        ("It [x](now:joint/BB/size).", "mine.md: .*no joint 'BB'; did you mean 'B'"),
        ("It [x](now:joint/B/sise).", "mine.md: .*names no series.*did you mean 'size'"),
        ("It [x](number:cranck).", "mine.md: .*no number 'cranck' can be dragged; did you mean 'crank'"),
        ("It [x](at:soon).", "mine.md: .*soon is no time"),
        ("It.\n{curve=joints/B/size}", "mine.md: curve=joints/B/size: .*did you mean 'joint'"),
        ("It.\n{at=soon}", "mine.md: at=soon is no number"),
        ("It.\n{arrow=forces}", "mine.md: 'arrow' cannot be bound .*did you mean 'arrows'"),
        ("It.\n{arrows=force}", "mine.md: arrows=force: 'force' is nothing to show"),
    ],
)
def test_what_an_author_binds_must_be_there(machine: Machine, own: str, message: str) -> None:
    numbers = [{"name": "crank", "label": "crank"}]
    with pytest.raises(UserError, match=message):
        Markup(machine.payload, numbers, "mine.md").text(own)


def test_hostile_words_stay_words(machine: Machine) -> None:
    own = f"# <script>1</script>\n\n## <b>2</b> {{#trick}}\n\n<script>3</script> [4](javascript:alert(4)) {HOSTILE}\n"
    text = Markup(machine.payload, [], "mine.md").text(own)
    page = article.written(text.title, text.sections, "", "four_bar").replace(f"<script>{article.THEME}</script>", "")
    assert re.findall(r"<(script|img|b\b)", page) == []
    assert 'href="javascript' not in page


def test_hostile_names_of_a_model_stay_words() -> None:
    motion = _renamed(four_bar_motion(), "rocker", HOSTILE)
    moving = plain_skeleton(four_bar_motion()).moving
    assert moving is not None
    machine = Machine("four_bar", f"See {HOSTILE}.", motion, payload(motion, moving))
    text = Markup(machine.payload, [], "article").text(markdown(machine, steps_of(machine)))
    page = "".join(each.body for each in text.sections)
    assert re.findall(r"<(?!/?(?:p|span|b|code|em|strong)\b)[^>]*", page) == []
    assert set(re.findall(r' ([\w-]+)="', page)) <= {
        "data-scene", "class", "data-show", "data-at", "data-measure", "data-of", "data-turn", "aria-label"
    }  # fmt: skip
    assert "onerror" in page, "it is shown as text"
    series_of(machine.payload, re.findall(r'data-of="(body/[^"]*)"', page)[0])


def _renamed(motion: Motion, old: str, new: str) -> Motion:
    bodies = {new if name == old else name: body for name, body in motion.bodies.items()}
    joints = {
        name: msgspec.structs.replace(joint, bodies=tuple(new if body == old else body for body in joint.bodies))
        for name, joint in motion.joints.items()
    }
    return msgspec.structs.replace(motion, bodies=bodies, joints=joints)


def test_without_parts_it_says_so_and_without_a_motion_or_in_space_it_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("MBSD_OUT", str(tmp_path))
    out = Out("four_bar")
    with pytest.raises(UserError, match=r"data\.json is missing; run make solve-four-bar first"):
        article.run("four_bar")
    film_fixture.write(Shot())
    out.parts.unlink()
    machine = Machine("four_bar", "", read_motion(out.motion), read_payload(out))
    assert steps_of(machine)[-1].paragraphs == ["It has no solid parts here; `mbsd parts four_bar` makes them."]
    out.motion.write_text('{"schema": "mbsd.motion", "space": 3}')
    with pytest.raises(UserError, match="four_bar moves in space, and an article explains mechanisms in the plane"):
        article.run("four_bar")
