"""Tests of campaigns on this machine, including interruptions."""

from __future__ import annotations

import contextlib
import json
import os
import pathlib
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from typing import Any

import pytest
from conftest import SOURCE_FOLDER
from folder_watch import wait_until

import broadmark
from broadmark.campaign.attempts import PARTIAL_SUFFIX, read_attempt
from broadmark.campaign.description import read_campaign
from broadmark.campaign.estimate import Estimate
from broadmark.campaign.ledger import Ledger, Outcome
from broadmark.campaign.plan import Recording, planned_recordings
from broadmark.campaign.slurm import planned_jobs

BLOCK = {"scenes": "brownian", "objects": [20, 40], "frames": 5, "engine": "kinematic"}


@pytest.fixture
def write(tmp_path: pathlib.Path) -> Callable[..., pathlib.Path]:
    """Writes a campaign of two small recordings and two variants; arguments replace its keys."""

    def write(**keys: Any) -> pathlib.Path:
        document = {
            "schema": "broadmark-campaign/1",
            "recordings": [BLOCK],
            "algorithm": ["bf", "kd"],
            "time_limit": 60,  # no case ends early on a busy machine
        }
        path = tmp_path / "some campaign.json"
        path.write_text(json.dumps(document | keys))
        return path

    return write


@pytest.fixture
def launch(tmp_path: pathlib.Path, command: Any) -> Callable[..., tuple[int, str, str]]:
    """Runs the command on a campaign with the output folder "the output"."""

    def launch(file: pathlib.Path, *options: str) -> tuple[int, str, str]:
        status, out, err = command("campaign", file, "--output", tmp_path / "the output", *options)
        return int(status), str(out), str(err)

    return launch


def attempts(folder: pathlib.Path) -> dict[str, bytes]:
    """The contents of all attempts, by path."""
    paths = (folder / "the output/runs").glob("*/*.jsonl")
    return {f"{path.parent.name}/{path.name}": path.read_bytes() for path in paths}


def results(folder: pathlib.Path) -> broadmark.Results:
    return broadmark.read_results(folder / "the output/results.json")


def test_every_case_is_run_once(write: Any, launch: Any, tmp_path: pathlib.Path) -> None:
    blocks = [
        BLOCK | {"seed": [1, 2], "parameters": {"density": [0.05, 0.1]}, "objects": 20},
        BLOCK | {"scenes": ["freefall"], "engine": ["kinematic", "bullet"], "objects": 20},
    ]
    own = {
        "algorithm": ["bf*", "kd-mt"],
        "threads": [1, 2],
        "parameters": {"kd-mt:margin": [0, 0.1]},
    }
    file = write(recordings=blocks, algorithm=["bf", "bf-mt", own], threads=2, repetitions=2)
    status, out, err = launch(file)
    assert status == 0, err
    cases = results(tmp_path).cases
    assert len(cases) == 6 * 10  # recordings, variants
    assert cases["id"].is_unique and results(tmp_path).partial == []
    assert set(cases["repetitions"]) == {2} and set(cases["status"]) == {"ok"}
    ids = set(cases["id"])
    assert "Brownian/Cubes/N20/F5/s2/density=0.05/kd-mt/avx2/t1/margin=0" in {
        id_.replace("avx512", "avx2").replace("neon", "avx2") for id_ in ids
    }
    assert "FreeFall/Cubes/N20/F5/s1/engine=bullet/bf-mt/t2" in ids
    assert set(cases["seed"]) == {1, 2}
    assert f"{len(cases)} of {len(cases)} cases" in err  # the last line of progress

    before = attempts(tmp_path)
    status, out, err = launch(file)
    assert status == 0 and err == "" and attempts(tmp_path) == before
    assert f"written: {tmp_path / 'the output/results.json'}" in out


