"""The folder of a campaign: what lies where.

    campaign.json                          a copy of the campaign file
    recordings/bullet seed=1/…             a folder for each engine, seed and parameters
    runs/RECORDING/1.jsonl …               an attempt for each call of the program (attempts.py)
    results.json                           all finished cases
    slurm/                                 job scripts and their output
"""

from __future__ import annotations

import contextlib
import fcntl
import itertools
import pathlib
from collections.abc import Callable, Iterator
from typing import TextIO

from broadmark.campaign.attempts import PART, outcome_of, read_attempt, variant_of
from broadmark.campaign.description import Campaign, read_campaign
from broadmark.campaign.ledger import Ledger
from broadmark.campaign.plan import Recording, shrunk
from broadmark.errors import InputError
from broadmark.files import whole_file

KINDS = {
    "aabbs": "Recordings_AABBs",
    "broadmark": "Recordings_Broadmark",
    "posrot": "Recordings_PositionRotation",
}
#: Those that a scene is run on: `bake` takes the first that can hold it.
BOX_KINDS = ("aabbs", "broadmark")


class Folder:
    """A campaign's folder. `names` are those that recordings' files begin with, such as
    "FreeFall Cubes", by scene and object type."""

    def __init__(self, path: pathlib.Path, names: dict[tuple[str, str], str]) -> None:
        self.path = path
        self._names = names

    @property
    def results(self) -> pathlib.Path:
        return self.path / "results.json"

    @property
    def campaign(self) -> pathlib.Path:
        return self.path / "campaign.json"

    def require_same(self, campaign: Campaign) -> None:
        """Raises InputError if the folder holds a campaign that this one does not contain."""
        if not self.campaign.exists():
            return
        change = shrunk(read_campaign(self.campaign), campaign)
        if change:
            raise InputError(
                f"{self.path}: holds another campaign: {change}; a campaign may only grow in "
                "recordings and variants: choose another --output"
            )

    def take(self, campaign: Campaign) -> None:
        """Makes it the folder of this campaign."""
        self.require_same(campaign)
        try:
            self.path.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise InputError(f"{self.path}: cannot be made: {error.strerror}") from None
        if not self.campaign.exists() or self.campaign.read_text("utf-8") != campaign.text:
            with whole_file(self.campaign) as file:
                file.write(campaign.text.encode())

    def home(self, recording: Recording) -> pathlib.Path:
        """Where `bake` puts a recording, into a folder of its kind."""
        return self.path / "recordings" / recording.series.variation

    def file(self, recording: Recording) -> pathlib.Path:
        """The file that a recording is run on, whether it is there or not."""
        files = [self._file(recording, kind) for kind in BOX_KINDS]
        return next((file for file in files if file.exists()), files[0])

    def poses(self, recording: Recording) -> pathlib.Path:
        """The file that a recording is split from, likewise."""
        return self._file(recording, "posrot")

    def is_baked(self, recording: Recording) -> bool:
        there = self.file(recording).exists()
        return there and (not recording.is_split or self.poses(recording).exists())

    def _file(self, recording: Recording, kind: str) -> pathlib.Path:
        series = recording.series
        name = self._names[series.scene.lower(), series.object_type.lower()]
        stem = f"{name} N{recording.objects} F{recording.frames}frames"
        return self.home(recording) / KINDS[kind] / f"{stem}.{kind}"

    def runs(self, recording: Recording) -> pathlib.Path:
        return self.path / "runs" / recording.name

    def attempts(self, recording: Recording) -> list[pathlib.Path]:
        """The oldest first."""
        paths = self.runs(recording).glob("*.jsonl")
        return sorted(paths, key=lambda path: int(path.name.split(".")[0]))

    def load(self, recording: Recording, ledger: Ledger) -> None:
        """Enters into the ledger what has been run on a recording."""
        for path in self.attempts(recording):
            for line in read_attempt(path):
                if line.kind == "case":
                    ledger.add(recording, variant_of(line.content), outcome_of(line.content))

    def new_attempt(self, recording: Recording) -> pathlib.Path:
        """An empty file that is nobody else's."""
        for number in itertools.count(len(self.attempts(recording)) + 1):
            path = self.runs(recording) / f"{number}{PART}"
            with contextlib.suppress(FileExistsError):
                path.open("x").close()
                return path
        raise AssertionError

    @contextlib.contextmanager
    def lock(self, recording: Recording, waiting: Callable[[], None]) -> Iterator[TextIO]:
        """Waits until no other process runs the recording, and tells when it has to. A program that
        outlived the process that began it holds the lock, too, if it was given the file."""
        self.runs(recording).mkdir(parents=True, exist_ok=True)
        with open(self.runs(recording) / "lock", "w", encoding="utf-8") as file:
            try:
                fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                waiting()
                fcntl.flock(file, fcntl.LOCK_EX)
            except OSError:
                pass  # the file system knows no locks; attempts are still files of their own
            yield file


def recorders_of(recording: Recording) -> list[str] | None:
    """The kinds that a recording is baked as; None: what suits the scene."""
    return ["aabbs", "posrot"] if recording.is_split else None
