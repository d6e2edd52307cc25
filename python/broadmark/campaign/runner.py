"""Bakes and runs what is missing, size by size: what the cap leaves out is known before the next
size begins, and a recording that no variant needs any more is not even baked."""

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

from broadmark.campaign.attempts import Tail, outcome_of, variant_of, whole
from broadmark.campaign.description import Campaign, Selection, Value
from broadmark.campaign.estimate import Estimate
from broadmark.campaign.folder import Folder, recorders_of
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
    copy_to: str | None = None  #: a folder, for the time of a run
    failed: bool = False  #: something could not be baked or run

    def run(self, recordings: Iterable[Recording], bake_only: bool = False) -> None:
        """What fails is told, and left out."""
        for _, level in levels(recordings):
            if not bake_only:
                level = [one for one in level if self.ledger.pending(one)]
            baked = self._bake(level)
            for recording in [] if bake_only else baked:
                try:
                    self._run_recording(recording)
                except (InputError, OSError) as error:
                    self._fail(f"{recording.name}: {error}")

    def _fail(self, message: str) -> None:
        self.failed = True
        self.progress.complain(message)

    def _bake(self, recordings: list[Recording]) -> list[Recording]:
        """Returns those that are as they should be: the program reads through what is there."""

        def together(one: Recording) -> tuple[int, str, bool]:
            return one.objects, one.series.variation, one.is_split

        failed: set[Recording] = set()
        needed = sorted(with_sources(recordings), key=together)
        for _, same in itertools.groupby(needed, key=together):
            group = list(same)
            missing = [one for one in group if not self.folder.is_baked(one)]
            if missing:
                self.progress.event(f"baking: {_names(missing)}")
            try:
                with self.estimate.baking(missing):
                    self._bake_together(group)
            except InputError as error:
                self._fail(f"{_names(group)}: {error}")
                failed.update(group)
        return [one for one in recordings if failed.isdisjoint(with_sources([one]))]

    def _bake_together(self, recordings: list[Recording]) -> None:
        """Recordings of one folder and of the same kinds."""
        with tempfile.TemporaryDirectory(prefix="broadmark-") as temporary:
            files = []
            for number, recording in enumerate(recordings):
                files.append(os.path.join(temporary, f"{number}.json"))
                pathlib.Path(files[-1]).write_text(self._scene_parameters(recording), "utf-8")
            follow(
                "bake",
                *itertools.chain(*(("--parameters", file) for file in files)),
                *plugin_options(self.campaign),
                *as_options(recorder=recorders_of(recordings[0]), quiet=True),
                *("--output", str(self.folder.home(recordings[0]))),
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
            self.progress.event(f"waiting for another process that runs it: {recording.name}")

        with self.folder.lock(recording, waiting) as lock, self._at_hand(recording) as path:
            self.folder.load(recording, self.ledger)  # another process may have run it meanwhile
            for selection in self.campaign.selections:
                pending = [
                    one for one in self.ledger.pending(recording) if self.variants[one] == selection
                ]
                if pending:
                    self._run_cases(recording, path, selection, pending, lock.fileno())

    def _run_cases(
        self, recording: Recording, path: str, selection: Selection, pending: list[str], lock: int
    ) -> None:
        """One call of the program, so that the repetitions of all these cases take turns."""
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
        attempt.rename(whole(attempt))

    @contextlib.contextmanager
    def _at_hand(self, recording: Recording) -> Iterator[str]:
        """The recording's file, or a copy for the time of a run."""
        file = self.folder.file(recording)
        if self.copy_to is None:
            yield str(file)
            return
        place = os.path.expandvars(self.copy_to)
        if "$" in place:
            raise InputError(f"--copy-to: '{self.copy_to}': such a variable is not set")
        try:
            temporary = tempfile.TemporaryDirectory(dir=place, prefix="broadmark-")
        except OSError as error:
            raise InputError(f"--copy-to: '{place}': {error.strerror}") from None
        with temporary as copies:
            try:
                copy = shutil.copy(file, copies)
            except OSError as error:
                raise InputError(f"--copy-to: {file}: cannot be copied: {error}") from None
            yield copy


def _names(recordings: list[Recording]) -> str:
    return ", ".join(one.name for one in recordings)
