"""A campaign as jobs of Slurm.

For each size an array of jobs bakes and an array of jobs runs, a recording each; a last job merges.
A job is this same command on one recording, which goes on where it was: a job that is requeued
repeats no finished case.

- A recording is run when it is baked, and when all smaller ones were run, as the cap goes by them.
- One that is split is baked after those with an eighth of its bodies.
- Runs have a node for themselves.

All of it is in the script `submit`, which can be read, changed and run by hand.
"""

from __future__ import annotations

import os
import pathlib
import shlex
import subprocess
import sys
from dataclasses import dataclass, field

import broadmark
from broadmark.campaign.folder import Folder
from broadmark.campaign.ledger import Ledger
from broadmark.campaign.plan import Recording, levels
from broadmark.errors import InputError
from broadmark.files import write_text
from broadmark.program import VARIABLE, find_program

SUBMIT = """\
#!/bin/bash
# Submits the jobs of a campaign. If Slurm refuses one, none is left.
set -eE
cd -- "$(dirname -- "${BASH_SOURCE[0]}")"
submitted=()
trap '[ ${#submitted[@]} -eq 0 ] || scancel "${submitted[@]}"' ERR
submit() {  # a variable for the job's number, then arguments of sbatch
  local job
  job=$(sbatch --parsable --requeue --open-mode=append --kill-on-invalid-dep=yes "${@:2}")
  printf -v "$1" %s "${job%%;*}"
  submitted+=("${job%%;*}")
}
"""

JOB = """\
#!/bin/bash
# {what}
cd -- {here}
export PYTHONPATH={package}${{PYTHONPATH:+:$PYTHONPATH}}
export {variable}={program}
"""


@dataclass
class Job:
    """A job, or an array of jobs with a recording each."""

    name: str
    what: str
    arguments: list[str]  #: of the command
    recordings: list[Recording] = field(default_factory=list)  #: empty: no array
    after: list[tuple[str, Job]] = field(default_factory=list)  #: kind of dependency, and on what
    options: list[str] = field(default_factory=list)  #: of sbatch

    @property
    def variable(self) -> str:
        return self.name.replace("-", "_")


def planned_jobs(folder: Folder, ledger: Ledger, copy_to: str | None) -> list[Job]:
    """Jobs for all that is not finished, in an order in which they can be submitted."""
    jobs: list[Job] = []
    bakes: dict[int, Job] = {}  # by size
    run = None
    for objects, level in levels(one for one in ledger.recordings if ledger.pending(one)):
        needs = []
        if not all(map(folder.is_baked, level)):
            sources = {one.source.objects for one in level if one.source} & bakes.keys()
            bakes[objects] = Job(
                f"bake-{objects}",
                f"Bakes recordings of {objects} bodies.",
                ["--bake"],
                level,
                after=[("afterok", bakes[size]) for size in sorted(sources)],
            )
            jobs.append(bakes[objects])
            needs.append(("aftercorr", bakes[objects]))
        if run:
            needs.append(("afterany", run))
        run = Job(
            f"run-{objects}",
            f"Runs all variants on recordings of {objects} bodies.",
            ["--copy-to", copy_to] if copy_to else [],
            level,
            after=needs,
            options=["--exclusive", "--mem=0"],
        )
        jobs.append(run)
    if run:
        what = "Writes the results of all jobs as one file."
        jobs.append(Job("merge", what, ["--merge"], after=[("afterany", run)]))
    return jobs


def write(folder: Folder, jobs: list[Job], sbatch: str) -> pathlib.Path:
    """Writes the jobs' scripts, and the one that submits them, whose path is returned."""
    place = folder.path / "slurm"
    place.mkdir(exist_ok=True)
    for job in jobs:
        write_text(os.fspath(place / f"{job.name}.sh"), _script(folder, job))
    submit = place / "submit"
    lines = [SUBMIT, *(_submission(job, sbatch) for job in jobs), 'echo "${submitted[*]}"\n']
    write_text(os.fspath(submit), "".join(lines))
    submit.chmod(0o755)
    return submit


def submit(script: pathlib.Path) -> str:
    """Runs the script that submits. Returns the jobs' numbers."""
    done = subprocess.run(["bash", script], capture_output=True, text=True, check=False)
    if done.returncode:
        lines = done.stderr.strip().splitlines() or [f"it ended with status {done.returncode}"]
        raise InputError(f"{script}: nothing is submitted: {lines[-1]}")
    return done.stdout.strip()


def _submission(job: Job, sbatch: str) -> str:
    """The line that submits a job. The user's options come last: they win."""
    array = [f"--array=0-{len(job.recordings) - 1}"] if job.recordings else []
    log = f"{job.name}.%a.log" if job.recordings else f"{job.name}.log"
    words = [*array, f"--output={log}", *job.options, *shlex.split(sbatch)]
    after = ",".join(f"{kind}:${{{other.variable}}}" for kind, other in job.after)
    dependency = f'--dependency="{after}" ' if after else ""
    return f"submit {job.variable} {dependency}{shlex.join(words)} {job.name}.sh\n"


def _script(folder: Folder, job: Job) -> str:
    """What a job does: this command, called as it was here."""
    text = JOB.format(
        what=job.what,
        here=shlex.quote(os.getcwd()),
        package=shlex.quote(os.fspath(pathlib.Path(broadmark.__file__).resolve().parents[1])),
        variable=VARIABLE,
        program=shlex.quote(os.path.abspath(find_program())),
    )
    command = [sys.executable, "-m", "broadmark", "campaign", os.fspath(folder.campaign)]
    command += ["--output", os.fspath(folder.path), "--quiet", *job.arguments]
    if not job.recordings:
        return f"{text}exec {shlex.join(command)}\n"
    names = "".join(f"  {shlex.quote(one.name)}\n" for one in job.recordings)
    task = '--recording "${recordings[SLURM_ARRAY_TASK_ID]}"'
    return f"{text}recordings=(\n{names})\nexec {shlex.join(command)} {task}\n"
