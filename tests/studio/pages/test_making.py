"""Pages of all mechanisms: fresh ones are left, the run goes on after a failure and from where it was stopped."""

from __future__ import annotations

from pathlib import Path

import pytest

from render.view import pictures
from shared.stage.errors import UserError
from shared.stage.paths import Out
from studio import pages

NAMES = ["four_bar", "pendulum", "trammel"]


class Shop:
    """Stand-in for the stages and the browser: current pages, and pictures that were taken."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.current: set[str] = set(NAMES)
        self.taken: list[str] = []
        self.refused: set[str] = set()
        self.version = "Browser 1"
        for name in NAMES:
            out = Out(name)
            out.folder.mkdir(parents=True)
            out.view.write_text(f"page of {name}")
        monkeypatch.setattr(pages, "_current", lambda names: self.current & set(names))
        monkeypatch.setattr(pictures, "chromium", lambda: "browser")
        monkeypatch.setattr(pictures, "version_of", lambda browser: self.version)
        monkeypatch.setattr(pictures, "take_picture", self.take_picture)

    def take_picture(self, out: Out, browser: str) -> None:
        if out.name in self.refused:
            raise UserError(f"{out.name}: the page complained")
        self.taken.append(out.name)
        pictures.picture_of(out).write_bytes(b"picture")


@pytest.fixture
def shop(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Shop:
    monkeypatch.setenv("MBSD_OUT", str(tmp_path / "out"))
    return Shop(monkeypatch)


def test_a_second_run_takes_no_picture(shop: Shop, capsys: pytest.CaptureFixture[str]) -> None:
    assert pages.run(NAMES) == 0
    assert shop.taken == NAMES
    assert "3/3" in capsys.readouterr().out
    assert pages.run(NAMES) == 0
    assert shop.taken == NAMES
    assert "3 of 3 have nothing to do" in capsys.readouterr().out


def test_a_picture_is_of_the_pages_bytes_and_the_browser(shop: Shop) -> None:
    pages.run(NAMES)
    Out("pendulum").view.write_text("another page")
    pictures.picture_of(Out("trammel")).write_bytes(b"cut sh")
    pages.run(NAMES)
    assert shop.taken[3:] == ["pendulum", "trammel"]
    shop.version = "Browser 2"
    pages.run(NAMES)
    assert shop.taken[5:] == NAMES


def test_failures_are_told_at_the_end_and_the_others_are_made(shop: Shop, capsys: pytest.CaptureFixture[str]) -> None:
    shop.refused = {"four_bar"}
    assert pages.run(NAMES) == 1
    assert shop.taken == ["pendulum", "trammel"]
    said = capsys.readouterr().out
    assert "the page complained" in said.split("what could not be made")[1]
    assert "2 of 3 are there" in said
    shop.refused = set()
    assert pages.run(NAMES) == 0
    assert shop.taken == ["pendulum", "trammel", "four_bar"]


def test_a_stopped_run_goes_on(shop: Shop, monkeypatch: pytest.MonkeyPatch) -> None:
    def stop(out: Out, browser: str) -> None:
        if out.name == "pendulum":
            raise KeyboardInterrupt
        shop.take_picture(out, browser)

    monkeypatch.setattr(pictures, "take_picture", stop)
    with pytest.raises(KeyboardInterrupt):
        pages.run(NAMES)
    monkeypatch.setattr(pictures, "take_picture", shop.take_picture)
    assert pages.run(NAMES) == 0
    assert shop.taken == NAMES


def test_outdated_products_are_rebuilt_by_their_stages(
    shop: Shop, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Here the stage of the page says why it cannot: there is no motion."""
    monkeypatch.setattr(pages, "STEPS", (("render", "view"),))
    shop.current = {"pendulum", "trammel"}
    assert pages.run(NAMES) == 1
    assert shop.taken == ["pendulum", "trammel"]
    assert "run make solve-four-bar" in " ".join(capsys.readouterr().err.split())


def test_without_a_browser_there_are_pages(
    shop: Shop, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(pictures, "chromium", lambda: None)
    assert pages.run(NAMES) == 0
    assert "need Chromium" in capsys.readouterr().err
