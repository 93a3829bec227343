"""DXF documents whose bytes follow from the drawing alone, on layers with names that DXF allows.

ezdxf writes the time, two random marks, and the classes of entities in the order of a set, which differs from process
to process. Source of the rules for names: AutoCAD DXF reference, symbol table entries.
"""

from __future__ import annotations

import io
import re
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

FORBIDDEN = re.compile(r'[<>/\\":;?*|=`]')
"""Characters that the name of a layer cannot have, beside those that cannot be printed."""
LONGEST = 255
"""Characters of a name."""
RESERVED = ("0", "defpoints")
"""Layers with a meaning of their own to programs that read a DXF."""


@contextmanager
def without_times() -> Iterator[None]:
    """Leave the time and random marks out of the documents that are created and written within."""
    from ezdxf import options  # pyright: ignore[reportPrivateImportUsage]

    before = options.write_fixed_meta_data_for_testing
    options.write_fixed_meta_data_for_testing = True
    try:
        yield
    finally:
        options.write_fixed_meta_data_for_testing = before


def text_of(document: Any) -> str:
    """Return an ``ezdxf.document.Drawing`` as text: the same for the same entities in the same order."""
    for kind in sorted(document.entitydb.dxf_types_in_use()):
        document.classes.add_class(kind)
    text = io.StringIO()
    with without_times():
        document.write(text)
    return text.getvalue()


class Layers:
    """Layers of a document by the names that its author knows.

    Each has one of its own, which the format allows.
    """

    def __init__(self, document: Any) -> None:
        self._document = document
        self._names: dict[tuple[str, str], str] = {}

    def named(self, name: str, kind: str = "") -> str:
        """Return the layer for ``name`` among those of one ``kind``, added to the document if missing.

        Forbidden characters become underscores. Where another layer has that name, as DXF compares them (without
        regard to case), a number follows.
        """
        if (kind, name) not in self._names:
            allowed = _allowed(name)
            taken = {*RESERVED, *(other.casefold() for other in self._names.values())}
            number, free = 1, allowed
            while free.casefold() in taken:
                number += 1
                free = f"{allowed[: LONGEST - 8]} ({number})"
            self._document.layers.add(free)
            self._names[kind, name] = free
        return self._names[kind, name]


def _allowed(name: str) -> str:
    printed = "".join(letter if letter.isprintable() else "_" for letter in name)
    return FORBIDDEN.sub("_", printed).strip()[:LONGEST] or "_"
