"""docs/theory.md lists the sources of the equations; the site shows the equations themselves."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from shared.stage.errors import UserError
from shared.stage.paths import ROOT
from tools.site.staging import THEORY, with_equations


def test_every_section_of_the_page_is_filled_from_its_sources() -> None:
    kept = (ROOT / THEORY).read_text()
    filled = with_equations(kept, ROOT)
    sections = re.split(r"^## ", filled, flags=re.MULTILINE)[1:]
    assert len(sections) == kept.count("Sources: [") == len(re.findall(r"^## ", kept, re.MULTILINE)) > 10
    for section in sections:
        assert "\n### " in section
        assert "```text" in section
    assert "Sources: [" not in filled
    assert filled.startswith(kept.partition("Sources:")[0])


def test_a_source_is_shown_with_its_equations(tmp_path: Path) -> None:
    (tmp_path / "docs").mkdir()
    (tmp_path / "joints").mkdir()
    (tmp_path / "joints" / "pin.py").write_text('"""A pin.\n\n    x1 = x2\n    y1 = y2\n"""\n')
    (tmp_path / "joints" / "short.py").write_text('"""No equations."""\n')
    page = "# T\n\n## Joints\n\nWords.\n\nSources: [joints](../joints)\n"
    assert with_equations(page, tmp_path) == (
        "# T\n\n## Joints\n\nWords.\n\n### Pin\n\nA pin.\n\n```text\nx1 = x2\ny1 = y2\n```\n\n`joints/pin.py`\n"
    )


@pytest.mark.parametrize("source", ["joints/gone.py", "joints/short.py"])
def test_a_source_without_equations_raises_an_error(tmp_path: Path, source: str) -> None:
    (tmp_path / "joints").mkdir()
    (tmp_path / "joints" / "short.py").write_text('"""No equations."""\n')
    with pytest.raises(UserError, match=rf"lists \.\./{source}, which holds no equations"):
        with_equations(f"## A\n\nSources: [a](../{source})\n", tmp_path)
