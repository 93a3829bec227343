"""The place where a machine is filmed: ground, background, sky and lights of its look. Sized by what is filmed, turned
with the camera.

Places are (right, away, up) as the camera stands, in radii of the swept motion around its middle. A light's power
grows with the square of its distance, so a mechanism of any size is lit alike.
"""

# pyright: reportAttributeAccessIssue=false
# bpy fills itself in when it is imported, its stubs are empty.
from __future__ import annotations

from typing import Any

from render.blender.scene.world import backdrop, lights, pegboard, sky, vice
from render.blender.scene.world.shapes import Thing
from render.film.framing import studio as studio_axes
from render.film.scene import Point, StudioSpec
from render.looks.look import Light
from shared.contract.mount import Z

BESIDE = 0.35
"""From what the machine reaches to the things beside it, in radii."""


def build(scene: Any, studio: StudioSpec) -> None:
    """Put the look around the mechanism and set the view."""
    look, stands = studio.look, studio.up != Z
    sky.build(scene, look.sky, studio.up)
    light = look.standing if stands else look.lying
    things = [
        backdrop.build(scene, studio, light.bounce),
        *(lights.softbox(scene, studio, box) for box in light.softboxes),
    ]
    if light.sun is not None:
        things += lights.sun(scene, studio, light.sun)
    if studio.wall is not None and (look.wall is None or look.wall.kind == "sweep"):
        things.append(backdrop.wall(scene, studio))
    things += _workshop(scene, studio, light)
    if stands:
        for thing in things:
            thing.matrix_world = to_world(studio.up) @ thing.matrix_basis
    view = scene.view_settings
    view.view_transform = "AgX"
    view.look = look.contrast
    view.exposure = look.exposure


def to_world(up: Point) -> Any:
    """Turns the studio's axes into those of the world (4 x 4)."""
    from mathutils import Matrix

    return Matrix(studio_axes(up).T.tolist()).to_4x4()


def _workshop(scene: Any, studio: StudioSpec, light: Light) -> list[Any]:
    """The things of a bench, where the machine does not reach: a wall with tools and a vice."""
    from mathutils import Matrix, Vector

    look, radius = studio.look, studio.radius
    right, away = studio.reach
    floor = Vector((studio.centre[0], studio.centre[1], studio.floor))
    made = []
    if look.wall is not None and look.wall.kind == "pegboard":
        made.append(Thing(scene, "pegboard", radius, floor, studio.azimuth if studio.wall is None else 0.0))
        behind = away / radius + look.wall.away
        if studio.wall is not None:
            behind = (studio.wall - studio.centre[1]) / radius
        lamps = lights.lamps_seen_from(made[-1].root, studio, light.softboxes)
        pegboard.build(made[-1], look.wall.colour, behind, right / radius, light.bounce, lamps)
    if look.vice and studio.wall is None:
        turn = Matrix.Rotation(studio.azimuth, 4, "Z")
        place = turn @ Vector((-0.62 * right, away + BESIDE * radius, 0.0))
        made.append(Thing(scene, "vice", radius, floor + place, studio.azimuth + 0.5))
        made[-1].seen_only = True
        vice.build(made[-1], lights.lamps_seen_from(made[-1].root, studio, light.softboxes))
    return [thing.root for thing in made]
