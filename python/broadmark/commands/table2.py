"""Makes the paper's Table 2 of results: our seconds per frame beside the paper's.

A row per algorithm, in a block per scene; a second block has the ratios to CGAL's time, which carry
over between machines. An algorithm is shown up to the first size that takes it more than 0.5 s a
frame. Where it ran with several numbers of threads or instruction sets, its time is that with the
most threads and the widest instructions. Each machine has tables of its own.
"""

from __future__ import annotations

import argparse

from broadmark import selection
from broadmark.files import write_text
from broadmark.paper.table2 import FORMATS
from broadmark.paper.times import times_by_machine


def add_options(parser: argparse.ArgumentParser) -> None:
    selection.add_options(parser)
    parser.add_argument("--format", choices=list(FORMATS), default="text", help="default: text")
    parser.add_argument("-o", "--output", metavar="FILE", help="default: standard output")


def main(options: argparse.Namespace) -> None:
    times = times_by_machine(selection.read_selected(options))
    write_text(options.output, FORMATS[options.format](times))
