"""Draws the paper's figures 5, 6 and 7 from results: seconds per frame over numbers of objects.

There is a figure per scene, with the paper's colours, markers and lines; other algorithms have their
own styles. Cases are chosen as by `table2`. The files are figure5.svg and so on; with --log,
figure5-log.svg.
"""

from __future__ import annotations

import argparse
import functools
import pathlib
import sys

from broadmark import selection
from broadmark.drawing import FORMATS, draw
from broadmark.errors import InputError
from broadmark.files import is_standard_output
from broadmark.paper.algorithms import SCENES
from broadmark.paper.figures import FigureOptions, curves, figure
from broadmark.paper.times import times_by_machine


def add_options(parser: argparse.ArgumentParser) -> None:
    selection.add_options(parser)
    parser.add_argument(
        "-o", "--output", required=True, metavar="DIR", help="folder for the figures"
    )
    parser.add_argument(
        "--format", default="svg", metavar="KIND[,KIND…]", help="svg (default), pdf, png"
    )
    parser.add_argument(
        "--paper",
        action="store_true",
        help="draw the paper's curves, faint, behind the measured curves",
    )
    parser.add_argument(
        "--full-range",
        action="store_true",
        help="draw the axis up to 1,024,000 objects, even without results (implied by --paper)",
    )
    parser.add_argument(
        "--log", action="store_true", help="use logarithmic axes, so that small sizes are legible"
    )


def main(options: argparse.Namespace) -> None:
    _, results = selection.single_machine(selection.read_selected(options))
    (times,) = times_by_machine(results)
    figure_options = FigureOptions(options.paper, options.full_range, options.log)
    formats = options.format.split(",")
    for format_ in formats:
        if format_ not in FORMATS:
            raise InputError(f"--format {format_}: expected one of {', '.join(FORMATS)}")
    if is_standard_output(options.output):
        raise InputError("-o -: expected a folder, not standard output")
    folder = pathlib.Path(options.output)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"{folder}: cannot be created: {error.strerror}") from None
    for scene in SCENES:
        name = f"figure{scene.figure}" + ("-log" if options.log else "")
        paths = [folder / f"{name}.{format_}" for format_ in formats]
        if not curves(times, scene.name):
            print(f"{scene.title}: nothing to draw: no case has a time", file=sys.stderr)
            continue
        draw(paths, functools.partial(figure, times, scene, figure_options))
        for path in paths:
            print(f"written: {path}")
