"""The paper's Table 2 from our results, with the paper's numbers, as text, Markdown, CSV or LaTeX.

The table is transposed, because there are more algorithms than in the paper: a block per scene, a row
per algorithm, and for each number of objects our seconds per frame and the paper's. A second block has
our medians with the 95 % interval of the mean, and marks means that a few spikes dominate. A third has
the ratios to CGAL's time: both use the same CGAL library, so these ratios are comparable between
machines. The paper's times are rounded to 0.01 s, so ratios of short times are left out.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Callable
from dataclasses import dataclass, field

from broadmark.paper.algorithms import BY_ID, CAP_SECONDS, SCENES, Scene, table2
from broadmark.paper.times import SPIKE_FACTOR, SPIKE_WINDOW, Times
from broadmark.text_tables import aligned, markdown_row

REFERENCE = "cgal"

#: The paper's times, CGAL's and others, below which rounding would dominate a ratio.
MIN_REFERENCE_SECONDS, MIN_OTHER_SECONDS = 0.05, 0.02

PAST_THE_CAP = "–"

#: The share of spikes in a mean from which it is marked.
MAX_SPIKE_SHARE = 0.05
SPIKES = "!"


@dataclass(frozen=True)
class Entry:
    """A cell: an algorithm in a scene of one size, with our and the paper's result, if any."""

    scene: str
    objects: int
    algorithm: str
    status: str  #: of our case; PAST_THE_CAP: past the cap at a smaller size; "": no case
    seconds: float | None
    paper_seconds: float | None
    ratio: float | None  #: to CGAL's time
    paper_ratio: float | None
    median: float | None
    noise: float | None  #: half of the mean's 95 % interval, relative to it; None: measured once
    spike_share: float | None

    @property
    def mark(self) -> str:
        """A mark for a mean that spikes dominate."""
        return SPIKES if (self.spike_share or 0) > MAX_SPIKE_SHARE else ""


def entries(times: Times, scene: str) -> list[list[Entry]]:
    """A row per algorithm with an entry per measured number of objects."""
    ids = [*BY_ID, *times.other_algorithms]
    return [[_entry(times, scene, n, algorithm) for n in times.sizes(scene)] for algorithm in ids]


def _entry(times: Times, scene: str, objects: int, algorithm: str) -> Entry:
    shown = times.shown(scene, algorithm)
    measurement = shown.get(objects)
    past = any(smaller.exceeds_cap for size, smaller in shown.items() if size < objects)
    seconds = measurement.seconds if measurement else None
    reference = times.shown(scene, REFERENCE).get(objects)
    paper_seconds = table2().get((scene, objects, algorithm))
    paper_reference = table2().get((scene, objects, REFERENCE), 0)
    rounded = paper_reference < MIN_REFERENCE_SECONDS or (paper_seconds or 0) < MIN_OTHER_SECONDS
    return Entry(
        scene,
        objects,
        algorithm,
        measurement.status if measurement else PAST_THE_CAP if past else "",
        seconds,
        paper_seconds,
        seconds / reference.seconds if seconds and reference and reference.seconds else None,
        None if paper_seconds is None or rounded else paper_seconds / paper_reference,
        measurement.median if measurement and seconds else None,
        measurement.noise if measurement and seconds and measurement.repeated else None,
        measurement.spike_share if measurement and seconds else None,
    )


# Text, Markdown and LaTeX: grids of cells.


@dataclass(frozen=True)
class Grid:
    """A block of the table with formatted cells."""

    title: str
    #: The columns by number of objects: "ours", and "paper" if the paper has this number.
    columns: list[tuple[int, list[str]]]
    rows: list[tuple[str, str, list[str]]]  #: the paper's name, our id, cells


@dataclass(frozen=True)
class Page:
    """The tables of one machine."""

    title: str
    notes: list[str]
    grids: list[Grid] = field(default_factory=list)


def _page(times: Times) -> Page:
    notes = [
        f"“{PAST_THE_CAP}”: exceeded {CAP_SECONDS} s per frame at a smaller size. A word is the "
        "status of our case. A blank cell was not measured.",
        f"“{SPIKES}”: more than {100 * MAX_SPIKE_SHARE:g} % of the mean are frames that take over "
        f"{SPIKE_FACTOR} times as long as the median of the {SPIKE_WINDOW} around them.",
    ]
    notes += [f"{line}." for line in times.conditions]
    page = Page(times.machine, notes)
    for scene in SCENES:
        if times.sizes(scene.name):
            page.grids.extend(_grids(times, scene))
    return page


