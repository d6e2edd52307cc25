"""Reproducible figures, and the styles of algorithms in them. The same input gives the same bytes.

Colour and marker show the algorithm, as assets/palette.txt states them. Figures are made without
pyplot and within a style context, so no display is needed and no global setting changes.
"""

from __future__ import annotations

import os
import pathlib
import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import matplotlib.style
from matplotlib.backends.backend_pdf import PdfPages
from matplotlib.colors import to_hex, to_rgb
from matplotlib.figure import Figure
from matplotlib.ticker import EngFormatter, FuncFormatter, LogLocator, NullFormatter

from broadmark.errors import InputError
from broadmark.files import atomic_write, is_standard_output
from broadmark.palette import LIGHT, light, look_of

#: Formats with the metadata that keeps dates and versions out of the files.
FORMATS: dict[str, dict[str, Any]] = {
    "svg": {"Date": None, "Creator": "Broadmark"},
    "pdf": {"CreationDate": None, "Creator": "Broadmark", "Producer": None},
    "png": {"Software": None},
}

SETTINGS = {
    "svg.hashsalt": "broadmark",
    "svg.fonttype": "none",  # text instead of paths: small, searchable files
    "pdf.fonttype": 42,
    "text.parse_math": False,  # names may contain $
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
    """The format of a file name's extension, SVG for standard output. Raises InputError for an unknown
    extension."""
    if is_standard_output(path):
        return "svg"
    kind = pathlib.PurePath(path).suffix[1:]
    if kind not in FORMATS:
        raise InputError(f"{path}: the extension must be .svg, .pdf or .png")
    return kind


def draw(paths: Iterable[str | os.PathLike[str]], picture: Callable[[], Figure]) -> None:
    """Makes a figure and saves it in each path's format."""
    formats = {path: check_format(path) for path in paths}
    with matplotlib.style.context(["default", SETTINGS]):
        figure = picture()
        for path, kind in formats.items():
            with atomic_write(path) as file:
                figure.savefig(file, format=kind, metadata=FORMATS[kind])


def draw_pages(
    path: str | os.PathLike[str], pages: Sequence[tuple[str, Callable[[], Figure]]]
) -> list[pathlib.Path]:
    """Draws several figures, each with a name: as pages of a PDF, or in files of their own, named
    PATH-NAME.svg, if there are several. Returns the files."""
    path = pathlib.Path(path)
    if check_format(path) == "pdf":
        with (
            matplotlib.style.context(["default", SETTINGS]),
            atomic_write(path) as file,
            PdfPages(file, metadata=FORMATS["pdf"]) as document,
        ):
            for _, picture in pages:
                document.savefig(picture())
        return [path]
    paths = [path]
    if len(pages) > 1:
        if is_standard_output(path):
            raise InputError(
                f"-o -: standard output takes one page, not {len(pages)}: name a file (a .pdf has all), "
                "or choose with --scene, --objects or --filter"
            )
        names = [re.sub(r"[^\w.+-]+", "-", name).strip("-") for name, _ in pages]
        names = [
            name if names.count(name) == 1 else f"{name}-{i}" for i, name in enumerate(names, 1)
        ]
        paths = [path.with_name(f"{path.stem}-{name}{path.suffix}") for name in names]
    for file_path, (_, picture) in zip(paths, pages):
        draw([file_path], picture)
    return paths


@dataclass(frozen=True)
class Style:
    """The style of an algorithm in figures."""

    colour: str
    marker: str
    filled: bool
    line: str

    def line_properties(self) -> dict[str, Any]:
        """Arguments of Axes.plot for a line with markers."""
        face = self.colour if self.filled else light("page")
        return {"color": self.colour, "linestyle": self.line, **self._marker_properties(face)}

    def point_properties(self) -> dict[str, Any]:
        """Arguments of Axes.plot for markers without a line."""
        return {**self.line_properties(), "linestyle": "none"}

    def _marker_properties(self, face: str) -> dict[str, Any]:
        return {
            "marker": self.marker,
            "markerfacecolor": face,
            "markeredgecolor": self.colour,
            "markeredgewidth": 0.9,
        }

    def lighter(self) -> Style:
        """The style of a parallel variant beside its sequential counterpart."""
        return replace(
            self, colour=to_hex([0.4 + 0.6 * channel for channel in to_rgb(self.colour)])
        )


#: The markers, by the index of a symbol (palette.SYMBOLS).
MARKERS = ["o", "s", "^", "D", "*", "P"]


def style(algorithm: str) -> Style:
    """The style of an algorithm, the same in every figure: filled markers for the multi-threaded variant
    (-mt), dashes on a device."""
    curve, symbol = look_of(algorithm)
    line = "--" if algorithm.startswith(("gpu-", "b3-")) else "-"
    return Style(LIGHT["curve"][curve], MARKERS[symbol], algorithm.endswith("-mt"), line)


def plain_numbers() -> FuncFormatter:
    """Ticks without a unit: 0.5, 2000, 10k, 5M."""
    engineering = EngFormatter(sep="")
    return FuncFormatter(lambda value, _: engineering(value) if abs(value) >= 1e4 else f"{value:g}")


def log_scale(axes: Any, name: str, unit: str = "") -> None:
    """Makes the axis x or y logarithmic; with a unit, ticks have SI prefixes (2 ms, 10 kB)."""
    {"x": axes.set_xscale, "y": axes.set_yscale}[name]("log")
    axis = {"x": axes.xaxis, "y": axes.yaxis}[name]
    axis.set_major_locator(LogLocator(subs=(1,) if unit == "B" else (1, 2, 5)))
    axis.set_major_formatter(EngFormatter(unit) if unit else plain_numbers())
    axis.set_minor_formatter(NullFormatter())
