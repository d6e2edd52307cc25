"""Tests of the command `history`: order, lines, drift, output and figures."""

from __future__ import annotations

import copy
import csv
import gzip
import io
import json
import pathlib
import subprocess
from typing import Any

import matplotlib.image
import matplotlib.style
import numpy as np
import pandas as pd
import pytest
from simulated_history import false_rate, found_rates, simulated
from synthetic_results import case

from broadmark.drawing import SETTINGS
from broadmark.history.figure import page
from broadmark.history.machines import machine_labels, machine_of
from broadmark.history.measures import minimum_times
from broadmark.program import call

pytestmark = pytest.mark.filterwarnings("error")

ALGORITHMS = ["bf", "kd", "sap", "tide", "tracy"]


def environment(number: int, **others: Any) -> dict[str, Any]:
    return {
        "cpu": "A (R) Processor 8-Core Processor",
        "logical_cores": 8,
        "memory_bytes": 2**34 + number,
        "compiler": "gcc 12",
        "build_type": "Release",
        "started": f"2026-01-{1 + number:02}T00:00:00Z",
        "commit": f"{number + 0xABCDEF0:040x}"[::-1],
        **others,
    }


def write(
    path: pathlib.Path, cases: list[dict[str, Any]], environments: list[dict[str, Any]]
) -> pathlib.Path:
    document = {
        "schema": "broadmark-results/2",
        "options": [],
        "environments": environments,
        "complete": True,
        "cases": cases,
    }
    if path.suffix == ".gz":
        with gzip.open(path, "wt") as file:
            json.dump(document, file)
    else:
        path.write_text(json.dumps(document))
    return path


def write_history(
    folder: pathlib.Path,
    count: int,
    ratio: Any = lambda algorithm, number: 1.0,
    algorithms: list[str] = ALGORITHMS,
    **others: Any,
) -> list[pathlib.Path]:
    """A results file per commit. `others` are values of environments, or functions of the number."""
    folder.mkdir(exist_ok=True)
    random = np.random.default_rng(1)
    files = []
    for number in range(count):
        cases = []
        for i, algorithm in enumerate(algorithms):
            seconds = 1e-3 * (i + 1) * ratio(algorithm, number) * (1 + 0.005 * random.normal())
            cases.append(case("Brownian", 1000, algorithm, seconds))
            cases[-1]["processor"] = {
                "instructions": [1000000 * (1.03 if ratio(algorithm, number) > 1.05 else 1)]
            }
        own = {key: value(number) if callable(value) else value for key, value in others.items()}
        # Files are named against the order.
        name = f"{count - number:03}.json"
        files.append(write(folder / name, cases, [environment(number, **own)]))
    return files


def slower_kd(algorithm: str, number: int) -> float:
    return 1.1 if algorithm == "kd" and number >= 6 else 1.0


def label(number: int) -> str:
    return str(environment(number)["commit"])[:7]


def test_a_change_is_listed(tmp_path: pathlib.Path, command: Any) -> None:
    write_history(tmp_path / "runs", 12, slower_kd)
    status, out, error = command("history", tmp_path / "runs")
    assert (status, error) == (0, "")
    head, row, _, summary = out.splitlines()
    assert head.split()[:5] == ["case", "commit", "before", "after", "ratio"]
    cells = row.split()
    assert cells[0] == "Brownian/Cubes/N1000/F1/s1/kd/t1/scalar" and cells[1] == label(6)
    assert cells[3] == cells[5] == "ms" and 1.09 < float(cells[6]) < 1.11
    assert float(cells[2]) == pytest.approx(2, rel=0.01)
    low, high = map(float, cells[7].split("…"))
    assert low < float(cells[6]) < high
    assert summary == "12 commits, 5 cases, 1 machine: time per frame: 1 change, 1 slower"


