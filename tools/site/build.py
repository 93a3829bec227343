"""The site: a folder of pages for MkDocs, and MkDocs."""

from __future__ import annotations

import logging
import os
import re
import shutil
import tempfile
from pathlib import Path
from typing import Any

from shared.stage.errors import UserError
from tools.site.reference import PAGES, write_reference
from tools.site.staging import stage

# The navigation: the groups of mkdocs.yml, with lists that follow from the pages that there are.


DECISIONS = Path("docs/decisions")
HEADING = re.compile(r"^## (.+)$|^- \[(.+?)\]\((.+?)\)$", re.MULTILINE)


def navigation(groups: list[Any], pages: Path) -> list[Any]:
    """Return the groups with ``{decisions}`` and ``{reference}`` filled in.

    Pages of docs/ in none of them are under More.
    """
    filled = _filled(groups, {"{decisions}": _decisions(pages), "{reference}": [f"reference/{name}" for name in PAGES]})
    listed = set(_files(filled))
    more = [name for page in sorted((pages / "docs").glob("*.md")) if (name := f"docs/{page.name}") not in listed]
    return [*filled, {"More": more}] if more else filled


def _filled(entries: list[Any], lists: dict[str, list[Any]]) -> list[Any]:
    out: list[Any] = []
    for entry in entries:
        if isinstance(entry, str) and entry in lists:
            out += lists[entry]
        elif isinstance(entry, dict):
            out.append(
                {title: _filled(below, lists) if isinstance(below, list) else below for title, below in entry.items()}
            )
        else:
            out.append(entry)
    return out


def _decisions(pages: Path) -> list[dict[str, list[dict[str, str]]]]:
    """The sections of the list of decisions."""
    out: list[dict[str, list[dict[str, str]]]] = []
    for section, title, place in HEADING.findall((pages / DECISIONS / "README.md").read_text()):
        if section:
            out.append({section: []})
        else:
            next(iter(out[-1].values())).append({title: (DECISIONS / place).as_posix()})
    return out


def _files(entries: list[Any]) -> list[str]:
    """Every page that is named."""
    out: list[str] = []
    for entry in entries:
        for value in entry.values() if isinstance(entry, dict) else [entry]:
            out += _files(value) if isinstance(value, list) else [value]
    return out


CONFIGURATION = Path(__file__).with_name("mkdocs.yml")


def build(root: Path, out: Path) -> None:
    """Write the site of the clone ``root`` to ``out``, whole or not at all.

    Raises UserError where a page is wrong.
    """
    out.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=out.parent, prefix=".site-") as temporary:
        pages, built = Path(temporary) / "pages", Path(temporary) / "site"
        stage(root, pages)
        write_reference(pages / "reference")
        _mkdocs(pages, built)
        shutil.rmtree(out, ignore_errors=True)
        built.rename(out)


def _mkdocs(pages: Path, built: Path) -> None:
    os.environ.setdefault("DISABLE_MKDOCS_2_WARNING", "true")
    from mkdocs.commands.build import build as mkdocs_build
    from mkdocs.config import load_config
    from mkdocs.exceptions import Abort, ConfigurationError

    messages = _Messages()
    logging.getLogger("mkdocs").addHandler(messages)
    try:
        configuration = load_config(str(CONFIGURATION), docs_dir=str(pages), site_dir=str(built), strict=True)
        configuration.nav = navigation(configuration.nav or [], pages)
        mkdocs_build(configuration)
    except (Abort, ConfigurationError) as error:
        raise UserError(f"site: {'; '.join(messages.texts) or error}") from error
    finally:
        logging.getLogger("mkdocs").removeHandler(messages)


class _Messages(logging.Handler):
    """Keeps warnings for the one sentence of an error."""

    def __init__(self) -> None:
        super().__init__(logging.WARNING)
        self.texts: list[str] = []

    def emit(self, record: logging.LogRecord) -> None:
        """Keep one."""
        self.texts.append(record.getMessage())
