"""A campaign as Slurm jobs.

For every size, a job array bakes and a job array runs, with a task per recording; the last job
merges. A task runs this command on one recording and resumes an earlier attempt, so a requeued job
repeats no finished case.

- A recording is run after it is baked and after all smaller recordings have been run, because the
  cap depends on them.
- A split recording is baked after the recordings with an eighth of its bodies.
- Runs have exclusive nodes.

The script `submit` submits the jobs; it can be read, changed and run by hand.
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
# Submits the jobs of a campaign, unless earlier ones are still queued. If Slurm rejects a job, all are
# cancelled. The file `submitted` has the jobs' numbers.
set -eE
cd -- "$(dirname -- "${BASH_SOURCE[0]}")"
if [ -e submitted ]; then
  if ! jobs=$(squeue --noheader --format=%F); then
    echo "squeue failed: earlier jobs may be queued; without any, remove $PWD/submitted" >&2
    exit 1
  fi
  queued=$(sort -u <<<"$jobs" | grep -xF -f submitted || true)
  if [ -n "$queued" ]; then
    echo "its jobs are queued already: wait for them, or scancel" $queued >&2
    exit 1
  fi
fi
submitted=()
trap '[ ${#submitted[@]} -eq 0 ] || scancel "${submitted[@]}"' ERR
submit() {  # the variable for the job's number, then arguments for sbatch
  local job
  job=$(sbatch --parsable --requeue --open-mode=append --kill-on-invalid-dep=yes "${@:2}")
  printf -v "$1" %s "${job%%;*}"
  submitted+=("${job%%;*}")
}
"""

SUBMITTED = """\
printf '%s\\n' "${submitted[@]}" >submitted
echo "${submitted[*]}"
"""

JOB = """\
#!/bin/bash
# {summary}
cd -- {here}
export PYTHONPATH={package}${{PYTHONPATH:+:$PYTHONPATH}}
export {variable}={program}
"""


@dataclass
class Job:
    """A job, or a job array with a task per recording."""

    name: str
    summary: str
    arguments: list[str]  #: arguments of the command
    recordings: list[Recording] = field(default_factory=list)  #: empty: not an array
    after: list[tuple[str, Job]] = field(default_factory=list)  #: type and job of each dependency
    options: list[str] = field(default_factory=list)  #: options of sbatch

    @property
    def variable(self) -> str:
        return self.name.replace("-", "_")


def planned_jobs(folder: Folder, ledger: Ledger, copy_to: str | None) -> list[Job]:
    """The jobs for all unfinished cases, in the order of submission."""
    jobs: list[Job] = []
    bakes: dict[int, Job] = {}  # by size
    previous_run = None
    for objects, level in levels(filter(ledger.pending, ledger.recordings)):
        needs = []
        if not all(map(folder.is_baked, level)):
            made_of = [(recording.whole or recording).source for recording in level]
            sources = {source.objects for source in made_of if source} & bakes.keys()
            bakes[objects] = Job(
                f"bake-{objects}",
                f"Bakes recordings of {objects} bodies.",
                ["--bake"],
                level,
                after=[("afterok", bakes[size]) for size in sorted(sources)],
            )
            jobs.append(bakes[objects])
            needs.append(("aftercorr", bakes[objects]))
        if previous_run:
            needs.append(("afterany", previous_run))
        previous_run = Job(
            f"run-{objects}",
            f"Runs all variants on recordings of {objects} bodies.",
            ["--copy-to", copy_to] if copy_to else [],
            level,
            after=needs,
            options=["--exclusive", "--mem=0"],
        )
        jobs.append(previous_run)
    if previous_run:
        summary = "Writes the results of all jobs as one file."
        jobs.append(Job("merge", summary, ["--merge"], after=[("afterany", previous_run)]))
    return jobs


def write(folder: Folder, jobs: list[Job], sbatch: str) -> pathlib.Path:
    """Writes the jobs' scripts and the script that submits them. Returns the path of the latter."""
    try:
        words = shlex.split(sbatch)
    except ValueError as error:
        raise InputError(f"--sbatch {sbatch}: {error}") from None
    slurm_folder = folder.path / "slurm"
    slurm_folder.mkdir(exist_ok=True)
    for job in jobs:
        write_text(os.fspath(slurm_folder / f"{job.name}.sh"), _script(folder, job))
    submit = slurm_folder / "submit"
    campaign = folder.path.resolve().name
    lines = [SUBMIT, *(_submission(campaign, job, words) for job in jobs), SUBMITTED]
    write_text(os.fspath(submit), "".join(lines))
    submit.chmod(0o755)
    return submit


def submit(script: pathlib.Path) -> str:
    """Runs the script `submit`. Returns the jobs' numbers."""
    completed = subprocess.run(["bash", script], capture_output=True, text=True, check=False)
    if completed.returncode:
        lines = completed.stderr.strip().splitlines() or [
            f"it ended with status {completed.returncode}"
        ]
        raise InputError(f"{script}: no job was submitted: {lines[-1]}")
    return completed.stdout.strip()


def _submission(campaign: str, job: Job, sbatch: list[str]) -> str:
    """The line that submits a job. The user's options come last and take precedence."""
    array = [f"--array=0-{len(job.recordings) - 1}"] if job.recordings else []
    log = f"{job.name}.%a.log" if job.recordings else f"{job.name}.log"
    names = [f"--job-name={campaign}-{job.name}", f"--output={log}"]
    words = [*array, *names, *job.options, *sbatch]
    after = ",".join(
        f"{condition}:${{{dependency.variable}}}" for condition, dependency in job.after
    )
    option = f'--dependency="{after}" ' if after else ""
    return f"submit {job.variable} {option}{shlex.join(words)} {job.name}.sh\n"


def _script(folder: Folder, job: Job) -> str:
    """The script of a job: this command in this environment."""
    text = JOB.format(
        summary=job.summary,
        here=shlex.quote(os.getcwd()),
        package=shlex.quote(os.fspath(pathlib.Path(broadmark.__file__).resolve().parents[1])),
        variable=VARIABLE,
        program=shlex.quote(os.path.abspath(find_program())),
    )
    command = [sys.executable, "-m", "broadmark", "campaign", os.fspath(folder.campaign)]
    command += ["--output", os.fspath(folder.path), "--quiet", *job.arguments]
    if not job.recordings:
        return f"{text}exec {shlex.join(command)}\n"
    names = "".join(f"  {shlex.quote(recording.name)}\n" for recording in job.recordings)
    task = '--recording "${recordings[SLURM_ARRAY_TASK_ID]}"'
    return f"{text}recordings=(\n{names})\nexec {shlex.join(command)} {task}\n"