def test_json_and_csv(tmp_path: pathlib.Path, command: Any) -> None:
    write_history(tmp_path / "runs", 12, slower_kd)
    status, out, _ = command("history", tmp_path / "runs", "--csv", "-")
    (row,) = csv.DictReader(io.StringIO(out))
    assert status == 0 and row["commit"] == environment(6)["commit"]
    assert row["previous_commit"] == environment(5)["commit"]
    assert float(row["time_after"]) == pytest.approx(2.2e-3, rel=0.01)
    status, out, _ = command("history", tmp_path / "runs", "--json", "-")
    document = json.loads(out)
    assert status == 0 and document["schema"] == "broadmark-history/1"
    assert [entry["commit"] for entry in document["commits"]] == [
        environment(number)["commit"] for number in range(12)
    ]
    line = next(line for line in document["lines"] if "/kd/" in line["case"])
    assert line["commits"] == list(range(12)) and len(line["values"]) == len(line["drift"]) == 12
    assert line["values"][0] == pytest.approx(2e-3, rel=0.03) and line["low"][0] is None
    assert line["changes"][0]["ratio"] == pytest.approx(float(row["ratio"]))
    file = tmp_path / "changes.json"
    status, out, _ = command("history", tmp_path / "runs", "--json", file)
    assert json.loads(file.read_text()) == document and "1 slower" in out


def test_a_change_of_the_machine_is_none_of_the_code(tmp_path: pathlib.Path, command: Any) -> None:
    def ratio(algorithm: str, number: int) -> float:
        return slower_kd(algorithm, number) * (1.3 if number >= 10 else 1)

    write_history(tmp_path / "runs", 16, ratio)
    status, out, _ = command("history", tmp_path / "runs")
    rows = out.splitlines()
    assert status == 0 and rows[1].split()[1] == label(6)
    assert rows[2].startswith("all cases") and rows[2].split()[2] == label(10)
    assert float(rows[2].split()[3]) == pytest.approx(1.3, abs=0.005)
    assert f"from {label(10)} the times of all cases changed by +30 % in the median" in out
    assert "1 change, 1 slower" in rows[-1]


def test_few_cases_cannot_tell_the_machine(tmp_path: pathlib.Path, command: Any) -> None:
    write_history(tmp_path / "runs", 12, slower_kd, algorithms=["kd", "bf"])
    status, out, error = command("history", tmp_path / "runs")
    assert status == 0 and label(6) in out
    assert "fewer than 4 cases: a change of the machine looks like one of the code" in error


def test_machines_and_compilers_have_their_own_lines(tmp_path: pathlib.Path, command: Any) -> None:
    first = write_history(
        tmp_path / "a",
        12,
        lambda _, number: 2.0 if number >= 6 else 1.0,
        compiler=lambda number: "gcc 13" if number >= 6 else "gcc 12",
    )
    write_history(tmp_path / "b", 12, slower_kd, cpu="Another", host=lambda number: f"h{number}")
    status, out, _ = command("history", *first, tmp_path / "b")
    rows = out.splitlines()
    assert status == 0 and len(rows) == 4
    assert "Another, 8 cores, gcc 12" in rows[1] and label(6) in rows[1]
    assert rows[-1].startswith("12 commits, 5 cases, 3 machines")
    status, out, _ = command("history", *first, tmp_path / "b", "--machine", "Another")
    assert status == 0 and "1 machine:" in out
    status, _, error = command("history", *first, "--machine", "Mine")
    assert status == 2 and "--machine 'Mine': matches none of 'A 8-Core" not in error
    assert "matches none of 'A, 8 cores, gcc 12', 'A, 8 cores, gcc 13'" in error
    status, out, _ = command("history", tmp_path / "b", "--by-host")
    assert status == 0 and "12 machines" in out


def test_other_conditions_begin_a_new_line(tmp_path: pathlib.Path, command: Any) -> None:
    for number, file in enumerate(write_history(tmp_path / "runs", 12)):
        document = json.loads(file.read_text())
        if number >= 6:
            kd = document["cases"][1]
            kd["conditions"]["check"] = "off"
            kd["recording"]["hash"] = "1" * 32
            kd["frames"]["total"] = [[5000000]]
        file.write_text(json.dumps(document))
    status, out, _ = command("history", tmp_path / "runs")
    assert status == 0 and "no certain change" in out
    assert f"from {label(6)}: other recordings, check none -> off: a new line begins: " in out
    assert "kd" in out and "bf" not in out


