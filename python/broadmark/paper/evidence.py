"""Judges the parts of the paper's claims by results: comparisons, ratios, limits.

A part is judged at the largest size at which all its algorithms have a time. Results of GPU algorithms
on a CPU are no evidence about GPUs: such parts are not measured.
"""

from __future__ import annotations

from dataclasses import dataclass

from broadmark.paper.algorithms import BY_NAME, MAX_SECONDS, SCENES, is_gpu
from broadmark.paper.times import Measurement, Times

#: A number counts as reproduced within this factor.
TOLERANCE = 1.25

MILLION = 1_000_000


@dataclass(frozen=True)
class PartVerdict:
    """The verdict on a part of a claim. `holds` is None if the part is not measured."""

    holds: bool | None
    subject: str
    figures: str  #: or the reason why it is not measured


@dataclass(frozen=True)
class Evidence:
    """Results of one machine, by the paper's names of algorithms."""

    cubes: Times
    assorted: Times

    def common(self, scene: str, *names: str) -> list[tuple[int, list[float]]]:
        """The sizes at which all algorithms have a time, the largest first, with the times."""
        found = []
        for objects in reversed(self.cubes.sizes(scene)):
            measurements = [self._measurement(self.cubes, scene, objects, name) for name in names]
            times = [
                measurement.seconds
                for measurement in measurements
                if measurement and measurement.seconds is not None
            ]
            if len(times) == len(names):
                found.append((objects, times))
        return found

    def _measurement(self, times: Times, scene: str, objects: int, name: str) -> Measurement | None:
        if self._lacks_gpu(name):
            return None
        return times.measurements.get((scene, objects, BY_NAME[name].id))

    def _lacks_gpu(self, name: str) -> bool:
        return is_gpu(BY_NAME[name]) and self.cubes.device.endswith("(a CPU)")

    def missing(self, scene: str, *names: str) -> PartVerdict:
        """The verdict "not measured" with its reason."""
        lacking = [name for name in names if self._lacks_gpu(name)]
        if lacking:
            why = f"there is no GPU: the OpenCL device is {self.cubes.device}"
            return PartVerdict(None, ", ".join(lacking), why)
        sizes = self.cubes.sizes(scene)
        never = [
            n for n in names if not any(self._measurement(self.cubes, scene, s, n) for s in sizes)
        ]
        where = TITLES[scene]
        if never:
            return PartVerdict(None, ", ".join(never), f"not in these results of {where}")
        return PartVerdict(None, ", ".join(names), f"no size of {where} at which all have a time")

    # The parts of claims.

    def faster(self, scene: str, fast: list[str], slow: list[str]) -> list[PartVerdict]:
        """Each of `fast` takes less time than each of `slow`."""
        pairs = [(faster, slower) for faster in fast for slower in slow]
        parts: list[PartVerdict] = []
        missing: list[str] = []
        for faster, slower in pairs:
            found = self.common(scene, faster, slower)
            if not found:
                missing += [name for name in (faster, slower) if name not in missing]
            elif found[0][1][0] >= found[0][1][1]:
                objects, (first, second) = found[0]
                figures = f"{_seconds(first)}, {slower} {_seconds(second)}"
                parts.append(PartVerdict(False, faster, f"{figures} {_at(scene, objects)}"))
        if missing:
            parts.append(self.missing(scene, *missing))
        if not parts:
            parts.append(
                PartVerdict(True, _and(fast), f"faster than {_and(slow)} in {TITLES[scene]}")
            )
        return parts

    def gain(
        self,
        scene: str,
        slow: str,
        fast: str,
        low: float,
        high: float,
        also: list[str] | None = None,
    ) -> PartVerdict:
        """`fast` is `low` to `high` times as fast as `slow`, at a size where `also` have times."""
        for objects, (first, second, *_) in self.common(scene, slow, fast, *(also or [])):
            if min(first, second) > 0:  # 0: rounded
                ratio = first / second
                return PartVerdict(
                    low / TOLERANCE <= ratio <= high * TOLERANCE,
                    fast,
                    f"{_number(ratio)} times as fast as {slow} {_at(scene, objects)}"
                    + self._threads(scene, objects, fast),
                )
        return self.missing(scene, slow, fast, *(also or []))

    def gain_up_to(
        self, scene: str, slow: list[str], fast: list[str], expected: float
    ) -> PartVerdict:
        """The largest speed-up of `fast` over `slow`, over all sizes, is `expected`."""
        ratios = [
            (times[0] / times[1], objects, slower, faster)
            for slower in slow
            for faster in fast
            for objects, times in self.common(scene, slower, faster)
            if times[1] > 0
        ]
        if not ratios:
            return self.missing(scene, *slow, *fast)
        ratio, objects, slower, faster = max(ratios)
        return PartVerdict(
            expected / TOLERANCE <= ratio <= expected * TOLERANCE,
            faster,
            f"up to {_number(ratio)} times as fast as {slower} {_at(scene, objects)}"
            + self._threads(scene, objects, faster),
        )

    def _threads(self, scene: str, objects: int, name: str) -> str:
        measurement = self._measurement(self.cubes, scene, objects, name)
        return (
            f" ({measurement.threads} threads)" if measurement and measurement.threads > 1 else ""
        )

    def changes(self, scene: str, name: str, low: float, high: float) -> PartVerdict:
        """The time in `scene` is `low` to `high` (both exclusive) times the time in Brownian."""
        scene_times = dict(self.common(scene, name))
        for objects, (brownian,) in self.common("Brownian", name):
            if objects in scene_times and brownian > 0:
                ratio = scene_times[objects][0] / brownian
                figures = f"{_number(ratio)} times its time in Brownian {_at(scene, objects)}"
                return PartVerdict(low < ratio < high, name, figures)
        return self.missing(scene, name)

    def reaches_a_million(self, scene: str, name: str, expected: bool) -> PartVerdict:
        """Whether the algorithm stays within the cap up to a million objects, as `expected`."""
        for objects in reversed(self.cubes.sizes(scene)):
            measurement = self._measurement(self.cubes, scene, objects, name)
            if measurement is None or measurement.status not in ("ok", "timeout"):
                continue
            seconds = measurement.seconds
            if seconds is not None and seconds <= MAX_SECONDS and objects >= MILLION:
                return PartVerdict(expected, name, f"{_seconds(seconds)} {_at(scene, objects)}")
            if measurement.exceeds_cap:
                time = "timeout" if seconds is None else _seconds(seconds)
                return PartVerdict(
                    not expected, name, f"past the cap: {time} {_at(scene, objects)}"
                )
            break
        why = f"neither a million objects in {TITLES[scene]} nor past the cap before"
        return PartVerdict(None, name, why)

    def fails_above(self, name: str, limit: int) -> PartVerdict:
        """The algorithm fails with more than `limit` objects."""
        above = [
            (objects, measurement.status)
            for (_, objects, id_), measurement in sorted(self.cubes.measurements.items())
            if id_ == BY_NAME[name].id and objects > limit and measurement.status != "timeout"
        ]
        if not above:
            return PartVerdict(None, name, f"no case of more than {limit:,} objects")
        objects, status = min(above, key=lambda case: case[1] != "ok")
        return PartVerdict(status != "ok", name, f"{status} at {objects:,}")

    def extra_pairs(self, name: str, share: float) -> PartVerdict:
        """The algorithm reports non-overlapping pairs, `share` of the number of overlapping pairs."""
        shares = [
            measurement.extra_share
            for (_, _, id_), measurement in self.cubes.measurements.items()
            if id_ == BY_NAME[name].id
            and measurement.status == "ok"
            and measurement.extra_share is not None
        ]
        if not shares:
            return PartVerdict(None, name, "no case with checked answers")
        mean = sum(shares) / len(shares)
        fits = share / TOLERANCE <= mean <= share * TOLERANCE
        return PartVerdict(fits, name, f"{100 * mean:.1f} % more, mean of {len(shares)} cases")

    def assorted_takes(self, name: str, low: float, high: float) -> list[PartVerdict]:
        """Assorted objects take `low` to `high` times as long as cubes."""
        parts = []
        for scene in TITLES:
            for objects, (cubes,) in self.common(scene, name):
                measurement = self._measurement(self.assorted, scene, objects, name)
                if measurement and measurement.seconds and cubes > 0:
                    ratio = measurement.seconds / cubes
                    fits = low / TOLERANCE <= ratio <= high * TOLERANCE
                    figures = f"{_number(ratio)} times as long {_at(scene, objects)}"
                    parts.append(PartVerdict(fits, name, figures))
                    break
        return parts or [
            PartVerdict(None, name, "no results of equally many assorted objects and cubes")
        ]


TITLES = {scene.name: scene.title for scene in SCENES}


def _at(scene: str, objects: int) -> str:
    return f"at {objects:,} in {TITLES[scene]}"


def _seconds(seconds: float) -> str:
    return f"{seconds:.2g} s"


def _number(ratio: float) -> str:
    return f"{ratio:.2f}" if ratio < 9.995 else f"{ratio:.0f}"


def _and(names: list[str]) -> str:
    return ", ".join(names) if len(names) < 5 else f"the other {len(names)}"