def test_a_campaign_can_request_events(write: Any, launch: Any, tmp_path: pathlib.Path) -> None:
    file = write(recordings=[BLOCK | {"objects": 20}], algorithm=["bf", "kd"], answer="events")
    status, _, err = launch(file)
    assert status == 0, err
    cases = results(tmp_path).cases
    assert set(cases["answer"]) == {"events"} and set(cases["status"]) == {"ok"}
    assert all("/events" in id_ for id_ in cases["id"])


def test_results_identify_their_recordings(write: Any, launch: Any, tmp_path: pathlib.Path) -> None:
    assert launch(write(), "--quiet")[2] == ""
    moved = tmp_path / "moved"
    (tmp_path / "the output").rename(moved)
    case = broadmark.read_results(moved / "results.json").cases.iloc[0]
    again = broadmark.program.call("--headless", str(moved / "results.json"), "--case", case["id"])
    assert "ok" in again


def test_recordings_past_the_cap_are_not_run(
    write: Any, launch: Any, tmp_path: pathlib.Path
) -> None:
    blocks = [BLOCK | {"objects": [20, 40, 80]}, BLOCK | {"objects": 40, "seed": 2}]
    file = write(
        recordings=blocks,
        algorithm=["time-validator"],
        parameters={"phase_us": [1, 3000]},
        time_limit=0.01,
    )
    status, out, _ = launch(file)
    assert status == 0  # a timeout is not a failure of the campaign
    cases = results(tmp_path).cases
    slow = cases[cases["params"] == "phase_us=3000"]
    assert list(slow["objects"]) == [20, 40] and list(slow["seed"]) == [1, 2]
    assert set(slow["status"]) == {"timeout"}
    assert len(cases) - len(slow) == 4
    rows = {line.split("  ")[0]: line.split()[-7:] for line in out.splitlines()}
    assert rows["brownian cubes N20 F5 kinematic seed=1"] == ["1", "1", *"–––––"]
    assert rows["brownian cubes N80 F5 kinematic seed=1"] == ["1", *"––––", "1", "–"]
    assert (
        "not run, past the cap: brownian cubes kinematic seed=1 beyond 20: "
        "time-validator/phase_us=3000" in out
    )
    assert results(tmp_path).partial == []


def test_recordings_without_pending_variants_are_not_baked(
    write: Any, launch: Any, tmp_path: pathlib.Path
) -> None:
    file = write(algorithm=["time-validator"], time_limit=0.001)
    assert launch(file)[0] == 0
    (recording,) = (tmp_path / "the output/recordings").rglob("*.aabbs")
    assert " N20 " in recording.name


def test_large_recordings_are_split_from_small_ones(
    write: Any, launch: Any, tmp_path: pathlib.Path
) -> None:
    blocks = [
        BLOCK | {"objects": 10, "frames": 8},
        BLOCK | {"objects": [80, 640], "frames": 4, "split": True},
    ]
    assert launch(write(recordings=blocks))[0] == 0
    cases = results(tmp_path).cases
    assert sorted(set(zip(cases["objects"], cases["frames"]))) == [(10, 8), (80, 4), (640, 4)]
    assert set(cases["status"]) == {"ok"}
    sidecars = (tmp_path / "the output/recordings").rglob("*N640*.json")
    (parameters,) = (json.loads(sidecar.read_text())["parameters"] for sidecar in sidecars)
    assert parameters["engine"] == "splitter"


def test_a_campaign_can_be_extended(write: Any, launch: Any, tmp_path: pathlib.Path) -> None:
    assert launch(write(algorithm=["bf"]))[0] == 0
    before = attempts(tmp_path)
    larger = BLOCK | {"objects": [20, 40, 80]}
    assert launch(write(recordings=[larger, larger], algorithm=["bf", "kd"]))[0] == 0
    assert before.items() < attempts(tmp_path).items()
    assert len(results(tmp_path).cases) == 6

    kept = (tmp_path / "the output/campaign.json").read_bytes()
    for change, what in (
        ({"repetitions": 2}, "the 'repetitions' is None, not 2"),
        ({"recordings": [BLOCK]}, "it has the recording 'brownian cubes N80 F5 kinematic seed=1'"),
        ({"algorithm": ["bf"], "recordings": [larger]}, "it runs bf, kd with other"),
        ({"threads": [1], "recordings": [larger]}, "it runs bf, kd with other"),
    ):
        for option in ("--quiet", "--list"):
            status, _, err = launch(write(**change), option)
            assert status == 2 and f"holds another campaign: {what}" in err, err
    assert (tmp_path / "the output/campaign.json").read_bytes() == kept


