"""Draws a plot of results: bars, violins, lines, scaling, memory, phases, pairs.

Only complete cases without wrong answers are shown; the command reports the others. Bars and violins
that do not fit a page are drawn on several, in files named FILE-SCENE.
"""

from __future__ import annotations

import argparse
import sys
from functools import partial

from broadmark import selection
from broadmark.drawing import check_format, draw_pages
from broadmark.files import report_written
from broadmark.plots import KINDS, PAGED
from broadmark.plots.cases import omitted, timed_cases
from broadmark.plots.panels import pages_of


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("kind", choices=list(KINDS), metavar="KIND", help="kind of plot, see below")
    parser.epilog = "kinds:\n" + "\n".join(
        f"  {name:9} {function.__doc__}" for name, function in KINDS.items()
    )
    selection.add_options(parser)
    parser.add_argument(
        "-o",
        "--output",
        required=True,
        metavar="FILE",
        help="the image (.svg, .pdf, .png); '-': standard output, SVG",
    )
    selection.add_case_options(parser)
    parser.add_argument("--log", action="store_true", help="use logarithmic time axes")


def main(options: argparse.Namespace) -> None:
    check_format(options.output)
    machine, results = selection.read_cases(options)
    cases = timed_cases(results, log=options.log, note=machine)
    if reasons := omitted(results.cases):
        print(f"cases without a time are not shown: {reasons}", file=sys.stderr)
    function = KINDS[options.kind]
    pages = pages_of(cases) if options.kind in PAGED else [("", cases)]
    files = draw_pages(options.output, [(name, partial(function, page)) for name, page in pages])
    for file in files:
        report_written(file)
