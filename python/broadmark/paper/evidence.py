"""Judges the parts of the paper's claims by results: comparisons, ratios, limits.

A comparison is judged at every size at which all its algorithms have a time, by the 95 % interval of its
ratio. No evidence are sizes at which the paper prints 0.00 s for one of them, GPU algorithms on a CPU,
and algorithms with another number of threads or another setting than the paper's.
"""

from __future__ import annotations

import enum
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

from broadmark.paper.algorithms import (
    BY_NAME,
    MAX_SECONDS,
    PARALLEL,
    THREADS,
    TITLES,
    is_gpu,
    table2,
)
from broadmark.paper.times import Measurement, Times

#: A single number counts as reproduced within this factor.
TOLERANCE = 1.25

MILLION = 1_000_000


class Outcome(str, enum.Enum):
    """The outcome of a claim is the first of these among its parts."""

    FAILS = "does not hold"
    MIXED = "mixed"
    UNDECIDED = "undecided"
    INCOMPARABLE = "not comparable"
    UNMEASURED = "not measured"
    HOLDS = "holds"


FIRST = list(Outcome)


@dataclass(frozen=True)
class PartVerdict:
    """The verdict on a part of a claim."""

    outcome: Outcome
    subject: str
    figures: str  #: or the reason why there is no evidence


@dataclass(frozen=True)
class Range:
    """The ratios with which a claim holds."""

    low: float
    high: float


FASTER = Range(0, 1)
SLOWER = Range(1, math.inf)


def about(number: float) -> Range:
    """A single number, within the tolerance, but never across 1."""
    low, high = number / TOLERANCE, number * TOLERANCE
    return Range(max(low, 1) if number > 1 else low, high)


def between(low: float, high: float, decimals: int = 0) -> Range:
    """A range as printed with `decimals` decimals: 2 to 3 is 1.5 to 3.5."""
    rounding = 0.5 * 10**-decimals
    return Range(low - rounding, high + rounding)


@dataclass(frozen=True)
class Ratio:
    """A ratio of times at a size with the half width of its 95 % interval, in logarithms."""

    objects: int
    value: float
    noise: float

    def outcome(self, expected: Range) -> Outcome:
        """Whether the interval is inside the range, outside, or on a limit."""
        low, high = self.value * math.exp(-self.noise), self.value * math.exp(self.noise)
        if expected.low <= low and high <= expected.high:
            return Outcome.HOLDS
        if high < expected.low or low > expected.high:
            return Outcome.FAILS
        return Outcome.UNDECIDED


def _ratio(objects: int, above: Measurement, below: Measurement) -> Ratio:
    assert above.seconds and below.seconds
    return Ratio(objects, above.seconds / below.seconds, math.hypot(above.noise, below.noise))


def _over_sizes(outcomes: Sequence[Outcome]) -> Outcome:
    """Decided sizes that agree outvote undecided ones."""
    decided = set(outcomes) - {Outcome.UNDECIDED}
    if not decided:
        return Outcome.UNDECIDED
    return decided.pop() if len(decided) == 1 else Outcome.MIXED


