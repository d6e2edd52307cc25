"""Draws the paper's figures 5, 6 and 7 of results: seconds per frame over numbers of objects.

A figure per scene, with the paper's colours, markers and lines; algorithms that are not in the paper
have a style of their own. Cases are chosen as by `table2`. The files are figure5.svg and so on; with
--log figure5-log.svg.
"""

from __future__ import annotations

import argparse
import functools
import pathlib
import sys

from broadmark import selection
from broadmark.drawing import FORMATS, draw
from broadmark.errors import InputError
from broadmark.paper.algorithms import SCENES
from broadmark.paper.figures import Look, curves, figure
from broadmark.paper.times import times_by_machine


def add_options(parser: argparse.ArgumentParser) -> None:
    selection.add_options(parser)
    parser.add_argument("-o", "--output", required=True, metavar="DIR", help="where to put them")
    parser.add_argument(
        "--format", default="svg", metavar="KIND[,KIND…]", help="svg (default), pdf, png"
    )
    parser.add_argument(
        "--paper", action="store_true", help="the paper's curves, faint, behind ours"
    )
    parser.add_argument(
        "--full-range",
        action="store_true",
        help="to 1,024,000 objects, even if fewer ran (as with --paper)",
    )
    parser.add_argument(
        "--log", action="store_true", help="logarithmic axes: small sizes are legible"
    )


def main(options: argparse.Namespace) -> None:
    _, results = selection.one_machine(selection.read_selected(options))
    (times,) = times_by_machine(results)
    look = Look(options.paper, options.full_range, options.log)
    formats = options.format.split(",")
    for kind in formats:
        if kind not in FORMATS:
            raise InputError(f"--format {kind}: is none of {', '.join(FORMATS)}")
    folder = pathlib.Path(options.output)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"{folder}: cannot be made: {error.strerror}") from None
    for scene in SCENES:
        name = f"figure{scene.figure}" + ("-log" if options.log else "")
        paths = [folder / f"{name}.{kind}" for kind in formats]
        if not curves(times, scene.name):
            print(f"{scene.title}: nothing to draw: no case with a time", file=sys.stderr)
            continue
        draw(paths, functools.partial(figure, times, scene, look))
        for path in paths:
            print(f"written: {path}")
