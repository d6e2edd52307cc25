"""The judgements of claims as text, Markdown or JSON."""

from __future__ import annotations

import dataclasses
import json
import textwrap
from collections.abc import Callable
from dataclasses import dataclass

from broadmark.paper.claims import FAILS, HOLDS, TERMS, UNKNOWN, Judgement
from broadmark.paper.evidence import PartVerdict

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
        """The number of claims by verdict."""
        verdicts = [judgement.verdict for judgement in self.judgements]
        return ", ".join(
            f"{verdict}: {verdicts.count(verdict)}" for verdict in (HOLDS, FAILS, UNKNOWN)
        )


def _lines(parts: list[PartVerdict]) -> list[str]:
    """Failed parts first; subjects with the same figures share a line."""
    subjects: dict[tuple[bool | None, str], list[str]] = {}
    for part in sorted(parts, key=lambda part: [False, None, True].index(part.holds)):
        known = subjects.setdefault((part.holds, part.figures), [])
        known += [name for name in part.subject.split(", ") if name not in known]
    return [
        f"{MARKS[holds]} {', '.join(names)}{': ' if holds is None else ' '}{figures}"
        for (holds, figures), names in subjects.items()
    ]


def _as_text(all_verdicts: list[Verdicts]) -> str:
    lines = textwrap.wrap(TERMS + " Marks: + holds, – does not hold, ? not measured.", WIDTH)
    for verdicts in all_verdicts:
        lines += ["", "; ".join([verdicts.machine, *verdicts.conditions]), verdicts.summary]
        for judgement in verdicts.judgements:
            head = f"{judgement.number:2}  {judgement.verdict:13}  "
            indent = " " * len(head)
            lines += ["", *textwrap.wrap(head + judgement.claim, WIDTH, subsequent_indent=indent)]
            for line in _lines(judgement.parts):
                lines += textwrap.wrap(indent + line, WIDTH, subsequent_indent=indent + "  ")
    return "\n".join(lines) + "\n"


def _as_markdown(all_verdicts: list[Verdicts]) -> str:
    blocks = [TERMS]
    for verdicts in all_verdicts:
        rows = ["| | claim | verdict | figures |", "|---|---|---|---|"]
        for judgement in verdicts.judgements:
            figures = "<br>".join(_lines(judgement.parts))
            cells = [str(judgement.number), judgement.claim, judgement.verdict, figures]
            rows.append("| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |")
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
