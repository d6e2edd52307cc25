"""Times by frame: lines, stacked phases, and time against pairs. Times are means over repetitions."""

from __future__ import annotations

from typing import Any

import pandas as pd
from matplotlib.figure import Figure

from broadmark.drawing import log_scale
from broadmark.errors import InputError
from broadmark.palette import LIGHT, light
from broadmark.plots.cases import Cases
from broadmark.plots.panels import by_scene, by_scene_and_size
from broadmark.results import PHASES, TRANSFERS

#: The number of points above which a scatter plot is rasterised in SVG and PDF to limit their size.
MAX_VECTOR_POINTS = 20_000


def frames(cases: Cases) -> Figure:
    """time of each frame, with a line per algorithm"""
    styles = cases.styles

    def paint(axes: Any, panel_cases: pd.DataFrame) -> None:
        for number, (case, label) in enumerate(panel_cases["label"].items()):
            means = cases.mean_frames(case)
            spacing = max(1, len(means) // 8)
            style = {**styles[label].line_properties(), "markersize": 3.5, "linewidth": 0.9}
            mark_every = (number * spacing // 5 % spacing, spacing)  # staggered
            axes.plot(
                means["frame"], means["total_ns"] / 1e6, **style, markevery=mark_every, label=label
            )
        _scale_y(axes, cases.log)

    return by_scene_and_size(
        cases, paint, size=(2.8, 2.3), x="frame", y="milliseconds", legend=True
    )


def pairs(cases: Cases) -> Figure:
    """time of each frame against its pairs, for all numbers of bodies"""
    styles = cases.styles
    rasterized = len(cases.table) * cases.table["frames"].max() > MAX_VECTOR_POINTS

    def paint(axes: Any, panel_cases: pd.DataFrame) -> None:
        for case, label in panel_cases["label"].items():
            means = cases.mean_frames(case)
            style = {**styles[label].point_properties(), "markersize": 2.5, "markeredgewidth": 0.6}
            axes.plot(
                means["pairs"], means["total_ns"] / 1e6, **style, label=label, rasterized=rasterized
            )
        _scale_y(axes, cases.log)
        if cases.log:
            log_scale(axes, "x")
        else:
            axes.set_xlim(left=0)

    return by_scene(
        cases, paint, size=(3.6, 3), x="pairs reported in a frame", y="milliseconds", legend=True
    )


def phases(cases: Cases) -> Figure:
    """stacked phases of each frame of a case"""
    if len(cases.table) != 1:
        ids = ", ".join(cases.table["id"].iloc[:3]) + (", …" if len(cases.table) > 3 else "")
        raise InputError(
            f"phases requires a single case, but {len(cases.table)} are left: {ids}: choose with "
            "--scene, --objects, --algorithm or --filter"
        )
    if cases.log:
        raise InputError(
            "phases are stacked, which a logarithmic axis would distort: leave out --log"
        )
    case = cases.table.iloc[0]
    means = cases.mean_frames(case.name)

    def paint(axes: Any, _: pd.DataFrame) -> None:
        axes.stackplot(
            means["frame"],
            [means[f"{phase}_ns"] / 1e6 for phase in PHASES],
            labels=[phase.replace("_", " ") for phase in PHASES],
            colors=LIGHT["phase"],
            linewidth=0,
        )
        transfers = sum(means[f"{phase}_ns"] for phase in TRANSFERS) / 1e6
        if transfers.any():
            label = f"including {' and '.join(TRANSFERS)}"
            axes.plot(means["frame"], transfers, color=light("text"), linewidth=0.8, label=label)
        axes.set(xlim=(means["frame"].min(), means["frame"].max()), ylim=(0, None))
        handles, names = axes.get_legend_handles_labels()
        axes.legend(handles[::-1], names[::-1], loc="center left", bbox_to_anchor=(1.01, 0.5))
        axes.set_title(f"{case['label']}: {case['panel']}, {case['objects']:,} bodies", loc="left")

    return by_scene(cases, paint, size=(6.4, 3), x="frame", y="milliseconds", legend=False)


def _scale_y(axes: Any, log: bool) -> None:
    if log:
        log_scale(axes, "y")
    else:
        axes.set_ylim(bottom=0)
