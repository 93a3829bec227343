"""The folder that MkDocs reads: the documents where they are in the clone, and a page for every source they link to."""

from __future__ import annotations

import re
import shutil
from collections.abc import Iterator
from pathlib import Path

from shared.stage.errors import UserError
from tools.site.notebooks import page_of_notebook
from tools.site.pictures import for_both_themes
from tools.site.sources import page_of_folder, page_of_source
from tools.site.theory import PAGE as THEORY
from tools.site.theory import with_equations

AT_THE_TOP = ("README.md", "ARCHITECTURE.md", "CONTRIBUTING.md", "CHANGELOG.md")
ELSEWHERE = ("tests/published/reference/README.md",)
HOME = Path("README.md")
ALONE = "---\nhide:\n  - navigation\n---\n\n"
"""The first page has the tabs alone."""
PICTURES = (".svg", ".png", ".jpg", ".gif", ".webp")
ASSETS = Path(__file__).with_name("theme") / "assets"
LINK = re.compile(r"(?<=\]\()([^)#\s]+)")
FENCE = re.compile(r"(^```.*?^```$|`[^`\n]+`)", re.MULTILINE | re.DOTALL)
"""What is no Markdown: blocks of code, and code in a line."""


def documents(root: Path) -> list[Path]:
    """Every Markdown file that is a page, relative to the clone."""
    below = sorted(path.relative_to(root) for path in (root / "docs").rglob("*.md"))
    return [Path(name) for name in AT_THE_TOP + ELSEWHERE] + below


def stage(root: Path, folder: Path) -> None:
    """Write the pages of the clone ``root``, their pictures, notebooks and sources into ``folder``."""
    pages = documents(root)
    wanted: set[Path] = set()
    for page in pages:
        text = (root / page).read_text()
        if page == THEORY:
            text = with_equations(text, root)
        text, linked = linked_page(text, page, root, pages)
        wanted |= linked
        _write(folder / page, (ALONE if page == HOME else "") + for_both_themes(text))
    for path in sorted((root / "docs").rglob("*")):
        if path.suffix in PICTURES:
            _copy(path, folder / path.relative_to(root))
        if path.suffix == ".ipynb":
            _copy(path, folder / path.relative_to(root))
            _stage_notebook(path, folder / path.relative_to(root).parent)
    for source in sorted(_with_contents(root, wanted)):
        page = page_of_folder(root, source) if (root / source).is_dir() else page_of_source(root, source)
        _write(folder / place_of(root, source), page)
    shutil.copytree(ASSETS, folder / "assets")


def _stage_notebook(path: Path, folder: Path) -> None:
    text, pictures = page_of_notebook(path)
    _write(folder / f"{path.stem}.md", for_both_themes(text))
    for name, picture in pictures.items():
        (folder / name).write_bytes(picture)


def linked_page(text: str, page: Path, root: Path, pages: list[Path]) -> tuple[str, set[Path]]:
    """The page with links to sources turned to their pages, and these sources."""
    wanted: set[Path] = set()

    def turned(match: re.Match[str]) -> str:
        link = match[1]
        if re.match(r"[a-z]+:", link):
            return link
        target = _inside(root, page, link)
        if target in pages or target.suffix in PICTURES or target.suffix == ".ipynb":
            return link.removesuffix(".ipynb") + ".md" if link.endswith(".ipynb") else link
        wanted.add(target)
        return f"{link.rstrip('/')}{'/README' if (root / target).is_dir() else ''}.md"

    pieces = FENCE.split(text)
    pieces[::2] = [LINK.sub(turned, piece) for piece in pieces[::2]]
    return "".join(pieces), wanted


def place_of(root: Path, source: Path) -> Path:
    """Where the page of a source file or folder is: ``mechanism.py.md``, ``schema/README.md``."""
    return source / "README.md" if (root / source).is_dir() else source.with_name(f"{source.name}.md")


def _inside(root: Path, page: Path, link: str) -> Path:
    target = (root / page.parent / link).resolve()
    if not target.is_relative_to(root.resolve()) or not target.exists():
        raise UserError(f"site: {page.as_posix()} links to {link}, which is no file of the clone; correct the link")
    return target.relative_to(root.resolve())


def _with_contents(root: Path, sources: set[Path]) -> Iterator[Path]:
    """The sources, and the files of those that are folders."""
    for source in sources:
        yield source
        if (root / source).is_dir():
            yield from (path.relative_to(root) for path in (root / source).iterdir() if path.is_file())


def _write(path: Path, text: str) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)


def _copy(path: Path, to: Path) -> None:
    to.parent.mkdir(parents=True, exist_ok=True)
    shutil.copy(path, to)