def test_counts_are_followed_by_the_names_of_columns(tmp_path: pathlib.Path, command: Any) -> None:
    write_history(tmp_path / "runs", 8, lambda _, number: 1.1 if number == 7 else 1.0)
    count = ["history", tmp_path / "runs", "--column", "instructions_per_frame"]
    status, out, error = command(*count)
    assert (status, error) == (0, "")
    # All cases change at the last commit: no machine makes a program do more.
    assert out.count(label(7)) == 5 and "5 changes, 5 up" in out and "1.030" in out
    assert command(*count, "--margin", "4%")[1].count(label(7)) == 0
    status, out, _ = command("history", tmp_path / "runs", "--column", "seconds_per_frame")
    assert status == 0 and "mean: no certain change" in out
    status, _, error = command("history", tmp_path / "runs", "--column", "speed")
    assert status == 2 and "--column 'speed': expected one of time, objects," in error
    status, _, error = command("history", tmp_path / "runs", "--column", "cycles_per_frame")
    assert status == 2 and "no case has a cycles per frame above 0" in error


def test_runs_of_a_commit_are_judged_together(tmp_path: pathlib.Path, command: Any) -> None:
    """Three runs of the last commit show its level."""
    files = write_history(tmp_path / "runs", 9, slower_kd)
    for number in (7, 8):
        document = json.loads(files[number].read_text())
        document["environments"][0]["commit"] = environment(6)["commit"]
        files[number].write_text(json.dumps(document))
    status, out, _ = command("history", tmp_path / "runs")
    assert status == 0 and label(6) in out and out.splitlines()[-1].startswith("7 commits")


def test_the_same_run_counts_once(tmp_path: pathlib.Path, command: Any) -> None:
    files = write_history(tmp_path / "runs", 3)
    copied = tmp_path / "copy.json.gz"
    with gzip.open(copied, "wt") as file:
        file.write(files[0].read_text())
    with pytest.warns(UserWarning, match="copy.json.gz: repeats 5 cases of "):
        status, out, _ = command("history", *files, files[0], copied)
    assert status == 0
    assert out.startswith("3 commits")


def test_folders_leave_out_other_files(tmp_path: pathlib.Path, command: Any) -> None:
    write_history(tmp_path / "runs", 3)
    other = tmp_path / "runs" / "other.json"
    other.write_text('{"schema": "broadmark-duel/1"}')
    status, out, error = command("history", tmp_path)
    assert status == 0 and "other.json: not a results file" in error and "left out" in error
    status, _, error = command("history", other)
    assert status == 2 and "not a results file" in error
    (tmp_path / "empty").mkdir()
    status, _, error = command("history", tmp_path / "empty")
    assert status == 2 and "the folder has no results" in error


def test_without_commits_files_are_in_the_order_of_their_runs(
    tmp_path: pathlib.Path, command: Any
) -> None:
    write_history(tmp_path / "runs", 12, slower_kd, commit=None)
    status, out, _ = command("history", tmp_path / "runs")
    assert status == 0 and "2026-01-07" in out and out.splitlines()[-1].startswith("12 runs")


def test_builds_with_changes_are_in_the_order_of_their_runs(
    tmp_path: pathlib.Path, command: Any
) -> None:
    write_history(tmp_path / "runs", 12, slower_kd, commit="a" * 40, dirty=True)
    status, out, _ = command("history", tmp_path / "runs")
    assert status == 0 and out.splitlines()[-1].startswith("12 runs")


def test_dates_of_commits_come_before_those_of_runs(tmp_path: pathlib.Path, command: Any) -> None:
    """The oldest commit ran last."""
    write_history(
        tmp_path / "runs", 5, commit_date=lambda number: f"2026-02-{20 - number:02}T00:00:00+01:00"
    )
    _, out, _ = command("history", tmp_path / "runs", "--json", "-")
    names = [entry["commit"] for entry in json.loads(out)["commits"]]
    assert names == [environment(number)["commit"] for number in (4, 3, 2, 1, 0)]


