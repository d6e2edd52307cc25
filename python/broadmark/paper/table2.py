"""The paper's Table 2 from our results, ours beside theirs, as text, Markdown, CSV or LaTeX.

Turned, because there are more algorithms here than there were columns: a block per scene, a row per
algorithm, and for each number of objects our seconds per frame and the paper's. A second block tells
how many times CGAL's time that is: CGAL's library is the same for both, so these ratios carry over
from machine to machine. The paper's times are rounded to 0.01 s, so ratios of small ones are left out.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Callable
from dataclasses import dataclass, field

from broadmark.paper.algorithms import BY_ID, CAP_SECONDS, SCENES, Scene, table2
from broadmark.paper.times import Times

YARDSTICK = "cgal"

#: The paper's times below which a ratio would be one of rounding: CGAL's and the other's.
LEAST_OF_YARDSTICK, LEAST_OF_OTHERS = 0.05, 0.02

PAST_THE_CAP = "–"


@dataclass(frozen=True)
class Entry:
    """An algorithm in a scene of one size, measured by us, by the paper, or by neither."""

    scene: str
    objects: int
    algorithm: str
    status: str  #: of our case; PAST_THE_CAP: at a smaller size; "": none
    seconds: float | None
    paper_seconds: float | None
    ratio: float | None  #: to CGAL's time
    paper_ratio: float | None


def entries(times: Times, scene: str) -> list[list[Entry]]:
    """A row for each algorithm, an entry in it for each number of objects that we ran."""
    ids = [*BY_ID, *times.own]
    return [[_entry(times, scene, n, algorithm) for n in times.sizes(scene)] for algorithm in ids]


def _entry(times: Times, scene: str, objects: int, algorithm: str) -> Entry:
    shown = times.shown(scene, algorithm)
    place = shown.get(objects)
    past = any(one.past_the_cap for n, one in shown.items() if n < objects)
    seconds = place.seconds if place else None
    yardstick = times.shown(scene, YARDSTICK).get(objects)
    theirs = table2().get((scene, objects, algorithm))
    their_yardstick = table2().get((scene, objects, YARDSTICK), 0)
    rounded = their_yardstick < LEAST_OF_YARDSTICK or (theirs or 0) < LEAST_OF_OTHERS
    return Entry(
        scene,
        objects,
        algorithm,
        place.status if place else PAST_THE_CAP if past else "",
        seconds,
        theirs,
        seconds / yardstick.seconds if seconds and yardstick and yardstick.seconds else None,
        None if theirs is None or rounded else theirs / their_yardstick,
    )


# As text, Markdown and LaTeX: grids of cells.


@dataclass(frozen=True)
class Grid:
    """A block of the table, its cells as they are printed."""

    title: str
    #: Of each number of objects its columns: "ours", and "paper" where the paper has that number.
    columns: list[tuple[int, list[str]]]
    rows: list[tuple[str, str, list[str]]]  #: the paper's name, ours, cells


@dataclass(frozen=True)
class Page:
    """The tables of one machine."""

    title: str
    notes: list[str]
    grids: list[Grid] = field(default_factory=list)


def _page(times: Times) -> Page:
    notes = [
        f"“{PAST_THE_CAP}”: crossed {CAP_SECONDS} s a frame at a smaller size. A word: the status "
        "of our case. Blank: not measured.",
    ]
    notes += [f"{line}." for line in times.conditions]
    page = Page(times.machine, notes)
    for scene in SCENES:
        if times.sizes(scene.name):
            page.grids.extend(_grids(times, scene))
    return page


def _grids(times: Times, scene: Scene) -> list[Grid]:
    rows = [row for row in entries(times, scene.name) if _is_known(row)]
    paper_sizes = {objects for name, objects, _ in table2() if name == scene.name}
    columns = [
        (entry.objects, ["ours", "paper"] if entry.objects in paper_sizes else ["ours"])
        for entry in rows[0]
    ]

    def grid(title: str, ours: Callable[[Entry], str], paper: Callable[[Entry], str]) -> Grid:
        lines = []
        for row in rows:
            cells = []
            for entry, (_, kinds) in zip(row, columns):
                cells += [ours(entry), paper(entry)][: len(kinds)]
            name = BY_ID[row[0].algorithm].name if row[0].algorithm in BY_ID else ""
            lines.append((name, row[0].algorithm, cells))
        return Grid(f"{scene.title}: {title}", columns, lines)

    blocks = [grid("seconds per frame", _seconds, _paper_seconds)]
    if any(entry.ratio or entry.paper_ratio for row in rows for entry in row):
        blocks.append(
            grid("times CGAL’s", lambda e: _ratio(e.ratio), lambda e: _ratio(e.paper_ratio))
        )
    return blocks


def _is_known(row: list[Entry]) -> bool:
    return any(entry.status or entry.paper_seconds is not None for entry in row)


def _seconds(entry: Entry) -> str:
    return entry.status if entry.seconds is None else _two_digits(entry.seconds, 2)


def _paper_seconds(entry: Entry) -> str:
    if entry.paper_seconds is not None:
        return f"{entry.paper_seconds:.2f}"
    return PAST_THE_CAP if entry.algorithm in BY_ID else ""


def _ratio(ratio: float | None) -> str:
    return "" if ratio is None else _two_digits(ratio, 0)


def _two_digits(value: float, decimals: int) -> str:
    """Two significant digits and at least so many decimals, without an exponent."""
    while decimals < 9 and 0 < value * 10**decimals < 9.95:
        decimals += 1
    return f"{value:.{decimals}f}"


def as_text(pages: list[Page]) -> str:
    """For a terminal."""
    blocks = []
    for page in pages:
        blocks.append(page.title)
        for grid in page.grids:
            sizes, kinds = ["", ""], ["paper’s name", "algorithm"]
            for objects, names in grid.columns:
                sizes += [f"{objects:,}"] + [""] * (len(names) - 1)
                kinds += names
            lines = [sizes, kinds, *([name, id_, *cells] for name, id_, cells in grid.rows)]
            widths = [max(len(line[i]) for line in lines) for i in range(len(kinds))]
            text = ["  ".join(c.ljust(w) for c, w in zip(line, widths)).rstrip() for line in lines]
            blocks.append("\n".join([grid.title, *text]))
        blocks.append("\n".join(page.notes))
    return "\n\n".join(blocks) + "\n"


def as_markdown(pages: list[Page]) -> str:
    """For a README."""
    blocks = []
    for page in pages:
        blocks.append(f"## {_escaped_markdown(page.title)}")
        for grid in page.grids:
            heads = ["paper’s name", "algorithm"]
            for objects, names in grid.columns:
                heads += [f"{objects:,} {name}" for name in names]
            lines = ["| " + " | ".join(heads) + " |", "|" + "---|" * len(heads)]
            for name, id_, cells in grid.rows:
                row = [name, f"`{id_}`", *cells]
                lines.append("| " + " | ".join(map(_escaped_markdown, row)) + " |")
            blocks += [f"### {grid.title}", "\n".join(lines)]
        blocks.append("\n".join(map(_escaped_markdown, page.notes)))
    return "\n\n".join(blocks) + "\n"


def _escaped_markdown(text: str) -> str:
    return text.replace("|", "\\|").replace("<", "&lt;")


def as_latex(pages: list[Page]) -> str:
    """For a paper: tables that need the package booktabs."""
    blocks = [r"% \usepackage{booktabs}; wide ones: \begin{sidewaystable} of the package rotating"]
    for page in pages:
        for grid in page.grids:
            blocks.append("\n".join(_latex_table(page, grid)))
    return "\n\n".join(blocks) + "\n"


def _latex_table(page: Page, grid: Grid) -> list[str]:
    sizes, rules, kinds, column = ["", ""], [], ["paper's name", "algorithm"], 3
    for objects, names in grid.columns:
        number = f"{objects:,}".replace(",", "{,}")
        sizes.append(rf"\multicolumn{{{len(names)}}}{{c}}{{{number}}}")
        rules.append(rf"\cmidrule(lr){{{column}-{column + len(names) - 1}}}")
        kinds += names
        column += len(names)
    lines = [
        r"\begin{table}",
        r"  \centering\scriptsize\setlength{\tabcolsep}{3pt}",
        rf"  \caption{{{_escaped_latex(f'{grid.title}. {page.title}. ' + ' '.join(page.notes))}}}",
        rf"  \begin{{tabular}}{{{'l' * len(kinds)}}}",
        r"    \toprule",
        "    " + " & ".join(sizes) + r" \\",
        "    " + "".join(rules),
        "    " + " & ".join(kinds) + r" \\",
        r"    \midrule",
    ]
    for name, id_, cells in grid.rows:
        row = [_escaped_latex(name), rf"\texttt{{{_escaped_latex(id_)}}}"]
        lines.append("    " + " & ".join(row + [_escaped_latex(c) for c in cells]) + r" \\")
    return [*lines, r"    \bottomrule", r"  \end{tabular}", r"\end{table}"]


LATEX = {
    **{character: "\\" + character for character in "&%$#_{}"},
    **{"\\": r"\textbackslash{}", "~": r"\textasciitilde{}", "^": r"\textasciicircum{}"},
    **{"–": "--", "’": "'", "“": "``", "”": "''"},
}


def _escaped_latex(text: str) -> str:
    return "".join(LATEX.get(character, character) for character in text)


# As CSV: an entry per row.

CSV_COLUMNS = [
    *("machine", "scene", "objects", "algorithm", "paper_algorithm", "status"),
    *("seconds_per_frame", "paper_seconds_per_frame", "ratio_to_cgal", "paper_ratio_to_cgal"),
]


def _as_csv(all_times: list[Times]) -> str:
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(CSV_COLUMNS)
    for times in all_times:
        for scene in SCENES:
            for row in entries(times, scene.name):
                for entry in row:
                    if entry.status or entry.paper_seconds is not None:
                        writer.writerow(_csv_row(times.machine, entry))
    return text.getvalue()


def _csv_row(machine: str, entry: Entry) -> list[object]:
    name = BY_ID[entry.algorithm].name if entry.algorithm in BY_ID else ""
    status = "past the cap" if entry.status == PAST_THE_CAP else entry.status
    return [
        *(machine, entry.scene, entry.objects, entry.algorithm, name, status),
        *(entry.seconds, entry.paper_seconds, entry.ratio, entry.paper_ratio),
    ]


#: One line per format.
FORMATS: dict[str, Callable[[list[Times]], str]] = {
    "text": lambda times: as_text([_page(one) for one in times]),
    "markdown": lambda times: as_markdown([_page(one) for one in times]),
    "csv": _as_csv,
    "latex": lambda times: as_latex([_page(one) for one in times]),
}