@dataclass(frozen=True)
class Evidence:
    """Results of one machine, by the paper's names of algorithms."""

    cubes: Times
    assorted: Times

    def common(self, scene: str, *names: str) -> list[tuple[int, list[Measurement]]]:
        """The sizes at which all algorithms have a time that counts as evidence, with the times."""
        found = []
        for objects in self.cubes.sizes(scene):
            times = [self._measurement(self.cubes, scene, objects, name) for name in names]
            known = [time for time in times if time and time.seconds]
            rounded = any(table2().get((scene, objects, BY_NAME[name].id)) == 0 for name in names)
            if len(known) == len(names) and not rounded:
                found.append((objects, known))
        return found

    def ratios(self, scene: str, above: str, below: str) -> list[Ratio]:
        """The time of `above` over that of `below`, by size."""
        return [_ratio(n, first, second) for n, (first, second) in self.common(scene, above, below)]

    def _measurement(self, times: Times, scene: str, objects: int, name: str) -> Measurement | None:
        if self._lacks_gpu(name):
            return None
        return times.originals.get((scene, objects, BY_NAME[name].id))

    def _lacks_gpu(self, name: str) -> bool:
        return is_gpu(BY_NAME[name]) and self.cubes.device.endswith("(a CPU)")

    def missing(self, scene: str, *names: str, why: str = "") -> PartVerdict:
        """The verdict "not measured" or "not comparable" with its reason; `why`: if all were measured."""
        lacking = [name for name in names if self._lacks_gpu(name)]
        if lacking:
            why = f"there is no GPU: the OpenCL device is {self.cubes.device}"
            return PartVerdict(Outcome.UNMEASURED, ", ".join(lacking), why)
        sizes = self.cubes.sizes(scene)
        never = [
            n for n in names if not any(self._measurement(self.cubes, scene, s, n) for s in sizes)
        ]
        where = TITLES[scene]
        incomparable = self._has_other_settings(never, scene)
        if incomparable:
            return incomparable
        if never:
            why = f"not in these results of {where}"
            return PartVerdict(Outcome.UNMEASURED, ", ".join(never), why)
        why = (
            why
            or f"no size of {where} at which all have a time and the paper prints more than 0.00 s"
        )
        return PartVerdict(Outcome.UNMEASURED, ", ".join(names), why)

    def _has_other_settings(self, names: list[str], scene: str) -> PartVerdict | None:
        """The verdict if the algorithms ran, but some never with the original's settings."""
        ran = {(name, id_) for name, _, id_ in self.cubes.measurements}
        others = [name for name in names if (scene, BY_NAME[name].id) in ran]
        settings = " ".join(BY_NAME[name].settings for name in others) or "default parameters"
        why = f"never with the original’s {settings} in {TITLES[scene]}"
        return PartVerdict(Outcome.INCOMPARABLE, ", ".join(others), why) if others else None

    def _judged(
        self, subject: str, figures: str, ratios: list[Ratio], expected: Range, *names: str
    ) -> PartVerdict:
        """The verdict over all sizes. `figures` has "{}" in place of the ratios."""
        outcomes = [ratio.outcome(expected) for ratio in ratios]
        outcome = _over_sizes(outcomes)
        values = [_number(value) for value in sorted(ratio.value for ratio in ratios)]
        text = values[0] if values[0] == values[-1] else f"{values[0]} to {values[-1]}"
        text = f"{figures.format(text)} {_sizes([ratio.objects for ratio in ratios])}"
        details = []
        for kind in (Outcome.HOLDS, Outcome.FAILS, Outcome.UNDECIDED):
            of_kind = [r.objects for r, found in zip(ratios, outcomes) if found == kind]
            if of_kind and len(of_kind) < len(ratios):
                details.append(f"{kind.value} {_sizes(of_kind)}")
        if details:
            text += ": " + ", ".join(details)
        return self._comparable(PartVerdict(outcome, subject, text), *names)

    def _comparable(self, verdict: PartVerdict, *names: str) -> PartVerdict:
        """The verdict, or "not comparable" if an algorithm ran with other threads than the paper's."""
        threads = {
            self.cubes.threads_of(BY_NAME[name].id)
            for name in names
            if BY_NAME[name].panel == PARALLEL and not is_gpu(BY_NAME[name])
        } - {THREADS}
        if not threads:
            return verdict
        figures = f"{verdict.figures}; {max(threads)} threads, the paper’s {THREADS}"
        return replace(verdict, outcome=Outcome.INCOMPARABLE, figures=figures)

    # The parts of claims.

    def faster(self, scene: str, fast: list[str], slow: list[str]) -> list[PartVerdict]:
        """Each of `fast` takes less time than each of `slow`: a part for each pair that does not
        hold, or one for all."""
        parts: list[PartVerdict] = []
        missing: list[str] = []
        for faster in fast:
            for slower in slow:
                ratios = self.ratios(scene, faster, slower)
                if ratios:
                    figures = f"takes {{}} of {slower}’s time in {TITLES[scene]}"
                    parts.append(self._judged(faster, figures, ratios, FASTER, faster, slower))
                else:
                    missing += [name for name in (faster, slower) if name not in missing]
        others = [part for part in parts if part.outcome != Outcome.HOLDS]
        if missing:
            others.append(self.missing(scene, *missing))
        if others or len(parts) == 1:
            return others or parts
        figures = f"faster than {_and(slow)} in {TITLES[scene]}"
        return [PartVerdict(Outcome.HOLDS, _and(fast), figures)]

    def gain(self, scene: str, slow: str, fast: str, expected: Range) -> PartVerdict:
        """`fast` is as many times as fast as `slow` as expected."""
        ratios = self.ratios(scene, slow, fast)
        if not ratios:
            return self.missing(scene, slow, fast)
        figures = f"{{}} times as fast as {slow} in {TITLES[scene]}"
        return self._judged(fast, figures, ratios, expected, slow, fast)

    def gain_up_to(
        self, scene: str, slow: list[str], fast: list[str], expected: float
    ) -> PartVerdict:
        """The largest speed-up of `fast` over `slow`, over all sizes, is `expected`."""
        found = [
            (ratio.value, ratio, slower, faster)
            for slower in slow
            for faster in fast
            for ratio in self.ratios(scene, slower, faster)
        ]
        if not found:
            return self.missing(scene, *slow, *fast)
        _, ratio, slower, faster = max(found, key=lambda entry: entry[0])
        figures = f"up to {{}} times as fast as {slower} in {TITLES[scene]}"
        return self._judged(faster, figures, [ratio], about(expected), slower, faster)

    def changes(self, scene: str, name: str, expected: Range) -> PartVerdict:
        """The time in `scene` over the time in Brownian is as expected."""
        times = dict(self.common(scene, name))
        ratios = [
            _ratio(objects, times[objects][0], brownian)
            for objects, (brownian,) in self.common("Brownian", name)
            if objects in times
        ]
        if not ratios:
            return self.missing(scene, name)
        figures = f"{{}} times its time in Brownian in {TITLES[scene]}"
        return self._judged(name, figures, ratios, expected, name)

    def reaches_a_million(self, scene: str, name: str, expected: bool) -> PartVerdict:
        """Whether the algorithm stays within the cap up to a million objects, as `expected`."""
        for objects in reversed(self.cubes.sizes(scene)):
            measurement = self._measurement(self.cubes, scene, objects, name)
            if measurement is None or measurement.status not in ("ok", "timeout"):
                continue
            seconds = measurement.seconds
            if seconds is not None and seconds <= MAX_SECONDS and objects >= MILLION:
                figures, reached = f"{_seconds(seconds)} {_sizes([objects])}", True
            elif measurement.exceeds_cap:
                time = "timeout" if seconds is None else _seconds(seconds)
                figures, reached = f"past the cap: {time} {_sizes([objects])}", False
            else:
                break
            outcome = Outcome.HOLDS if reached == expected else Outcome.FAILS
            verdict = PartVerdict(outcome, name, f"{figures} in {TITLES[scene]}")
            return self._comparable(verdict, name)
        why = f"neither a million objects in {TITLES[scene]} nor past the cap before"
        return self.missing(scene, name, why=why)

    def fails_above(self, name: str, limit: int) -> PartVerdict:
        """The algorithm fails with more than `limit` objects."""
        if self._lacks_gpu(name):
            return self.missing("Brownian", name)
        above = [
            (objects, measurement.status)
            for (_, objects, id_), measurement in sorted(self.cubes.originals.items())
            if id_ == BY_NAME[name].id and objects > limit and measurement.status != "timeout"
        ]
        if not above:
            why = f"no case of more than {limit:,} objects"
            return PartVerdict(Outcome.UNMEASURED, name, why)
        objects, status = min(above, key=lambda case: case[1] != "ok")
        outcome = Outcome.FAILS if status == "ok" else Outcome.HOLDS
        return PartVerdict(outcome, name, f"{status} at {objects:,}")

    def extra_pairs(self, name: str, share: float) -> PartVerdict:
        """The algorithm reports non-overlapping pairs, `share` of the number of overlapping pairs."""
        algorithm = BY_NAME[name]
        shares = [
            measurement.extra_share
            for (_, _, id_), measurement in self.cubes.originals.items()
            if id_ == algorithm.id
            and measurement.status == "ok"
            and measurement.extra_share is not None
        ]
        if not shares and algorithm.settings:
            why = f"no checked case with the original’s {algorithm.settings}"
            return PartVerdict(Outcome.INCOMPARABLE, name, why)
        if not shares:
            return PartVerdict(Outcome.UNMEASURED, name, "no case with checked answers")
        mean, expected = sum(shares) / len(shares), about(share)
        outcome = Outcome.HOLDS if expected.low <= mean <= expected.high else Outcome.FAILS
        figures = f"{100 * mean:.1f} % more, mean of {len(shares)} cases"
        return PartVerdict(outcome, name, figures)

    def assorted_takes(self, name: str, expected: Range) -> list[PartVerdict]:
        """Assorted objects take longer than cubes, by a factor as expected."""
        parts = []
        for scene, title in TITLES.items():
            ratios = []
            for objects in self.cubes.sizes(scene):
                cubes = self._measurement(self.cubes, scene, objects, name)
                assorted = self._measurement(self.assorted, scene, objects, name)
                if cubes and cubes.seconds and assorted and assorted.seconds:
                    ratios.append(_ratio(objects, assorted, cubes))
            if ratios:
                figures = f"{{}} times as long in {title}"
                parts.append(self._judged(name, figures, ratios, expected, name))
        why = "no results of equally many assorted objects and cubes"
        return parts or [PartVerdict(Outcome.UNMEASURED, name, why)]


def _sizes(objects: list[int]) -> str:
    if len(objects) <= 3:
        return "at " + ", ".join(f"{n:,}" for n in sorted(objects))
    return f"at {len(objects)} sizes from {min(objects):,} to {max(objects):,}"


def _seconds(seconds: float) -> str:
    return f"{seconds:.2g} s"


def _number(ratio: float) -> str:
    return f"{ratio:.2f}" if ratio < 9.995 else f"{ratio:.0f}"


def _and(names: list[str]) -> str:
    return ", ".join(names) if len(names) < 5 else f"the other {len(names)}"
