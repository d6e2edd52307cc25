"""Bakes missing recordings and runs pending cases in ascending order of size. The cap is known before
the next size begins, so a recording without pending variants is not baked."""

from __future__ import annotations

import contextlib
import itertools
import json
import os
import pathlib
import shutil
import tempfile
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from broadmark.campaign.attempts import Tail, completed_path, outcome_of, variant_of
from broadmark.campaign.description import Campaign, Selection, Value
from broadmark.campaign.estimate import Estimate
from broadmark.campaign.folder import Folder, recorder_options
from broadmark.campaign.ledger import Ledger
from broadmark.campaign.options import (
    filter_for,
    measuring_request,
    plugin_options,
    selection_request,
)
from broadmark.campaign.plan import Recording, levels, with_sources
from broadmark.campaign.progress import Progress
from broadmark.errors import InputError
from broadmark.program import WITH_RESULTS, as_options, follow, request_file

SCENE_PARAMETERS = "broadmark-scene-parameters/1"


@dataclass
class Runner:
    """Runs the recordings of a campaign."""

    campaign: Campaign
    folder: Folder
    ledger: Ledger
    variants: dict[str, Selection]
    estimate: Estimate
    progress: Progress
    copy_to: str | None = None  #: a folder for copies of recordings while they are run
    failed: bool = False  #: a recording could not be baked or run

    def run(self, recordings: Iterable[Recording], bake_only: bool = False) -> None:
        """Bakes and runs the recordings. Failures are reported and skipped."""
        for _, level in levels(recordings):
            if not bake_only:
                level = [recording for recording in level if self.ledger.pending(recording)]
            baked = self._bake(level)
            for recording in [] if bake_only else baked:
                try:
                    self._run_recording(recording)
                except (InputError, OSError) as error:
                    self._report_failure(f"{recording.name}: {error}")

    def _report_failure(self, message: str) -> None:
        self.failed = True
        self.progress.report_error(message)

    def _bake(self, recordings: list[Recording]) -> list[Recording]:
        """Bakes missing recordings, verifies existing ones and returns the valid ones."""

        def group_key(recording: Recording) -> tuple[int, str, bool, bool]:
            series = recording.series
            return recording.objects, series.variation, recording.is_split, recording.is_cut

        failed: set[Recording] = set()
        needed = sorted(
            (recording for recording in with_sources(recordings) if not recording.span),
            key=group_key,
        )
        for _, recordings_of_key in itertools.groupby(needed, key=group_key):
            group = list(recordings_of_key)
            with self._bake_lock(group[0]):
                missing = [recording for recording in group if not self.folder.is_baked(recording)]
                if missing:
                    self.progress.event(f"baking: {_names(missing)}")
                try:
                    with self.estimate.baking(missing):
                        self._bake_group(group)
                except InputError as error:
                    self._report_failure(f"{_names(group)}: {error}")
                    failed.update(group)
        valid = [
            recording for recording in recordings if failed.isdisjoint(with_sources([recording]))
        ]
        for recording in valid:
            if recording.span and not self.folder.is_baked(recording):
                self.folder.cut(recording)
        return valid

    def _bake_lock(self, recording: Recording) -> contextlib.AbstractContextManager[object]:
        """Processes that run parts of the same recording at the same time bake it once."""

        def waiting() -> None:
            self.progress.event(f"waiting for another process that bakes {recording.name}")

        if not recording.is_cut:
            return contextlib.nullcontext()
        return self.folder.lock(recording, waiting)

    def _bake_group(self, recordings: list[Recording]) -> None:
        """Bakes recordings with the same folder and formats by a single call."""
        with tempfile.TemporaryDirectory(prefix="broadmark-") as temporary:
            files = []
            for number, recording in enumerate(recordings):
                files.append(os.path.join(temporary, f"{number}.json"))
                pathlib.Path(files[-1]).write_text(self._scene_parameters(recording), "utf-8")
            follow(
                "bake",
                *itertools.chain(*(("--parameters", file) for file in files)),
                *plugin_options(self.campaign),
                *as_options(recorder=recorder_options(recordings[0]), quiet=True),
                *("--output", str(self.folder.bake_folder(recordings[0]))),
                tick=self.progress.tick,
            )

    def _scene_parameters(self, recording: Recording) -> str:
        series = recording.series
        parameters: dict[str, Value] = {
            "objects": recording.objects,
            "frames": recording.frames,
            "object_type": series.object_type,
        }
        if recording.source:
            source = self.folder.poses(recording.source).absolute()
            parameters |= {"engine": "splitter", "input": os.fspath(source)}
        else:
            parameters |= series.parameters
            parameters["seed"] = series.seed
            if series.engine:
                parameters["engine"] = series.engine
        return json.dumps(
            {"schema": SCENE_PARAMETERS, "scene": series.scene, "parameters": parameters}
        )

    def _run_recording(self, recording: Recording) -> None:
        def waiting() -> None:
            self.progress.event(f"waiting for another process that runs {recording.name}")

        with self.folder.lock(recording, waiting) as lock, self._local_copy(recording) as path:
            self.folder.load(recording, self.ledger)  # another process may have run it
            for selection in self.campaign.selections:
                pending = [
                    variant
                    for variant in self.ledger.pending(recording)
                    if self.variants[variant] == selection
                ]
                if pending:
                    self._run_cases(recording, path, selection, pending, lock.fileno())

    def _run_cases(
        self, recording: Recording, path: str, selection: Selection, pending: list[str], lock: int
    ) -> None:
        """Runs the cases by a single call, which interleaves their repetitions."""
        self.progress.event(f"running {len(pending)} cases: {recording.name}")
        attempt = self.folder.new_attempt(recording)
        tail = Tail(attempt)

        def tick() -> None:
            for case in tail.new_cases():
                variant, outcome = variant_of(case), outcome_of(case)
                self.ledger.add(recording, variant, outcome)
                self.progress.case(recording, variant, outcome)
            self.progress.tick()

        request = {
            "source": path,
            **selection_request(self.campaign, selection),
            **measuring_request(self.campaign),
            **dict(recording.options),
            "allow_timeout": True,
            "filter": filter_for(pending),
            "jsonl": str(attempt),
        }
        with self.estimate.running(recording, pending), request_file(**request) as file:
            follow(
                *("--headless", "--request", file, "--quiet"),
                tick=tick,
                accept=WITH_RESULTS,
                keep_open=(lock,),
            )
        attempt.rename(completed_path(attempt))

    @contextlib.contextmanager
    def _local_copy(self, recording: Recording) -> Iterator[str]:
        """The path of the recording's file, or of a temporary copy in `copy_to`."""
        file = self.folder.file(recording)
        if self.copy_to is None:
            yield str(file)
            return
        copy_folder = os.path.expandvars(self.copy_to)
        if "$" in copy_folder:
            raise InputError(f"--copy-to: '{self.copy_to}': the variable is not set")
        try:
            temporary = tempfile.TemporaryDirectory(dir=copy_folder, prefix="broadmark-")
        except OSError as error:
            raise InputError(f"--copy-to: '{copy_folder}': {error.strerror}") from None
        with temporary as temporary_folder:
            try:
                copy = shutil.copy(file, temporary_folder)
            except OSError as error:
                raise InputError(f"--copy-to: {file}: cannot be copied: {error}") from None
            yield copy


def _names(recordings: list[Recording]) -> str:
    return ", ".join(recording.name for recording in recordings)
