"""Tests of the paper's figures and the plots: files, legends, axes, reproducibility."""

from __future__ import annotations

import math
import pathlib
import re
import subprocess
import sys
from typing import Any

import matplotlib.image
import numpy as np
import pytest
from synthetic_results import case, paper_cases, write

import broadmark
from broadmark.drawing import MARKERS, SETTINGS, style
from broadmark.palette import LOOKS, SYMBOLS
from broadmark.paper.algorithms import BY_ID, PARALLEL, SCENES, SINGLE
from broadmark.paper.figures import FigureOptions, curves, fastest_single, figure
from broadmark.paper.times import times_by_machine
from broadmark.plots import KINDS
from broadmark.plots import KINDS
from broadmark.plots.cases import timed_cases
from broadmark.plots.scaling import fit, scaling
from broadmark.program import call

pytestmark = pytest.mark.filterwarnings("error")

MAGIC = {"svg": b"<?xml", "pdf": b"%PDF", "png": b"\x89PNG"}


@pytest.fixture(scope="module")
def paper(tmp_path_factory: pytest.TempPathFactory) -> pathlib.Path:
    return write(tmp_path_factory.mktemp("paper") / "paper.json", paper_cases())


def drawn(file: pathlib.Path, options: FigureOptions, scene: int = 0) -> Any:
    (times,) = times_by_machine(broadmark.read_results(file))
    return figure(times, SCENES[scene], options)


def labels(axes: Any) -> list[str]:
    return [text.get_text() for text in axes.get_legend().get_texts()]


def test_figures_in_all_formats(paper: pathlib.Path, tmp_path: pathlib.Path, command: Any) -> None:
    status, out, _ = command("figures", paper, "-o", tmp_path / "new", "--format", "svg,pdf,png")
    names = [f"figure{n}.{kind}" for n in (5, 6, 7) for kind in MAGIC]
    assert status == 0 and [line.rpartition("/")[2] for line in out.split("\n")[:-1]] == names
    assert sorted(path.name for path in (tmp_path / "new").iterdir()) == sorted(names)
    for name in names:
        content = (tmp_path / "new" / name).read_bytes()
        assert content.startswith(MAGIC[name.rpartition(".")[2]])
    svg = (tmp_path / "new" / "figure5.svg").read_text()
    for algorithm in BY_ID.values():
        assert f">{algorithm.name}</text>" in svg
    assert "thousands of objects" in svg and "Brownian" in svg


def test_panels_have_the_papers_algorithms(paper: pathlib.Path) -> None:
    single, parallel = drawn(paper, FigureOptions()).axes
    assert labels(single) == [a.name for a in BY_ID.values() if a.panel == SINGLE]
    assert labels(parallel) == [a.name for a in BY_ID.values() if a.panel == PARALLEL] + ["KD"]
    assert single.get_xlim() == (0, 1024 * 1.02) and single.get_ylim() == (0, 0.55)
    kd = next(line for line in single.get_lines() if line.get_label() == "KD")
    assert (kd.get_xdata()[-1], kd.get_ydata()[-1]) == (1024, 0.28)


def test_a_line_ends_at_the_first_size_past_the_cap(tmp_path: pathlib.Path) -> None:
    cases = [case("Brownian", n, "bf", s) for n, s in ((1000, 0.1), (2000, 0.6), (4000, 2.4))]
    cases += [
        case("Brownian", 1000, "kd", 0.1),
        case("Brownian", 2000, "kd", 0.51, status="timeout"),
        case("Brownian", 1000, "sap", 0.1, status="mismatch"),
    ]
    (times,) = times_by_machine(broadmark.read_results(write(tmp_path / "a.json", cases)))
    bf, kd = curves(times, "Brownian")
    assert bf.points == [(1, 0.1), (2, 0.6)] and bf.timeout is None
    assert kd.points == [(1, 0.1)] and kd.timeout == (2, 0.5)
    assert "time limit exceeded" in labels(figure(times, SCENES[0], FigureOptions()).axes[0])


def test_a_scene_without_a_time_has_no_figure(tmp_path: pathlib.Path, command: Any) -> None:
    cases = [
        case("Brownian", 1000, "kd", 0.1, status="mismatch"),
        case("Gravity", 1000, "a$b$_{c}", 0.1),
    ]
    file = write(tmp_path / "a.json", cases)
    status, out, error = command("figures", file, "-o", tmp_path / "new")
    assert status == 0 and "Brownian: nothing to draw" in error and "figure5" not in out
    (svg,) = (tmp_path / "new").iterdir()
    assert svg.name == "figure7.svg" and ">a$b$_{c}</text>" in svg.read_text()


