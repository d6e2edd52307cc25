"""Pictures that are the same bytes for the same input, and how algorithms look in them.

The colour says the family, the marker the algorithm; the paper's algorithms keep the paper's markers.
No display is needed, and nothing outside is changed: figures are made without pyplot, with settings
that hold only meanwhile.
"""

from __future__ import annotations

import os
import pathlib
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import matplotlib.style
from matplotlib.colors import to_hex, to_rgb
from matplotlib.figure import Figure
from matplotlib.ticker import EngFormatter, FuncFormatter, LogLocator, NullFormatter

from broadmark.errors import InputError
from broadmark.files import whole_file
from broadmark.palette import LIGHT, curves_of, light
from broadmark.paper.algorithms import BY_ID

#: Formats, with what keeps dates and versions out of the files.
FORMATS: dict[str, dict[str, Any]] = {
    "svg": {"Date": None, "Creator": "Broadmark"},
    "pdf": {"CreationDate": None, "Creator": "Broadmark", "Producer": None},
    "png": {"Software": None},
}

SETTINGS = {
    "svg.hashsalt": "broadmark",
    "svg.fonttype": "none",  # text stays text: small files, words that can be searched
    "pdf.fonttype": 42,
    "text.parse_math": False,  # a $ in a name is a $
    "savefig.dpi": 160,
    "font.size": 8,
    "axes.titlesize": 9,
    "axes.linewidth": 0.6,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.axisbelow": True,
    "axes.grid": True,
    "grid.color": light("line"),
    "grid.linewidth": 0.5,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "lines.linewidth": 1.1,
    "lines.markersize": 4.5,
    "legend.frameon": False,
    "legend.fontsize": 7.5,
}


def check_format(path: str | os.PathLike[str]) -> str:
    """The format that a name's ending says; InputError for none of ours."""
    kind = pathlib.PurePath(path).suffix[1:]
    if kind not in FORMATS:
        raise InputError(f"{path}: its name ends with none of .svg, .pdf, .png")
    return kind


def draw(paths: Iterable[str | os.PathLike[str]], picture: Callable[[], Figure]) -> None:
    """Makes a figure and saves it in the format of each name's ending."""
    formats = {path: check_format(path) for path in paths}
    with matplotlib.style.context(["default", SETTINGS]):
        figure = picture()
        for path, kind in formats.items():
            with whole_file(path) as file:
                figure.savefig(file, format=kind, metadata=FORMATS[kind])


@dataclass(frozen=True)
class Style:
    """How an algorithm looks."""

    colour: str
    marker: str
    filled: bool
    line: str

    def of_line(self) -> dict[str, Any]:
        """For Axes.plot."""
        face = self.colour if self.filled else light("page")
        return {"color": self.colour, "linestyle": self.line, **self._of_marker(face)}

    def of_points(self) -> dict[str, Any]:
        """For Axes.plot of points alone."""
        return {**self.of_line(), "linestyle": "none"}

    def _of_marker(self, face: str) -> dict[str, Any]:
        return {
            "marker": self.marker,
            "markerfacecolor": face,
            "markeredgecolor": self.colour,
            "markeredgewidth": 0.9,
        }

    def lighter(self) -> Style:
        """For a parallel variant beside its sequential twin of the same style."""
        return replace(self, colour=to_hex([0.4 + 0.6 * part for part in to_rgb(self.colour)]))


#: Of algorithms that are not in the paper.
OWN_MARKERS = ["P", "X", "*", "h", "<", ">", "8", "H"]


def styles(families: Mapping[str, str]) -> dict[str, Style]:
    """A style for each of these ids of algorithms, of the family beside it. A variant on several
    threads (-mt) looks like that on one, as in the paper."""
    curves = curves_of(families.values())
    own = sorted({_stem(one) for one in families if one not in BY_ID})
    found = {}
    for id_, family in families.items():
        colour = LIGHT["curve"][curves[family]]
        if id_ in BY_ID:
            paper = BY_ID[id_]
            found[id_] = Style(colour, paper.marker, paper.filled, paper.line)
        else:
            marker = OWN_MARKERS[own.index(_stem(id_)) % len(OWN_MARKERS)]
            found[id_] = Style(colour, marker, True, "--" if id_.startswith("gpu-") else "-")
    return found


def _stem(algorithm: str) -> str:
    return algorithm.removesuffix("-mt")


def log_scale(axes: Any, name: str, unit: str = "") -> None:
    """Makes the axis x or y logarithmic, with plain numbers or with a unit and prefix (2 ms, 10 kB)."""
    {"x": axes.set_xscale, "y": axes.set_yscale}[name]("log")
    axis = {"x": axes.xaxis, "y": axes.yaxis}[name]
    axis.set_major_locator(LogLocator(subs=(1,) if unit == "B" else (1, 2, 5)))
    formatter = EngFormatter(unit) if unit else FuncFormatter(lambda value, _: f"{value:g}")
    axis.set_major_formatter(formatter)
    axis.set_minor_formatter(NullFormatter())
