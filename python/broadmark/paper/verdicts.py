"""The judgements of claims as text, Markdown or JSON."""

from __future__ import annotations

import dataclasses
import json
import textwrap
from collections.abc import Callable
from dataclasses import dataclass

from broadmark.paper.claims import TERMS, Judgement
from broadmark.paper.evidence import FIRST, Outcome, PartVerdict
from broadmark.text_tables import markdown_row

MARKS = {
    Outcome.FAILS: "–",
    Outcome.MIXED: "±",
    Outcome.UNDECIDED: "~",
    Outcome.INCOMPARABLE: "≠",
    Outcome.UNMEASURED: "?",
    Outcome.HOLDS: "+",
}
WIDTH = 100


@dataclass(frozen=True)
class Verdicts:
    """The judgements of one machine's results."""

    machine: str
    conditions: list[str]
    judgements: list[Judgement]

    @property
    def summary(self) -> str:
        """The number of claims by verdict."""
        outcomes = [judgement.verdict for judgement in self.judgements]
        kinds = [Outcome.HOLDS, *FIRST[:-1]]
        return ", ".join(f"{kind.value}: {outcomes.count(kind)}" for kind in kinds)


def _lines(parts: list[PartVerdict]) -> list[str]:
    """Failed parts first; subjects with the same figures share a line."""
    subjects: dict[tuple[Outcome, str], list[str]] = {}
    for part in sorted(parts, key=lambda part: FIRST.index(part.outcome)):
        known = subjects.setdefault((part.outcome, part.figures), [])
        known += [name for name in part.subject.split(", ") if name not in known]
    return [
        f"{MARKS[outcome]} {', '.join(names)}"
        f"{':' if outcome == Outcome.UNMEASURED else ''} {figures}"
        for (outcome, figures), names in subjects.items()
    ]


def _marks() -> str:
    return ", ".join(f"{mark} {outcome.value}" for outcome, mark in MARKS.items())


def _as_text(all_verdicts: list[Verdicts]) -> str:
    lines = textwrap.wrap(f"{TERMS} Marks: {_marks()}.", WIDTH)
    for verdicts in all_verdicts:
        lines += ["", "; ".join([verdicts.machine, *verdicts.conditions]), verdicts.summary]
        for judgement in verdicts.judgements:
            head = f"{judgement.number:2}  {judgement.verdict.value:14}  "
            indent = " " * len(head)
            lines += ["", *textwrap.wrap(head + judgement.claim, WIDTH, subsequent_indent=indent)]
            for line in _lines(judgement.parts):
                lines += textwrap.wrap(indent + line, WIDTH, subsequent_indent=indent + "  ")
    return "\n".join(lines) + "\n"


def _as_markdown(all_verdicts: list[Verdicts]) -> str:
    blocks = [f"{TERMS} Marks: {_marks()}."]
    for verdicts in all_verdicts:
        rows = ["| | claim | verdict | figures |", "|---|---|---|---|"]
        for judgement in verdicts.judgements:
            figures = "<br>".join(_lines(judgement.parts))
            cells = [str(judgement.number), judgement.claim, judgement.verdict.value, figures]
            rows.append(markdown_row(cells))
        blocks += [
            f"## {verdicts.machine}",
            "; ".join([*verdicts.conditions, verdicts.summary]),
            "\n".join(rows),
        ]
    return "\n\n".join(blocks) + "\n"


def _as_json(all_verdicts: list[Verdicts]) -> str:
    document = {
        "terms": TERMS,
        "machines": [dataclasses.asdict(verdicts) for verdicts in all_verdicts],
    }
    return json.dumps(document, indent=1, ensure_ascii=False) + "\n"


#: The formats and their functions.
FORMATS: dict[str, Callable[[list[Verdicts]], str]] = {
    "text": _as_text,
    "markdown": _as_markdown,
    "json": _as_json,
}