def test_the_axis_range_follows_the_results_unless_full(tmp_path: pathlib.Path) -> None:
    cases = [case("Brownian", n, id_, 0.01) for n in (1000, 32000) for id_ in ("kd", "kd-mt")]
    file = write(tmp_path / "a.json", cases)
    assert drawn(file, FigureOptions()).axes[0].get_xlim()[1] == pytest.approx(32 * 1.02)
    assert drawn(file, FigureOptions(full_range=True)).axes[0].get_xlim()[1] == pytest.approx(
        1024 * 1.02
    )
    with_paper = drawn(file, FigureOptions(paper=True)).axes[0]
    assert with_paper.get_xlim()[1] == pytest.approx(1024 * 1.02)
    assert sum((line.get_alpha() or 1) < 0.5 for line in with_paper.get_lines()) == 10
    names = {text.get_text() for text in with_paper.texts}
    assert {"BF ST", "SAP ST", "Tracy ST", "KD"} <= names  # every faint curve has its name
    assert drawn(file, FigureOptions()).axes[0].get_ylim()[1] == pytest.approx(0.01 * 1.05)
    assert with_paper.get_ylim()[1] == 0.55
    log = drawn(file, FigureOptions(log=True)).axes[0]
    assert (log.get_xscale(), log.get_yscale()) == ("log", "log") and log.get_ylim()[1] == 0.55


def test_every_algorithm_has_its_own_style(tmp_path: pathlib.Path) -> None:
    ids = re.findall(r"^   ([\w-]+) +(?!self-check)\S", call("list", "algorithms"), re.MULTILINE)
    assert len(ids) > 20 and {id_ for id_ in LOOKS} <= set(ids)
    assert set(ids) - {"none", "time-validator"} <= {*LOOKS, *(f"{id_}-mt" for id_ in LOOKS)}
    assert len(set(LOOKS.values())) == len(LOOKS)
    assert max(symbol for _, symbol in LOOKS.values()) < SYMBOLS == len(MARKERS)
    single, parallel = style("kd"), style("kd-mt")
    assert (single.colour, single.marker) == (parallel.colour, parallel.marker)
    assert not single.filled and parallel.filled
    # Algorithms that the palette does not list have styles by their names.
    assert style("mine") == style("mine") and style("mine") != style("yours")
    cases = [case("Brownian", 1000, id_, 0.1) for id_ in ("kd-mt", "mine", "yours-mt", "gpu-grid")]
    single_panel, parallel_panel = drawn(write(tmp_path / "a.json", cases), FigureOptions()).axes
    assert labels(single_panel) == ["mine"]
    assert set(labels(parallel_panel)) >= {"kd-mt", "yours-mt", "gpu-grid"}


def test_the_fastest_algorithm_is_chosen_at_the_largest_size(tmp_path: pathlib.Path) -> None:
    times_of = {"bf": (0.1, 0.9), "kd": (0.3, 0.4), "sap": (0.2, 0.4), "kd-mt": (0.1, 0.1)}
    cases = [
        case("Brownian", n, id_, seconds)
        for id_, both in times_of.items()
        for n, seconds in zip((1000, 2000), both)
    ]
    (times,) = times_by_machine(broadmark.read_results(write(tmp_path / "a.json", cases)))
    best = fastest_single(curves(times, "Brownian"))
    assert best is not None and best.algorithm == "sap"


def test_memory_shows_cases_below_a_page(tmp_path: pathlib.Path, command: Any) -> None:
    cases = [
        case("Brownian", 1000, id_, 0.1) | {"peak_bytes": n}
        for id_, n in (("grid2d-sap", 0), ("axis-sweep", 9999))
    ]
    file = tmp_path / "plot.svg"
    assert command("plot", "memory", write(tmp_path / "a.json", cases), "-o", file)[0] == 0
    assert "grid2d-sap" in file.read_text() and "axis-sweep" in file.read_text()


def test_output_is_reproducible(
    small_results: pathlib.Path, tmp_path: pathlib.Path, command: Any
) -> None:
    results = small_results / "results.json"
    for kind in MAGIC:
        files = [tmp_path / f"{n}.{kind}" for n in "ab"]
        for file in files:
            assert command("plot", "bars", results, "-o", file, "--filter", "N100/")[0] == 0
        assert files[0].read_bytes() == files[1].read_bytes()
    assert "matplotlib v" not in files[0].with_suffix(".svg").read_text()


def test_global_settings_are_unchanged(
    small_results: pathlib.Path, tmp_path: pathlib.Path, command: Any
) -> None:
    before = dict(matplotlib.rcParams)
    command("plot", "bars", small_results / "results.json", "-o", tmp_path / "a.svg")
    assert dict(matplotlib.rcParams) == before
    assert before["svg.hashsalt"] != SETTINGS["svg.hashsalt"]