def test_the_list_runs_nothing(write: Any, launch: Any, tmp_path: pathlib.Path) -> None:
    status, out, err = launch(write(), "--list")
    assert status == 0 and not (tmp_path / "the output").exists()
    assert "brownian cubes N40 F5 kinematic seed=1  to bake" in out
    assert "0 cases are finished, 4 remain; 2 recordings remain to be baked" in out


def test_a_single_recording_can_be_run(write: Any, launch: Any, tmp_path: pathlib.Path) -> None:
    name = "brownian cubes N40 F5 kinematic seed=1"
    file = write()
    assert launch(file, "--recording", name, "--bake")[0] == 0
    assert len(list((tmp_path / "the output/recordings").rglob("*.aabbs"))) == 1
    assert not attempts(tmp_path)
    copies = tmp_path / "local"
    copies.mkdir()
    assert launch(file, "--recording", name, "--copy-to", str(copies))[0] == 0
    assert list(attempts(tmp_path)) == [f"{name}/1.jsonl"]
    assert not list(copies.iterdir())
    status, out, err = launch(file, "--merge")
    assert status == 0 and len(results(tmp_path).cases) == 2
    assert results(tmp_path).partial  # half of the campaign
    status, _, err = launch(file, "--recording", "brownian")
    assert status == 2 and "not a recording shown by --list" in err


def test_only_what_varies_within_a_scene_is_in_an_id(
    write: Any, launch: Any, tmp_path: pathlib.Path
) -> None:
    swarm = {"scenes": "swarm", "objects": 20, "frames": 5}  # has no engine
    status, _, err = launch(write(recordings=[BLOCK | {"objects": 20}, swarm], algorithm=["bf"]))
    assert status == 0, err
    cases = results(tmp_path).cases
    assert set(cases["id"]) == {"Brownian/Cubes/N20/F5/s1/bf", "Swarm/Cubes/N20/F5/s1/bf"}
    assert set(cases["varied_params"]) == {""}


def test_wrong_answers_do_not_stop_a_campaign(
    write: Any, launch: Any, tmp_path: pathlib.Path, faulty_plugin: str
) -> None:
    block = BLOCK | {"objects": [200, 300], "frames": 300, "engine": "bullet"}
    status, out, _ = launch(
        write(recordings=[block], algorithm=["faulty", "kd"], plugin=faulty_plugin)
    )
    assert status == 1
    assert sorted(results(tmp_path).cases["status"]) == ["mismatch", "mismatch", "ok", "ok"]


def test_engines_of_plugins_bake(
    write: Any, launch: Any, tmp_path: pathlib.Path, engine_plugin: str
) -> None:
    block = BLOCK | {"engine": "drift", "parameters": {"drift": 2}}
    status, _, err = launch(write(recordings=[block], plugin=engine_plugin))
    assert status == 0, err
    assert set(results(tmp_path).cases["status"]) == {"ok"}


def test_a_failed_recording_does_not_stop_the_others(
    write: Any, launch: Any, tmp_path: pathlib.Path
) -> None:
    file = write()
    assert launch(file, "--bake")[0] == 0
    broken = next((tmp_path / "the output/recordings").rglob("*N20*.aabbs"))
    sidecar = broken.with_suffix(".json")
    sidecar.write_text(sidecar.read_text().replace('"seed": 1', '"seed": 2'))
    status, _, err = launch(file)
    assert status == 2 and "N20 F5 kinematic seed=1: " in err and "baked before" in err, err
    assert list(results(tmp_path).cases["objects"]) == [40, 40]


