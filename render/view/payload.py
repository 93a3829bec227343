"""The data of a page."""

from __future__ import annotations

import math
import types
from collections.abc import Mapping, Sequence
from typing import Any

import msgspec
import numpy as np

from render.film.clock import Clock
from render.film.film import Film
from render.film.poses import local_place
from render.film.tubes.trails import colour_of, trails_of
from render.freshness import current_clearance
from render.insights import insights
from render.insights.loops import marks
from render.magnitudes import floor_of, floors, shaking, without_noise
from render.view.loads import arcs_of, arrows_of, clearance_of
from render.view.solid import with_parts
from render.view.space import things_in_space
from shared.contract import AnyMotion, JointMotion, Motion, read_any_motion, read_parts
from shared.contract.geometry import with_rods
from shared.contract.links import with_links
from shared.contract.shot import Shot, read_shot
from shared.contract.skeleton import Carrier, Moving, Stroke, read_skeleton
from shared.stage.errors import UserError
from shared.stage.face import to_run
from shared.stage.paths import Out

# The content of the page, as one dict of plain values and arrays; document.py makes bytes of it.
#
# SI units and radians; names are those of data.json. Arrays are float32 unless said; T is the number of times.
#
# In space it is that of space.py here and there.
#
#     mechanism, title        its name, and in words
#     analysis, gravity       "sweep" or "simulation"; [x, y] (m/s^2)
#     time                    (T,) float64; rows right before and right after an event share a time
#     period                  s, or null: then it plays forwards, holds at its end and begins anew
#     clock                   start, end (s of the motion); seconds: film time of one showing; hold: film time at the
#     end;                         fps: of the film, for going on by one frame bodies[name]            x y theta vx vy
#     omega ax ay alpha (T,); mass com inertia; inks: on light and on dark paper joints[name]            kind, bodies;
#     pair: pin, guide, slot or null; x y fx fy torque (T,); at: {body, x, y} of its                         second
#     marker drivers[name]           kind, bodies; value effort power (T,); unit, effort_unit points[name]
#     body; x y vx vy ax ay (T,) forces[name]            kind; value, rate, effort (T,) or null; power potential (T,);
#     unit, effort_unit contacts[name]          kind, bodies; unit, effort_unit; x y fx fy torque gap normal friction
#     (T,) frame                   null, or of a motion with couples that repeats with a crank: fx fy x y (T,), force of
#     inertia and centre of mass; crank; order (K,), harmonics[name]: unit, size (K,), rounding
#     left out couple                  null, or mx my (T,) of bodies in different places along the normal of the plane
#     energy                  kinetic potential (T,), work audit (T,) or null margin                  (T,) smallest over
#     largest singular value of the scaled Jacobian marks                   [{time, words, kind: "event" or "dead
#     point"}]
#     insights                [{time, words}] of a page made from files, the most telling first
#     skeleton                unit, low, high (m); strokes, names, times: see skeleton() arrows, arcs
#     see loads.py trails                  [{point, colour (linear) or null: as the theme has it, tail (turns), radius,
#     z}] clearance               null, or limit and pairs: see loads.py solid                   null, or the parts: see
#     solid.py
#
# A server may send the same dict again, or some of its keys alone: what is given replaces what was there.

UNITS = {
    "vx": "m/s", "vy": "m/s", "omega": "rad/s", "ax": "m/s²", "ay": "m/s²", "fx": "N", "fy": "N", "torque": "N m",
    "power": "W", "kinetic": "J", "potential": "J",
}  # fmt: skip
"""Units of series whose rounding is drawn as zero."""
INSIGHTS = 6
"""Insights on the page, at most."""
EFFORTS = ("effort", "normal", "friction")
"""Series in the unit of the effort of their driver, force or contact."""


