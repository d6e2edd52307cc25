"""Tests of campaigns as Slurm jobs, on a real Slurm with one node in a temporary folder."""

from __future__ import annotations

import contextlib
import ctypes
import getpass
import json
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import tempfile
from collections.abc import Iterator
from typing import Any

import pytest
from folder_watch import wait_until

import broadmark
from broadmark.campaign import slurm
from broadmark.campaign.attempts import read_attempt

DAEMONS = ["/usr/sbin/munged", "/usr/sbin/slurmctld", "/usr/sbin/slurmd"]

CONFIGURATION = """\
ClusterName=test
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={port}
SlurmdPort={node_port}
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
AuthInfo=socket={folder}/munge,cred_expire=5
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SlurmdParameters=config_overrides
SchedulerParameters=batch_sched_delay=0,bf_interval=1,sched_interval=1
ReturnToService=2
KillWait=20
NodeName={host} NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=main Nodes={host} Default=YES State=UP
"""


def end_with_parent() -> None:
    """Called in a child between fork and exec: the kernel kills the child when the parent dies."""
    ctypes.CDLL(None).prctl(1, signal.SIGKILL)


def free_ports(count: int) -> list[int]:
    sockets = [socket.create_server(("127.0.0.1", 0)) for _ in range(count)]
    ports = [int(socket_.getsockname()[1]) for socket_ in sockets]
    for socket_ in sockets:
        socket_.close()
    return ports


class Cluster:
    """Slurm with one node."""

    def __init__(self, folder: pathlib.Path) -> None:
        self.folder = folder
        self.environment = os.environ | {"SLURM_CONF": f"{folder}/slurm.conf"}
        self._daemons: list[subprocess.Popen[bytes]] = []

    def start(self) -> None:
        port, node_port = free_ports(2)
        host = socket.gethostname().split(".")[0]
        user = getpass.getuser()
        (self.folder / "slurm.conf").write_text(
            CONFIGURATION.format(
                folder=self.folder, host=host, user=user, port=port, node_port=node_port
            )
        )
        key = self.folder / "key"
        key.write_bytes(os.urandom(128))
        key.chmod(0o600)
        for name in ("state", "spool"):
            (self.folder / name).mkdir()
        files = {"key-file": "key", "pid-file": "pid", "seed-file": "seed", "log-file": "log"}
        munge = [f"--{option}={self.folder}/munge.{name}" for option, name in files.items()]
        key.rename(self.folder / "munge.key")
        # --force: the parent folder is world-writable.
        self._begin("/usr/sbin/munged", "--foreground", "--force", *munge, f"-S{self.folder}/munge")
        wait_until(self.folder, (self.folder / "munge").exists)
        self._begin("/usr/sbin/slurmctld", "-D", "-i")
        log = self.folder / "slurmctld.log"
        wait_until(self.folder, lambda: "Running as primary controller" in log.read_text())
        self._begin("/usr/sbin/slurmd", "-D")
        self.call("srun", "true")  # waits for the node

    def call(self, *command: str) -> str:
        done = subprocess.run(
            command, env=self.environment, capture_output=True, text=True, check=False
        )
        assert done.returncode == 0, (command, done.stdout, done.stderr)
        return done.stdout

    def jobs(self) -> str:
        """The unfinished jobs."""
        return self.call("squeue", "--noheader", "--states=PD,R", "--array", "--format=%i %j %T %R")

    def wait_for_jobs(self) -> None:
        """Waits until all jobs have ended."""
        if numbers := self.call("squeue", "--noheader", "--format=%A").split():
            self.call("srun", "--dependency=afterany:" + ":".join(numbers), "true")

    def running_task(self, recording: str) -> tuple[str, list[int]]:
        """The array task that runs a recording, and its processes."""
        tasks: dict[str, list[int]] = {}
        for pid, environment in self._our_processes():
            variables = dict(variable.split("=", 1) for variable in environment if "=" in variable)
            if "SLURM_ARRAY_TASK_ID" in variables:
                task = f"{variables['SLURM_ARRAY_JOB_ID']}_{variables['SLURM_ARRAY_TASK_ID']}"
                tasks.setdefault(task, []).append(pid)
        for task, pids in tasks.items():
            for pid in pids:
                with contextlib.suppress(OSError):
                    if recording in pathlib.Path(f"/proc/{pid}/cmdline").read_text().split("\0"):
                        return task, pids
        raise AssertionError(f"no job runs {recording}: {self.jobs()}")

    def stop(self) -> None:
        """Kills all started processes, in any state."""
        if (self.folder / "slurm.conf").exists():
            subprocess.run(["scancel", "--me"], env=self.environment, check=False)
        for daemon in reversed(self._daemons):
            daemon.kill()
        for pid, _ in self._our_processes():
            with contextlib.suppress(ProcessLookupError):
                os.kill(pid, signal.SIGKILL)
        for daemon in self._daemons:
            daemon.wait()

    def _begin(self, *command: str) -> None:
        with open(self.folder / f"{pathlib.Path(command[0]).name}.log", "wb") as log:
            self._daemons.append(
                subprocess.Popen(
                    command,
                    env=self.environment,
                    stdin=subprocess.DEVNULL,
                    stdout=log,
                    stderr=log,
                    start_new_session=True,
                    preexec_fn=end_with_parent,
                )
            )

    def _our_processes(self) -> Iterator[tuple[int, list[str]]]:
        """This cluster's daemons and all processes that they started."""
        ours = f"SLURM_CONF={self.folder}/slurm.conf"
        for entry in pathlib.Path("/proc").glob("[0-9]*/environ"):
            with contextlib.suppress(OSError):
                environment = entry.read_text(errors="replace").split("\0")
                if ours in environment:
                    yield int(entry.parent.name), environment


