"""Runs a campaign: many cases that one file states, on this machine or as jobs of Slurm.

Bakes what is missing, runs what is not finished, and writes all results as one file. After whatever
interrupted it, the same command goes on. docs/campaigns.md describes the file.
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
from broadmark.campaign.plan import Recording, planned_recordings
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
        help="folder for recordings and results (default: the file's name without .json, here)",
    )
    what = parser.add_mutually_exclusive_group()
    what.add_argument("--list", action="store_true", help="show how it stands, run nothing")
    what.add_argument("--bake", action="store_true", help="bake what is missing, run nothing")
    what.add_argument(
        "--merge", action="store_true", help="write the results there are, run nothing"
    )
    parser.add_argument("--recording", metavar="NAME", help="only this one, named as by --list")
    parser.add_argument(
        "--copy-to",
        metavar="DIR",
        help="copy each recording there while it is run; may be '$TMPDIR'",
    )
    parser.add_argument("--quiet", action="store_true", help="no progress")
    parser.add_argument(
        "--slurm",
        action="store_true",
        help="write jobs for Slurm and submit them; with --list: only write them",
    )
    parser.add_argument(
        "--sbatch",
        default="",
        metavar="OPTIONS",
        help="options for all jobs: --sbatch='--partition=x --time=2:00:00'",
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
        folder.take(campaign)
    ledger = Ledger(recordings, list(variants))
    concerned = {one.series for one in chosen}  # the cap goes by smaller recordings, too
    for recording in recordings:
        if recording.series in concerned:
            folder.load(recording, ledger)
    estimate = Estimate(ledger, campaign.options)

    def missing() -> list[Recording]:
        return [one for one in chosen if ledger.pending(one) and not folder.is_baked(one)]

    if options.slurm:
        return _hand_over(folder, ledger, options)
    failed = False
    if not options.list and not options.merge:
        progress = Progress(ledger, estimate, missing, options.quiet)
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
        room = sum(one.bytes for one in missing()) / 1e9
        print(
            f"{ledger.finished} cases are finished, {ledger.to_run} are to be run; "
            f"{len(missing())} recordings are to be baked, {room:.1f} GB; "
            f"about {long_time(estimate.left(missing()))}"
        )
        return 0
    return 1 if ledger.has_wrong(chosen) else 2 if failed else 0


def _chosen(recordings: list[Recording], options: argparse.Namespace) -> list[Recording]:
    if options.slurm and (options.recording or options.bake or options.merge):
        raise InputError("--slurm: makes jobs of the whole campaign: only --list goes with it")
    if options.recording is None:
        return recordings
    chosen = [one for one in recordings if one.name == options.recording]
    if not chosen:
        raise InputError(f"--recording: '{options.recording}' is none of those that --list shows")
    return chosen


def _hand_over(folder: Folder, ledger: Ledger, options: argparse.Namespace) -> int:
    jobs = slurm.planned_jobs(folder, ledger, options.copy_to)
    if not jobs:
        print("nothing is left to run")
        return 0
    script = slurm.write(folder, jobs, options.sbatch)
    if options.list:
        print(f"written: {script} and the jobs beside it")
    else:
        print(f"submitted: {slurm.submit(script)}")
    return 0


@contextlib.contextmanager
def _interruptible(progress: Progress, ledger: Ledger) -> Iterator[None]:
    """Termination, as by Slurm, is an interruption; what is kept is told."""
    former = signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        yield
    except KeyboardInterrupt:
        progress.complain(f"{ledger.finished} cases are finished; the same command goes on")
        raise
    finally:
        signal.signal(signal.SIGTERM, former)
        progress.end()
