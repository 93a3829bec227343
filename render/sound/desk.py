"""The desk: strikes, tones and noises of all sources, added up to stereo, a stem for each source.

A showing is a ring: its last sample is followed by its first, and what still rings at the end rings on at the start. So
a film that loops has no click, and the sound of a film is that of a showing as often as it is shown.

    strike   an impulse J within a time tau, as half a sine, on a body that rings:  J p(t) * h(t)
    tone     sum w_k a(t) sin(2 pi k phi(t)), each harmonic as far as it is heard
    noise    rms a(t) about a frequency f(t): octaves of one noise, whose powers add up

Left and right are cos and sin of (1 + side) pi / 4, equal power.
"""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Sequence
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from render.sound.ringing import Modes
from render.sound.setting import RATE, Setting
from render.sound.waves import irfft, octave_noise, rfft

Array = NDArray[np.float64]
Spectrum = NDArray[np.complex128]
NARROW = 0.15
"""Strikes that come from sides this near each other are heard from one."""
SOFT = 0.015
"""Seconds over which levels are smoothed: nothing clicks."""
TOGETHER = 2_000_000
"""Samples of strikes that are made at once."""
SHORTEST = 1.5 / RATE
"""Shortest time of a strike (s)."""
LOW, HIGH = (20.0, 28.0), (14_000.0, 16_000.0)
"""Between these a harmonic comes, and goes (Hz)."""
OCTAVES = 125.0 * 2.0 ** np.arange(7)


class Blows(NamedTuple):
    """Strikes, (n,) each: film seconds, impulses (N s), durations (s), sides from which they are heard."""

    film: Array
    impulse: Array
    tau: Array
    side: Array