def git(folder: pathlib.Path, *arguments: str) -> str:
    identity = ["-c", "user.name=A", "-c", "user.email=a@example.org"]
    done = subprocess.run(
        ["git", "-C", str(folder), *identity, *arguments],
        capture_output=True,
        text=True,
        check=True,
    )
    return done.stdout.strip()


def test_a_repository_tells_the_order(tmp_path: pathlib.Path, command: Any) -> None:
    repository = tmp_path / "repository"
    repository.mkdir()
    git(repository, "init", "-q")
    hashes = []
    for number in range(4):
        git(repository, "commit", "-q", "--allow-empty", "-m", str(number))
        hashes.append(git(repository, "rev-parse", "HEAD"))
    files = write_history(tmp_path / "runs", 4, commit=None)
    (tmp_path / "runs" / hashes[1]).mkdir()
    # The runs are in the reverse order of the commits.
    names = [
        files[0].rename(tmp_path / "runs" / f"machine-{hashes[3][:9]}.json"),
        files[1].rename(tmp_path / "runs" / f"{hashes[2]}.json"),
        files[2].rename(tmp_path / "runs" / hashes[1] / "results.json"),
        files[3].rename(tmp_path / "runs" / f"{hashes[0][:7]}_1.json"),
    ]
    _, out, error = command("history", *names, "--git", repository, "--json", "-")
    assert [entry["commit"] for entry in json.loads(out)["commits"]] == hashes, error
    wrong = names[0].rename(tmp_path / "runs" / "00000000.json")
    status, _, error = command("history", wrong, "--git", repository)
    assert status == 2 and "00000000.json: commit 00000000 is not in" in error
    nameless = wrong.rename(tmp_path / "nameless.json")
    status, _, error = command("history", nameless, "--git", repository)
    assert status == 2 and "names no commit: expected one in its path" in error
    status, _, error = command("history", nameless, "--git", tmp_path / "runs")
    assert status == 2 and "--git" in error and "not a git repository" in error


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"started": None, "commit": None}, "neither when the run began ('started') nor"),
        ({"started": "yesterday"}, "started 'yesterday': expected a time such as 2026-"),
        ({"commit": None}, "its environment names no commit, those of other files do"),
        ({"started": environment(1)["started"]}, "they began at the same time: give --git"),
        ({"commit_date": "2026"}, "no certain change"),  # not all have one
    ],
)
def test_an_unknown_order_is_an_error(
    changes: dict[str, Any], message: str, tmp_path: pathlib.Path, command: Any
) -> None:
    files = write_history(tmp_path / "runs", 3)
    if changes == {"started": None, "commit": None}:
        files = write_history(tmp_path / "runs", 3, commit=None)
    document = json.loads(files[2].read_text())
    document["environments"][0].update(changes)
    files[2].write_text(json.dumps(document))
    status, out, error = command("history", *files)
    assert status == (0 if message == "no certain change" else 2) and message in out + error
    assert len(error.splitlines()) <= 1 and (status == 0 or "order" in error or "001.json" in error)


def test_contradicting_orders_are_an_error(tmp_path: pathlib.Path, command: Any) -> None:
    write_history(tmp_path / "a", 3)
    write_history(
        tmp_path / "b",
        3,
        host="b",
        cpu="Another",
        started=lambda number: f"2026-03-{20 - number:02}T00:00:00Z",
    )
    status, _, error = command("history", tmp_path / "a", tmp_path / "b")
    assert status == 2 and "is unknown: they ran in the reverse order on 'b: Another" in error


