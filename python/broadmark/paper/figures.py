"""The paper's figures 5, 6 and 7: mean seconds per frame over thousands of objects. Each scene has a
figure with two panels: single-threaded algorithms, and multi-threaded and GPU algorithms. The second
panel also shows the fastest single-threaded algorithm.

Linear axes, as in the paper, show where algorithms reach the cap; logarithmic axes show small sizes.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator, NullLocator

from broadmark.drawing import log_scale, style
from broadmark.palette import light
from broadmark.paper.algorithms import (
    BY_ID,
    CAP_SECONDS,
    MAX_SECONDS,
    MAX_THOUSANDS,
    PARALLEL,
    SINGLE,
    Scene,
    table2,
)
from broadmark.paper.times import Measurement, Times

#: The size of the axes, nearly, and the distance between names, in points.
AXES_SIZE = (235, 200)
NAME_DISTANCE = 7

Points = list[tuple[float, float]]  #: thousands of objects, seconds


@dataclass(frozen=True)
class FigureOptions:
    """The options of a figure."""

    paper: bool = False  #: draw the paper's curves behind ours
    full_range: bool = False  #: use the paper's range of objects
    log: bool = False


@dataclass(frozen=True)
class Curve:
    """An algorithm in a scene."""

    algorithm: str
    parallel: bool
    points: Points
    timeout: tuple[float, float] | None  #: the point of a timeout, at the time limit

    @property
    def label(self) -> str:
        """The paper's name, or our id."""
        return BY_ID[self.algorithm].name if self.algorithm in BY_ID else self.algorithm


def curves(times: Times, scene: str) -> list[Curve]:
    """The measured curves: the paper's algorithms in the order of Table 2, then others."""
    found = []
    for algorithm in [*BY_ID, *times.other_algorithms]:
        shown = times.shown(scene, algorithm)
        points = [(n / 1000, p.seconds) for n, p in shown.items() if p.seconds]
        timeout = [
            (n / 1000, measurement.limit)
            for n, measurement in shown.items()
            if _timed_out(measurement)
        ][:1]
        if points or timeout:
            parallel = (
                BY_ID[algorithm].panel == PARALLEL
                if algorithm in BY_ID
                else times.is_parallel(algorithm)
            )
            found.append(Curve(algorithm, parallel, points, timeout[0] if timeout else None))
    return found


def _timed_out(measurement: Measurement) -> bool:
    return measurement.status == "timeout" and measurement.limit <= MAX_SECONDS


def paper_curves(scene: str, log: bool) -> list[Curve]:
    """The paper's curves; on logarithmic axes without times that are rounded to 0.00 or 0.01 s."""
    min_seconds = 0.015 if log else 0
    found = []
    for algorithm in BY_ID.values():
        points = [
            (objects / 1000, seconds)
            for (name, objects, id_), seconds in sorted(table2().items())
            if (name, id_) == (scene, algorithm.id) and seconds >= min_seconds
        ]
        found.append(Curve(algorithm.id, algorithm.panel == PARALLEL, points, None))
    return found


def fastest_single(measured_curves: list[Curve]) -> Curve | None:
    """The single-threaded algorithm with the least time at the largest size within the cap. Ties are
    resolved at the next smaller size, and so on."""
    times_within_cap = {
        curve.algorithm: {n: s for n, s in curve.points if s <= CAP_SECONDS}
        for curve in measured_curves
        if not curve.parallel
    }
    sizes = sorted({n for points in times_within_cap.values() for n in points}, reverse=True)
    if not sizes:
        return None
    best = min(
        times_within_cap, key=lambda a: [times_within_cap[a].get(n, math.inf) for n in sizes]
    )
    return next(curve for curve in measured_curves if curve.algorithm == best)


def figure(times: Times, scene: Scene, options: FigureOptions) -> Figure:
    """Figure 5, 6 or 7."""
    measured_curves = curves(times, scene.name)
    reference_curves = paper_curves(scene.name, options.log) if options.paper else []
    result = Figure(figsize=(9.8, 4.6), layout="constrained")
    result.suptitle(f"{scene.title}: mean time per frame")
    panels = result.subplots(1, 2, sharey=True)
    for axes, panel in zip(panels, (SINGLE, PARALLEL)):
        # Above the names of the paper's curves.
        axes.set_title(panel[0].upper() + panel[1:], loc="left", pad=38 if options.paper else None)
        axes.set_xlabel("thousands of objects")
        for curve in _panel_curves(reference_curves, panel):
            faint = {**style(curve.algorithm).line_properties(), "marker": "", "linewidth": 2.2}
            axes.plot(*zip(*curve.points), **faint, alpha=0.25, zorder=1.5)
        drawn = _panel_curves(measured_curves, panel)
        for curve in drawn:
            _draw(axes, curve)
        if reference_curves:
            axes.plot(
                [],
                [],
                color=light("faint"),
                linewidth=2.2,
                alpha=0.5,
                label="faint: the paper’s curves",
            )
        if any(curve.timeout for curve in drawn):
            axes.plot([], [], "x", color=light("faint"), label="time limit exceeded")
        axes.legend(
            loc="upper center",
            bbox_to_anchor=(0.5, -0.14),
            ncol=4,
            columnspacing=1.2,
            handlelength=2.6,
        )
        _set_axes(axes, measured_curves, options)
        _name_ends(axes, _panel_curves(reference_curves, panel))
    panels[0].set_ylabel("time per frame" if options.log else "seconds per frame")
    notes = [times.machine, *times.conditions]
    result.supxlabel("; ".join(notes), fontsize=6.5, color=light("faint"))
    return result


