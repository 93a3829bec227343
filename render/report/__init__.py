"""report.md: a run in sentences and tables: ``python -m render report NAME``."""

from __future__ import annotations

import ast
from pathlib import Path

from render import FRAME_SOURCES
from render.freshness import clearance_files, current_clearance
from render.insights import insights
from render.report import sections
from render.report.loads import load_section
from render.report.orders import orders_section
from render.report.space import motion_in_space, sections_in_space
from render.report.transmission import event_section, transmission_section
from render.report.travel import travel_section
from shared.contract import AnyMotion, Motion, Motion3, Parts, read_any_motion, read_parts
from shared.contract.clearance import Clearance
from shared.stage.console import say
from shared.stage.files import sources_hash, write_bytes
from shared.stage.paths import Out, mechanism_file
from shared.stage.stages import Stage, contract_sources, key_of, versions

INSIGHTS = 8
"""Insights of a report, at most."""
READ = [*contract_sources("clearance"), *FRAME_SOURCES]


def run(name: str) -> None:
    """Write out/<name>/report.md, if its inputs or its own sources have changed.

    Raises UserError without data.json.
    """
    out = Out(name)
    motion = read_any_motion(out.motion, out.name)
    parts = read_parts(out.parts, out.name) if out.parts.is_file() else None
    clearance = current_clearance(out, parts, "report")
    said = description(out.name)
    stage = _stage(out, said)
    if stage.is_fresh():
        say("report", f"{out.name}: nothing to do")
        return
    write_bytes(out.report, report(motion, parts, clearance, said).encode())
    stage.record()
    say("report", f"{out.name}: {out.report}")


def is_fresh(name: str) -> bool:
    """Return True if there is nothing to do."""
    out = Out(name)
    return out.motion.is_file() and _stage(out, description(out.name)).is_fresh()


def _stage(out: Out, said: str) -> Stage:
    files = [path for path in (out.motion, out.parts, *clearance_files(out)) if path.is_file()]
    key = key_of(*files, len(files), said, sources_hash(Path(__file__).parent, *READ), versions("numpy"))
    return Stage(out, "report", key, [out.report])


def report(motion: AnyMotion, parts: Parts | None, clearance: Clearance | None, said: str = "") -> str:
    """Return the whole document, Markdown."""
    title = motion.mechanism.replace("_", " ").replace("-", ": ")
    lines = [f"# {title[:1].upper()}{title[1:]}", ""]
    lines += [said, ""] if said else []
    if isinstance(motion, Motion3):
        lines += motion_in_space(motion)
        chapters = [*sections_in_space(motion, parts), ("Clearance", sections.clearance_section(clearance))]
    else:
        lines += sections.motion_section(motion)
        chapters = _planar_sections(motion, parts, clearance)
    for head, body in chapters:
        if body:
            lines += ["", f"## {head}", "", *body]
    text = "\n".join(lines)
    while "\n\n\n" in text:
        text = text.replace("\n\n\n", "\n\n")
    return text.rstrip() + "\n"


def _planar_sections(motion: Motion, parts: Parts | None, clearance: Clearance | None) -> list[tuple[str, list[str]]]:
    """Return headings and lines of a mechanism in the plane."""
    return [
        ("Insights", insight_section(motion)),
        ("Travel", travel_section(motion)),
        ("Events", event_section(motion)),
        ("Speeds", sections.speed_section(motion)),
        ("Loads", load_section(motion)),
        ("Shaking of the frame", sections.frame_section(motion)),
        ("Orders", orders_section(motion)),
        ("Energy", sections.energy_section(motion)),
        ("Transmission", transmission_section(motion)),
        ("Masses", sections.mass_section(motion, parts)),
        ("Clearance", sections.clearance_section(clearance)),
    ]


def insight_section(motion: Motion) -> list[str]:
    """Return what the motion shows as a list, the most telling first."""
    return [f"- {each.sentence()}" for each in insights(motion)[:INSIGHTS]]


def description(name: str) -> str:
    """Return the docstring of mechanism.py, read without running it; empty where there is none."""
    try:
        return ast.get_docstring(ast.parse(mechanism_file(name).read_bytes())) or ""
    except (SyntaxError, OSError):
        return ""
