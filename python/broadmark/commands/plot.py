"""Draws a plot of results: bars, violins, lines, scaling, memory, phases, pairs.

Shown are cases with a time: complete, and every answer right. What is left out is told.
"""

from __future__ import annotations

import argparse
import sys

import pandas as pd

from broadmark import selection
from broadmark.drawing import check_format, draw
from broadmark.errors import InputError
from broadmark.plots import KINDS
from broadmark.plots.cases import chosen


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("kind", choices=list(KINDS), metavar="KIND", help="one of those below")
    parser.epilog = "kinds:\n" + "\n".join(
        f"  {name:9} {function.__doc__}" for name, function in KINDS.items()
    )
    selection.add_options(parser)
    parser.add_argument(
        "-o", "--output", required=True, metavar="FILE", help="the picture (.svg, .pdf, .png)"
    )
    parser.add_argument("--scene", metavar="NAME[,NAME…]", help="of these scenes only")
    parser.add_argument(
        "--algorithm", metavar="ID[,ID…]", help="of these algorithms only; patterns such as 'sap*'"
    )
    parser.add_argument("--objects", metavar="N[,N…]", help="of these numbers of bodies only")
    parser.add_argument("--log", action="store_true", help="logarithmic axes of times")


def main(options: argparse.Namespace) -> None:
    check_format(options.output)
    machine, results = selection.one_machine(selection.read_selected(options))
    results = results.select(_wanted(results.cases, options))
    if not len(results.cases):
        raise InputError(
            "no case is left: no case has all that --scene, --algorithm, --objects ask"
        )
    cases = chosen(results, log=options.log, note=machine)
    missing = results.cases.drop(cases.table.index)
    if len(missing):
        counts = missing["status"].replace("ok", "incomplete").value_counts()
        found = ", ".join(f"{count} {status}" for status, count in counts.items())
        print(f"cases without a time are left out: {found}", file=sys.stderr)
    draw([options.output], lambda: KINDS[options.kind](cases))
    print(f"written: {options.output}")


def _wanted(cases: pd.DataFrame, options: argparse.Namespace) -> pd.Series:
    wanted = pd.Series(True, cases.index)
    for option, column in (
        (options.scene, "scene"),
        (options.algorithm, "algorithm"),
        (options.objects, "objects"),
    ):
        if option is not None:
            wanted &= selection.match_names(cases[column].astype(str), option)
    return wanted
