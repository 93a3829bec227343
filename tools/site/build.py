"""The site: a folder of pages for MkDocs, and MkDocs."""

from __future__ import annotations

import logging
import os
import shutil
import tempfile
from pathlib import Path

from shared.stage.errors import UserError
from tools.site.navigation import navigation
from tools.site.reference.pages import write_reference
from tools.site.staging import stage

CONFIGURATION = Path(__file__).with_name("mkdocs.yml")


def build(root: Path, out: Path) -> None:
    """Write the site of the clone ``root`` to ``out``, whole or not at all. Raises UserError where a page is wrong."""
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
