"""The article: one HTML page that explains a machine in eight steps, beside the page's view of it."""

from __future__ import annotations

import base64
from html import escape
from pathlib import Path
from typing import Any

from render import FRAME_SOURCES
from render.freshness import clearance_files, current_clearance
from shared.contract import Motion, is_in_space, read_motion, read_parts
from shared.contract.skeleton import read_skeleton
from shared.stage.console import say
from shared.stage.errors import UserError
from shared.stage.face import to_run
from shared.stage.files import sources_hash, write_bytes
from shared.stage.paths import ROOT, Out, is_single_file, mechanism_file, mechanism_folder, owner_of, variants_in
from shared.stage.stages import Stage, contract_sources, key_of, versions

LARGEST = 9_000_000
"""Bytes of an article."""
THEME = (
    "document.currentScript.parentElement.dataset.theme = "
    'matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light"'
)
"""Script that colours the text before it is painted."""
VARIANTS = 3
"""Variants that stand beside a machine, at most."""


def run(name: str) -> None:
    """Write out/<name>/article.html and its text article.md, if what they show has changed. Raises UserError."""
    out = Out(name)
    stage = _stage(out)
    if stage.is_fresh():
        say("article", f"{out.name}: nothing to do")
        return
    content, text = _article(out)
    if len(content) > LARGEST:
        raise UserError(
            f"{out.name}: the article would have {len(content) / 1e6:.1f} MB, more than {LARGEST / 1e6:.0f}; "
            "use fewer or coarser solids, or fewer times"
        )
    write_bytes(out.article, content)
    write_bytes(out.article.with_suffix(".md"), text.encode())
    stage.record()
    say("article", f"{out.name}: {out.article}: {len(content) / 1e6:.1f} MB; its text: article.md beside it")


def author_file(name: str) -> Path:
    """Return the file of an author's own text: article.md, or excavator.md of excavator.py."""
    return mechanism_folder(name) / (f"{owner_of(name)}.md" if is_single_file(name) else "article.md")


def _stage(out: Out) -> Stage:
    from render.film.inputs import SHARED
    from render.view.bundle import sources_key

    mechanism_folder(out.name)
    for path, target in ((out.motion, "solve"), (out.skeleton, "solve")):
        if not path.is_file():
            raise UserError(f"{out.name}: {path} is missing; run {to_run(target, out.name)} first")
    if is_in_space(out.motion):
        raise UserError(
            f"{out.name} moves in space, and an article explains mechanisms in the plane alone; "
            f"open its page: {to_run('view', out.name)}"
        )
    beside = [author_file(out.name), mechanism_file(out.name), out.parts, out.shot, out.designs, *clearance_files(out)]
    motions = [path for variant in variants_of(out).values() for path in (variant.motion, variant.skeleton)]
    there = [path for path in (*beside, *motions) if path.is_file()]
    rooms = [ROOT / "render" / name for name in ("film", "glb", "insights", "report", "view", "blender/scene/tubes.py")]
    ours = (
        sources_hash(
            Path(__file__).parent, *rooms, *FRAME_SOURCES, *contract_sources(*SHARED, "skeleton", "clearance")
        ),
        sources_key(),
        versions("numpy", "markdown-it-py"),
    )
    key = key_of(out.motion, out.skeleton, *there, *(path.name for path in there), *ours)
    return Stage(out, "article", key, [out.article, out.article.with_suffix(".md")])


def variants_of(out: Out) -> dict[str, Out]:
    """Return the solved variants of a mechanism that stand beside it; none beside a variant."""
    if out.name != owner_of(out.name):
        return {}
    variants = {variant: Out(f"{out.name}-{variant}") for variant in variants_in(mechanism_file(out.name))}
    solved = {
        variant: files for variant, files in variants.items() if files.motion.is_file() and files.skeleton.is_file()
    }
    return dict(list(solved.items())[:VARIANTS])


def _article(out: Out) -> tuple[bytes, str]:
    """Return the page and its generated text, Markdown."""
    from render.article.markup import Markup, merged
    from render.article.sentences import Machine
    from render.article.steps import markdown, steps_of
    from render.report import description
    from render.view.bundle import bundle
    from render.view.document import document, encode, header_of, sketch
    from render.view.payload import payload, read_payload

    page = read_payload(out)
    parts = read_parts(out.parts, out.name) if out.parts.is_file() else None
    table = out.designs.read_bytes() if out.designs.is_file() else b""
    variants: dict[str, Motion] = {}
    page["variants"] = {}
    for variant, files in variants_of(out).items():
        variants[variant] = read_motion(files.motion)
        moving = read_skeleton(files.skeleton).moving
        if moving is not None:
            page["variants"][variant] = payload(variants[variant], moving)
    designs = header_of(table) if table else {}
    clearance = current_clearance(out, parts, "article")
    motion = read_motion(out.motion, out.name)
    machine = Machine(out.name, description(out.name), motion, page, parts, clearance, designs, variants)
    source = markdown(machine, steps_of(machine))
    numbers = designs.get("numbers", [])
    text = Markup(page, numbers, "article").text(source)
    own = author_file(out.name)
    if own.is_file():
        text = merged(text, Markup(page, numbers, str(own)).text(_read(own)))
    more = f'<script type="text/plain" id="mbsd-designs">{base64.b64encode(table).decode()}</script>\n' if table else ""
    inside = written(text.title, text.sections, sketch(page["skeleton"]), out.name)
    return document(page["title"], encode(page), bundle("article"), more, sketch=inside), source


def _read(path: Path) -> str:
    try:
        return path.read_text("utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise UserError(f"{path} cannot be read as UTF-8 text: {error}") from error


def written(title: str, sections: list[Any], picture: str, name: str) -> str:
    """Return the HTML of an article, whole without a script: title, sketch, text."""
    rows = []
    for each in sections:
        head = f'<h2 id="{escape(each.key, quote=True)}">{each.title}</h2>' if each.key else ""
        label = f' aria-labelledby="{escape(each.key, quote=True)}"' if each.key else ""
        rows.append(f"<section{label}>{head}{each.body}</section>")
    return (
        f'<div class="mbsd article"><script>{THEME}</script><header><h1>{title}</h1></header>'
        f'<aside class="viewer" aria-label="The machine">{picture}</aside><main>{"".join(rows)}'
        f"<footer>Made from {escape(name)}/mechanism.py by mbsd; numbers are those of its motion.</footer></main></div>"
    )
