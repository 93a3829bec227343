"""Checks what ``parts()`` returned before anything is made of it."""

from __future__ import annotations

import re
from typing import Any

from shared.contract.materials import MATERIALS
from shared.shapes.bodies import Bodies
from shared.shapes.solid import Solid
from shared.stage.errors import UserError
from shared.stage.suggestions import did_you_mean

NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*")


def refuse_unfit(name: str, bodies: Any) -> None:
    """Raise UserError unless ``bodies`` is a dict of lists of Solid by body with fit names and known materials."""
    if not isinstance(bodies, dict) or not bodies:
        raise UserError(f"{name}: parts() must return a dict of lists of Solid by body, not {type(bodies).__name__}")
    known: dict[str, str] = {}
    for body, solids in bodies.items():
        if not solids or not all(isinstance(solid, Solid) for solid in solids):
            raise UserError(
                f"{name}: parts()['{body}'] must be a list of one Solid or more; "
                "Bodies.leave_out (shared/shapes/bodies.py) names a body without any"
            )
        for solid in solids:
            if not NAME.fullmatch(solid.name):
                raise UserError(f"{name}: {body}: a solid is called '{solid.name}'; use letters, digits and _")
            if solid.name in known:
                raise UserError(
                    f"{name}: {known[solid.name]} and {body} both have a solid '{solid.name}'; "
                    "files are named after solids, so give one of them another name"
                )
            if solid.material not in MATERIALS:
                raise UserError(
                    f"{name}: {body}: {solid.name} is of '{solid.material}'; there is {', '.join(MATERIALS)}"
                    f"{did_you_mean(solid.material, MATERIALS)}"
                )
            known[solid.name] = body
    if isinstance(bodies, Bodies):
        _refuse_unknown(name, bodies)
        _refuse_unknown_pieces(name, bodies, known)


def _refuse_unknown(name: str, bodies: Bodies) -> None:
    """Pairs that touch have solids, bodies that are left out have none."""
    for body in sorted(bodies.left_out & bodies.keys()):
        raise UserError(f"{name}: parts() has solids of '{body}' and leaves it out; do one of the two")
    for pair in sorted(bodies.touching):
        for body in pair:
            if body not in bodies:
                raise UserError(
                    f"{name}: may_touch{pair} names '{body}', which has no solids; there is: {', '.join(bodies)}"
                    f"{did_you_mean(body, bodies)}"
                )
    for rod in sorted(bodies.rods):
        if rod not in bodies:
            raise UserError(
                f"{name}: join_places names '{rod}', which has no solids; there is: {', '.join(bodies)}"
                f"{did_you_mean(rod, bodies)}"
            )


def _refuse_unknown_pieces(name: str, bodies: Bodies, home: dict[str, str]) -> None:
    """Pairs of solids that touch are there, and are of two bodies; ``home`` is the body of each solid."""
    for pair in sorted(bodies.pieces_touching):
        for solid in pair:
            if solid not in home:
                raise UserError(
                    f"{name}: pieces_may_touch{pair} names '{solid}', which is no solid; there is: "
                    f"{', '.join(home)}{did_you_mean(solid, home)}"
                )
        if home[pair[0]] == home[pair[1]]:
            raise UserError(
                f"{name}: pieces_may_touch{pair} names two solids of '{home[pair[0]]}', which are not compared anyway; "
                "name solids of two bodies"
            )
