"""Numbers written into mechanism.py are those of Params afterwards, or the page hears which line decides them."""

from __future__ import annotations

from pathlib import Path

import pytest

from studio.live import writing
from studio.live.writing import replace
from tests.studio.live.arm import ARM
from tests.studio.live.served import Page, Served, live_server

FIELDS = "    length: float = 0.2  # of the crank\n    speed: float = tau\n"
DECIDES = {
    "set again": (FIELDS + "    length: float = 0.35  # decides\n", ""),
    "assigned": (FIELDS + "    length = 0.35  # decides\n", ""),
    "in a condition": (FIELDS + "    if True:\n        length = 0.35  # decides\n", ""),
    "after init": (
        FIELDS + "\n    def __post_init__(self):\n        object.__setattr__(self, 'length', 0.35)  # decides\n",
        "",
    ),
    "inherited": (FIELDS, "@dataclass(frozen=True)\nclass Params(Params):\n    length: float = 0.35  # decides\n"),
    "bound again": (FIELDS, "Own = Params\nParams = lambda: Own(length=0.35)  # decides\n"),
}
"""Fields of Params, and what stands after the class."""


live = live_server("written")


def file_of(live: Served) -> Path:
    return live.folder / "arm" / "mechanism.py"


def solved(live: Served, page: Page, source: str) -> None:
    """Save this source and wait until it is solved."""
    live.session.history.add({})
    if file_of(live).read_text() != source:
        live.write(source)
        page.hear("solved")
        page.hear("motion")


def write(page: Page, **values: float) -> dict:
    """Set these numbers, ask for them to be written, and hear what comes of it."""
    page.say(do="set", values=values, final=True)
    page.hear("motion", "refused")
    page.say(do="write")
    return page.hear("refused", "line", wanted=lambda header: "written" in header["text"])


@pytest.mark.parametrize("kind", DECIDES)
def test_a_later_line_that_decides_a_number_is_named(live: Served, kind: str) -> None:
    fields, after = DECIDES[kind]
    source = ARM.replace(FIELDS, fields).replace("def build(", f"{after}\n\ndef build(")
    with live.page() as page:
        solved(live, page, source)
        told = write(page, length=0.25)
    assert told["kind"] == "refused"
    (line,) = (k for k, text in enumerate(source.splitlines(), 1) if "# decides" in text)
    assert f"mechanisms/arm/mechanism.py:{line}: length cannot be written: line {line} decides it" in told["text"]
    assert "it would still be 0.35" in told["text"]
    assert file_of(live).read_text() == source
    assert live.session.history.now == {"length": 0.25}


def test_values_computed_from_it_and_computed_values_are_named(live: Served) -> None:
    source = ARM.replace(FIELDS, FIELDS + "    twice: float = 2 * length\n")
    with live.page() as page:
        solved(live, page, source)
        told = write(page, length=0.25, speed=3.0)
        page.heard("solved")
    assert told["kind"] == "line"
    assert "length, speed written into mechanisms/arm/mechanism.py" in told["text"]
    assert "speed was tau and is a number now" in told["text"]
    assert "twice is 0.5 then (it was 0.4)" in told["text"]
    expected = source.replace("float = 0.2 ", "float = 0.25 ").replace("float = tau", "float = 3.0")
    assert file_of(live).read_text() == expected
    assert live.session.history.now == {}


def test_numbers_with_which_the_file_cannot_be_loaded_are_not_written(live: Served) -> None:
    check = "    def __post_init__(self):\n        if self.length > 0.22:\n            raise ValueError('too long')\n"
    source = ARM.replace(FIELDS, f"{FIELDS}\n{check}")
    with live.page() as page:
        solved(live, page, source)
        live.session.history.add({"length": 0.3})
        page.say(do="write")
        told = page.hear("refused")
    assert "nothing was written" in told["text"]
    assert "too long" in told["text"]
    assert file_of(live).read_text() == source


def test_a_save_within_the_write_is_kept_and_written_into(live: Served, monkeypatch: pytest.MonkeyPatch) -> None:
    saved = ARM.replace("STEPS = 24", "STEPS = 30  # saved meanwhile")
    saves = [saved]

    def saved_before(path: Path, before: bytes, after: bytes) -> None:
        if saves:
            live.write(saves.pop())
        replace(path, before, after)

    with live.page() as page:
        solved(live, page, ARM)
        monkeypatch.setattr(writing, "replace", saved_before)
        told = write(page, length=0.26)
        assert told["kind"] == "line"
        page.heard("solved", wanted=lambda header: header["numbers"][0]["value"] == 0.26)
    assert file_of(live).read_text() == saved.replace("0.2 ", "0.26 ")


def test_a_file_that_is_saved_again_and_again_is_left_alone(live: Served, monkeypatch: pytest.MonkeyPatch) -> None:
    saves: list[str] = []

    def saved_before(path: Path, before: bytes, after: bytes) -> None:
        saves.append(f"{ARM}# {len(saves)}\n")
        live.write(saves[-1])
        replace(path, before, after)

    with live.page() as page:
        solved(live, page, ARM)
        monkeypatch.setattr(writing, "replace", saved_before)
        assert "saved 3 times while" in write(page, length=0.27)["text"]
        page.heard("solved")  # else the next test's save of the old content is no change
    assert file_of(live).read_text() == saves[-1]
    assert live.session.history.now == {"length": 0.27}


def test_a_number_that_moves_on_while_it_is_written_stays_moved(live: Served, monkeypatch: pytest.MonkeyPatch) -> None:
    def moved_before(path: Path, before: bytes, after: bytes) -> None:
        live.session.history.add({"length": 0.29})
        replace(path, before, after)

    with live.page() as page:
        solved(live, page, ARM)
        monkeypatch.setattr(writing, "replace", moved_before)
        assert write(page, length=0.28)["kind"] == "line"
        page.heard("solved")
    assert "length: float = 0.28 " in file_of(live).read_text()
    assert live.session.history.now == {"length": 0.29}


def test_marks_newlines_and_links_stay(live: Served, tmp_path: Path) -> None:
    """A file with a byte-order mark and lines that end as in Windows, to which a symbolic link leads."""
    source = b"\xef\xbb\xbf" + ARM.replace("\n", "\r\n").replace("of the crank", "der Länge nach").encode()
    target = tmp_path / "elsewhere.py"
    target.write_bytes(source)
    with live.page() as page:
        solved(live, page, ARM)
        live.session.history.add({})
        file_of(live).unlink()
        file_of(live).symlink_to(target)
        page.hear("solved")
        page.hear("motion")
        assert write(page, length=0.31)["kind"] == "line"
    assert file_of(live).is_symlink()
    assert target.read_bytes() == source.replace(b"= 0.2 ", b"= 0.31 ")
    file_of(live).unlink()


def test_a_file_that_is_read_only_or_gone_is_told(live: Served) -> None:
    with live.page() as page:
        live.write(ARM)
        page.hear("motion")
        file_of(live).chmod(0o444)
        assert "is read-only" in write(page, length=0.32)["text"]
        assert file_of(live).read_text() == ARM