class Desk:
    """Waves of a showing, by source."""

    def __init__(self, setting: Setting) -> None:
        self.setting = setting
        self.struck: dict[str, list[tuple[str, Blows]]] = defaultdict(list)
        """Strikes by source: the bodies that were struck, and how."""
        self._modes: dict[str, Modes] = {}
        self._waves: dict[str, Array] = {}
        self._powers: dict[str, dict[int, Array]] = defaultdict(dict)

    def strike(self, source: str, body: str, blows: Blows, modes: Modes | None = None) -> None:
        """Strike a body, or what else rings with these ``modes`` under that name."""
        modes = modes or self.setting.modes(body)
        if modes is not None and len(blows.film):
            self._modes[body] = modes
            self.struck[source].append((body, blows))

    def tone(self, source: str, phase: Array, level: Array, weights: Sequence[float], side: Array) -> None:
        """A tone of ``level`` (M + 1,) Pa, with weights of its harmonics.

        Its phase (M + 1,) counts cycles, and closes as the film does.
        """
        speed = np.abs(np.gradient(phase, self.setting.at))
        level = level * self.setting.fade
        heard = {k: weight * level * _audible(k * speed) for k, weight in enumerate(weights, 1)}
        heard = {k: row for k, row in heard.items() if row.any()}
        if not heard:
            return
        turn, mono = np.exp(2j * np.pi * self._fine(phase)), np.zeros(self.setting.samples)
        power = np.ones_like(turn)
        for k in range(1, max(heard) + 1):
            power *= turn
            if k in heard:
                mono += self._fine(self._soft(heard[k])) * np.imag(power)
        wave = self._waves.setdefault(source, np.zeros((2, len(mono))))
        for channel, gain in zip(wave, _gains(side), strict=True):
            channel += mono * self._fine(gain)

    def noise(self, source: str, level: Array, centre: Array, side: Array) -> None:
        """Add noise of rms ``level`` (M + 1,) Pa about ``centre`` (M + 1,) Hz."""
        at = np.clip(np.log2(np.maximum(centre, 1.0) / OCTAVES[0]), 0, len(OCTAVES) - 1)
        power = (level * _gains(side)) ** 2
        for k in range(len(OCTAVES)):
            share = np.clip(1 - np.abs(at - k), 0, 1)
            if (share * level).any():
                rows = self._powers[source].setdefault(k, np.zeros_like(power))
                rows += power * share

    def stems(self) -> dict[str, Spectrum]:
        """Return (2, N // 2 + 1) the spectrum of what each source is heard as (Pa)."""
        bank: dict[int, Array] = {}
        for source, rows in self._powers.items():
            wave = self._waves.setdefault(source, np.zeros((2, self.setting.samples)))
            for k, power in rows.items():
                bank[k] = bank[k] if k in bank else self._octave(k)
                for channel, row in zip(wave, power, strict=True):
                    channel += self._fine(self._soft(np.sqrt(row))) * bank[k]
        stems = {source: rfft(wave) for source, wave in self._waves.items()}
        responses: dict[str, Spectrum] = {}
        for source, struck in self.struck.items():
            for body in dict.fromkeys(body for body, _ in struck):
                if body not in responses:
                    responses[body] = rfft(self._modes[body].response(self.setting.samples, RATE))
                rung = self._blows([blows for name, blows in struck if name == body]) * responses[body]
                stems[source] = stems[source] + rung if source in stems else rung
        return stems

    def _octave(self, k: int) -> Array:
        return octave_noise(self.setting.samples, float(OCTAVES[k]), self.setting.streams + k)

    def _blows(self, blows: Sequence[Blows]) -> Spectrum:
        """Return the spectrum (2, N // 2 + 1) of all strikes of a body.

        Strikes that come from one place are summed first.
        """
        film, impulse, tau, side = (np.concatenate(row) for row in zip(*blows, strict=True))
        gains = _gains(side)
        if np.ptp(side) < NARROW:
            return np.outer(gains.mean(axis=1), rfft(self._pulses(film, impulse, tau)))
        return np.stack([rfft(self._pulses(film, gain * impulse, tau)) for gain in gains])

    def _pulses(self, film: Array, impulse: Array, tau: Array) -> Array:
        """Return (N,) half sines of these areas; those that last about as long are made together."""
        count = self.setting.samples
        wave, place = np.zeros(count), film / self.setting.seconds * count
        width = np.maximum(tau, SHORTEST) * RATE
        order, at = np.argsort(width, kind="stable"), 0
        while at < len(order):
            long = math.ceil(2 * float(width[order[at]])) + 2
            rows = order[at : at + max(1, TOGETHER // long)]
            rows = rows[width[rows] <= long - 2]
            first = np.floor(place[rows]).astype(int)
            inside = (np.arange(long) - (place[rows] - first)[:, None]) / width[rows][:, None]
            pulse = np.where((inside > 0) & (inside < 1), np.sin(np.pi * np.clip(inside, 0, 1)), 0.0)
            pulse *= (impulse[rows] / pulse.sum(axis=1))[:, None]
            where = (first[:, None] + np.arange(long)) % count
            wave += np.bincount(where.ravel(), pulse.ravel(), minlength=count)
            at += len(rows)
        return wave

    def _fine(self, values: Array) -> Array:
        """Return (N,) of (M + 1,), straight in between."""
        first, part = self._between
        return values[first] + part * np.diff(values)[first]

    @cached_property
    def _between(self) -> tuple[NDArray[np.intp], Array]:
        """(N,) after which of the values (M + 1,) each sample is, and the part of the way to the next."""
        count = self.setting.samples
        first, rest = np.divmod(np.arange(count) * self.setting.steps, count)
        return first, rest / count

    def _soft(self, level: Array) -> Array:
        """Return the smoothed round the ring."""
        width = max(3, round(SOFT * self.setting.steps / self.setting.seconds))
        bell = np.hanning(width + 2)[1:-1]
        ring, full = level[:-1], np.zeros(len(level) - 1)
        np.add.at(full, (np.arange(width) - width // 2) % len(ring), bell / bell.sum())
        smooth = np.maximum(irfft(rfft(ring) * rfft(full), len(ring)), 0.0)
        return np.append(smooth, smooth[0])


def _audible(frequency: Array) -> Array:
    """Return (n,) how much of a harmonic at these frequencies (Hz) is heard, 0 .. 1."""
    (low, begun), (going, gone) = LOW, HIGH
    return np.clip((frequency - low) / (begun - low), 0, 1) * np.clip((gone - frequency) / (gone - going), 0, 1)


def _gains(side: Array) -> Array:
    """Return (2, n) of left and right."""
    angle = (1 + side) * np.pi / 4
    return np.stack([np.cos(angle), np.sin(angle)])
