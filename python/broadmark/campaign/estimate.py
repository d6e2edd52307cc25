"""An estimate of a campaign's remaining time. The model is documented in docs/campaigns.md:

- A frame takes the time of the same variant on the next smaller recording of the series, scaled by
  the number of bodies; 0.2 µs per body for a variant without results.
- A case takes the time of its frames times its repetitions; beyond the time limit, three frames.
- The overhead of a case is a tenth of a second for its process and a share of the measured time, for
  checks and the like, taken from the finished cases.
- Baking takes the time per body and frame of earlier baking; split and simulated recordings have
  separate rates.
"""

from __future__ import annotations

import contextlib
import time
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any

from broadmark.campaign.ledger import Ledger
from broadmark.campaign.plan import Recording

SECONDS_PER_BODY = 2e-7  #: per frame, for a variant without results
SECONDS_PER_CASE = 0.1
DEFAULT_OVERHEAD = 2.0  #: total time per measured time, before a case has finished
SPLITTING, SIMULATING = 4e-8, 4e-6  #: initial rates: seconds per body and frame
MIN_LEARNING_SECONDS = 1.0  #: shorter baking is no evidence for large recordings

FRAMES_TO_TIMEOUT = 3
MIN_AUTO_REPETITIONS = 5
DEFAULT_TIME_LIMIT = 0.5


@dataclass
class _Work:
    """The current work: baking the recordings or, with variants, running them on a recording."""

    recordings: list[Recording]
    variants: list[str]
    predicted: float
    begin: float


class Estimate:
    """The predicted time of cases and recordings, corrected by the time of finished work."""

    def __init__(self, ledger: Ledger, options: dict[str, Any]) -> None:
        self._ledger = ledger
        self._options = options
        self._limit: float = options.get("time_limit", DEFAULT_TIME_LIMIT)
        self._total = self._measured = 0.0
        self._rates = {True: SPLITTING, False: SIMULATING}  # by whether the recording is split
        self._work = _Work([], [], 0, 0)

    @contextlib.contextmanager
    def baking(self, recordings: list[Recording]) -> Iterator[None]:
        """Updates the model with the time of the with block."""
        predicted = sum(map(self._bake_seconds, recordings))
        with self._working(_Work(recordings, [], predicted, time.monotonic())) as work:
            yield
        elapsed = time.monotonic() - work.begin
        if predicted and elapsed > MIN_LEARNING_SECONDS:
            for split in {recording.source is not None for recording in recordings}:
                self._rates[split] *= elapsed / predicted

    @contextlib.contextmanager
    def running(self, recording: Recording, variants: list[str]) -> Iterator[None]:
        """Updates the model with the time of the with block."""
        predicted = sum(self._case_seconds(recording, variant) for variant in variants)
        with self._working(_Work([recording], variants, predicted, time.monotonic())) as work:
            yield
        self._total += time.monotonic() - work.begin - SECONDS_PER_CASE * len(variants)
        self._measured += sum(self._measured_seconds(recording, variant) for variant in variants)

    def remaining(self, unbaked: Iterable[Recording]) -> float:
        """The remaining seconds of the campaign."""
        if not self._ledger.to_run:
            return 0.0
        work = self._work
        running = {
            (recording, variant) for recording in work.recordings for variant in work.variants
        }
        cases = (
            self._case_seconds(recording, variant)
            for recording in self._ledger.recordings
            for variant in self._ledger.pending(recording)
            if (recording, variant) not in running
        )
        bakes = (
            self._bake_seconds(recording)
            for recording in unbaked
            if recording not in work.recordings
        )
        current = max(0.0, work.predicted - (time.monotonic() - work.begin))
        return current + sum(cases) + sum(bakes)

    @contextlib.contextmanager
    def _working(self, work: _Work) -> Iterator[_Work]:
        self._work = work
        try:
            yield work
        finally:
            self._work = _Work([], [], 0, 0)

    @property
    def _overhead(self) -> float:
        return max(1.0, self._total / self._measured) if self._measured else DEFAULT_OVERHEAD

    def _case_seconds(self, recording: Recording, variant: str) -> float:
        return SECONDS_PER_CASE + self._overhead * self._measured_seconds(recording, variant)

    def _measured_seconds(self, recording: Recording, variant: str) -> float:
        """The measured time of a case's frames."""
        frame = self._seconds_per_body(recording, variant) * recording.objects
        options = self._options | dict(recording.options)
        repetitions = options.get("repetitions", 1)
        passes = MIN_AUTO_REPETITIONS if repetitions == "auto" else repetitions
        frames: int = recording.frames * passes * (options.get("warmup", 0) + 1)
        return frame * (frames if frame < self._limit else min(frames, FRAMES_TO_TIMEOUT))

    def _seconds_per_body(self, recording: Recording, variant: str) -> float:
        """Seconds per frame and body."""
        known = self._ledger.times(recording.series, variant)
        if not known:
            return SECONDS_PER_BODY
        objects = max((size for size in known if size <= recording.objects), default=min(known))
        return known[objects] / max(objects, 1)

    def _bake_seconds(self, recording: Recording) -> float:
        rate = self._rates[recording.source is not None]
        return rate * recording.objects * recording.frames