# Interruptions of the real command in a separate process


@pytest.fixture
def start(tmp_path: pathlib.Path) -> Iterator[Callable[..., subprocess.Popen[str]]]:
    """Starts the command as the leader of a process group."""
    started = []

    def start(file: pathlib.Path, **environment: str) -> subprocess.Popen[str]:
        command = [sys.executable, "-m", "broadmark", "campaign", str(file)]
        process = subprocess.Popen(
            [*command, "--output", str(tmp_path / "the output")],
            env=os.environ | {"PYTHONPATH": str(SOURCE_FOLDER / "python")} | environment,
            stderr=subprocess.PIPE,
            stdout=subprocess.DEVNULL,
            text=True,
            start_new_session=True,
        )
        started.append(process)
        return process

    yield start
    for process in started:
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
        with process:
            pass  # waits and closes the pipe


def finished_cases(folder: pathlib.Path) -> dict[str, Any]:
    """The times of all finished cases, by the program's id."""
    cases = {}
    for path in (folder / "the output/runs").glob("*/*.jsonl"):
        for line in read_attempt(path):
            if line.kind == "case":
                assert line.content["id"] not in cases
                cases[line.content["id"]] = line.content["frames"]["total"]
    return cases


@pytest.fixture
def long_campaign(write: Any) -> pathlib.Path:
    """A campaign of two recordings with two variants that end at once and one that takes a second."""
    path = write(
        recordings=[BLOCK | {"frames": 100}],
        algorithm=["bf", "sap", "time-validator"],
        parameters={"time-validator:phase_us": 3000},
    )
    return pathlib.Path(path)


@pytest.mark.parametrize(
    "interruption", ["kill everything", "kill the command", "Ctrl-C", "termination"]
)
def test_after_an_interruption_no_finished_case_is_run_again(
    interruption: str,
    long_campaign: pathlib.Path,
    start: Any,
    launch: Any,
    tmp_path: pathlib.Path,
) -> None:
    process = start(long_campaign)
    wait_until(tmp_path, lambda: len(finished_cases(tmp_path)) >= 2)
    if interruption == "kill everything":
        os.killpg(process.pid, signal.SIGKILL)
    elif (
        interruption == "kill the command"
    ):  # the program continues, and the next command waits for it
        process.kill()
    elif interruption == "Ctrl-C":
        os.killpg(process.pid, signal.SIGINT)
    else:
        process.terminate()
    _, err = process.communicate()
    if interruption in ("Ctrl-C", "termination"):
        assert process.returncode == 130
        assert "cases are finished; rerun the same command to resume" in err
    before = finished_cases(tmp_path)
    assert not (tmp_path / "the output/results.json").exists()

    assert launch(long_campaign)[0] == 0
    after = finished_cases(tmp_path)
    assert before.items() <= after.items() and len(before) < len(after) == 6
    cases = results(tmp_path).cases
    assert len(cases) == 6 and cases["id"].is_unique
    assert results(tmp_path).partial == []


