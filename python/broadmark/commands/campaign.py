"""Runs a campaign, many cases described in one file, on this machine or as Slurm jobs.

Bakes missing recordings, runs unfinished cases and writes all results to one file. After an
interruption, the same command resumes the campaign. docs/campaigns.md describes the file.
"""

from __future__ import annotations

import argparse
import contextlib
import pathlib
import signal
from collections.abc import Iterator

from broadmark.campaign import slurm
from broadmark.campaign.description import read_campaign
from broadmark.campaign.estimate import Estimate
from broadmark.campaign.folder import Folder
from broadmark.campaign.ledger import Ledger
from broadmark.campaign.merging import merge
from broadmark.campaign.options import planned_variants, recording_names
from broadmark.campaign.plan import Recording, planned_recordings, with_sources
from broadmark.campaign.progress import Progress, long_time
from broadmark.campaign.runner import Runner
from broadmark.campaign.summary import table
from broadmark.errors import InputError


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("campaign", type=pathlib.Path, metavar="FILE", help="the campaign (.json)")
    parser.add_argument(
        *("-o", "--output"),
        type=pathlib.Path,
        metavar="DIR",
        help="folder for recordings and results (default: the file's name without .json, in the current folder)",
    )
    mode = parser.add_mutually_exclusive_group()
    mode.add_argument("--list", action="store_true", help="only show the state of the campaign")
    mode.add_argument("--bake", action="store_true", help="only bake missing recordings")
    mode.add_argument("--merge", action="store_true", help="only merge the existing results")
    parser.add_argument(
        "--recording", metavar="NAME", help="only this recording, named as by --list"
    )
    parser.add_argument(
        "--copy-to",
        metavar="DIR",
        help="copy each recording to DIR before it is run; may be '$TMPDIR'",
    )
    parser.add_argument("--quiet", action="store_true", help="suppress progress output")
    parser.add_argument(
        "--slurm",
        action="store_true",
        help="write Slurm jobs and submit them; with --list, only write them",
    )
    parser.add_argument(
        "--sbatch",
        default="",
        metavar="OPTIONS",
        help="sbatch options for all jobs: --sbatch='--partition=x --time=2:00:00'",
    )


def main(options: argparse.Namespace) -> int:
    campaign = read_campaign(options.campaign)
    recordings = planned_recordings(campaign)
    chosen = _chosen(recordings, options)
    folder = Folder(options.output or pathlib.Path(campaign.path.stem), recording_names(campaign))
    variants = planned_variants(campaign)
    if options.list and not options.slurm:
        folder.require_same(campaign)
    else:
        folder.claim(campaign)
    ledger = Ledger(recordings, list(variants))
    # The cap depends on all smaller recordings of a series.
    chosen_series = {recording.series for recording in chosen}
    for recording in recordings:
        if recording.series in chosen_series:
            folder.load(recording, ledger)
    estimate = Estimate(ledger, campaign.options)

    def missing_recordings() -> list[Recording]:
        unbaked = (r for r in chosen if ledger.pending(r) and not folder.is_baked(r))
        return [r for r in with_sources(unbaked) if not folder.is_baked(r)]

    if options.slurm:
        return _write_jobs(folder, ledger, options)
    failed = False
    if not options.list and not options.merge:
        progress = Progress(ledger, estimate, missing_recordings, options.quiet)
        runner = Runner(campaign, folder, ledger, variants, estimate, progress, options.copy_to)
        with _interruptible(progress, ledger):
            runner.run(chosen, bake_only=options.bake)
        failed = runner.failed
    if not options.list and chosen == recordings and merge(folder, ledger):
        print(f"written: {folder.results}")
    if campaign.title:
        print(campaign.title)
    print(table(ledger, chosen, folder.is_baked))
    if options.list:
        gigabytes = sum(recording.bytes for recording in missing_recordings()) / 1e9
        print(
            f"{ledger.finished} cases are finished, {ledger.to_run} remain; "
            f"{len(missing_recordings())} recordings remain to be baked, at most {gigabytes:.1f} GB; "
            f"about {long_time(estimate.remaining(missing_recordings()))}"
        )
        return 0
    return 1 if ledger.has_failures(chosen) else 2 if failed else 0


def _chosen(recordings: list[Recording], options: argparse.Namespace) -> list[Recording]:
    if options.slurm and (options.recording or options.bake or options.merge):
        raise InputError(
            "--slurm: jobs are for the whole campaign: --recording, --bake and --merge are not allowed"
        )
    if options.recording is None:
        return recordings
    chosen = [recording for recording in recordings if recording.name == options.recording]
    if not chosen:
        raise InputError(f"--recording: '{options.recording}' is not a recording shown by --list")
    return chosen


def _write_jobs(folder: Folder, ledger: Ledger, options: argparse.Namespace) -> int:
    jobs = slurm.planned_jobs(folder, ledger, options.copy_to)
    if not jobs:
        print("no case is left to run")
        return 0
    script = slurm.write(folder, jobs, options.sbatch)
    if options.list:
        print(f"written: {script} and its jobs")
    else:
        print(f"submitted: {slurm.submit(script)}")
    return 0


@contextlib.contextmanager
def _interruptible(progress: Progress, ledger: Ledger) -> Iterator[None]:
    """Handles termination, for example by Slurm, as an interruption. Reports the finished cases."""
    previous_handler = signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        yield
    except KeyboardInterrupt:
        progress.report_error(
            f"{ledger.finished} cases are finished; rerun the same command to resume"
        )
        raise
    finally:
        signal.signal(signal.SIGTERM, previous_handler)
        progress.end()
