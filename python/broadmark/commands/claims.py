"""Judges the paper's thirteen claims by results: each holds, does not hold, or is not measured.

Each verdict is given with the figures, or with the missing results. Cases are chosen as by `table2`.
Claims about GPUs require results of a GPU.
"""

from __future__ import annotations

import argparse

from broadmark import selection
from broadmark.files import write_text
from broadmark.paper.claims import judge
from broadmark.paper.evidence import Evidence
from broadmark.paper.times import Times
from broadmark.paper.verdicts import FORMATS, Verdicts


def add_options(parser: argparse.ArgumentParser) -> None:
    selection.add_options(parser)
    parser.add_argument("--format", choices=list(FORMATS), default="text", help="default: text")
    parser.add_argument("-o", "--output", metavar="FILE", help="'-', the default: standard output")


def main(options: argparse.Namespace) -> None:
    verdicts = []
    for machine, results in selection.by_machine(selection.read_selected(options)):
        cubes, assorted = (
            Times(machine, results, object_type) for object_type in ("Cubes", "Assorted")
        )
        judgements = judge(Evidence(cubes, assorted))
        verdicts.append(Verdicts(machine, cubes.conditions, judgements))
    write_text(options.output, FORMATS[options.format](verdicts))