def _grids(times: Times, scene: Scene) -> list[Grid]:
    rows = [row for row in entries(times, scene.name) if _has_result(row)]
    paper_sizes = {objects for name, objects, _ in table2() if name == scene.name}
    columns = [
        (entry.objects, ["ours", "paper"] if entry.objects in paper_sizes else ["ours"])
        for entry in rows[0]
    ]

    def grid(
        title: str, ours: Callable[[Entry], str], paper: Callable[[Entry], str] | None = None
    ) -> Grid:
        lines = []
        for row in rows:
            cells = []
            for entry, (_, kinds) in zip(row, columns):
                cells += [ours(entry), paper(entry)][: len(kinds)] if paper else [ours(entry)]
            name = BY_ID[row[0].algorithm].name if row[0].algorithm in BY_ID else ""
            lines.append((name, row[0].algorithm, cells))
        all_columns = columns if paper else [(objects, ["ours"]) for objects, _ in columns]
        return Grid(f"{scene.title}: {title}", all_columns, lines)

    blocks = [
        grid("seconds per frame", _seconds, _paper_seconds),
        grid("median of the frames, ± of the mean", _median),
    ]
    if any(entry.ratio or entry.paper_ratio for row in rows for entry in row):
        blocks.append(
            grid("times CGAL’s", lambda e: _ratio(e.ratio), lambda e: _ratio(e.paper_ratio))
        )
    return blocks


def _has_result(row: list[Entry]) -> bool:
    return any(entry.status or entry.paper_seconds is not None for entry in row)


def _seconds(entry: Entry) -> str:
    return entry.status if entry.seconds is None else _two_digits(entry.seconds, 2) + entry.mark


def _median(entry: Entry) -> str:
    if entry.median is None:
        return ""
    interval = "" if entry.noise is None else f" ±{100 * entry.noise:.0f} %"
    return _two_digits(entry.median, 2) + interval


def _paper_seconds(entry: Entry) -> str:
    if entry.paper_seconds is not None:
        return f"{entry.paper_seconds:.2f}"
    return PAST_THE_CAP if entry.algorithm in BY_ID else ""


def _ratio(ratio: float | None) -> str:
    return "" if ratio is None else _two_digits(ratio, 0)


def _two_digits(value: float, decimals: int) -> str:
    """At least two significant digits and `decimals` decimals, without an exponent."""
    while decimals < 9 and 0 < value * 10**decimals < 9.95:
        decimals += 1
    return f"{value:.{decimals}f}"


def as_text(pages: list[Page]) -> str:
    """The tables for a terminal."""
    blocks = []
    for page in pages:
        blocks.append(page.title)
        for grid in page.grids:
            sizes, kinds = ["", ""], ["paper’s name", "algorithm"]
            for objects, names in grid.columns:
                sizes += [f"{objects:,}"] + [""] * (len(names) - 1)
                kinds += names
            lines = [sizes, kinds, *([name, id_, *cells] for name, id_, cells in grid.rows)]
            blocks.append("\n".join([grid.title, *aligned(lines, left=len(kinds))]))
        blocks.append("\n".join(page.notes))
    return "\n\n".join(blocks) + "\n"


def as_markdown(pages: list[Page]) -> str:
    """The tables in Markdown."""
    blocks = []
    for page in pages:
        blocks.append(f"## {_escaped_markdown(page.title)}")
        for grid in page.grids:
            headings = ["paper’s name", "algorithm"]
            for objects, names in grid.columns:
                headings += [f"{objects:,} {name}" for name in names]
            lines = [markdown_row(headings), "|" + "---|" * len(headings)]
            for name, id_, cells in grid.rows:
                row = [name, f"`{id_}`", *cells]
                lines.append(markdown_row([cell.replace("<", "&lt;") for cell in row]))
            blocks += [f"### {grid.title}", "\n".join(lines)]
        blocks.append("\n".join(map(_escaped_markdown, page.notes)))
    return "\n\n".join(blocks) + "\n"


def _escaped_markdown(text: str) -> str:
    return text.replace("|", "\\|").replace("<", "&lt;")


def as_latex(pages: list[Page]) -> str:
    """The tables in LaTeX; they require the package booktabs."""
    blocks = [
        r"% \usepackage{booktabs}; for wide tables: \begin{sidewaystable} of the package rotating"
    ]
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


# CSV: a row per entry.

CSV_COLUMNS = [
    *("machine", "scene", "objects", "algorithm", "paper_algorithm", "status"),
    *("seconds_per_frame", "paper_seconds_per_frame", "ratio_to_cgal", "paper_ratio_to_cgal"),
    *("median_seconds", "relative_interval", "spike_share"),
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
        *(entry.median, entry.noise, entry.spike_share),
    ]


#: The formats and their functions.
FORMATS: dict[str, Callable[[list[Times]], str]] = {
    "text": lambda times: as_text([_page(machine_times) for machine_times in times]),
    "markdown": lambda times: as_markdown([_page(machine_times) for machine_times in times]),
    "csv": _as_csv,
    "latex": lambda times: as_latex([_page(machine_times) for machine_times in times]),
}