# A fault and the number of the file system call at which it occurs, in the command and its programs.
@pytest.mark.parametrize(
    "fault",
    ["ENOSPC 1", "ENOSPC 9", "ENOSPC 20", "kill 5", "kill 9", "kill 20"],
)
def test_after_a_disk_failure_the_same_command_resumes(
    fault: str,
    write: Any,
    start: Any,
    launch: Any,
    fault_injection: str,
    tmp_path: pathlib.Path,
) -> None:
    file = write()
    environment = {
        "LD_PRELOAD": os.path.basename(fault_injection),  # not a path: spaces separate entries
        "LD_LIBRARY_PATH": os.path.dirname(fault_injection),
        "BROADMARK_FAULT_FOLDER": str(tmp_path / "the output"),
        "BROADMARK_FAULT_LOG": str(tmp_path / "calls.txt"),
    }
    process = start(file, **environment, BROADMARK_FAULT=fault)
    _, err = process.communicate()
    assert f"\n{fault.split()[1]} " in "\n" + (tmp_path / "calls.txt").read_text()
    killed = fault.startswith("kill")
    assert process.returncode in ((2, -signal.SIGKILL) if killed else (2,)), err
    assert "Traceback" not in err
    assert killed or "No space left on device" in err
    before = finished_cases(tmp_path)

    status, _, err = launch(file)
    assert status == 0, err
    assert before.items() <= finished_cases(tmp_path).items()
    cases = results(tmp_path).cases
    assert len(cases) == 4 and cases["id"].is_unique and set(cases["status"]) == {"ok"}


@pytest.mark.parametrize(
    ("text", "replacement"),
    [
        # Interrupted between two repetitions.
        ('"repetitions":1', '"repetitions":2'),
        # The program may see its worker die before it is killed itself.
        ('"status":"ok","reason":""', '"status":"error","reason":"killed with SIGKILL (Killed)"'),
        ('"status":"ok","reason":""', '"status":"error","reason":"crashed with SIGTERM (…)"'),
    ],
)
def test_unfinished_cases_are_run_again(
    text: str, replacement: str, write: Any, launch: Any, tmp_path: pathlib.Path
) -> None:
    file = write(recordings=[BLOCK | {"objects": 20}], algorithm=["bf", "kd", "sap"])
    assert launch(file)[0] == 0
    path = next((tmp_path / "the output/runs").glob("*/1.jsonl"))
    lines = path.read_text().splitlines(keepends=True)
    assert text in lines[2]
    cut = [*lines[:2], lines[2].replace(text, replacement), lines[3], lines[4][:100]]
    path.with_name("1" + PARTIAL_SUFFIX).write_text("".join(cut))
    path.unlink()
    before = finished_cases(tmp_path)
    assert len(before) == 1
    assert launch(file)[0] == 0
    assert before.items() < finished_cases(tmp_path).items()
    cases = results(tmp_path).cases
    assert len(cases) == 3 and cases["id"].is_unique and set(cases["status"]) == {"ok"}


# Plain values


def recordings_of(path: pathlib.Path) -> list[Recording]:
    return planned_recordings(read_campaign(path))


def test_each_recording_is_planned_once_by_size(write: Any) -> None:
    names = [
        recording.name
        for recording in recordings_of(write(recordings=[BLOCK | {"objects": [40, 20]}, BLOCK]))
    ]
    assert names == [f"brownian cubes N{n} F5 kinematic seed=1" for n in (20, 40)]


def test_a_recording_is_split_from_the_shortest_sufficient_source(write: Any) -> None:
    blocks = [
        BLOCK | {"objects": 10, "frames": [5, 20, 10]},
        BLOCK | {"objects": [80, 640], "frames": 8, "split": True},
    ]
    planned = {
        (recording.objects, recording.frames): recording
        for recording in recordings_of(write(recordings=blocks))
    }
    assert planned[80, 8].source == planned[10, 10] and planned[640, 8].source == planned[80, 8]
    assert [key for key, recording in planned.items() if recording.is_split] == [(10, 10), (80, 8)]


