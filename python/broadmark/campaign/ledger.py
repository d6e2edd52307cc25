"""The states of a campaign's cases: finished, past the cap, pending."""

from __future__ import annotations

import collections
from dataclasses import dataclass

from broadmark.campaign.plan import Recording, Series

#: A wrong answer or a failed algorithm.
FAILURE_STATUSES = ("mismatch", "error")


@dataclass(frozen=True)
class Outcome:
    """The result of a case."""

    status: str
    seconds_per_frame: float | None  #: None: no frame finished


class Ledger:
    """All cases of a campaign: each variant on each recording.

    The cap: a variant that exceeded a time limit is not run on larger recordings of the series.
    """

    def __init__(self, recordings: list[Recording], variants: list[str]) -> None:
        self.recordings = recordings
        self.variants = variants
        self._outcomes: dict[Recording, dict[str, Outcome]] = {
            recording: {} for recording in recordings
        }
        # The smallest number of bodies with a timeout.
        self._capped: dict[tuple[Series, str], int] = {}
        self._times: dict[tuple[Series, str], dict[int, float]] = {}

    def add(self, recording: Recording, variant: str, outcome: Outcome) -> None:
        """Records the result of a case."""
        self._outcomes[recording][variant] = outcome
        key = recording.series, variant
        if outcome.seconds_per_frame:
            self._times.setdefault(key, {})[recording.objects] = outcome.seconds_per_frame
        if outcome.status == "timeout":
            self._capped[key] = min(recording.objects, self._capped.get(key, recording.objects))

    def outcome(self, recording: Recording, variant: str) -> Outcome | None:
        return self._outcomes[recording].get(variant)

    def times(self, series: Series, variant: str) -> dict[int, float]:
        """The seconds per frame, by number of bodies."""
        return self._times.get((series, variant), {})

    def cap(self, recording: Recording, variant: str) -> int | None:
        """The number of bodies at which the variant exceeded the time limit, if the cap excludes it from
        this recording."""
        smallest = self._capped.get((recording.series, variant), recording.objects)
        if smallest >= recording.objects or self.outcome(recording, variant):
            return None
        return smallest

    def pending(self, recording: Recording) -> list[str]:
        """The variants still to run on a recording."""
        return [
            variant
            for variant in self.variants
            if not self.outcome(recording, variant) and self.cap(recording, variant) is None
        ]

    def tally(self, recording: Recording) -> collections.Counter[str]:
        """The number of a recording's cases by status; cases past the cap count as "not run"."""
        counts = collections.Counter(
            outcome.status for outcome in self._outcomes[recording].values()
        )
        counts["not run"] = sum(
            self.cap(recording, variant) is not None for variant in self.variants
        )
        counts["pending"] = len(self.pending(recording))
        return counts

    @property
    def finished(self) -> int:
        return sum(map(len, self._outcomes.values()))

    @property
    def to_run(self) -> int:
        return sum(len(self.pending(recording)) for recording in self.recordings)

    def has_failures(self, recordings: list[Recording]) -> bool:
        """Whether a finished case of the recordings failed or gave a wrong answer."""
        return any(
            outcome.status in FAILURE_STATUSES
            for recording in recordings
            for outcome in self._outcomes[recording].values()
        )