def payload(motion: AnyMotion, moving: Moving, shot: Shot | None = None, arrows: bool = True) -> dict[str, Any]:
    """Return everything but the parts; arrows and arcs only if ``arrows``.

    ``motion`` may have more bodies than the skeleton: rods of the parts.
    """
    shot = shot or Shot()
    clock = Clock(motion, shot)
    size = max(float(np.ptp([moving.low, moving.high], axis=0).max()), 10 * moving.unit)
    quiet = floors(motion) if isinstance(motion, Motion) else {}
    return {
        "mechanism": motion.mechanism,
        "title": title_of(motion.mechanism),
        "analysis": motion.analysis,
        "gravity": list(motion.gravity),
        "time": np.asarray(motion.time, np.float64),
        "period": motion.period,
        "clock": {
            "start": clock.start,
            "end": clock.end,
            "seconds": clock.moving / shot.fps,
            "hold": 0.0 if clock.repeats else (clock.frames - clock.moving) / shot.fps,
            "fps": shot.fps,
            "turns": clock.turns,
        },
        **(_things(motion, quiet) if isinstance(motion, Motion) else things_in_space(motion)),
        "energy": _series(motion.energy, "kinetic", "potential", "work", "audit", quiet=quiet),
        "margin": floats(motion.diagnostics.singularity_margin),
        "insights": [],
        "skeleton": skeleton(moving),
        **({"arrows": arrows_of(motion, size), "arcs": arcs_of(motion, size)} if arrows else {}),
        "trails": [
            {
                "point": trail.point,
                "colour": list(colour_of(trail, False)) if trail.colour or trail.ink else None,
                "tail": trail.tail,
                "radius": trail.radius * size,
                "z": 0.0,
            }
            for trail in trails_of(motion, shot)
        ],
        "clearance": None,
        "solid": None,
    }


def _things(motion: Motion, quiet: Mapping[str, float]) -> dict[str, Any]:
    """Return bodies, joints and all else that a motion in the plane has of its own."""
    return {
        "bodies": {name: _body(body, quiet) for name, body in motion.bodies.items()},
        "joints": {name: _joint(motion, joint, quiet) for name, joint in motion.joints.items()},
        "drivers": {name: _driver(driver, quiet) for name, driver in motion.drivers.items()},
        "points": {
            name: {"body": point.body} | _series(point, "x", "y", "vx", "vy", "ax", "ay", quiet=quiet)
            for name, point in motion.points.items()
        },
        "forces": {name: _force(force, quiet) for name, force in motion.forces.items()},
        "contacts": {
            name: {
                "kind": contact.kind,
                "bodies": list(contact.bodies),
                "unit": contact.unit,
                "effort_unit": contact.effort_unit,
            }
            | _series(contact, "x", "y", "fx", "fy", "torque", "gap", "normal", "friction", quiet=quiet)
            for name, contact in motion.contacts.items()
        },
        "couple": couple_of(motion),
        "frame": frame_of(motion),
        "marks": [
            {"time": time, "words": words, "kind": "dead point" if words.endswith("turns back") else "event"}
            for time, words in marks(motion)
        ],
    }


def skeleton(moving: Moving) -> dict[str, Any]:
    """Return strokes, names and carriers of the skeleton.

    Strokes {points (2 n,), closed, ink, fill, alpha, width, order, dash, sign, carrier, shapes (k, 2 n)}, in the order
    in which they are drawn; names {text, at, clearance, ink, carrier}; carriers {kind, ends: [{body, x, y}]}.
    """
    return {
        "unit": moving.unit,
        "low": list(moving.low),
        "high": list(moving.high),
        "times": np.asarray(moving.times, np.float64),
        "strokes": [
            _stroke(carried.stroke)
            | {"carrier": _carrier(carried.carrier), "shapes": floats(carried.shapes) if carried.shapes else None}
            for carried in sorted(moving.strokes, key=lambda carried: carried.stroke.order)
        ],
        "names": [
            {
                "text": label.name.text,
                "at": list(label.name.at),
                "clearance": label.name.clearance,
                "ink": label.name.ink,
                "carrier": _carrier(label.carrier),
            }
            for label in moving.names
        ],
    }


def title_of(mechanism: str) -> str:
    """Return the name in words: ``Four bar``, ``Slider crank: no gravity``."""
    words = mechanism.replace("_", " ").replace("-", ": ")
    return words[:1].upper() + words[1:]


def floats(values: Any) -> np.ndarray:
    """Return values as float32."""
    return np.asarray(values, np.float64).astype(np.float32)


def _series(thing: Any, *names: str, quiet: Mapping[str, float] = types.MappingProxyType({})) -> dict[str, Any]:
    """Return series of a thing by name; what is below the floor of its unit is 0."""
    series: dict[str, Sequence[float] | None] = {name: getattr(thing, name) for name in names}
    return {
        name: None if values is None else floats(without_noise(np.asarray(values), _floor(thing, name, quiet)))
        for name, values in series.items()
    }


def _floor(thing: Any, name: str, quiet: Mapping[str, float]) -> float:
    unit = thing.effort_unit if name in EFFORTS else UNITS.get(name, "")
    return quiet.get(unit, 0.0)


def couple_of(motion: Motion) -> dict[str, Any] | None:
    """Return the moments of inertia on the frame about axes in the plane, with rounding set to zero."""
    shaken = shaking(motion)
    return None if shaken.mx is None else _series(shaken, "mx", "my")