@pytest.mark.parametrize("kind", [kind for kind in KINDS if kind != "phases"])
@pytest.mark.parametrize("log", [[], ["--log"]])
def test_every_kind(
    kind: str, log: list[str], small_results: pathlib.Path, tmp_path: pathlib.Path, command: Any
) -> None:
    file = tmp_path / "plot.svg"
    status, out, error = command("plot", kind, small_results / "results.json", "-o", file, *log)
    assert (status, error) == (0, "") and out == f"written: {file}\n"
    svg = file.read_text()
    for text in ("Brownian cubes", "FreeFall cubes", "sap-mt/t1", "sap-mt/t2", "kd"):
        assert text in svg
    if kind == "scaling":
        assert ">exponent<" in svg  # of two sizes


def test_phases_require_a_single_case(
    small_results: pathlib.Path, tmp_path: pathlib.Path, command: Any
) -> None:
    plot = ["plot", "phases", small_results / "results.json", "-o", tmp_path / "plot.svg"]
    single = ["--scene", "brownian", "--algorithm", "kd", "--objects", "100"]
    status, _, error = command(*plot)
    assert status == 2 and "16 are left" in error and "--filter" in error
    assert command(*plot, *single)[0] == 0
    assert "search overlaps" in (tmp_path / "plot.svg").read_text()
    status, _, error = command(*plot, *single, "--log")
    assert status == 2 and "--log" in error


def test_omitted_cases_are_reported(tmp_path: pathlib.Path, command: Any) -> None:
    cases = [
        case("Brownian", 1000, "kd", 0.1),
        case("Brownian", 1000, "bf", 0.6, status="timeout"),
        case("Brownian", 1000, "sap", 0.1, asked=3),
    ]
    file = write(tmp_path / "a.json", cases)
    status, _, error = command("plot", "bars", file, "-o", tmp_path / "a.svg")
    assert status == 0 and "1 timeout" in error and "1 incomplete" in error
    assert ">bf<" not in (tmp_path / "a.svg").read_text()


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--algorithm", "no*"], "'no*': matches none of 'bf'"),
        (["--objects", "77"], "'77': matches none of '1000'"),
        (["--algorithm", "bf"], "no case with a time is left: 1 mismatch"),
        (["--algorithm", "kd", "--scene", "Gravity"], "no case is left"),
        (["--filter", "nothing"], "no case is left"),
        (["-o", "a.gif"], "a.gif: the extension must be"),
        (["-o", "no/such/folder.svg"], "cannot be written"),
    ],
)
def test_invalid_requests_are_rejected(
    options: list[str], message: str, tmp_path: pathlib.Path, command: Any
) -> None:
    cases = [
        case("Brownian", 1000, "kd", 0.1),
        case("Gravity", 1000, "bf", 0.1, status="mismatch"),
    ]
    file = write(tmp_path / "a.json", cases)
    status, _, error = command("plot", "bars", file, "-o", tmp_path / "a.svg", *options)
    assert status == 2 and message in error.splitlines()[-1]
    assert not (tmp_path / "a.svg").exists()


def test_plots_require_their_columns(tmp_path: pathlib.Path, command: Any) -> None:
    file = write(tmp_path / "a.json", [case("Brownian", 1000, "kd", 0.1, peak_bytes=None)])
    for kind, message in (("memory", "--in-process"), ("scaling", "two numbers of bodies")):
        status, _, error = command("plot", kind, file, "-o", tmp_path / "a.svg")
        assert status == 2 and message in error


def test_an_exponent_and_its_error() -> None:
    objects = np.array([1000, 2000, 4000, 8000])
    factor, exponent, error = fit(objects, 3e-9 * objects**1.5)
    assert (factor, exponent) == pytest.approx((3e-9, 1.5)) and error < 1e-9
    # By hand: x = 0, 1, 2 and y = 0, 2, 1 have the slope 1/2 and the standard error √(3/4).
    _, exponent, error = fit(np.exp([0, 1, 2]), np.exp([0, 2, 1]))
    assert (exponent, error) == pytest.approx((0.5, math.sqrt(0.75)))
    assert math.isnan(fit([1, 2], [1, 2])[2])


def test_two_sizes_have_no_standard_error(tmp_path: pathlib.Path) -> None:
    for sizes, title in (
        ((1000, 2000), "exponent"),
        ((1000, 2000, 4000), "exponent ± standard error"),
    ):
        cases = [case("Brownian", n, "kd", 1e-6 * n) for n in sizes]
        results = broadmark.read_results(write(tmp_path / "a.json", cases))
        axes = scaling(timed_cases(results, log=True, note="")).subfigs[0].axes[0]
        assert axes.get_legend().get_title().get_text() == title