def test_two_results_of_one_run_are_an_error(tmp_path: pathlib.Path, command: Any) -> None:
    cases = [case("Brownian", 1000, "kd", seconds) for seconds in (1e-3, 2e-3)]
    file = write(tmp_path / "a.json", cases, [environment(0)])
    status, _, error = command("history", file)
    assert status == 2 and "occurs twice, with different times and the same start" in error


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--margin", "much"], "--margin 'much': expected a share"),
        (["--margin", "120%"], "--margin '120%': expected a share"),
        (["-o", "a.gif"], "a.gif: the extension must be"),
        (["--filter", "("], "not a regular expression"),
        (["--filter", "nothing"], "no case is left"),
        (["--algorithm", "no*"], "'no*': matches none of"),
        (["--json", "-", "--csv", "-"], "only one of them can be '-'"),
        (["there/is/no.json"], "cannot be read"),
    ],
)
def test_invalid_requests_are_rejected(
    options: list[str], message: str, tmp_path: pathlib.Path, command: Any
) -> None:
    (file,) = write_history(tmp_path / "runs", 1)
    status, out, error = command("history", file, *options)
    assert (status, out) == (2, "") and message in error and len(error.splitlines()) == 1


def test_failed_cases_are_left_out(tmp_path: pathlib.Path, command: Any) -> None:
    cases = [
        case("Brownian", 1000, "kd", 1e-3),
        case("Brownian", 1000, "bf", 1e-3, status="mismatch"),
        case("Brownian", 1000, "sap", 1e-3, asked=3),
    ]
    status, out, error = command("history", write(tmp_path / "a.json", cases, [environment(0)]))
    assert status == 0 and "left out: 1 mismatch, 1 incomplete" in error and "1 case," in out
    file = write(tmp_path / "a.json", cases[1:], [environment(0)])
    status, _, error = command("history", file)
    assert status == 2 and "no case is ok and complete" in error


@pytest.mark.parametrize("kind", ["svg", "pdf", "png"])
def test_figures(kind: str, tmp_path: pathlib.Path, command: Any) -> None:
    files = write_history(tmp_path / "runs", 12, slower_kd)
    file = tmp_path / f"history.{kind}"
    status, out, error = command("history", *files, "-o", file)
    assert (status, error) == (0, "") and out.endswith(f"written: {file}\n")
    first = file.read_bytes()
    command("history", *files, "-o", file)
    assert file.read_bytes() == first
    if kind == "svg":
        for text in ("1,000 bodies, kd/t1/scalar", f" % at {label(6)}", "A, 8 cores"):
            assert text in first.decode()


def test_scenes_have_their_own_pages(tmp_path: pathlib.Path, command: Any) -> None:
    cases = [case(scene, 1000, "kd", 1e-3) for scene in ("Brownian", "a/b")]
    file = write(tmp_path / "a.json", cases, [environment(0)])
    _, out, _ = command("history", file, "-o", tmp_path / "h.svg")
    names = [pathlib.Path(line.split(": ")[1]).name for line in out.splitlines()[1:]]
    assert names == ["h-Brownian-Cubes.svg", "h-a-b-Cubes.svg"]
    _, out, _ = command("history", file, "-o", tmp_path / "h.pdf")
    assert out.splitlines()[1:] == [f"written: {tmp_path / 'h.pdf'}"]
    assert b"/Count 2" in (tmp_path / "h.pdf").read_bytes()


def test_labels_do_not_overlap() -> None:
    """Forty cases, three machines, sixty commits, several changes."""
    history = simulated(np.random.default_rng(1), cases=40, commits=60, machines=3)
    ids = [f"case {i}" for i in range(40)]
    history.cases = pd.DataFrame(
        {"id": ids, "scene": "Brownian", "object_type": "Cubes", "objects": 1000, "algorithm": ids},
        index=ids,
    )
    with matplotlib.style.context(["default", SETTINGS]):
        figure = page(history, "Brownian Cubes", ids)
        figure.savefig(io.BytesIO(), format="png")
        panels = [axes for part in figure.subfigs for axes in part.axes if axes.axison]
        boxes = [axes.get_tightbbox() for axes in panels]
    assert len(boxes) == 40
    for i, box in enumerate(boxes):
        assert not any(box.overlaps(other) for other in boxes[i + 1 :])


