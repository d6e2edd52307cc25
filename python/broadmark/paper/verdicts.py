"""The judgements of claims as text, Markdown or JSON."""

from __future__ import annotations

import dataclasses
import json
import textwrap
from collections.abc import Callable
from dataclasses import dataclass

from broadmark.paper.claims import FAILS, HOLDS, TERMS, UNKNOWN, Judgement
from broadmark.paper.evidence import Part

MARKS = {True: "+", False: "–", None: "?"}
WIDTH = 100


@dataclass(frozen=True)
class Verdicts:
    """The judgements of one machine's results."""

    machine: str
    conditions: list[str]
    judgements: list[Judgement]

    @property
    def summary(self) -> str:
        """How many of each."""
        found = [judgement.verdict for judgement in self.judgements]
        return ", ".join(f"{one}: {found.count(one)}" for one in (HOLDS, FAILS, UNKNOWN))


def _lines(parts: list[Part]) -> list[str]:
    """What decided first; subjects of which the same is to be said in one line."""
    subjects: dict[tuple[bool | None, str], list[str]] = {}
    for part in sorted(parts, key=lambda part: [False, None, True].index(part.holds)):
        known = subjects.setdefault((part.holds, part.figures), [])
        known += [name for name in part.subject.split(", ") if name not in known]
    return [
        f"{MARKS[holds]} {', '.join(names)}{': ' if holds is None else ' '}{figures}"
        for (holds, figures), names in subjects.items()
    ]


def _as_text(all_verdicts: list[Verdicts]) -> str:
    lines = textwrap.wrap(TERMS + " Marks: + as claimed, – not so, ? not measured.", WIDTH)
    for one in all_verdicts:
        lines += ["", "; ".join([one.machine, *one.conditions]), one.summary]
        for judgement in one.judgements:
            head = f"{judgement.number:2}  {judgement.verdict:13}  "
            indent = " " * len(head)
            lines += ["", *textwrap.wrap(head + judgement.claim, WIDTH, subsequent_indent=indent)]
            for line in _lines(judgement.parts):
                lines += textwrap.wrap(indent + line, WIDTH, subsequent_indent=indent + "  ")
    return "\n".join(lines) + "\n"


def _as_markdown(all_verdicts: list[Verdicts]) -> str:
    blocks = [TERMS]
    for one in all_verdicts:
        rows = ["| | claim | verdict | figures |", "|---|---|---|---|"]
        for judgement in one.judgements:
            figures = "<br>".join(_lines(judgement.parts))
            cells = [str(judgement.number), judgement.claim, judgement.verdict, figures]
            rows.append("| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |")
        blocks += [f"## {one.machine}", "; ".join([*one.conditions, one.summary]), "\n".join(rows)]
    return "\n\n".join(blocks) + "\n"


def _as_json(all_verdicts: list[Verdicts]) -> str:
    document = {"terms": TERMS, "machines": [dataclasses.asdict(one) for one in all_verdicts]}
    return json.dumps(document, indent=1, ensure_ascii=False) + "\n"


#: One line per format.
FORMATS: dict[str, Callable[[list[Verdicts]], str]] = {
    "text": _as_text,
    "markdown": _as_markdown,
    "json": _as_json,
}
