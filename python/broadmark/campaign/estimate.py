"""How long the rest of a campaign will take. A simple model, documented in docs/campaigns.md:

- A frame of a case takes as long as the same variant took on the next smaller recording of the
  series, times the ratio of their sizes; 0.2 µs a body if it was not run on any yet.
- A case takes its frames, as often as it is repeated; one past the time limit takes three frames.
- Beside that a case takes a tenth of a second, for its process, and what has been more so far, such as
  checks, in proportion.
- Baking takes as long per body and frame as it has so far, splitting and simulating apart.
"""

from __future__ import annotations

import contextlib
import time
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any

from broadmark.campaign.ledger import Ledger
from broadmark.campaign.plan import Recording

SECONDS_PER_BODY = 2e-7  #: of a frame, before the variant has run
SECONDS_PER_CASE = 0.1
BESIDE = 2.0  #: time in proportion to what is measured, before anything has run
SPLITTING, SIMULATING = 4e-8, 4e-6  #: per body and frame, likewise
FEWEST_SECONDS = 1.0  #: baking that takes less tells nothing about large recordings

FRAMES_TO_TIMEOUT = 3
FEWEST_AUTO_REPETITIONS = 5
USUAL_TIME_LIMIT = 0.5


@dataclass
class _Work:
    """What is being done: baking these recordings or, with variants, running them on one."""

    recordings: list[Recording]
    variants: list[str]
    predicted: float
    begin: float


class Estimate:
    """Seconds that cases and recordings will take, corrected by those that they did take."""

    def __init__(self, ledger: Ledger, options: dict[str, Any]) -> None:
        self._ledger = ledger
        repetitions = options.get("repetitions", 1)
        self._passes: int = options.get("warmup", 0) + (
            FEWEST_AUTO_REPETITIONS if repetitions == "auto" else repetitions
        )
        self._limit: float = options.get("time_limit", USUAL_TIME_LIMIT)
        self._ran = self._measured = 0.0
        self._rates = {True: SPLITTING, False: SIMULATING}  # by whether it is split
        self._work = _Work([], [], 0, 0)

    @contextlib.contextmanager
    def baking(self, recordings: list[Recording]) -> Iterator[None]:
        """Learns from how long these take."""
        predicted = sum(map(self._of_bake, recordings))
        with self._working(_Work(recordings, [], predicted, time.monotonic())) as work:
            yield
        taken = time.monotonic() - work.begin
        if predicted and taken > FEWEST_SECONDS:
            for split in {one.source is not None for one in recordings}:
                self._rates[split] *= taken / predicted

    @contextlib.contextmanager
    def running(self, recording: Recording, variants: list[str]) -> Iterator[None]:
        """Learns from how long these take."""
        predicted = sum(self._of_case(recording, one) for one in variants)
        with self._working(_Work([recording], variants, predicted, time.monotonic())) as work:
            yield
        self._ran += time.monotonic() - work.begin - SECONDS_PER_CASE * len(variants)
        self._measured += sum(self._measured_in(recording, one) for one in variants)

    def left(self, unbaked: Iterable[Recording]) -> float:
        """Of the whole campaign."""
        if not self._ledger.to_run:
            return 0.0
        work = self._work
        running = {(one, variant) for one in work.recordings for variant in work.variants}
        cases = (
            self._of_case(recording, variant)
            for recording in self._ledger.recordings
            for variant in self._ledger.pending(recording)
            if (recording, variant) not in running
        )
        bakes = (self._of_bake(one) for one in unbaked if one not in work.recordings)
        under_way = max(0.0, work.predicted - (time.monotonic() - work.begin))
        return under_way + sum(cases) + sum(bakes)

    @contextlib.contextmanager
    def _working(self, work: _Work) -> Iterator[_Work]:
        self._work = work
        try:
            yield work
        finally:
            self._work = _Work([], [], 0, 0)

    @property
    def _beside(self) -> float:
        return max(1.0, self._ran / self._measured) if self._measured else BESIDE

    def _of_case(self, recording: Recording, variant: str) -> float:
        return SECONDS_PER_CASE + self._beside * self._measured_in(recording, variant)

    def _measured_in(self, recording: Recording, variant: str) -> float:
        """What the clocks of a case show."""
        frame = self._per_body(recording, variant) * recording.objects
        frames = recording.frames * self._passes
        return frame * (frames if frame < self._limit else min(frames, FRAMES_TO_TIMEOUT))

    def _per_body(self, recording: Recording, variant: str) -> float:
        """Seconds of a frame, for each body."""
        known = self._ledger.times(recording.series, variant)
        if not known:
            return SECONDS_PER_BODY
        objects = max((one for one in known if one <= recording.objects), default=min(known))
        return known[objects] / max(objects, 1)

    def _of_bake(self, recording: Recording) -> float:
        rate = self._rates[recording.source is not None]
        return rate * recording.objects * recording.frames