def test_a_minimum_is_that_of_as_many_repetitions() -> None:
    times = np.array([[4000, 4000], [2000, 6000], [3000, 5000]])
    (log,), (half,) = minimum_times([list(times)])
    assert np.exp(log) == pytest.approx(3e-6) and half > 0
    logs, halves = minimum_times([list(times), [times[0]]])
    # Of one repetition, the expected minimum is the mean of all.
    assert np.exp(logs) == pytest.approx([4e-6, 4e-6])
    assert halves[0] == pytest.approx(half, rel=0.5) and np.isnan(halves[1])
    logs, _ = minimum_times([list(times), list(times[:2])])
    # The minima of two of three: 2, 2, 3 and 4, 4, 5.
    assert np.exp(logs) == pytest.approx([(7 + 13) / 6 * 1e-6, 3e-6])


def test_names_of_machines() -> None:
    facts = {"cpu": "Intel(R) Core(TM) i7-6700 CPU @ 3.40GHz", "logical_cores": 4, "host": "desk"}
    machines = [machine_of(facts, False), machine_of({**facts, "logical_cores": 2.0}, False)]
    assert machine_labels(machines) == [
        "Intel Core i7-6700, 4 cores",
        "Intel Core i7-6700, 2 cores",
    ]
    assert machine_labels([machine_of(facts, True)]) == ["desk, Intel Core i7-6700, 4 cores"]
    other = machine_of({**facts, "memory_bytes": 2**34}, False)
    assert machine_labels([machines[0], other])[1] == "Intel Core i7-6700, 4 cores, 16 GiB"
    assert machine_labels([machine_of({}, False)]) == ["unknown machine"]


@pytest.mark.parametrize("cases", [4, 10])
def test_histories_without_a_change_show_none(cases: int) -> None:
    assert false_rate(40, 1, cases=cases, commits=30, margin=0.0) <= 0.05
    assert false_rate(40, 2, cases=cases, commits=30, disturbed=0.05) <= 0.05


def test_a_step_of_ten_percent_is_found_at_its_commit() -> None:
    exact, near = found_rates(40, 3, 1.1, cases=10, commits=40)
    assert exact >= 0.9 and near >= 0.95


def test_the_program(tmp_path: pathlib.Path, command: Any) -> None:
    """Runs of the real program, as the runs of eight commits, of which the second half is slower."""
    runs = []
    for number in range(2):
        file = tmp_path / f"run-{number}.json"
        call(
            *("--headless", "brownian", "--objects", "100", "--frames", "3", "--quiet"),
            *("--algorithm", "bf,sap,kd,grid-sap,tide", "--repetitions", "2", "--json", str(file)),
            accept=(0, 4),
        )
        runs.append(json.loads(file.read_text()))
        # Both may have begun in the same second.
        runs[-1]["environments"][0]["started"] = f"2026-01-02T03:04:0{number}Z"
        file.write_text(json.dumps(runs[-1]))
    status, out, _ = command("history", tmp_path)
    assert status == 0 and "1 machine: time per frame" in out
    commits = tmp_path / "commits"
    commits.mkdir()
    for number in range(8):
        document = copy.deepcopy(runs[0])
        facts = document["environments"][0]
        facts |= {"commit": f"{number + 1:x}" * 40, "commit_date": "", "dirty": False}
        facts["started"] = f"2026-01-02T03:04:0{number}Z"
        for phases in [
            entry["frames"] for entry in document["cases"] if entry["algorithm"] == "kd"
        ]:
            factor = (3 if number >= 4 else 1) * (1 + 0.001 * (number % 3))
            phases["total"] = [[round(factor * ns) for ns in times] for times in phases["total"]]
        (commits / f"{number}.json").write_text(json.dumps(document))
    image = tmp_path / "history.png"
    status, out, _ = command("history", commits, "-o", image)
    rows = out.splitlines()
    assert status == 0 and "/kd" in rows[1] and "5555555" in rows[1] and "3.00" in rows[1]
    assert "1 change, 1 slower" in out
    assert matplotlib.image.imread(image).shape[0] > 500
