"""The folder of a campaign and its layout.

- `campaign.json`: a copy of the campaign file
- `recordings/bullet seed=1/…`: a folder for each engine, seed and parameters
- `runs/RECORDING/1.jsonl …`: an attempt per call of the program (attempts.py)
- `results.json`: all finished cases
- `slurm/`: job scripts and logs
"""

from __future__ import annotations

import contextlib
import fcntl
import itertools
import pathlib
from collections.abc import Callable, Iterable, Iterator
from typing import TextIO

from broadmark.campaign.attempts import PARTIAL_SUFFIX, outcome_of, read_attempt, variant_of
from broadmark.campaign.description import Campaign, read_campaign
from broadmark.campaign.ledger import Ledger
from broadmark.campaign.plan import Recording, incompatibility
from broadmark.errors import InputError
from broadmark.files import atomic_write
from broadmark.recording2 import ChangingRecording, Groups
from broadmark.recordings import PoseRecording, read_recording, write_recording

SUBFOLDERS = {
    "aabbs": "Recordings_AABBs",
    "broadmark": "Recordings_Broadmark",
    "posrot": "Recordings_PositionRotation",
}
#: The formats of recordings that are run. `bake` uses the first format that can hold the scene.
BOX_FORMATS = ("aabbs", "broadmark")


class Folder:
    """A campaign's folder. `names` maps scene and object type to the prefix of recordings' file names,
    such as "FreeFall Cubes"."""

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
        """Raises InputError unless `campaign` extends the campaign of an existing folder."""
        if not self.campaign.exists():
            return
        difference = incompatibility(read_campaign(self.campaign), campaign)
        if difference:
            raise InputError(
                f"{self.path}: holds another campaign: {difference}; recordings and variants may only "
                "be added: choose another --output"
            )

    def claim(self, campaign: Campaign) -> None:
        """Creates the folder and stores the campaign."""
        self.require_same(campaign)
        try:
            self.path.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise InputError(f"{self.path}: cannot be created: {error.strerror}") from None
        if not self.campaign.exists() or self.campaign.read_text("utf-8") != campaign.text:
            with atomic_write(self.campaign) as file:
                file.write(campaign.text.encode())

    def bake_folder(self, recording: Recording) -> pathlib.Path:
        """The output folder of `bake`, which adds a subfolder per format."""
        return self.path / "recordings" / recording.series.variation

    def file(self, recording: Recording) -> pathlib.Path:
        """The path of the file to run, which may not exist."""
        files = [self._path_of(recording, format_) for format_ in BOX_FORMATS]
        return next((file for file in files if file.exists()), files[0])

    def poses(self, recording: Recording) -> pathlib.Path:
        """The path of the file to split, which may not exist."""
        return self._path_of(recording, "posrot")

    def is_baked(self, recording: Recording) -> bool:
        exists = self.file(recording).exists()
        return exists and (not recording.is_split or self.poses(recording).exists())

    def cut(self, recording: Recording) -> None:
        """Writes the file of a recording that is a part of another."""
        assert recording.whole and recording.span
        path = self.file(recording.whole)
        whole = read_recording(path)
        if isinstance(whole, PoseRecording):
            raise InputError(f"{path}: has poses, not boxes")
        first, last = recording.span
        frames = range(first, last + 1)
        groups: Groups | Iterable[Groups] | None = None
        if isinstance(whole, ChangingRecording):
            boxes = (boxes for boxes, _ in itertools.islice(whole.frames(), first, last + 1))
            groups = map(whole.groups_at, frames) if whole.filter_changes else whole.groups
        else:
            boxes = (whole.boxes[k] for k in frames)
        file = self._path_of(recording, path.suffix[1:])
        file.parent.mkdir(parents=True, exist_ok=True)
        write_recording(
            file,
            boxes,
            name=whole.name,
            object_type=whole.object_type,
            world=whole.world,
            groups=groups,
        )

    def _path_of(self, recording: Recording, format_: str) -> pathlib.Path:
        if recording.span:
            return self.bake_folder(recording) / "spans" / f"{recording.name}.{format_}"
        series = recording.series
        name = self._names[series.scene.lower(), series.object_type.lower()]
        stem = f"{name} N{recording.objects} F{recording.frames}frames"
        return self.bake_folder(recording) / SUBFOLDERS[format_] / f"{stem}.{format_}"

    def runs(self, recording: Recording) -> pathlib.Path:
        return self.path / "runs" / recording.name

    def attempts(self, recording: Recording) -> list[pathlib.Path]:
        """The paths of the attempts, the oldest first."""
        paths = self.runs(recording).glob("*.jsonl")
        return sorted(paths, key=lambda path: int(path.name.split(".")[0]))

    def load(self, recording: Recording, ledger: Ledger) -> None:
        """Adds the finished cases of a recording to the ledger."""
        for path in self.attempts(recording):
            for line in read_attempt(path):
                if line.kind == "case":
                    ledger.add(recording, variant_of(line.content), outcome_of(line.content))

    def new_attempt(self, recording: Recording) -> pathlib.Path:
        """Creates an empty file for an attempt. Safe against concurrent processes."""
        for number in itertools.count(len(self.attempts(recording)) + 1):
            path = self.runs(recording) / f"{number}{PARTIAL_SUFFIX}"
            with contextlib.suppress(FileExistsError):
                path.open("x").close()
                return path
        raise AssertionError

    @contextlib.contextmanager
    def lock(self, recording: Recording, waiting: Callable[[], None]) -> Iterator[TextIO]:
        """Locks the recording against other processes; calls `waiting` before it blocks. A program that
        inherits the file keeps the lock until it ends, even after this process."""
        self.runs(recording).mkdir(parents=True, exist_ok=True)
        with open(self.runs(recording) / "lock", "w", encoding="utf-8") as file:
            try:
                fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                waiting()
                fcntl.flock(file, fcntl.LOCK_EX)
            except OSError:
                pass  # the file system has no locks; attempts have unique files anyway
            yield file


def recorder_options(recording: Recording) -> list[str] | None:
    """The formats to bake a recording in; None: the default for the scene."""
    if not recording.is_split and not recording.is_cut:
        return None
    # Recordings to be cut are long: without bodies at rest they are much smaller.
    return ["broadmark" if recording.is_cut else "aabbs", *(["posrot"] * recording.is_split)]
