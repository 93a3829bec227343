"""SVG elements as text: numbers to a tenth of a pixel, so that equal diagrams are equal bytes."""

from __future__ import annotations

from html import escape


def tag(name: str, content: str | None = None, **attributes: str | float) -> str:
    """An element; underscores in the names of attributes stand for hyphens."""
    parts = [f'{key.replace("_", "-")}="{_value(value)}"' for key, value in attributes.items()]
    opening = f"<{' '.join([name, *parts])}"
    return f"{opening}/>" if content is None else f"{opening}>{escape(content)}</{name}>"


def d(*parts: str | float) -> str:
    """A path's data: commands and numbers."""
    return " ".join(part if isinstance(part, str) else _value(part) for part in parts)


def _value(value: str | float) -> str:
    if isinstance(value, str):
        return escape(value)
    text = f"{float(value):.1f}".removesuffix(".0")
    return "0" if text == "-0" else text