@pytest.mark.parametrize("kind", ["bars", "violins"])
def test_every_row_is_named_and_no_panel_is_empty(kind: str, tmp_path: pathlib.Path) -> None:
    cases = [case("Brownian", n, id_, 0.01) for n in (4000, 8000) for id_ in ("kd", "bf")]
    cases += [case("Gravity", 1000, id_, 0.02) for id_ in ("sap", "cgal", "kd")]
    results = broadmark.read_results(write(tmp_path / "a.json", cases))
    upper = KINDS[kind](timed_cases(results, log=False, note="")).subfigs[0]
    titles = [axes.get_title(loc="left") for axes in upper.axes]
    assert titles == [
        "Brownian cubes, 4,000 bodies",
        "Brownian cubes, 8,000 bodies",
        "Gravity cubes, 1,000 bodies",
    ]
    named = [[text.get_text() for text in axes.get_yticklabels()] for axes in upper.axes]
    assert named[0] == ["bf", "kd"] and named[2] == ["sap", "cgal", "kd"]  # all as fast
    rows = [int(axes.get_ylim()[0]) + 1 for axes in upper.axes]
    assert rows == [2, 2, 3]


def test_rows_are_sorted_by_the_time_at_the_largest_size(tmp_path: pathlib.Path) -> None:
    times = {"kd": (0.1, 0.4), "sap": (0.2, 0.3), "bf": (0.01, None), "tide": (0.3, 0.2)}
    cases = [
        case("Brownian", n, id_, seconds)
        for id_, both in times.items()
        for n, seconds in zip((1000, 2000), both)
        if seconds
    ]
    cases.append(case("Brownian", 2000, "none", 1e-7))
    results = broadmark.read_results(write(tmp_path / "a.json", cases))
    table = timed_cases(results, log=False, note="")
    assert list(table.rows_of("Brownian cubes")) == ["tide", "sap", "kd", "bf"]


def test_plots_are_divided_into_pages(tmp_path: pathlib.Path, command: Any) -> None:
    cases = [
        case(scene, 1000 * 2**k, f"a{i}", 0.01)
        for scene in ("Brownian", "Gravity")
        for k in range(7 if scene == "Brownian" else 3)
        for i in range(30)
    ]
    file = write(tmp_path / "a.json", cases)
    assert command("plot", "bars", file, "-o", tmp_path / "plot.svg")[0] == 0
    pages = sorted(path.name for path in tmp_path.glob("*.svg"))
    assert pages == [
        "plot-Brownian-cubes-from-1000.svg",
        "plot-Brownian-cubes-from-64000.svg",
        "plot-Gravity-cubes.svg",
    ]
    for page in pages:
        size = re.search(r'width="([\d.]+)pt" height="([\d.]+)pt"', (tmp_path / page).read_text())
        assert size and float(size[1]) < 595 and float(size[2]) < 842  # A4


def test_the_strip(tmp_path: pathlib.Path, command: Any) -> None:
    if "--screenshot" not in call("--help"):
        pytest.skip("the program was built without its renderer")
    simulated, replayed = tmp_path / "a.png", tmp_path / "b.png"
    options = ["--objects", "20,40", "--frame", "3"]
    assert command("figure3", "-o", simulated, *options)[0] == 0
    call(
        *("bake", "--scenes", "gravity", "--objects", "20,40", "--frames", "3", "--quiet"),
        *("--output", str(tmp_path)),
    )
    recordings = sorted(tmp_path.glob("*/*.aabbs"), key=lambda path: len(path.read_bytes()))
    assert command("figure3", *recordings, "-o", replayed, "--frame", "3")[0] == 0
    assert simulated.read_bytes() == replayed.read_bytes()
    height, width, _ = matplotlib.image.imread(simulated).shape
    assert 1.7 < width / height < 2


def test_invalid_strips_are_rejected(tmp_path: pathlib.Path, command: Any) -> None:
    for options in (["--objects", "many"], ["--objects", "0"], ["there/is/no.aabbs"]):
        status, _, error = command("figure3", "-o", tmp_path / "a.png", *options)
        assert status == 2 and error.startswith("broadmark: ")
    status, _, error = command("figure3", "-o", tmp_path / "a.gif")
    assert status == 2 and ".png" in error and "drawing" not in error


def test_no_display_is_needed() -> None:
    done = subprocess.run(
        [sys.executable, "-c", "import broadmark.plots, sys; print('tkinter' in sys.modules)"],
        capture_output=True,
        text=True,
        check=True,
        env={"PYTHONPATH": str(pathlib.Path(broadmark.__file__).parents[1])},
    )
    assert done.stdout == "False\n"
