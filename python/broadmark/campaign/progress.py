"""The progress of a campaign on standard error: an updated line on a terminal, otherwise a line per
event."""

from __future__ import annotations

import math
import shutil
import sys
import time
from collections.abc import Callable

from broadmark.campaign.estimate import Estimate
from broadmark.campaign.ledger import Ledger, Outcome
from broadmark.campaign.plan import Recording

SECONDS_BETWEEN_ESTIMATES = 5
ERASE_LINE = "\r\033[K"


class Progress:
    """Shows finished cases, elapsed time and remaining time."""

    def __init__(
        self,
        ledger: Ledger,
        estimate: Estimate,
        unbaked: Callable[[], list[Recording]],
        quiet: bool,
    ) -> None:
        self._ledger = ledger
        self._estimate = estimate
        self._unbaked = unbaked
        self._quiet = quiet
        self._terminal = sys.stderr.isatty()
        self._begin = time.monotonic()
        self._drawn = 0.0
        self._last_event = ""
        self._estimated = (-math.inf, 0.0)  # time of the estimate, remaining seconds

    def event(self, text: str) -> None:
        """Shows an event."""
        self._last_event = text
        if self._terminal:
            self.tick(now=True)
        else:
            self._print(self._line() + "\n")

    def case(self, recording: Recording, variant: str, outcome: Outcome) -> None:
        seconds = outcome.seconds_per_frame
        mean = f" {short_time(seconds)}" if seconds is not None else ""
        self.event(f"{variant}{mean} {outcome.status}: {recording.name}")

    def tick(self, now: bool = False) -> None:
        """Updates the line on a terminal."""
        if self._terminal and (now or time.monotonic() - self._drawn > 0.5):
            self._drawn = time.monotonic()
            width = shutil.get_terminal_size().columns - 1  # a line that wraps cannot be erased
            self._print(ERASE_LINE + self._line()[:width])

    def report_error(self, text: str) -> None:
        """Prints a permanent line, also with --quiet."""
        print((ERASE_LINE if self._terminal else "") + f"broadmark: {text}", file=sys.stderr)

    def end(self) -> None:
        if self._terminal:
            self._print(ERASE_LINE)

    def _line(self) -> str:
        finished = self._ledger.finished
        elapsed = long_time(time.monotonic() - self._begin)
        remaining = long_time(self._seconds_left())
        total = finished + self._ledger.to_run
        return f"{finished} of {total} cases, {elapsed}, about {remaining} left  {self._last_event}"

    def _seconds_left(self) -> float:
        """Re-estimated only every few seconds: estimates would disturb the measured cases."""
        now = time.monotonic()
        if now - self._estimated[0] > SECONDS_BETWEEN_ESTIMATES or not self._ledger.to_run:
            self._estimated = now, self._estimate.remaining(self._unbaked())
        return max(0.0, self._estimated[1] - (now - self._estimated[0]))

    def _print(self, text: str) -> None:
        if not self._quiet:
            print(text, end="", file=sys.stderr, flush=True)


def long_time(seconds: float) -> str:
    """A duration such as 1:02:03."""
    whole = round(seconds)
    return f"{whole // 3600}:{whole // 60 % 60:02}:{whole % 60:02}"


def short_time(seconds: float) -> str:
    """A time with three digits and a unit."""
    for unit, size in (("s", 1), ("ms", 1e-3), ("µs", 1e-6)):
        if seconds >= size:
            return f"{seconds / size:.3g} {unit}"
    return f"{seconds * 1e9:.0f} ns"
