"""Pages that compare variants: curves and spectra over each other."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from render.magnitudes import NOISE, energy_floor, force_scale, speed_scale, without_noise
from render.plots.measures import dress_axis, dress_plane
from render.plots.pages.spectra import NOTHING, shown_orders, spectrum
from render.plots.quantities import known_names, quantity
from render.plots.style import QUIET, colour, house_style, page
from shared.contract import Motion
from shared.contract.quantity import labelled

# Pages on which several motions of one mechanism lie over each other, a colour each.

PANELS = 9
"""Number of panels on one page; of more, those in which the motions differ most."""
STILL = 1e-9
"""m or rad: what varies less stands still."""
WIDE = 3.4
"""Width of the first line, of which the others are laid on top: equal motions show both."""
Motions = Mapping[str, Motion]
Panel = tuple[str, str, Callable[[Motion], np.ndarray | None]]
"""Title, unit, and its values over time in a motion."""


def figures(name: str, motions: Motions) -> dict[str, Figure]:
    """Return all pages by name; those with nothing to show are left out."""
    with house_style():
        pages = {
            "bodies": _page(name, motions, "how the bodies move", _body_panels(motions)),
            "drivers": _page(name, motions, "what the drivers give", _driver_panels(motions)),
            "reactions": _page(name, motions, "what the joints carry", _joint_panels(motions)),
            "forces": _page(name, motions, "what the forces do", _force_panels(motions)),
            "energy": _page(name, motions, "energy", _energy_panels()),
            "paths": _paths(name, motions),
        }
    return {plot: figure for plot, figure in pages.items() if figure is not None}


def _page(name: str, motions: Motions, title: str, panels: Sequence[Panel]) -> Figure | None:
    """Return panels in a grid; each has the lines of all motions over time."""
    values = [[read(motion) for motion in motions.values()] for _, _, read in panels]
    shown = [k for k, lines in enumerate(values) if any(line is not None for line in lines)]
    shown = sorted(sorted(shown, key=lambda k: -_spread(values[k]))[:PANELS])
    if not shown:
        return None
    left_out = f"; {len(panels) - len(shown)} more that differ less" if len(panels) > len(shown) else ""
    figure = page(name, title, f"{len(motions)} motions over time{left_out}")
    columns = 1 if len(shown) == 1 else 2 if len(shown) in (2, 4) else 3
    grid = figure.subplots(math.ceil(len(shown) / columns), columns, squeeze=False, sharex=True)
    figure.subplots_adjust(left=0.075, right=0.975, top=0.79, bottom=0.085, wspace=0.24, hspace=0.3)
    for axes, k in zip(grid.ravel(), shown, strict=False):
        text, unit, _ = panels[k]
        axes.set_title(text, fontsize=10, loc="left")
        for number, (line, motion) in enumerate(zip(values[k], motions.values(), strict=True)):
            if line is not None:
                _draw(axes, np.asarray(motion.time), line, number)
        axes.margins(x=0.0)
        dress_axis(axes.yaxis, "", unit)
        axes.set_title(labelled(text, axes.get_ylabel().removeprefix(" / ").strip("()")), fontsize=10, loc="left")
        axes.set_ylabel("")
        axes.tick_params(labelbottom=False)
    used = list(grid.ravel()[: len(shown)])
    for axes in grid.ravel()[len(shown) :]:
        axes.set_visible(False)
    for axes in used[-columns:]:
        dress_axis(axes.xaxis, "time", "s")
        axes.tick_params(labelbottom=True)
    legend(figure, list(motions))
    return figure


def _draw(axes: Axes, time: np.ndarray, line: np.ndarray, number: int) -> None:
    """Draw the first motion wide and pale below the others, so that a line that equals it is seen."""
    first = number == 0
    axes.plot(
        time, line, color=colour(number), linewidth=WIDE if first else 1.5, alpha=0.45 if first else 1.0,
        zorder=2 if first else 3,
    )  # fmt: skip


def legend(figure: Figure, names: list[str]) -> None:
    """Write the names in their colours, in a line below the title."""
    x = 0.035
    for number, name in enumerate(names):
        text = name.replace("_", " ")
        figure.text(x, 0.856, "\N{BLACK SQUARE} ", fontsize=11, color=colour(number), va="center")
        figure.text(x + 0.016, 0.856, text, fontsize=10, color=colour(number), va="center")
        x += 0.034 + 0.0078 * len(text)


def _body_panels(motions: Motions) -> list[Panel]:
    first = next(iter(motions.values()))
    out: list[Panel] = []
    for body in first.bodies:
        moved = {
            field: max(float(np.ptp(getattr(m.bodies[body], field))) for m in motions.values() if body in m.bodies)
            for field in ("x", "y", "theta")
        }
        if moved["theta"] > STILL:
            out.append((f"{body}, angle", "°", _series_of("bodies", body, "theta", np.degrees(1.0))))
            floor = NOISE * max(map(speed_scale, motions.values()))
            out.append((f"{body}, turning", "rad/s", _series_of("bodies", body, "omega", 1.0, floor)))
        elif max(moved["x"], moved["y"]) > STILL:
            field = "x" if moved["x"] >= moved["y"] else "y"
            out.append((f"{body}, {field}", "m", _series_of("bodies", body, field)))
            out.append((f"{body}, speed along {field}", "m/s", _series_of("bodies", body, f"v{field}")))
    return out


def _driver_panels(motions: Motions) -> list[Panel]:
    out: list[Panel] = []
    for name, driver in next(iter(motions.values())).drivers.items():
        unit = driver.effort_unit
        out.append((f"{name}, {'torque' if unit == 'N m' else 'force'}", unit, _series_of("drivers", name, "effort")))
        out.append((f"{name}, power", "W", _series_of("drivers", name, "power")))
    return out


def _joint_panels(motions: Motions) -> list[Panel]:
    weak = NOISE * max(map(force_scale, motions.values()))

    def size_of(name: str) -> Callable[[Motion], np.ndarray | None]:
        def read(motion: Motion) -> np.ndarray | None:
            joint = motion.joints.get(name)
            return None if joint is None else without_noise(np.hypot(joint.fx, joint.fy), weak)

        return read

    return [(f"{name}, reaction", "N", size_of(name)) for name in next(iter(motions.values())).joints]


def _force_panels(motions: Motions) -> list[Panel]:
    """Return their signed size where they have one, else their power."""
    out: list[Panel] = []
    for name, force in next(iter(motions.values())).forces.items():
        if force.effort is not None:
            unit = force.effort_unit
            out.append(
                (f"{name}, {'torque' if unit == 'N m' else 'force'}", unit, _series_of("forces", name, "effort"))
            )
        out.append((f"{name}, power", "W", _series_of("forces", name, "power")))
    for name, contact in next(iter(motions.values())).contacts.items():
        says = "normal force" if contact.effort_unit == "N" else "torque"
        out.append((f"{name}, {says}", contact.effort_unit, _series_of("contacts", name, "normal")))
    return out


def _energy_panels() -> list[Panel]:
    def kinetic(motion: Motion) -> np.ndarray:
        return without_noise(np.asarray(motion.energy.kinetic), energy_floor(motion))

    def gained(motion: Motion) -> np.ndarray:
        potential = np.asarray(motion.energy.potential)
        return without_noise(potential - potential[0], energy_floor(motion))

    return [
        ("kinetic", "J", kinetic),
        ("potential, from its start", "J", gained),
        ("both, potential from its start", "J", lambda motion: kinetic(motion) + gained(motion)),
    ]


def _series_of(
    kind: str, name: str, field: str, scale: float = 1.0, floor: float = 0.0
) -> Callable[[Motion], np.ndarray | None]:
    """Reads one series of every motion that has it."""

    def read(motion: Motion) -> np.ndarray | None:
        entry = getattr(motion, kind).get(name)
        series = None if entry is None else getattr(entry, field)
        return None if series is None else without_noise(scale * np.asarray(series), floor)

    return read


def _spread(lines: Sequence[np.ndarray | None]) -> float:
    """Return how much the motions differ in a panel, as a part of what it shows."""
    known = [line for line in lines if line is not None]
    largest = max((float(np.abs(line).max()) for line in known), default=0.0)
    if len(known) < len(lines):
        return math.inf
    ends = np.array([[line.min(), line.max(), line.mean()] for line in known])
    return float(np.ptp(ends, axis=0).max()) / largest if largest else 0.0


def _paths(name: str, motions: Motions) -> Figure | None:
    """Return the ways of all traced points."""
    if not any(motion.points for motion in motions.values()):
        return None
    figure = page(name, "paths of the traced points", f"{len(motions)} motions; a dot marks the start")
    axes = figure.add_axes((0.075, 0.085, 0.9, 0.72))
    axes.set_aspect("equal", adjustable="datalim")
    axes.margins(0.06)
    for number, motion in enumerate(motions.values()):
        for text, point in motion.points.items():
            x, y = np.asarray(point.x), np.asarray(point.y)
            first = number == 0
            axes.plot(
                x, y, color=colour(number), linewidth=WIDE if first else 1.8, alpha=0.45 if first else 1.0, zorder=2,
            )  # fmt: skip
            axes.plot(x[0], y[0], "o", color="white", markeredgecolor=colour(number), markeredgewidth=2, zorder=4)
            if first:
                axes.annotate(text, (x[0], y[0]), (8, 8), textcoords="offset points", color=QUIET)
    dress_plane(axes)
    legend(figure, list(motions))
    return figure


# The page on which the spectra of several motions of one mechanism stand beside each other, a colour each.

Series = tuple[np.ndarray, np.ndarray]
"""Orders and amplitudes."""


def spectra_figure(name: str, motions: Mapping[str, Motion], asked: Sequence[str]) -> Figure | None:
    """Return a panel for each component asked for; None where no motion has any, or none repeats."""
    panels = _panels(motions, asked)[:PANELS]
    if not panels:
        return None
    with house_style():
        figure = page(name, "amplitudes of the harmonics", f"{len(motions)} motions; orders of the crank or the period")
        columns = 1 if len(panels) == 1 else 2 if len(panels) in (2, 4) else 3
        grid = figure.subplots(math.ceil(len(panels) / columns), columns, squeeze=False)
        figure.subplots_adjust(left=0.075, right=0.975, top=0.79, bottom=0.085, wspace=0.24, hspace=0.34)
        for axes, (title, spectra_of_panel) in zip(grid.ravel(), panels, strict=False):
            axes.set_title(title, fontsize=10, loc="left")
            _stems(axes, spectra_of_panel, len(motions))
        for axes in grid.ravel()[len(panels) :]:
            axes.set_visible(False)
        for axes in list(grid.ravel()[: len(panels)])[-columns:]:
            axes.set_xlabel("order")
        legend(figure, list(motions))
    return figure


def _panels(motions: Mapping[str, Motion], asked: Sequence[str]) -> list[tuple[str, dict[int, Series]]]:
    """Return the title, and the orders and amplitudes of each motion by its number."""
    panels: dict[str, dict[int, Series]] = {}
    for what in asked:
        for number, motion in enumerate(motions.values()):
            if what not in known_names(motion):
                continue
            series = quantity(motion, what)
            spectra = spectrum(motion, series.rows)
            if not spectra.harmonic:
                continue
            last = shown_orders(spectra)
            for column, component in enumerate(series.components):
                part = f" {component}" if component in ("x", "y") else ""
                panel = panels.setdefault(labelled(f"{what}{part}", series.unit), {})
                panel[number] = spectra.at[1 : last + 1], spectra.amplitudes[1 : last + 1, column]
    return [(title, spectra) for title, spectra in panels.items() if any(sizes.any() for _, sizes in spectra.values())]


def _stems(axes: Axes, spectra: dict[int, Series], count: int) -> None:
    """Draw stems of all motions side by side at each order."""
    largest = max(float(sizes.max()) for _, sizes in spectra.values())
    end = max(float(at[-1]) for at, _ in spectra.values())
    for number, (at, sizes) in spectra.items():
        there = sizes > NOTHING * largest
        places = at + (number - (count - 1) / 2) * float(at[0]) * min(0.15, 0.7 / count)
        axes.vlines(places[there], 0.0, sizes[there], color=colour(number), linewidth=2.6)
        axes.plot(places[there], sizes[there], "o", color=colour(number), markersize=4.5)
    axes.set_xlim(0.4, end + 0.6)
    axes.set_ylim(0.0, 1.08 * largest)
    axes.locator_params(axis="x", integer=True, nbins=12)
    axes.locator_params(axis="y", nbins=5)
    axes.grid(visible=False, axis="x")
