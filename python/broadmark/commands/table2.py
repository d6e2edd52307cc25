"""Makes the paper's Table 2 from results: seconds per frame, measured and from the paper.

There is a block per scene with a row per algorithm; a second block has the ratios to CGAL's time,
which are comparable between machines. An algorithm is shown up to the first size at which a frame
takes more than 0.5 s. Among several numbers of threads and instruction sets, the case with the most
threads and the widest instruction set is shown. Each machine has its own tables.
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
    parser.add_argument("-o", "--output", metavar="FILE", help="'-', the default: standard output")


def main(options: argparse.Namespace) -> None:
    times = times_by_machine(selection.read_selected(options))
    write_text(options.output, FORMATS[options.format](times))
