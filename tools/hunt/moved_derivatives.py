"""Derivatives of a mechanism moved, mirrored, in other units or renamed, beside its own.

Asked for are places and turning of some bodies and the kinetic energy, by places of joints and by masses, of few
outputs. With the turn and mirror R of the world, and lengths and masses L and M times as large,

    dx' / dp' = R dx/dp R^T            p: a place on ground;   on a body: S, which mirrors alone, instead of R^T
    dx' / dm' = L / M R dx/dm          dE' / dp' = M L dE/dp R^T          domega' / dp' = +-1 / L domega/dp R^T

The bound is a part ``STEPS`` of the largest derivative of its kind, and of what the size of the quantity over that of
the number is; of a driven motion over the square of its margin, of a free one it grows as derivatives change where the
motion is nudged.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from mbsd import Mechanism
from mbsd.arrays.curve_branches import CurveBranches
from mbsd.base.errors import MechanismError
from mbsd.model.joint import SPECIALS
from mbsd.model.laws.function import Function
from mbsd.model.mechanism import Start, StartVelocity
from mbsd.numbers.names import known_numbers, number_named, with_values
from mbsd.results.solution import Solution
from tools.hunt.agreement import NUDGE, SLACK
from tools.hunt.outcome import AGREED, REFUSED, UNCLEAR, WRONG, Outcome
from tools.random_mechanisms.described import Pose, seen_from
from tools.random_mechanisms.similar import in_units, mirrored, new_names, renamed, shuffled
from tools.random_mechanisms.subject import attempt

OUTPUTS = 8
PARTS = ("x", "y", "theta", "omega")
BODIES, JOINTS = 2, 2
"""Bodies and joints of which something is asked."""
STEPS = 1e-5
"""Part of the largest derivative that steps of differences may leave."""
LOOSE = 0.03
"""Part of the largest derivative beyond which a bound tells nothing."""
AWAY = 2e-3
"""Part of the size by which a place is moved that must be possible: more than what radii may be rounded by."""
TOLERANCE = 1e-9
DOUBTFUL = "derivatives along this simulation"
"""First words of the warning of derivatives with few digits."""
HEALTHY = 0.02
"""Singularity margin above which nothing gives reason to refuse."""


@dataclass
class Moved:
    """A machine in other words, and what of it is otherwise."""

    m: Mechanism
    turn: np.ndarray
    """(2, 2) which takes directions of the world to the new ones."""
    mirror: np.ndarray
    """(2, 2) the same for those of bodies."""
    length: float = 1.0
    mass: float = 1.0
    names: dict[str, str] | None = None
    """New names by the old ones, if they are others."""

    @property
    def sense(self) -> float:
        """-1 where angles have the other sign."""
        return float(self.mirror[1, 1])

    def name(self, whole: str) -> str:
        """The new name of a thing."""
        return whole if self.names is None else self.names.get(whole, whole)


def moved(m: Mechanism, rng: np.random.Generator, pose: Pose, may_reorder: bool = True) -> Moved:
    """Return the machine in other words of several sorts, each as often as not."""
    c, s = np.cos(-pose[2]), np.sin(-pose[2])
    out = Moved(seen_from(m, {"ground": pose}), np.array([[c, -s], [s, c]]), np.eye(2))
    flip, units, order, names = rng.random(4) < 0.5
    length, mass = 10.0 ** rng.uniform(-2.0, 3.0, 2)
    image = mirrored(out.m) if flip else None
    if image is not None:
        out.m, out.mirror = image, np.diag([1.0, -1.0])
        out.turn = out.mirror @ out.turn
    scaled = in_units(out.m, float(length), float(mass)) if units else None
    if scaled is not None:
        out.m, out.length, out.mass = scaled, float(length), float(mass)
    if order and may_reorder:
        out.m = shuffled(out.m, rng)
    other = renamed(out.m) if names else None
    if other is not None:
        out.m, out.names = other, new_names(out.m)
    return out


@dataclass
class Asked:
    """Request of derivatives, by the names of the first machine."""

    bodies: list[str]
    places: list[tuple[str, bool]]
    """Joints, and whether the marker that is moved stands on ground."""
    masses: list[str]

    def labels(self, quantity: int, number: int) -> tuple[str, str]:
        """Names of one of the quantities and of one of the numbers of the first machine."""
        same = Moved(Mechanism("same"), np.eye(2), np.eye(2))
        return self.names_of_quantities(same)[quantity], self.names_of_numbers(same)[number]

    def names_of_quantities(self, words: Moved) -> list[str]:
        """Names of the quantities."""
        return [f"{words.name(body)}.{part}" for body in self.bodies for part in PARTS] + ["kinetic"]

    def names_of_numbers(self, words: Moved) -> list[str]:
        """Names of the numbers."""
        places = [f"{words.name(joint)}.{axis}" for joint, _ in self.places for axis in "xy"]
        return [*places, *(f"{words.name(body)}.mass" for body in self.masses)]

    def carried_back(self, slopes: np.ndarray, words: Moved) -> np.ndarray:
        """(T, quantities, numbers) of a machine in other words in those of the first."""
        out = slopes.copy()
        for k in range(len(self.bodies)):
            place = slice(4 * k, 4 * k + 2)
            out[:, place] = np.einsum("ij,tip->tjp", words.turn, out[:, place]) / words.length
            out[:, 4 * k + 2 : 4 * k + 4] *= words.sense
        out[:, -1] /= words.mass * words.length**2
        for k, (_, on_ground) in enumerate(self.places):
            axes = words.turn if on_ground else words.mirror
            part = out[:, :, 2 * k : 2 * k + 2]
            out[:, :, 2 * k : 2 * k + 2] = np.einsum("tqi,ij->tqj", part, axes) * words.length
        out[:, :, 2 * len(self.places) :] *= words.mass
        return out

    def kinds(self, first: Solution) -> list[tuple[list[int], list[float], slice, float]]:
        """Quantities of one kind in units of their size, numbers of one kind, and the size of these.

        Angles go with places: an error of an angle is one of the places of all points but one.
        """
        bodies, places, size = range(len(self.bodies)), 2 * len(self.places), first.packed.size
        mass = min((first.mechanism.bodies[name].mass for name in self.masses), default=1.0)
        speed = np.abs(first.v) / [size, size, 1.0]
        rows = (
            ([4 * k + c for k in bodies for c in (0, 1, 2)], [size, size, 1.0] * len(bodies)),
            ([4 * k + 3 for k in bodies], [float(speed.max())] * len(bodies)),
            ([4 * len(self.bodies)], [float(first.energy.kinetic.max())]),
        )
        numbers = (slice(0, places), size), (slice(places, None), mass)
        return [(own, units, column, of) for own, units in rows if all(units) for column, of in numbers]


def rolls(m: Mechanism, joint: str) -> bool:
    """Return True for wheels, whose start angles nothing decides: they are other ones in a world that is turned."""
    return any(name in SPECIALS and SPECIALS[name].phased for name in m.joints[joint].kind.constraints)


def asked_of(m: Mechanism, rng: np.random.Generator) -> Asked | None:
    """Some bodies, places of joints and masses; None where no joint has a place."""
    things = {*m.bodies, *m.traces, *m.drivers, *m.forces, *m.contacts}
    joints = [
        name
        for name in m.joints
        if name not in things and {"x", "y"} <= set(known_numbers(m, name)) and "." not in name and not rolls(m, name)
    ]
    bodies = [name for name in m.bodies if name not in {"ground", *m.joints, *m.traces, *m.drivers, *m.forces}]
    if not joints or not bodies:
        return None
    chosen = rng.permutation(joints)[:JOINTS].tolist()
    markers = [number_named(m, f"{name}.x").marker for name in chosen]
    places = [
        (name, marker.body.name == "ground") for name, marker in zip(chosen, markers, strict=True) if marker is not None
    ]
    some = rng.permutation(bodies)[:BODIES].tolist()
    return Asked(some, places, [name for name in some if m.bodies[name].mass > 0.0]) if places else None


def beside_its_own(
    name: str, m: Mechanism, rng: np.random.Generator, pose: Pose, first: Solution, is_free: bool,
    nudged: Callable[[Mechanism], Mechanism] | None = None,
) -> Outcome:  # fmt: skip
    """Derivatives of the machine in other words beside its own; ``first``: a solution of it."""
    if CurveBranches(first.packed).rows:
        return Outcome(name, UNCLEAR, "points on curves that cross themselves take minutes")
    laws = [driver.motion for driver in m.drivers.values()]
    if any(isinstance(law, Function) for law in [*laws, *(law for f in m.forces.values() for law in f.laws.values())]):
        return Outcome(name, UNCLEAR, "a law known by its values has other digits in other words")
    m = seen_from(m, {})  # inertias do not follow masses there
    asked = asked_of(m, rng)
    if asked is None:
        return Outcome(name, UNCLEAR, "no joint has a place of its own")
    if not _can_be_elsewhere(m, asked, first.packed.size, is_free):
        return Outcome(name, UNCLEAR, "a place is where another thing has it, as the centre of a gear")
    free = first.mobility.dof - len(m.drivers)
    if is_free and _given(m.starts) < free:
        return Outcome(name, UNCLEAR, "less is given than decides the start: it is the nearest to zero, here and there")
    # Of starts that contradict each other once a number changes, those given first hold.
    may_reorder = max(_given(m.starts), _given(m.velocities)) <= free or not is_free
    times, words = np.linspace(first.t[0], first.t[-1], OUTPUTS + 1), moved(m, rng, pose, may_reorder)
    same = Moved(m, np.eye(2), np.eye(2))

    doubts: list[str] = []

    def slopes(words: Moved, m: Mechanism) -> tuple[np.ndarray | None, MechanismError | None]:
        of, to = asked.names_of_quantities(words), asked.names_of_numbers(words)
        with warnings.catch_warnings(record=True) as said:
            warnings.simplefilter("always")
            derived, error = attempt(
                lambda: m.sensitivities(of, to, times=times, simulate=is_free, tolerance=TOLERANCE)
            )
        doubts.extend(str(warning.message) for warning in said if DOUBTFUL in str(warning.message))
        every = None if derived is None else np.stack([derived[label] for label in of], axis=1)
        return (None if every is None else asked.carried_back(every, words)), error

    own, refused = slopes(same, m)
    other, error = slopes(words, words.m)
    margin = float(first.singularity_margin.min())
    if doubts:
        return Outcome(name, UNCLEAR, "said to have few digits", doubts[0])
    if own is None or other is None:
        state = REFUSED if own is other or margin < HEALTHY else WRONG
        return Outcome(name, state, f"refused ({type(refused or error).__name__})", str(refused or error))
    nearby = None if nudged is None else slopes(same, nudged(m))[0]
    if is_free and nearby is None:
        return Outcome(name, UNCLEAR, "a nudged motion has no derivatives")
    return _judged(name, asked, times, (own, other, nearby), asked.kinds(first), margin)


def _given(starts: Mapping[str, Start] | Mapping[str, StartVelocity]) -> int:
    """Return how many coordinates ``starts`` give."""
    return sum(1 if start.place is None else 3 for start in starts.values())


def _can_be_elsewhere(m: Mechanism, asked: Asked, size: float, is_free: bool) -> bool:
    """Return True if the places that are asked for may be others while all else stays."""
    for joint, _ in asked.places:
        for axis in "xy":
            number = number_named(m, f"{joint}.{axis}")
            try:
                other = with_values(m, [number], [number.value + AWAY * size])
                other.simulate(1e-9, 1) if is_free else other.sweep(times=[0.0])
            except MechanismError:
                return False
    return True


def _judged(
    name: str, asked: Asked, times: np.ndarray, derived: tuple[np.ndarray, np.ndarray, np.ndarray | None],
    kinds: list[tuple[list[int], list[float], slice, float]], margin: float,
) -> Outcome:  # fmt: skip
    own, other, nearby = derived
    compared = 0
    for rows, units, column, number in kinds:
        unit = np.array(units)[:, None] / number
        here, there = own[:, rows, column] / unit, other[:, rows, column] / unit
        if not here.size:
            continue
        largest = max(float(np.abs(here).max()), 1.0)
        bound = np.full(len(times), STEPS * largest)
        if nearby is None:
            bound /= margin**2
        else:
            change = np.abs(nearby[:, rows, column] / unit - here).max(axis=(1, 2)) / NUDGE
            bound += SLACK * TOLERANCE * np.maximum.accumulate(change)
        bound[bound > LOOSE * largest] = np.inf
        compared += int(np.isfinite(bound).sum())
        gap = np.abs(there - here).max(axis=(1, 2))
        odd = np.flatnonzero(~(gap <= bound))
        if not len(odd):
            continue
        k = int(odd[np.argmax(gap[odd])])
        r, c = np.unravel_index(int(np.argmax(np.abs(there[k] - here[k]))), there[k].shape)
        of, to = asked.labels(rows[int(r)], range(own.shape[2])[column][int(c)])
        return Outcome(
            name, WRONG, "differs", f"d {of} / d {to} at t = {times[k]:.9g} s is {there[k, r, c]:.9g}, was "
            f"{here[k, r, c]:.9g} in units of their sizes: bound {bound[k]:.3g}, largest {largest:.3g}"
        )  # fmt: skip
    return Outcome(name, AGREED) if compared else Outcome(name, UNCLEAR, "too sensitive")
