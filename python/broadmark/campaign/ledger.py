"""Which cases of a campaign are finished, which the cap leaves out, and which are to be run."""

from __future__ import annotations

import collections
from dataclasses import dataclass

from broadmark.campaign.plan import Recording, Series

#: A wrong answer, or an algorithm that failed.
WRONG = ("mismatch", "error")


@dataclass(frozen=True)
class Outcome:
    """How a case ended."""

    status: str
    seconds_per_frame: float | None  #: None: no frame came to its end


class Ledger:
    """All cases of a campaign: each variant on each recording.

    The cap: a variant that crossed a time limit is not run on larger recordings of the series.
    """

    def __init__(self, recordings: list[Recording], variants: list[str]) -> None:
        self.recordings = recordings
        self.variants = variants
        self._outcomes: dict[Recording, dict[str, Outcome]] = {one: {} for one in recordings}
        self._capped: dict[tuple[Series, str], int] = {}  # to the smallest number of bodies
        self._times: dict[tuple[Series, str], dict[int, float]] = {}

    def add(self, recording: Recording, variant: str, outcome: Outcome) -> None:
        """A case has ended."""
        self._outcomes[recording][variant] = outcome
        key = recording.series, variant
        if outcome.seconds_per_frame:
            self._times.setdefault(key, {})[recording.objects] = outcome.seconds_per_frame
        if outcome.status == "timeout":
            self._capped[key] = min(recording.objects, self._capped.get(key, recording.objects))

    def outcome(self, recording: Recording, variant: str) -> Outcome | None:
        return self._outcomes[recording].get(variant)

    def times(self, series: Series, variant: str) -> dict[int, float]:
        """The seconds that a frame took, by number of bodies."""
        return self._times.get((series, variant), {})

    def cap(self, recording: Recording, variant: str) -> int | None:
        """The number of bodies with which the variant crossed the limit, if that is why it is not
        run on this recording."""
        smallest = self._capped.get((recording.series, variant), recording.objects)
        if smallest >= recording.objects or self.outcome(recording, variant):
            return None
        return smallest

    def pending(self, recording: Recording) -> list[str]:
        """The variants that are to be run on a recording."""
        return [
            one
            for one in self.variants
            if not self.outcome(recording, one) and self.cap(recording, one) is None
        ]

    def tally(self, recording: Recording) -> collections.Counter[str]:
        """How many cases of a recording ended how; those past the cap are "not run"."""
        counts = collections.Counter(one.status for one in self._outcomes[recording].values())
        counts["not run"] = sum(self.cap(recording, one) is not None for one in self.variants)
        counts["pending"] = len(self.pending(recording))
        return counts

    @property
    def finished(self) -> int:
        return sum(map(len, self._outcomes.values()))

    @property
    def to_run(self) -> int:
        return sum(len(self.pending(one)) for one in self.recordings)

    def has_wrong(self, recordings: list[Recording]) -> bool:
        """Whether a finished case of these gave a wrong answer or failed."""
        return any(
            outcome.status in WRONG
            for recording in recordings
            for outcome in self._outcomes[recording].values()
        )
