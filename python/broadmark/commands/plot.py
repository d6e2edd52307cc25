"""Draws a plot of results: bars, violins, lines, scaling, memory, phases, pairs.

Only complete cases without wrong answers are shown; the command reports the others.
"""

from __future__ import annotations

import argparse
import sys

from broadmark import selection
from broadmark.drawing import check_format, draw
from broadmark.errors import InputError
from broadmark.files import report_written
from broadmark.plots import KINDS
from broadmark.plots.cases import timed_cases


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
    machine, results = selection.single_machine(selection.read_selected(options))
    results = results.select(selection.match_cases(results.cases, options))
    if not len(results.cases):
        raise InputError("no case is left: no case matches --scene, --algorithm and --objects")
    cases = timed_cases(results, log=options.log, note=machine)
    missing = results.cases.drop(cases.table.index)
    if len(missing):
        counts = missing["status"].replace("ok", "incomplete").value_counts()
        summary = ", ".join(f"{count} {status}" for status, count in counts.items())
        print(f"cases without a time are not shown: {summary}", file=sys.stderr)
    draw([options.output], lambda: KINDS[options.kind](cases))
    report_written(options.output)
