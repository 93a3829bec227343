"""Pictures for light and dark paper, chosen by the site's switch instead of by the system."""

from __future__ import annotations

import re

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