@pytest.fixture(scope="module")
def cluster() -> Iterator[Cluster]:
    missing = [path for path in DAEMONS if not os.access(path, os.X_OK)]
    if missing:
        pytest.skip(f"needs the packages munge and slurm-wlm: {missing[0]} is not there")
    if os.geteuid() != 0:
        pytest.skip("Slurm's daemons need root to start jobs")
    # Not pytest's folder: the path of a socket is limited to 107 bytes.
    folder = pathlib.Path(tempfile.mkdtemp(prefix="bm-slurm-", dir="/tmp"))
    started = Cluster(folder)
    try:
        started.start()
        yield started
    finally:
        started.stop()
        shutil.rmtree(folder)


#: The last variant takes some seconds; the others have finished by then.
CAMPAIGN = {
    "schema": "broadmark-campaign/1",
    "recordings": [
        {
            "scenes": "brownian",
            "objects": 40,
            "frames": 50,
            "engine": "kinematic",
            "seed": [1, 2],
        },
        {
            "scenes": "brownian",
            "objects": 320,
            "frames": 50,
            "engine": "kinematic",
            "split": True,
        },
    ],
    "algorithm": ["kd", "bf", "time-validator"],
    "parameters": {"time-validator:phase_us": 15000},
}


@pytest.fixture
def file(tmp_path: pathlib.Path) -> pathlib.Path:
    path = tmp_path / "a campaign.json"
    path.write_text(json.dumps(CAMPAIGN))
    return path


def finished_cases(folder: pathlib.Path, recording: str) -> list[dict[str, Any]]:
    paths = (folder / "runs" / recording).glob("*.jsonl")
    return [line.content for path in paths for line in read_attempt(path) if line.kind == "case"]