def test_spans_and_repetitions_of_a_block(write: Any, launch: Any, tmp_path: pathlib.Path) -> None:
    blocks = [
        BLOCK | {"objects": 20, "frames": 9, "repetitions": 2},
        BLOCK | {"objects": 20, "frames": 9, "span": [[1, 2], [6, 8]]},
        BLOCK | {"objects": 30, "frames": 9, "span": [[3, 5]]},
    ]
    # Bodies appear and disappear.
    blocks += [{"scenes": "fountain", "objects": 40, "frames": 9, "span": [[2, 3], [7, 9]]}]
    status, _, error = launch(write(recordings=blocks, algorithm=["kd"]))
    assert status == 0, error
    cases = results(tmp_path)
    table = cases.cases
    keys = zip(table["scene"], table["objects"], table["frames"], table["varied_params"])
    assert dict(zip(keys, table["repetitions"])) == {
        ("Brownian", 20, 9, ""): 2,
        ("Brownian", 20, 1, "span=1-2"): 1,
        ("Brownian", 20, 2, "span=6-8"): 1,
        ("Brownian", 30, 2, "span=3-5"): 1,
        ("Fountain", 40, 1, "span=2-3"): 1,
        ("Fountain", 40, 2, "span=7-9"): 1,
    }
    assert set(table["status"]) == {"ok"}
    pairs = {
        (row.objects, row.frames): list(cases.details[row.case]["frame_counts"]["pairs"])
        for row in table[(table["scene"] == "Brownian") & (table["objects"] == 20)].itertuples()
    }
    whole = pairs[20, 9]  # of frames 1 to 9
    assert pairs[20, 1] == whole[1:2] and pairs[20, 2] == whole[6:8]
    # The same command finds nothing to do; other repetitions are another campaign.
    assert launch(write(recordings=blocks, algorithm=["kd"]))[0] == 0
    assert len(results(tmp_path).cases) == 6
    blocks[0]["repetitions"] = 3
    assert "in another way" in launch(write(recordings=blocks, algorithm=["kd"]))[2]


def test_jobs_depend_on_required_jobs(write: Any) -> None:
    class Empty:
        def is_baked(self, recording: Recording) -> bool:
            return False

    blocks = [
        BLOCK | {"objects": [10, 20, 30]},
        BLOCK | {"objects": [80, 160], "split": True},
        BLOCK | {"objects": 10, "seed": 2},
    ]
    ledger = Ledger(recordings_of(write(recordings=blocks)), ["kd"])
    jobs = planned_jobs(Empty(), ledger, None)  # type: ignore[arg-type]
    after = {job.name: [(condition, other.name) for condition, other in job.after] for job in jobs}
    assert after == {
        "bake-10": [],
        "run-10": [("aftercorr", "bake-10")],
        "bake-20": [],
        "run-20": [("aftercorr", "bake-20"), ("afterany", "run-10")],
        "bake-30": [],
        "run-30": [("aftercorr", "bake-30"), ("afterany", "run-20")],
        "bake-80": [("afterok", "bake-10")],
        "run-80": [("aftercorr", "bake-80"), ("afterany", "run-30")],
        "bake-160": [("afterok", "bake-20")],
        "run-160": [("aftercorr", "bake-160"), ("afterany", "run-80")],
        "merge": [("afterany", "run-160")],
    }
    assert [len(job.recordings) for job in jobs][:2] == [2, 2]


