"""The site: what is staged for it, what its checks see, and the whole of it, built."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

from shared.stage.errors import UserError
from shared.stage.paths import ROOT
from tests.running.needs import needed
from tools.site import __main__ as program
from tools.site.checks import faults
from tools.site.reference import ROOMS, contents, entry, members, signature, text
from tools.site.staging import for_both_themes, linked_page, page_of_notebook, page_of_source

BUILT = pytest.mark.skipif(find_spec("material") is None, reason="needs mkdocs-material, of the extra docs")


def clone(folder: Path, text: str) -> Path:
    """A clone with one page, a source, a folder of sources and a picture."""
    for name in ("docs/schema/a.json", "mechanisms/crank/mechanism.py", "docs/crank.svg"):
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text("{}\n")
    (folder / "docs" / "page.md").write_text(text)
    return folder


def linked(folder: Path, text: str) -> tuple[str, set[Path]]:
    page = Path("docs/page.md")
    return linked_page(text, page, clone(folder, text), [page])


@pytest.mark.parametrize("link", ["missing.md", "../../outside.md"])
def test_a_link_to_no_file_is_refused_by_page_and_link(tmp_path: Path, link: str) -> None:
    with pytest.raises(UserError, match=rf"docs/page.md links to {link}, which is no file"):
        linked(tmp_path, f"[a]({link})")


def test_a_source_that_holds_a_fence_stays_one_block(tmp_path: Path) -> None:
    (tmp_path / "a.py").write_text('"""\n```\n# no heading\n```\n"""\n')
    page = page_of_source(tmp_path, Path("a.py"))
    assert page.count("````") == 2
    assert "exclude: true" in page


def test_a_pair_of_pictures_is_chosen_by_the_theme_and_another_picture_stays() -> None:
    pair = (
        '<picture>\n  <source media="(prefers-color-scheme: dark)" srcset="a_dark.svg">\n'
        '  <img alt="A" src="a.svg">\n</picture>'
    )
    still = (
        '<picture><source media="(prefers-reduced-motion: reduce)" srcset="a.jpg"><img alt="A" src="a.webp"></picture>'
    )
    shown = for_both_themes(f"{pair}\n{still}")
    assert '<img class="on-light" loading="lazy" alt="A" src="a.svg">' in shown
    assert '<img class="on-dark" loading="lazy" alt="A" src="a_dark.svg">' in shown
    assert shown.endswith(still)


def test_a_notebook_is_its_text_code_and_outputs(tmp_path: Path) -> None:
    svg = '<svg xmlns="http://www.w3.org/2000/svg"><path stroke="#0b62a8"/></svg>'
    cells = [
        {"cell_type": "markdown", "source": ["# Title\n", "\n", "Text."]},
        {"cell_type": "code", "source": ["print(1)"], "outputs": [{"text": ["1\n"]}, {"data": {"image/svg+xml": svg}}]},
    ]
    (tmp_path / "a.ipynb").write_text(json.dumps({"cells": cells}))
    page, pictures = page_of_notebook(tmp_path / "a.ipynb")
    assert page.startswith("# Title\n\n[a.ipynb](a.ipynb) is this page as a notebook.\n")
    assert "```python\nprint(1)\n```\n\n``` { .text .printed }\n1\n```" in page
    assert list(pictures) == ["a_1.svg", "a_1_dark.svg"]
    assert pictures["a_1.svg"] == svg.encode()
    assert b"#0b62a8" not in pictures["a_1_dark.svg"]
    assert for_both_themes(page).endswith(
        '<img class="on-dark" loading="lazy" alt="What the cell draws" src="a_1_dark.svg"></p>\n'
    )


def test_every_public_name_is_on_one_page_of_the_reference() -> None:
    import mbsd

    names = [name for page in ROOMS for name in contents()[page][1]]
    assert sorted(names) == sorted(mbsd.__all__)


def test_an_entry_says_how_a_method_is_called_and_in_which_group_it_is() -> None:
    from mbsd import Mechanism

    section = entry("Mechanism", Mechanism)
    joints, drivers = section.index("### Joints"), section.index("### Drivers")
    assert joints < section.index("#### revolute { #Mechanism.revolute }") < drivers
    assert "m.revolute(name: str, i: Marker, j: Marker, limits: Limits = None) -> Joint" in section
    methods = {member.name for member in members(Mechanism) if member.kind == "method"}
    assert {"sweep", "bar", "spring", "draw"} <= methods
    assert not [name for name in methods if name.startswith("_")]


def test_signatures_and_docstrings_survive_markdown() -> None:
    def f(a: int, *, b: float = 0.5) -> str: ...

    assert signature("f", f) == "f(a: int, *, b: float = 0.5) -> str"
    assert text("i < j, ``a * b``, a * b; see :func:`mbsd.fit_path`.\n    x = 1\nEnd.") == (
        "i &lt; j, ``a * b``, a \\* b; see `fit_path`.\n\n    x = 1\n\nEnd."
    )


def site(folder: Path, body: str) -> list[str]:
    (folder / "a.html").write_text(body)
    (folder / "b.html").write_text('<h1 id="there">b</h1>')
    return faults(folder)


@pytest.mark.parametrize(
    ("body", "wrong"),
    [
        ('<a href="c.html">', "a.html: a c.html leads nowhere"),
        ('<a href="../b.html">', "a.html: a ../b.html leads nowhere"),
        ('<a href="b.html#here">', "a.html: a b.html#here leads to no place of that page"),
        ('<img src="c.png">', "a.html: img c.png leads nowhere"),
        ('<script src="https://x.org/a.js">', "a.html: script https://x.org/a.js is loaded from a network"),
        ('<link rel="stylesheet" href="//x.org/a.css">', "a.html: link //x.org/a.css is loaded from a network"),
    ],
)
def test_the_check_sees_what_is_wrong(tmp_path: Path, body: str, wrong: str) -> None:
    assert site(tmp_path, body) == [wrong]


def test_the_check_passes_what_is_right(tmp_path: Path) -> None:
    assert (
        site(tmp_path, '<a href="b.html#there"><a href="https://x.org"><img src="data:,"><a href="#up" id="up">') == []
    )


def test_a_style_that_loads_a_font_from_a_network_is_seen(tmp_path: Path) -> None:
    (tmp_path / "a.css").write_text("@font-face { src: url('https://x.org/a.woff2') }")
    assert faults(tmp_path) == ["a.css loads from a network"]


def test_missing_packages_are_named_with_what_brings_them(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(program, "NEEDED", {"no_such_module": "mkdocs-material"})
    with pytest.raises(UserError, match=r"needs mkdocs-material, .*make install.*pip install 'mbsd\[docs\]'"):
        program.refuse_without_packages()


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The site as the command builds it, which checks every link."""
    out = tmp_path_factory.mktemp("site") / "site"
    done = subprocess.run(
        [sys.executable, "-m", "tools.site", "--out", str(out)], cwd=ROOT, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    return out


@BUILT
@pytest.mark.slow
def test_the_site_is_whole_and_needs_no_network(built: Path) -> None:
    assert faults(built) == []
    pages = {path.relative_to(built).as_posix() for path in built.rglob("*.html")}
    documents = {path.relative_to(ROOT).as_posix() for path in (ROOT / "docs").rglob("*.md")}
    assert {_page(name) for name in documents} <= pages
    assert {"index.html", "ARCHITECTURE.html", "mechanisms/four_bar/mechanism.py.html"} <= pages
    tutorial = (built / "docs" / "tutorial.html").read_text()
    assert 'class="on-dark"' in tutorial
    assert "iframe-worker" in tutorial
    index = (built / "search" / "search_index.js").read_text()
    assert "four_stroke" in index
    assert '"mechanisms/four_bar/mechanism.py.html' not in index


@BUILT
@pytest.mark.slow
def test_the_search_answers_from_the_disk(built: Path, tmp_path: Path) -> None:
    """In a browser that resolves no host."""
    asked = f"{(built / 'index.html').as_uri()}?q=torsion"
    flags = ["--headless=new", "--no-sandbox", "--disable-gpu", f"--user-data-dir={tmp_path}", "--dump-dom"]
    flags += ["--host-resolver-rules=MAP * ~NOTFOUND", "--virtual-time-budget=8000"]
    done = subprocess.run([needed("chromium"), *flags, asked], capture_output=True, text=True, timeout=120)
    assert re.search(r'md-search-result__meta">\d+ matching documents', done.stdout)
    assert f'<a href="{built.as_uri()}/docs/forces.html' in done.stdout


def _page(document: str) -> str:
    return document.replace("README.md", "index.html").removesuffix(".md").removesuffix(".html") + ".html"