def frame_of(motion: Motion) -> dict[str, Any] | None:
    """Return the force of inertia, centre of mass, and the largest size of each harmonic."""
    vibration = motion.vibration
    if vibration is None or motion.couple is None:
        return None
    shaken = shaking(motion)
    harmonics = {}
    for name, each in vibration.harmonics.items():
        size, floor = np.add(each.forward, each.backward), floor_of(motion, name, each.unit)
        if size.max(initial=0.0) > floor:
            harmonics[name] = {"unit": each.unit, "size": floats(np.where(size > floor, size, 0.0))}
    series = _series(shaken, "fx", "fy") | _series(vibration, "x", "y")
    return series | {"crank": vibration.crank, "order": floats(vibration.order), "harmonics": harmonics}


def _body(body: Any, quiet: Mapping[str, float]) -> dict[str, Any]:
    out = _series(body, "x", "y", "vx", "vy", "omega", "ax", "ay", "alpha", quiet=quiet)
    # Whole turns at the start say nothing and cost figures.
    out["theta"] = floats(np.asarray(body.theta) - math.tau * round(body.theta[0] / math.tau))
    return out | {
        "mass": body.mass,
        "com": list(body.com),
        "inertia": body.inertia,
        "inks": [body.colour, body.colour_on_dark],
    }


def _joint(motion: Motion, joint: JointMotion, quiet: Mapping[str, float]) -> dict[str, Any]:
    """Return a joint; ``at``: the second marker in its body, from where both are at the start."""
    body, x, y = joint.bodies[1], joint.x[0], joint.y[0]
    if body in motion.bodies:
        x, y = local_place(motion.bodies[body], x, y)
    at = {"body": body, "x": x, "y": y}
    out = {"kind": joint.kind, "bodies": list(joint.bodies), "pair": joint.pair, "at": at}
    return out | _series(joint, "x", "y", "fx", "fy", "torque", quiet=quiet)


def _driver(driver: Any, quiet: Mapping[str, float]) -> dict[str, Any]:
    units = {"unit": driver.unit, "effort_unit": driver.effort_unit}
    bodies = list(driver.bodies) if driver.bodies else []
    return {"kind": driver.kind, "bodies": bodies} | units | _series(driver, "value", "effort", "power", quiet=quiet)


def _force(force: Any, quiet: Mapping[str, float]) -> dict[str, Any]:
    units = {"unit": force.unit or "m", "effort_unit": force.effort_unit}
    bodies = [action.body for action in force.actions]
    out = {"kind": force.kind, "bodies": bodies} | units
    return out | _series(force, "value", "rate", "effort", "power", "potential", quiet=quiet)


def _carrier(carrier: Carrier) -> dict[str, Any]:
    return {"kind": carrier.kind, "ends": [msgspec.to_builtins(end) for end in carrier.ends]}


def _stroke(stroke: Stroke) -> dict[str, Any]:
    return {
        "points": floats(stroke.points),
        "closed": stroke.closed,
        "ink": stroke.ink,
        "fill": stroke.fill,
        "alpha": stroke.alpha,
        "width": stroke.width,
        "order": stroke.order,
        "dash": list(stroke.dash),
        "sign": stroke.sign,
    }


# Reads what the page shows from out/<name>/: the motion and its skeleton, and what else is there.


def read_payload(out: Out) -> dict[str, Any]:
    """Return the whole payload of a mechanism. Raises UserError for files that do not fit together."""
    motion, skeleton = read_any_motion(out.motion, out.name), read_skeleton(out.skeleton)
    if skeleton.moving is None:
        raise UserError(f"{out.name}: {out.skeleton} is of an earlier version; run {to_run('solve', out.name)} again")
    if skeleton.provenance.inputs != motion.provenance.inputs:
        raise UserError(
            f"{out.name}: {out.skeleton} is not of the motion in {out.motion}; run {to_run('solve', out.name)} again"
        )
    shot = read_shot(out.shot) if out.shot.is_file() else Shot()
    parts = read_parts(out.parts, out.name) if out.parts.is_file() else None
    solved = motion
    if parts is not None:
        motion = with_rods(motion, parts) if isinstance(motion, Motion) else with_links(motion, parts)
    page = payload(motion, skeleton.moving, shot)
    if isinstance(solved, Motion):
        page["insights"] = [{"time": each.start, "words": each.sentence()} for each in insights(solved)[:INSIGHTS]]
    film = Film(motion, parts, shot, out.parts_folder) if parts else None
    if film is not None:
        page = with_parts(page, film)
    clearance = current_clearance(out, parts, "view")
    if clearance is not None:
        page["clearance"] = clearance_of(clearance, film)
    return page
