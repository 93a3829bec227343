"""Steps in independent coordinates that end where the pin of a Geneva enters or leaves its slot.

The wheel's acceleration jumps there. In reference coordinates what a step across the jump gets wrong is an impulse of
the joint, which the projection takes off again; in independent ones it is the speed of the crank, so that each index
would change the energy by about the tolerance. So a step ends right before the jump, and the next one begins right
after it with new derivatives, as at jumps of laws (prepare/stops.py).

    x - r = 0      x: the wheel's centre along the crank's axis, r: radius of the pin
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from mbsd.arrays.packing import Packed
from mbsd.compiling.jit import Often
from mbsd.dynamics.embedding.equations import write_alone
from mbsd.dynamics.runs.bounds import MOST, MOST_UNSEEN, NEAR, ROUNDING, SHORT, SIDE
from mbsd.dynamics.state import (
    ACCEPTED,
    ERROR,
    NEXT,
    PAUSED,
    REACHED,
    STARTED,
    STEP,
    TIME,
    WORK,
    State,
    copied,
    output_for,
)


def memory(arrays: Any, scratch: Any) -> tuple[np.ndarray, ...]:
    """What the next poses of a run in independent coordinates are predicted from."""
    return arrays.number, scratch.base, scratch.coordinate, scratch.block_work, scratch.body, scratch.watch


class Genevas:
    """The Genevas of a packed mechanism."""

    def __init__(self, packed: Packed) -> None:
        specials, system = packed.specials, packed.system
        self.rows = [
            (
                *(int(system.marker_body[marker]) for marker in place[:2]),
                *system.marker_arm[place[0]].tolist(),
                *system.marker_axis[place[0]].tolist(),
                *system.marker_arm[place[1]].tolist(),
                float(joint.params["radius"]),
            )
            for name, joint, place in zip(specials.names, specials.joints, specials.places, strict=True)
            if name == "geneva"
        ]
        """Bodies of crank and wheel, the crank's marker and its x axis, the wheel's marker, radius of the pin (m)."""
        self._write = Often(write_alone)
        self._here = output_for(np.zeros(1), len(packed.body_names) * 3, 0)

    def __bool__(self) -> bool:
        return bool(self.rows)

    def through(self, advance: Callable[..., int], arrays: Any, scratch: Any, state: State, *rest: Any) -> int:
        """``advance`` of an Integrator in independent coordinates (arrays: Embedding), from jump to jump."""
        out, settings, end, steps = rest
        gaps, wait = self._look(arrays, scratch, state)
        while True:
            step = float(state.clock[STEP]) or settings.longest
            now, before = float(state.clock[TIME]), _Point(arrays, scratch, state)
            if wait < min(NEAR * step, end - now):
                status = self._meet(advance, arrays, scratch, state, out, settings, gaps, wait, math.inf)
                gaps, wait = self._look(arrays, scratch, state)
            else:
                ahead = int(min(max(wait / (4.0 * step), 1.0), MOST_UNSEEN))
                status = advance(arrays, scratch, state, out, settings, end, min(ahead, steps))
                there, after = self._look(arrays, scratch, state)
                if not self._crossed(gaps, there):
                    gaps, wait = self._sides(gaps, there), after
                else:
                    late = float(state.clock[TIME])
                    before.restore(arrays, scratch, state)
                    status = self._meet(advance, arrays, scratch, state, out, settings, gaps, wait, late)
                    gaps, wait = self._look(arrays, scratch, state)
            if status == PAUSED and state.clock[TIME] == now:  # it cannot be met: a step goes over it
                status = advance(arrays, scratch, state, out, settings, end, 1)
                gaps, wait = self._look(arrays, scratch, state)
            if state.count[STARTED] == 0:
                state.clock[STEP], state.clock[ERROR] = step, 0.0
            steps -= int(state.count[ACCEPTED]) - before.accepted
            if status not in (REACHED, PAUSED):
                return status
            if state.clock[TIME] >= end:
                self._finish(arrays, scratch, state, out)
                return REACHED
            if steps <= 0:
                return PAUSED

    def _finish(self, arrays: Any, scratch: Any, state: State, out: Any) -> None:
        """Write outputs that the hop over a jump left behind, as at the end: no step is there to do it."""
        k = int(state.count[NEXT])
        while k < len(out.t) and out.t[k] <= state.clock[TIME]:
            self._write(arrays, scratch, float(state.clock[TIME]), state.y, scratch.stages[0], out, k)
            out.work[k] = state.clock[WORK]
            k += 1
        state.count[NEXT] = k

    def _look(self, arrays: Any, scratch: Any, state: State) -> tuple[list[float], float]:
        """x - r of each (m), and the time until the first is zero if they go on as they go (s)."""
        here, gaps, wait = self._here, [], math.inf
        self._write(arrays, scratch, float(state.clock[TIME]), state.y.copy(), np.zeros_like(state.y), here, 0)
        q, v = here.y[0].tolist()
        for i, j, arm_x, arm_y, axis_x, axis_y, to_x, to_y, radius in self.rows:
            c, s = math.cos(q[3 * i + 2]), math.sin(q[3 * i + 2])
            d, e = math.cos(q[3 * j + 2]), math.sin(q[3 * j + 2])
            ux, uy = c * axis_x - s * axis_y, s * axis_x + c * axis_y
            ax, ay = c * arm_x - s * arm_y, s * arm_x + c * arm_y
            bx, by = d * to_x - e * to_y, e * to_x + d * to_y
            dx, dy = q[3 * j] + bx - q[3 * i] - ax, q[3 * j + 1] + by - q[3 * i + 1] - ay
            turn, other = v[3 * i + 2], v[3 * j + 2]
            vx = v[3 * j] - other * by - v[3 * i] + turn * ay
            vy = v[3 * j + 1] + other * bx - v[3 * i + 1] - turn * ax
            gap, rate = ux * dx + uy * dy - radius, ux * vx + uy * vy + turn * (ux * dy - uy * dx)
            gaps.append(gap)
            if gap * rate < 0.0:
                wait = min(wait, -gap / rate)
        return gaps, wait

    def _crossed(self, before: list[float], after: list[float]) -> bool:
        """Whether a jump lies between them."""
        return any(a * b < 0.0 for a, b in zip(before, after, strict=True))

    def _sides(self, before: list[float], after: list[float]) -> list[float]:
        """``after``, where a gap of exactly zero counts to the side it came from: the jump is still ahead."""
        return [b or math.copysign(SIDE, a) if a else b for a, b in zip(before, after, strict=True)]

    def _meet(
        self,
        advance: Callable[..., int],
        arrays: Any,
        scratch: Any,
        state: State,
        out: Any,
        settings: Any,
        gaps: list[float],
        wait: float,
        late: float,
    ) -> int:
        """Go on to right after the next jump, which is before ``late`` (s); if it moves away, only towards it.

        ``gaps`` and ``wait`` are what ``_look`` says of the state.
        """
        nears = wait < math.inf
        for _ in range(MOST):
            now = float(state.clock[TIME])
            least = ROUNDING * math.ulp(now)
            if wait * SHORT <= least or late - now <= 4 * least:
                break
            if wait == late == math.inf:
                return PAUSED
            target = now + wait * (1.0 - SHORT)
            if not target < late - least:
                target = now + 0.5 * (late - now)
            before = _Point(arrays, scratch, state)
            status = advance(arrays, scratch, state, out, settings, target, MOST)
            if status not in (REACHED, PAUSED):
                return status
            there, after = self._look(arrays, scratch, state)
            if self._crossed(gaps, there):
                late = float(state.clock[TIME])
                before.restore(arrays, scratch, state)
                share = 0.5  # it may have left one jump and come to the next
                if nears:
                    share = min(a / (a - b) for a, b in zip(gaps, there, strict=True) if a * b < 0.0)  # secant
                wait = share * (late - float(state.clock[TIME]))
            elif 0.0 in there:
                wait = 0.0
                break
            else:
                gaps, wait, nears = there, after, after < math.inf
        else:
            return PAUSED
        hop = min(wait, late - float(state.clock[TIME])) + ROUNDING * math.ulp(float(state.clock[TIME]))
        before = _Point(arrays, scratch, state)
        while True:  # rates are those before the jump, over a time that does not matter
            if hop > SHORT * settings.longest:
                before.restore(arrays, scratch, state)
                return PAUSED
            state.clock[TIME] += hop
            state.y[0] += hop * state.y[1]
            if self._crossed(gaps, self._look(arrays, scratch, state)[0]):
                break
            hop *= 2.0  # the angles may round to what they were
        state.count[STARTED] = 0
        return PAUSED


class _Point:
    """Where a run in independent coordinates stands, with what it predicts from, to return to."""

    def __init__(self, arrays: Any, scratch: Any, state: State) -> None:
        self._state = copied(state)
        self._kept = [part.copy() for part in memory(arrays, scratch)]
        self.accepted = int(state.count[ACCEPTED])

    def restore(self, arrays: Any, scratch: Any, state: State) -> None:
        """Stand there again."""
        for part, kept in zip(state, self._state, strict=True):
            part[...] = kept
        for part, kept in zip(memory(arrays, scratch), self._kept, strict=True):
            part[...] = kept