def _panel_curves(all_curves: list[Curve], panel: str) -> list[Curve]:
    """The curves of a panel. The parallel panel includes the fastest single-threaded algorithm."""
    drawn = [curve for curve in all_curves if curve.parallel == (panel == PARALLEL)]
    best = fastest_single(all_curves) if panel == PARALLEL else None
    return drawn + ([best] if best else [])


def _draw(axes: Any, curve: Curve) -> None:
    own = style(curve.algorithm)
    x, y = zip(*curve.points) if curve.points else ((), ())
    axes.plot(x, y, **own.line_properties(), label=curve.label)
    if curve.timeout:
        last = curve.points[-1:] + [curve.timeout]
        axes.plot(*zip(*last), color=own.colour, linestyle=":", linewidth=0.9)
        axes.plot(*curve.timeout, "x", color=own.colour, markersize=6, zorder=3)


def _name_ends(axes: Any, named: list[Curve]) -> None:
    """Names the paper's curves where they leave the axes: above these, or to the right."""
    above, right = [], []
    for curve in named:
        fractions = [_fraction_of(axes, point) for point in curve.points]
        inside = [point for point in fractions if point[1] <= 1]
        beyond = fractions[len(inside) : len(inside) + 1]
        if inside and beyond:
            (x, y), (next_x, next_y) = inside[-1], beyond[0]
            above.append((x + (next_x - x) * (1 - y) / (next_y - y), curve))
        elif inside:
            right.append((inside[-1][1], curve))
    for ends, size, place in ((above, AXES_SIZE[0], _above), (right, AXES_SIZE[1], _beside)):
        last = -math.inf
        for end, curve in sorted(ends, key=lambda entry: entry[0]):
            last = max(end * size, last + NAME_DISTANCE)  # no name covers another
            colour = style(curve.algorithm).colour
            axes.annotate(curve.label, fontsize=6, color=colour, alpha=0.8, **place(last / size))


def _above(x: float) -> dict[str, Any]:
    at = {"xy": (x, 1.01), "xycoords": "axes fraction"}
    return {**at, "rotation": 60, "rotation_mode": "anchor", "ha": "left", "va": "center"}


def _beside(y: float) -> dict[str, Any]:
    return {"xy": (1.01, y), "xycoords": "axes fraction", "ha": "left", "va": "center"}


def _fraction_of(axes: Any, point: tuple[float, float]) -> tuple[float, float]:
    """A point as a share of the axes."""
    x, y = axes.transLimits.transform(axes.transScale.transform(point))
    return float(x), float(y)


def _set_axes(axes: Any, measured_curves: list[Curve], options: FigureOptions) -> None:
    measured = [
        n for curve in measured_curves for n, _ in [*curve.points, *filter(None, [curve.timeout])]
    ]
    full = options.paper or options.full_range
    max_thousands = max([*measured, MAX_THOUSANDS] if full else measured)
    if options.log:
        log_scale(axes, "x")
        log_scale(axes, "y", "s")
        axes.set_xlim(min(measured) / 1.15, max_thousands * 1.15)
        axes.set_ylim(top=MAX_SECONDS)
        ticks = [2.0**k for k in range(-10, 20) if min(measured) <= 2.0**k <= max_thousands]
        axes.set_xticks(ticks)
        axes.xaxis.set_minor_locator(NullLocator())
        axes.grid(True, which="minor", axis="y", linewidth=0.25)
    else:
        seconds = [
            s
            for curve in measured_curves
            for _, s in [*curve.points, *filter(None, [curve.timeout])]
        ]
        top = MAX_SECONDS if full else min(MAX_SECONDS, max(seconds) * 1.05)
        axes.set(xlim=(0, max_thousands * 1.02), ylim=(0, top))  # room for the last marker
        if max_thousands == MAX_THOUSANDS:
            axes.set_xticks(range(0, MAX_THOUSANDS + 1, 128))
        else:
            axes.xaxis.set_major_locator(MaxNLocator(8))
    if axes.get_ylim()[1] > CAP_SECONDS:
        axes.axhline(CAP_SECONDS, color=light("border"), linewidth=0.7, zorder=1)