def test_remaining_time_follows_finished_cases(write: Any) -> None:
    small, large = recordings_of(write(recordings=[BLOCK | {"objects": [1000, 4000]}]))
    ledger = Ledger([small, large], ["kd"])
    ledger.add(small, "kd", Outcome("ok", 0.02))
    estimate = Estimate(ledger, {"repetitions": 3})
    once = 5 * 3 * 4 * 0.02  # frames, repetitions, four times the bodies
    assert once < estimate.remaining([]) < 3 * once
    assert estimate.remaining([large]) > estimate.remaining([])
    with_timeout = Estimate(ledger, {"repetitions": 3, "time_limit": 0.05})
    assert with_timeout.remaining([]) < estimate.remaining([])  # three frames are enough
    ledger.add(large, "kd", Outcome("ok", 0.08))
    assert estimate.remaining([]) == 0


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ({"schema": "broadmark-campaign/2"}, "not a campaign"),
        ({"algorithms": ["kd"]}, "unknown key 'algorithms' (did you mean 'algorithm'?)"),
        ({"algorithm": "kd"}, 'algorithm: "kd" is not a non-empty list'),
        ({"algorithm": []}, "algorithm: [] is not a non-empty list"),
        ({"algorithm": [5]}, "algorithm[0]: expected an object with algorithm"),
        ({"algorithm": [{"threads": 1}]}, "algorithm[0]: 'algorithm' is missing"),
        ({"algorithm": ["no-such"]}, "algorithm: --algorithm: unknown algorithm 'no-such'"),
        ({"algorithm": None}, "'algorithm' is missing"),
        ({"threads": [1, "2"]}, 'threads: [1, "2"] is not a non-negative integer or a list of'),
        ({"parameters": {"margin": {}}}, "parameters: "),
        ({"parameters": {"no_such": 1}}, "algorithm: --param: unknown parameter 'no_such'"),
        (
            {"repetitions": "often"},
            "repetitions: \"often\" is not a non-negative integer or 'auto'",
        ),
        ({"time_limit": "0.5"}, 'time_limit: "0.5" is not a non-negative number'),
        ({"recordings": [{}]}, "recordings[0]: 'scenes' is missing"),
        ({"recordings": [5]}, "recordings[0]: expected an object with scenes, objects, frames"),
        ({"recordings": [BLOCK | {"objects": True}]}, "recordings[0].objects: true is not"),
        ({"recordings": [BLOCK | {"scenes": "no"}]}, "recordings[0]: unknown scene 'no'"),
        ({"recordings": [BLOCK | {"split": 1}]}, "recordings[0].split: 1 is not true or false"),
        (
            {"recordings": [BLOCK | {"objects": 80, "split": True}]},
            "recordings[0]: brownian cubes N80 F5 kinematic seed=1: requires a recording of 10 bodies",
        ),
        ({"recordings": [BLOCK | {"objects": 12, "split": True}]}, "12 is not a multiple of 8"),
        *(
            ({"recordings": [BLOCK | {"span": span}]}, "recordings[0].span: ")
            for span in ([[3, 1]], [[0, 2], [2, 4]], [], [5], [[0, 1, 2]], "0:2", [[0, 9]])
        ),
        (
            {"recordings": [BLOCK, BLOCK | {"repetitions": 2}]},
            "recordings[1]: brownian cubes N20 F5 kinematic seed=1 is measured in another way",
        ),
        (
            {"recordings": [BLOCK | {"objects": [5, 40]}, BLOCK | {"split": True, "objects": 40}]},
            "recordings[1]: brownian cubes N40 F5 kinematic seed=1 is split in this block and",
        ),
    ],
)
def test_invalid_files_are_rejected(
    write: Any, launch: Any, keys: dict[str, Any], message: str, tmp_path: pathlib.Path
) -> None:
    file = write(**keys)
    status, _, err = launch(file)
    assert status == 2 and f"broadmark: {file}: " in err and message in err, err
    assert not (tmp_path / "the output").exists()


def test_invalid_json_is_rejected(launch: Any, tmp_path: pathlib.Path) -> None:
    file = tmp_path / "some.json"
    assert "cannot be read" in launch(file)[2]
    for text in (
        "",
        "[]",
        "{",
        '{"schema": "broadmark-campaign/1", "schema": "broadmark-campaign/1"}',
    ):
        file.write_text(text)
        status, _, err = launch(file)
        assert status == 2 and str(file) in err


def test_the_campaigns_of_the_program_and_the_documents_are_valid(
    tmp_path: pathlib.Path, command: Any
) -> None:
    document = (SOURCE_FOLDER / "docs/campaigns.md").read_text("utf-8")
    example = tmp_path / "example.json"
    example.write_text(document.split("```json\n")[1].split("```")[0])
    paths = [example, *sorted((SOURCE_FOLDER / "assets/campaigns").glob("*.json"))]
    assert len(paths) == 6
    for path in paths:
        status, out, err = command("campaign", path, "--output", tmp_path / "none", "--list")
        assert status == 0 and "to bake" in out, err
