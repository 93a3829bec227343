"""Rods of parts.json: their motion follows from the two bodies that they join."""

from __future__ import annotations

from pathlib import Path

import msgspec
import numpy as np
import pytest

from mbsd import Mechanism
from mechanisms.stages.solve.masses import give_masses
from render.film.film import Film
from render.glb.build import glb
from shared.contract import BodyParts, End, Parts, read_motion, read_parts, write_parts
from shared.contract.geometry import with_rods
from shared.contract.shot import Shot
from shared.shapes.bodies import Bodies
from shared.stage.errors import UserError
from tests.mechanisms.clearance.clearance_pieces import NO_MASS
from tests.render.glb_file import GlbFile
from tests.shared.test_contract import parts_document
from tools.fixtures import film_fixture
from tools.models.motions import four_bar_motion

CRANK, COUPLER, ROCKER = 0.040, 0.120, 0.090


def rod_of(first: End, second: End) -> Parts:
    return parts_document(bodies={"rod": BodyParts(pieces={}, mass=NO_MASS, z=0.02, spans=(first, second))})


B, C = End(body="crank", x=CRANK, y=0.0), End(body="rocker", x=ROCKER, y=0.0)


def test_a_rod_between_crank_and_rocker_moves_as_the_coupler_does() -> None:
    motion = four_bar_motion()
    seen = with_rods(motion, rod_of(B, C))
    rod, coupler = seen.bodies["rod"], motion.bodies["coupler"]
    for field in ("x", "y", "theta", "vx", "vy", "omega", "ax", "ay", "alpha"):
        own, there = np.array(getattr(rod, field)), np.array(getattr(coupler, field))
        assert own == pytest.approx(there, abs=1e-9 * max(1.0, np.abs(there).max())), field
    assert (rod.z, rod.mass) == (0.02, 0.0)
    assert set(motion.bodies) == {"crank", "coupler", "rocker"}


def test_a_rod_turned_round_and_one_to_ground() -> None:
    motion = four_bar_motion()
    turned = with_rods(motion, rod_of(C, B)).bodies["rod"]
    coupler = motion.bodies["coupler"]
    assert np.cos(np.array(turned.theta) - coupler.theta) == pytest.approx(-1.0)
    assert turned.omega == pytest.approx(coupler.omega)
    spoke = with_rods(motion, rod_of(End(body="ground", x=0.0, y=0.0), B)).bodies["rod"]
    assert spoke.theta == pytest.approx(motion.bodies["crank"].theta)
    assert spoke.theta[-1] - spoke.theta[0] == 2 * np.pi  # no seam where the motion repeats
    assert spoke.alpha == pytest.approx(np.zeros(len(motion.time)), abs=1e-9)


def test_a_released_rod_stays_on_its_first_body() -> None:
    motion = four_bar_motion()
    row = len(motion.time) // 3
    joint = msgspec.structs.replace(motion.joints["B"], released=motion.time[row - 1])
    released = msgspec.structs.replace(motion, joints=motion.joints | {"rod": joint})
    held, left = (with_rods(each, rod_of(B, C)).bodies["rod"] for each in (motion, released))
    crank = motion.bodies["crank"]
    assert left.theta[:row] == held.theta[:row]
    turned = np.subtract(left.theta[row:], crank.theta[row:])
    assert turned == pytest.approx(np.full(len(turned), held.theta[row - 1] - crank.theta[row - 1]))
    assert (left.omega[row:], left.alpha[row:]) == (crank.omega[row:], crank.alpha[row:])


def test_rods_that_cannot_be_are_refused() -> None:
    motion = four_bar_motion()
    with pytest.raises(UserError, match=r"the rod 'rod' of parts\.json ends on 'arm', which data.json does not move"):
        with_rods(motion, rod_of(B, End(body="arm", x=0.0, y=0.0)))
    with pytest.raises(UserError, match=r"both ends of the rod 'rod' are on one place at t=0 s"):
        with_rods(motion, rod_of(B, End(body="coupler", x=0.0, y=0.0)))
    parts = rod_of(B, C)
    parts.bodies["coupler"] = parts.bodies.pop("rod")
    with pytest.raises(UserError, match=r"parts\.json has a rod 'coupler', and data.json a body of that name"):
        with_rods(motion, parts)


def test_the_model_has_no_body_for_a_rod() -> None:
    m = Mechanism("rodded")
    m.bar("crank", 0.04)
    parts = rod_of(B, End(body="ground", x=0.1, y=0.0))
    mass = msgspec.structs.replace(NO_MASS, mass=0.3, inertia=1e-4)
    parts.bodies["crank"] = BodyParts(pieces={}, mass=mass, z=0.0)
    parts.bodies["rod"] = msgspec.structs.replace(parts.bodies["rod"], mass=mass)
    sources, sentences = give_masses(m, parts)
    assert sources == {"crank": "parts"}
    assert sentences == ["rods have no mass in the motion, because distance joints have none: rod 300 g"]


def test_bodies_keep_their_rods_when_they_are_joined() -> None:
    made = Bodies()
    made.join_places("rod", ("crank", 40.0, 0.0), ("ground", 0.0, 0.0))
    assert (made | {"x": []}).rods == ({"x": []} | made).rods == made.rods != {}
    with pytest.raises(UserError, match="both ends are"):
        made.join_places("rod", ("crank", 40.0, 0.0), ("crank", 40.0, 0.0))


def test_film_and_glb_show_a_rod_where_its_ends_are(out_root: Path) -> None:
    """The coupler's solids as a rod: all is where the coupler had it."""
    out = film_fixture.write(Shot(seconds_per_turn=0.4))
    motion, parts = read_motion(out.motion), read_parts(out.parts)
    rod = msgspec.structs.replace(parts.bodies["coupler"], spans=(B, C))
    bodies = {name: body for name, body in parts.bodies.items() if name != "coupler"} | {"rod": rod}
    before = GlbFile(glb(Film(motion, parts, Shot(), out.parts_folder)))
    parts = msgspec.structs.replace(parts, bodies=bodies)
    write_parts(out.parts, parts)
    assert read_parts(out.parts) == parts
    film = Film(with_rods(motion, parts), parts, Shot(seconds_per_turn=0.4), out.parts_folder)
    read = GlbFile(glb(film))
    at = film.clock.moment(3)
    for k in (0, 100, 359):
        assert film.poses.body("rod", at) == pytest.approx(film.poses.body("coupler", at))
        assert read.matrices(motion.time[k])["rod"] == pytest.approx(
            before.matrices(motion.time[k])["coupler"], abs=1e-6
        )
