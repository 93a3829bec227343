"""Markdown of an article as HTML: steps, paragraphs with what is bound to them, numbers that can be dragged."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from html import escape
from typing import Any
from urllib.parse import unquote

from markdown_it import MarkdownIt
from markdown_it.token import Token

from render.article.quantities import MEASURES, named, series_of, thing_of
from shared.stage.errors import UserError, did_you_mean

# The links of a text (steps.py): [34°](turn:motor) and [0 s](time:) are dragged and move the machine,
# [40 mm](number:crank) is dragged and changes it; [1.4 N](now:joint/B/size) follows it; [133°](at:0.37) goes there and
# [the rocker](show:body/rocker) points at it. Others are links of the web or to files. HTML of an author stays text.

SCENE = re.compile(r"\{([\w-]+=\S+(?: [\w-]+=\S+)*)\}")
HEADING = re.compile(r"(.*?)\s*\{#([\w-]+)\}")
NUMBERS = ("at", "to", "apart", "speed")
WORDS = ("arrows", "curve", "near", "variant")
ARROWS = ("reactions", "forces", "velocities", "accelerations", "trails", "names", "centres", "glass")
NUMBER, JOINER = "</b>", "\N{WORD JOINER}"
"""End of a number that is a box of its own, and what keeps the sign behind it on its line."""
OUTSIDE = re.compile(r"(https?://|mailto:|#|\.?/?[\w][\w./-]*$)", re.IGNORECASE)


@dataclass(frozen=True)
class Section:
    """A step as HTML; the first of a text has no key and holds what stands before the first step."""

    key: str
    title: str
    body: str


@dataclass(frozen=True)
class Text:
    """A whole text."""

    title: str
    sections: list[Section]


class Markup:
    """Writes the HTML of texts about one machine; ``where`` begins the errors."""

    def __init__(self, payload: Mapping[str, Any], numbers: Sequence[Mapping[str, Any]], where: str) -> None:
        self.payload, self.where = dict(payload), where
        self.numbers = {number["name"]: number for number in numbers}
        self._parser = MarkdownIt("commonmark", {"html": False})
        self._parser.validateLink = lambda address: bool(self._known(address))  # type: ignore[method-assign]
        self._parser.normalizeLink = lambda address: address  # type: ignore[method-assign]

    def text(self, markdown: str) -> Text:
        """Return a text. Raises UserError for what is bound to a paragraph and does not exist."""
        title, key, head, rows = "", "", "", list[Section]()
        body: list[Token] = []
        tokens = self._parser.parse(markdown)

        def close() -> None:
            html = self._html(body)
            if key or html:
                rows.append(Section(key, head, html))
            body.clear()

        k = 0
        while k < len(tokens):
            token = tokens[k]
            if token.type == "heading_open" and token.tag in ("h1", "h2"):
                words = tokens[k + 1].content
                if token.tag == "h1":
                    title = words
                else:
                    close()
                    match = HEADING.fullmatch(words)
                    head, key = (
                        (match[1], match[2]) if match else (words, re.sub(r"\W+", "-", words.lower()).strip("-"))
                    )
                k += 3
                continue
            body.append(token)
            k += 1
        close()
        return Text(self.inline(title), [Section(each.key, self.inline(each.title), each.body) for each in rows])

    def inline(self, markdown: str) -> str:
        """Return a line as HTML without links."""
        (line,) = self._parser.parseInline(markdown)
        return escape("".join(child.content for child in line.children or []))

    def _html(self, tokens: list[Token]) -> str:
        out = []
        for k, token in enumerate(tokens):
            if token.type == "paragraph_open" and not token.hidden:
                scene = self._scene(tokens[k + 1])
                attribute = f' data-scene="{escape(json.dumps(scene), quote=True)}"' if scene is not None else ""
                out.append(f"<p{attribute}>")
            elif token.type == "inline":
                out.append(self._line(token.children or []))
            else:
                out.append(self._parser.renderer.render([token], self._parser.options, {}))
        return "".join(out)

    def _scene(self, line: Token) -> dict[str, Any] | None:
        """Return what is bound to a paragraph, and take its last line away; each paragraph has at least {}."""
        *text, last = line.content.split("\n")
        match = SCENE.fullmatch(last.strip())
        if match is None:
            return {}
        (fresh,) = self._parser.parseInline("\n".join(text))
        line.children = fresh.children
        scene: dict[str, Any] = {}
        for pair in match[1].split(" "):
            key, _, value = pair.partition("=")
            scene[key] = self._value(key, value)
        return scene

    def _value(self, key: str, value: str) -> Any:
        known = (*NUMBERS, *WORDS)
        try:
            if key in NUMBERS:
                return float(value)
            if key == "arrows":
                unknown = [word for word in value.split(",") if word not in ARROWS]
                if unknown:
                    raise UserError(f"'{unknown[0]}' is nothing to show; there is: {', '.join(ARROWS)}")
                return value.split(",")
            if key == "curve":
                series_of(self.payload, value)
                return named(value)
            if key == "near":
                thing_of(self.payload, value)
                return named(value)[:2]
            if key == "variant":
                return unquote(value)
        except ValueError:
            raise UserError(f"{self.where}: {key}={value} is no number") from None
        except UserError as error:
            raise UserError(f"{self.where}: {key}={value}: {error}") from None
        hint = f"there is: {', '.join(known)}{did_you_mean(key, known)}"
        raise UserError(f"{self.where}: '{key}' cannot be bound to a paragraph; {hint}")

    def _line(self, children: list[Token]) -> str:
        out, ends = [], list[str]()
        for token in children:
            if out and out[-1] == NUMBER and token.type == "text" and token.content[:1] in tuple(",.;:)"):
                out.append(JOINER)
            if token.type == "link_open":
                begin, end = self._link(str(token.attrs["href"]))
                out.append(begin)
                ends.append(end)
            elif token.type == "link_close":
                out.append(ends.pop())
            elif token.type == "image":
                out.append(escape(token.content))
            else:
                out.append(self._parser.renderer.render([token], self._parser.options, {}))
        return "".join(out)

    def _known(self, address: str) -> str:
        """Return the scheme of a link of the text; ``web`` of one to elsewhere, empty of one that is refused."""
        scheme = address.partition(":")[0]
        if scheme in (*MEASURES, "turn", "time", "number", "at", "show") and ":" in address:
            return scheme
        return "web" if OUTSIDE.match(address) else ""

    def _link(self, address: str) -> tuple[str, str]:
        """Return the tags before and behind the words of a link. Raises UserError for what the machine lacks."""
        scheme, target = self._known(address), address.partition(":")[2]
        data = escape(target, quote=True)
        try:
            if scheme in MEASURES:
                series_of(self.payload, target)
                return f'<b class="now" data-measure="{scheme}" data-of="{data}">', NUMBER
            if scheme in ("turn", "time"):
                if scheme == "turn":
                    thing_of(self.payload, f"driver/{target}")
                name = unquote(target).replace("_", " ")
                label = f"Angle of {name}" if scheme == "turn" else "Time"
                return _slider("turn", data, label), NUMBER
            if scheme == "number":
                number = self.numbers.get(unquote(target))
                if number is None:
                    raise UserError(
                        f"no number '{unquote(target)}' can be dragged{did_you_mean(unquote(target), self.numbers)}"
                    )
                return _slider("number", data, str(number["label"])), NUMBER
            if scheme == "at":
                return f'<span class="push" data-at="{float(target):.9g}">', "</span>"
            if scheme == "show":
                thing_of(self.payload, target)
                return f'<span class="push" data-show="{data}">', "</span>"
        except ValueError:
            raise UserError(f"{self.where}: [...]({address}): {target} is no time") from None
        except UserError as error:
            raise UserError(f"{self.where}: [...]({address}): {error}") from None
        return f'<a href="{escape(address, quote=True)}" rel="noopener">', "</a>"


def merged(generated: Text, author: Text) -> Text:
    """Return the text with the steps of an author in place of those of the same key; an empty one is left out.

    Steps of other keys stand behind the author's step before them.
    """
    rows = {each.key: each for each in generated.sections}
    order = list(rows)
    before = ""
    for each in author.sections:
        if each.key not in rows:
            order.insert(order.index(before) + 1 if before in order else 0, each.key)
        rows[each.key] = each
        before = each.key
    return Text(author.title or generated.title, [rows[key] for key in order if rows[key].body.strip()])


def _slider(kind: str, data: str, label: str) -> str:
    return f'<b class="drag" data-{kind}="{data}" aria-label="{escape(label, quote=True)}">'
