"""Random mechanisms in space: open trees, closed loops, loops with redundant joints; springs, drag and weight."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from mbsd.spatial import Mechanism

KINDS = ("revolute", "prismatic", "cylindrical", "universal", "spherical", "planar", "fixed")
FAMILIES = ("open", "closed", "redundant")


def random_mechanism(seed: int, family: str | None = None) -> Mechanism:
    """Return a mechanism that moves; the same one for the same seed."""
    random = np.random.default_rng(seed)
    chosen = family or FAMILIES[int(random.integers(len(FAMILIES)))]
    m = Mechanism(f"{chosen} {seed}", gravity=tuple(random.uniform(-10, 10, 3).tolist()))
    if chosen == "redundant":
        _four_bar(m, random)
    else:
        _tree(m, random, int(random.integers(2, 6)))
        if chosen == "closed":
            _close(m, random)
    _push(m, random)
    names = list(m.bodies)[1:]
    m.start_moving({name: random.uniform(-2, 2, 3) for name in names})
    return m


def _body(m: Mechanism, random: np.random.Generator, name: str, com: np.ndarray) -> Any:
    axes = Rotation.random(rng=random).as_matrix()
    inertia = axes @ np.diag(random.uniform(0.2, 0.35, 3)) @ axes.T
    frame = random.uniform(-1, 1, 3)
    turned = Rotation.random(rng=random)
    return m.body(
        name, random.uniform(0.5, 3.0), com=turned.inv().apply(com - frame), inertia=inertia, at=frame,
        orientation=np.roll(turned.as_quat(), 1),
    )  # fmt: skip


def _tree(m: Mechanism, random: np.random.Generator, count: int) -> None:
    for k in range(count):
        body = _body(m, random, f"body {k}", random.uniform(-1, 1, 3))
        before = m.ground if k == 0 else m.bodies[f"body {random.integers(k)}"]
        at, axis = random.uniform(-1, 1, 3), random.standard_normal(3)
        kind = KINDS[int(random.integers(len(KINDS) - (k == 0)))]
        ends = (before, body) if random.integers(2) else (body, before)
        if kind == "universal":
            other = np.cross(axis, random.standard_normal(3))
            m.universal(f"joint {k}", *ends, at=at, first=axis, second=other)
        elif kind in ("spherical", "fixed"):
            getattr(m, kind)(f"joint {k}", *ends, at=at)
        else:
            getattr(m, kind)(f"joint {k}", *ends, at=at, axis=axis)


def _close(m: Mechanism, random: np.random.Generator) -> None:
    """Add rods, points on planes and balls, as long as two degrees of freedom or more are left for each."""
    names = list(m.bodies)
    for k in range(int(random.integers(1, 4))):
        taken = (1, 1, 3)[k % 3]
        if m.mobility().dof <= taken:
            return
        a, b = random.choice(len(names), 2, replace=False)
        i, j = m.bodies[names[a]], m.bodies[names[b]]
        if k % 3 == 0:
            m.distance(f"rod {k}", i, j, start=random.uniform(-1, 1, 3), end=random.uniform(-1, 1, 3))
        elif k % 3 == 1:
            m.point_on_plane(f"plane {k}", i, j, at=random.uniform(-1, 1, 3), axis=random.standard_normal(3))
        else:
            m.spherical(f"ball {k}", i, j, at=random.uniform(-1, 1, 3))


def _four_bar(m: Mechanism, random: np.random.Generator) -> None:
    """Add a planar four-bar anywhere in space: four hinges, of which three directions repeat others."""
    turned = Rotation.random(rng=random).as_matrix()
    ends = np.array([[0, 0], random.uniform(0.2, 0.5, 2), [1.0, random.uniform(0.4, 0.8)], [1.2, 0]])
    places = [turned @ [x, y, 0.0] for x, y in ends]
    before = m.ground
    for k in range(4):
        after = m.ground if k == 3 else _body(m, random, f"link {k}", random.uniform(-0.5, 0.5, 3))
        m.revolute(f"hinge {k}", before, after, at=places[k], axis=turned[:, 2])
        before = after


def _push(m: Mechanism, random: np.random.Generator) -> None:
    names = list(m.bodies)
    for k in range(int(random.integers(0, 3))):
        a, b = random.choice(len(names), 2, replace=False)
        start, end = random.uniform(-1, 1, 3), random.uniform(1.5, 2.5, 3)
        m.spring(
            f"spring {k}", m.bodies[names[a]], m.bodies[names[b]], start=start, end=end,
            stiffness=random.uniform(1, 50), damping=random.uniform(0, 3), length=random.uniform(0.5, 2),
        )  # fmt: skip
    if random.integers(2):
        m.drag("air", names[-1], damping=random.uniform(0.1, 2.0))
