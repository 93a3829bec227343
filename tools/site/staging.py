"""The folder that MkDocs reads: documents as in the clone, and a page for every linked source."""

from __future__ import annotations

import ast
import json
import re
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from shared.stage.errors import UserError
from tools.documents.figures.dark import dark

# A notebook as a page: its text, its code, what the code printed and drew.


def page_of_notebook(path: Path) -> tuple[str, dict[str, bytes]]:
    """The page, and its pictures by name; a line below the title leads to the notebook itself."""
    pictures: dict[str, bytes] = {}
    cells = json.loads(path.read_text())["cells"]
    text = "\n\n".join(_cell(cell, path.stem, pictures) for cell in cells)
    title, _, rest = text.partition("\n")
    return f"{title}\n\n[{path.name}]({path.name}) is this page as a notebook.\n{rest}\n", pictures


def _cell(cell: dict[str, Any], stem: str, pictures: dict[str, bytes]) -> str:
    source = "".join(cell["source"])
    if cell["cell_type"] != "code":
        return source
    return "\n\n".join([f"```python\n{source}\n```", *(_output(output, stem, pictures) for output in cell["outputs"])])


def _output(output: dict[str, Any], stem: str, pictures: dict[str, bytes]) -> str:
    data = output.get("data", {"text/plain": output.get("text", "")})
    if "image/svg+xml" in data:
        return _pair("".join(data["image/svg+xml"]).encode(), stem, pictures)
    if "text/html" in data:
        return re.sub(r"\n\s*\n", "\n", "".join(data["text/html"]))
    return f"``` {{ .text .printed }}\n{''.join(data.get('text/plain', '')).rstrip()}\n```"


def _pair(svg: bytes, stem: str, pictures: dict[str, bytes]) -> str:
    """The two pictures, as pages of docs/ have them."""
    light, on_dark = (f"{stem}_{len(pictures) // 2 + 1}{paper}.svg" for paper in ("", "_dark"))
    pictures |= {light: svg, on_dark: dark(svg)}
    return (
        f'<picture><source media="(prefers-color-scheme: dark)" srcset="{on_dark}">'
        f'<img alt="What the cell draws" src="{light}"></picture>'
    )


# Pictures for light and dark paper, chosen by the site's switch instead of by the system.


DARK = re.compile(
    r'<picture>\s*<source media="\(prefers-color-scheme: dark\)" srcset="([^"]+)">\s*(<img [^>]*>)\s*</picture>'
)
SOURCE = re.compile(r' src="[^"]*"')


def for_both_themes(page: str) -> str:
    """The page with each pair of pictures as two, of which the style shows that of the theme."""
    return DARK.sub(_both, page)


def _both(match: re.Match[str]) -> str:
    dark, light = match[1], match[2]
    return f'<p class="picture">{_lazy(light, "on-light")}{_lazy(SOURCE.sub(f' src="{dark}"', light), "on-dark")}</p>'


def _lazy(image: str, name: str) -> str:
    return image.replace("<img ", f'<img class="{name}" loading="lazy" ', 1)


# Pages of files that documents link to: their text, coloured, out of the way of the search.


LANGUAGES = {".py": "python", ".json": "json", ".js": "javascript", ".sh": "sh", ".toml": "toml"}
APART = "---\nsearch:\n  exclude: true\nhide:\n  - toc\n---\n\n"


def page_of_source(root: Path, source: Path) -> str:
    """The page of one file."""
    text = (root / source).read_text().rstrip("\n")
    longest = max((len(run) for run in re.findall(r"`+", text)), default=0)
    fence = "`" * max(3, longest + 1)
    language = LANGUAGES.get(source.suffix, "text")
    return f"{APART}# {source.name}\n\n`{source.as_posix()}`\n\n{fence}{language}\n{text}\n{fence}\n"


def page_of_folder(root: Path, source: Path) -> str:
    """The list of the files of a folder, each with its page."""
    names = sorted(path.name for path in (root / source).iterdir() if path.is_file())
    rows = "\n".join(f"- [{name}]({name}.md)" for name in names)
    return f"{APART}# {source.name}\n\nThe files of `{source.as_posix()}/`:\n\n{rows}\n"


# The theory page of the site: docs/theory.md with the equations of the source files that it links to.


THEORY = Path("docs/theory.md")
SOURCES = re.compile(r"^Sources: .*?(?=^$|\Z)", re.MULTILINE | re.DOTALL)
"""The paragraph of a section that links to the files and folders with its equations."""
SOURCE_LINK = re.compile(r"\]\(([^)#\s]+)\)")
FEWEST_LINES = 2
"""A docstring of one line has no equations to show."""


def with_equations(text: str, root: Path) -> str:
    """Return the page ``text`` with each list of sources replaced by the docstrings of these files.

    A file stands once: in the section that links to it most closely. Raises UserError where a link gives nothing.
    """
    folder = root.resolve() / THEORY.parent
    places = [
        (folder / link).resolve() for paragraph in SOURCES.findall(text) for link in SOURCE_LINK.findall(paragraph)
    ]
    closest = {file: place for place in sorted(places, key=lambda p: len(p.parts)) for file in _files(place)}

    def filled(paragraph: re.Match[str]) -> str:
        return "\n".join(_section(link) for link in SOURCE_LINK.findall(paragraph[0]))

    def _section(link: str) -> str:
        place = (folder / link).resolve()
        entries = [entry for file in _files(place) if closest[file] == place and (entry := _entry(file, root))]
        if not entries:
            raise UserError(f"site: {THEORY} lists {link}, which holds no equations; name the file that has them")
        return "\n".join(entries)

    return SOURCES.sub(filled, text)


def _files(place: Path) -> list[Path]:
    """Return the modules of a place: the file itself, or all below a folder, those of the folder first."""
    if place.is_file():
        return [place]
    return sorted(place.rglob("*.py"), key=lambda file: (file.parent != place, file))


def _entry(file: Path, root: Path) -> str:
    """Return the section of one file, or an empty text where its docstring holds no equations."""
    text = ast.get_docstring(ast.parse(file.read_text())) or ""
    first, _, rest = text.partition("\n\n")
    if len(rest.splitlines()) < FEWEST_LINES or file.name.startswith("__"):
        return ""
    acronym = re.match(r"([A-Z]{2,}):", first)
    title = acronym[1] if acronym else file.stem.replace("_", " ").capitalize()
    source = file.relative_to(root.resolve()).as_posix()
    return f"### {title}\n\n{' '.join(first.split())}\n\n```text\n{rest}\n```\n\n`{source}`\n"


AT_THE_TOP = ("README.md", "ARCHITECTURE.md", "CONTRIBUTING.md", "CHANGELOG.md")
ELSEWHERE = ("tests/published/reference/README.md",)
HOME = Path("README.md")
ALONE = "---\nhide:\n  - navigation\n---\n\n"
"""The first page has the tabs alone."""
PICTURES = (".svg", ".png", ".jpg", ".gif", ".webp")
ASSETS = Path(__file__).with_name("theme") / "assets"
LINK = re.compile(r"(?<=\]\()([^)#\s]+)")
FENCE = re.compile(r"(^```.*?^```$|`[^`\n]+`)", re.MULTILINE | re.DOTALL)
"""Parts that are no Markdown: blocks of code, and code in a line."""


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
