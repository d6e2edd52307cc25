"""Writes results as a self-contained HTML page with tables, charts and pictures.

The page needs no network, can be filtered and sorted, and compares the results of several machines.
Two files are also compared as before and after, as by `broadmark compare`.
Charts are drawn by d3 (Debian's package node-d3), pictures by the program broadmark.
"""

from __future__ import annotations

import argparse
import os
import sys

from broadmark import selection
from broadmark.files import is_standard_output, report_written
from broadmark.report import write_report


def add_options(parser: argparse.ArgumentParser) -> None:
    selection.add_options(parser)
    parser.add_argument(
        "-o",
        "--output",
        default="report.html",
        metavar="FILE",
        help="'-': standard output (default: %(default)s)",
    )
    parser.add_argument("--title", default="Broadmark results", help="default: %(default)s")
    parser.add_argument(
        "--pictures",
        action=argparse.BooleanOptionalAction,
        default=True,
        help="include pictures of the scenes, drawn by the program (default: if it is found)",
    )
    parser.add_argument(
        "--program-page",
        default=os.environ.get("BROADMARK_PAGE", ""),
        type=_page,
        metavar="URL",
        help="address of the program for browsers (docs/browser.md), to which the cases link "
        "(default: BROADMARK_PAGE)",
    )


def _page(address: str) -> str:
    if not address.startswith(("http://", "https://")) and address:
        raise argparse.ArgumentTypeError(f"'{address}' does not begin with http:// or https://")
    return address


def main(options: argparse.Namespace) -> None:
    results = selection.read_selected(options, may_be_empty=True)
    for note in write_report(
        results,
        options.output,
        title=options.title,
        pictures=options.pictures,
        program_page=options.program_page,
    ):
        print(note, file=sys.stderr if is_standard_output(options.output) else sys.stdout)
    if not is_standard_output(options.output):
        size = os.path.getsize(options.output) / 1e6
        report_written(options.output, f" ({size:.1f} MB, {len(results.cases)} cases)")