def test_killed_and_requeued_jobs_repeat_no_finished_case(
    cluster: Cluster,
    file: pathlib.Path,
    tmp_path: pathlib.Path,
    command: Any,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("SLURM_CONF", cluster.environment["SLURM_CONF"])
    local = tmp_path / "local disk"
    local.mkdir()
    monkeypatch.setenv("LOCAL_DISK", str(local))  # sbatch passes it to the jobs
    output = tmp_path / "out put"
    status, out, err = command(
        *("campaign", file, "--output", output, "--slurm"),
        *("--copy-to", "$LOCAL_DISK", "--sbatch", "--job-name='a campaign' --time=5"),
    )
    assert status == 0 and out.startswith("submitted: "), err
    numbers = out.split()[1:]
    status, out, err = command("campaign", file, "--output", output, "--slurm")
    assert (status, out) == (2, "") and "its jobs are queued already" in err
    assert err.strip().split()[-1] in numbers

    before: dict[tuple[int, str], Any] = {}
    for seed, is_hard in ((1, True), (2, False)):  # SIGKILL, SIGTERM
        name = f"brownian cubes N40 F50 kinematic seed={seed}"
        wait_until(tmp_path, lambda: len(finished_cases(output, name)) == 2)  # in its last case
        there = finished_cases(output, name)
        task, pids = cluster.running_task(name)
        cluster.call("scontrol", "requeue", task)
        if is_hard:
            for pid in pids:
                with contextlib.suppress(ProcessLookupError):
                    os.kill(pid, signal.SIGKILL)
        before |= {(seed, case["algorithm"]): case["frames"]["total"] for case in there}
    cluster.wait_for_jobs()

    logs = {path.name: path.read_text() for path in (output / "slurm").glob("*.log")}
    results = broadmark.read_results(output / "results.json")
    assert results.partial == [], logs
    assert len(results.cases) == 9 and results.cases["id"].is_unique, logs
    assert set(results.cases["status"]) == {"ok"}
    for case in results.details:
        key = case["recording"]["seed"], case["algorithm"]
        if case["recording"]["objects"] == 40 and key in before:
            assert [list(times) for times in case["frames"]["total"]] == before[key]
    assert set(results.cases["recording_file"].str.startswith("recordings/")) == {True}
    assert len(list(local.iterdir())) == 1  # left by the killed job
    assert command("campaign", file, "--output", output, "--slurm")[1] == "no case is left to run\n"


def test_a_rejected_submission_leaves_no_job(
    cluster: Cluster,
    file: pathlib.Path,
    tmp_path: pathlib.Path,
    command: Any,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("SLURM_CONF", cluster.environment["SLURM_CONF"])
    arguments = ("campaign", file, "--output", tmp_path / "out", "--slurm")
    status, _, err = command(*arguments, "--sbatch=--partition=none")
    assert status == 2 and "no job was submitted" in err and "partition" in err
    assert not cluster.jobs()

    assert command(*arguments, "--list")[0] == 0
    script = (tmp_path / "out/slurm/submit").read_text()
    for name in ("bake-40", "run-320", "merge"):  # after the campaign
        assert f"--job-name=out-{name} " in script
    merge = tmp_path / "out/slurm/merge.sh"
    merge.unlink()  # the last job's script
    with pytest.raises(broadmark.InputError, match="merge.sh"):
        slurm.submit(tmp_path / "out/slurm/submit")
    cluster.wait_for_jobs()


@pytest.fixture
def fake_slurm(tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> pathlib.Path:
    """A folder with a `sbatch` that numbers jobs from 1, and nothing else of Slurm."""
    folder = tmp_path / "bin"
    folder.mkdir()
    for name in ("bash", "dirname", "grep", "sort", "printf"):
        if found := shutil.which(name):
            (folder / name).symlink_to(found)
    write_program(folder / "sbatch", 'echo job >>"$0.log"; exec grep -c job "$0.log"')
    monkeypatch.setenv("PATH", str(folder))
    return folder


def write_program(path: pathlib.Path, script: str) -> None:
    path.write_text(f"#!/bin/bash\n{script}\n")
    path.chmod(0o755)


def test_nothing_is_submitted_twice_if_squeue_fails(
    fake_slurm: pathlib.Path, file: pathlib.Path, tmp_path: pathlib.Path, command: Any
) -> None:
    arguments = ("campaign", file, "--output", tmp_path / "out", "--slurm")
    status, out, error = command(*arguments)
    assert status == 0 and out.startswith("submitted: 1 2 3"), error
    log = fake_slurm / "sbatch.log"
    jobs = log.read_text()
    for script in (None, "echo 1; exit 1"):
        if script:
            write_program(fake_slurm / "squeue", script)
        status, out, error = command(*arguments)
        assert (status, out) == (2, "") and log.read_text() == jobs
        line = (
            "no job was submitted: squeue failed: earlier jobs may be queued; without any, remove "
        )
        assert error.count("\n") == 1 and line in error and error.endswith("/slurm/submitted\n")
    write_program(fake_slurm / "squeue", "echo 2")
    assert "its jobs are queued already" in command(*arguments)[2]
    write_program(fake_slurm / "squeue", "echo 12")
    assert command(*arguments)[0] == 0 and log.read_text() != jobs


def test_options_of_sbatch_are_words(
    file: pathlib.Path, tmp_path: pathlib.Path, command: Any
) -> None:
    arguments = ("campaign", file, "--output", tmp_path / "out", "--slurm", "--list")
    status, out, error = command(*arguments, "--sbatch=--comment='x")
    assert (status, out) == (2, "")
    assert error == "broadmark: --sbatch --comment='x: No closing quotation\n"
