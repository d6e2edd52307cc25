"""What results say to the parts of the paper's claims: comparisons, ratios, limits.

Figures are taken at the largest size at which everything that a part needs has a time. GPU algorithms
that ran on a CPU say nothing about GPUs: what needs them is not measured.
"""

from __future__ import annotations

from dataclasses import dataclass

from broadmark.paper.algorithms import BY_NAME, MOST_SECONDS, SCENES, is_gpu
from broadmark.paper.times import Place, Times

#: A number counts as reproduced within this factor.
TOLERANCE = 1.25

MILLION = 1_000_000


@dataclass(frozen=True)
class Part:
    """A part of a claim, judged: True, False, or None if it is not measured."""

    holds: bool | None
    subject: str
    figures: str  #: or why it is not measured


@dataclass(frozen=True)
class Evidence:
    """Results of one machine, asked in the paper's names."""

    cubes: Times
    assorted: Times

    def common(self, scene: str, *names: str) -> list[tuple[int, list[float]]]:
        """The sizes at which all of these have a time, the largest first, with the times."""
        found = []
        for objects in reversed(self.cubes.sizes(scene)):
            places = [self._place(self.cubes, scene, objects, name) for name in names]
            times = [place.seconds for place in places if place and place.seconds is not None]
            if len(times) == len(names):
                found.append((objects, times))
        return found

    def _place(self, times: Times, scene: str, objects: int, name: str) -> Place | None:
        if self._lacks_gpu(name):
            return None
        return times.places.get((scene, objects, BY_NAME[name].id))

    def _lacks_gpu(self, name: str) -> bool:
        return is_gpu(BY_NAME[name]) and self.cubes.device.endswith("(a CPU)")

    def missing(self, scene: str, *names: str) -> Part:
        """The part that cannot be judged, and why."""
        lacking = [name for name in names if self._lacks_gpu(name)]
        if lacking:
            why = f"there is no GPU: the OpenCL device is {self.cubes.device}"
            return Part(None, ", ".join(lacking), why)
        sizes = self.cubes.sizes(scene)
        never = [n for n in names if not any(self._place(self.cubes, scene, s, n) for s in sizes)]
        where = TITLES[scene]
        if never:
            return Part(None, ", ".join(never), f"not in these results of {where}")
        return Part(None, ", ".join(names), f"no size of {where} at which all have a time")

    # Parts of claims.

    def faster(self, scene: str, fast: list[str], slow: list[str]) -> list[Part]:
        """Each of `fast` takes less time than each of `slow`."""
        pairs = [(one, other) for one in fast for other in slow]
        parts: list[Part] = []
        missing: list[str] = []
        for one, other in pairs:
            found = self.common(scene, one, other)
            if not found:
                missing += [name for name in (one, other) if name not in missing]
            elif found[0][1][0] >= found[0][1][1]:
                objects, (first, second) = found[0]
                figures = f"{_seconds(first)}, {other} {_seconds(second)}"
                parts.append(Part(False, one, f"{figures} {_at(scene, objects)}"))
        if missing:
            parts.append(self.missing(scene, *missing))
        if not parts:
            parts.append(Part(True, _and(fast), f"faster than {_and(slow)} in {TITLES[scene]}"))
        return parts

    def gain(
        self,
        scene: str,
        slow: str,
        fast: str,
        low: float,
        high: float,
        also: list[str] | None = None,
    ) -> Part:
        """`fast` is `low` to `high` times as fast as `slow`, at a size that `also` reach."""
        for objects, (first, second, *_) in self.common(scene, slow, fast, *(also or [])):
            if min(first, second) > 0:  # zero: rounded
                ratio = first / second
                return Part(
                    low / TOLERANCE <= ratio <= high * TOLERANCE,
                    fast,
                    f"{_number(ratio)} times as fast as {slow} {_at(scene, objects)}"
                    + self._threads(scene, objects, fast),
                )
        return self.missing(scene, slow, fast, *(also or []))

    def gain_up_to(self, scene: str, slow: list[str], fast: list[str], most: float) -> Part:
        """The largest ratio of any two, over all sizes, is `most`."""
        ratios = [
            (times[0] / times[1], objects, one, other)
            for one in slow
            for other in fast
            for objects, times in self.common(scene, one, other)
            if times[1] > 0
        ]
        if not ratios:
            return self.missing(scene, *slow, *fast)
        ratio, objects, one, other = max(ratios)
        return Part(
            most / TOLERANCE <= ratio <= most * TOLERANCE,
            other,
            f"up to {_number(ratio)} times as fast as {one} {_at(scene, objects)}"
            + self._threads(scene, objects, other),
        )

    def _threads(self, scene: str, objects: int, name: str) -> str:
        place = self._place(self.cubes, scene, objects, name)
        return f" ({place.threads} threads)" if place and place.threads > 1 else ""

    def changes(self, scene: str, name: str, low: float, high: float) -> Part:
        """Its time in `scene` is `low` to `high` times that in Brownian, both exclusive."""
        there = dict(self.common(scene, name))
        for objects, (brownian,) in self.common("Brownian", name):
            if objects in there and brownian > 0:
                ratio = there[objects][0] / brownian
                figures = f"{_number(ratio)} times its time in Brownian {_at(scene, objects)}"
                return Part(low < ratio < high, name, figures)
        return self.missing(scene, name)

    def reaches_a_million(self, scene: str, name: str, expected: bool) -> Part:
        """Whether it stays within the cap up to a million objects is as expected."""
        for objects in reversed(self.cubes.sizes(scene)):
            place = self._place(self.cubes, scene, objects, name)
            if place is None or place.status not in ("ok", "timeout"):
                continue
            seconds = place.seconds
            if seconds is not None and seconds <= MOST_SECONDS and objects >= MILLION:
                return Part(expected, name, f"{_seconds(seconds)} {_at(scene, objects)}")
            if place.past_the_cap:
                time = "timeout" if seconds is None else _seconds(seconds)
                return Part(not expected, name, f"past the cap: {time} {_at(scene, objects)}")
            break
        why = f"neither a million objects in {TITLES[scene]} nor past the cap before"
        return Part(None, name, why)

    def fails_above(self, name: str, most: int) -> Part:
        """It has no right answers with more than `most` objects."""
        above = [
            (objects, place.status)
            for (_, objects, id_), place in sorted(self.cubes.places.items())
            if id_ == BY_NAME[name].id and objects > most and place.status != "timeout"
        ]
        if not above:
            return Part(None, name, f"no case of more than {most:,} objects")
        objects, status = min(above, key=lambda case: case[1] != "ok")
        return Part(status != "ok", name, f"{status} at {objects:,}")

    def extra_pairs(self, name: str, share: float) -> Part:
        """It reports pairs that do not overlap, this share of those that do."""
        shares = [
            place.extra_share
            for (_, _, id_), place in self.cubes.places.items()
            if id_ == BY_NAME[name].id and place.status == "ok" and place.extra_share is not None
        ]
        if not shares:
            return Part(None, name, "no case with checked answers")
        mean = sum(shares) / len(shares)
        fits = share / TOLERANCE <= mean <= share * TOLERANCE
        return Part(fits, name, f"{100 * mean:.1f} % more, mean of {len(shares)} cases")

    def assorted_takes(self, name: str, low: float, high: float) -> list[Part]:
        """With assorted objects it takes `low` to `high` times as long as with cubes."""
        parts = []
        for scene in TITLES:
            for objects, (cubes,) in self.common(scene, name):
                place = self._place(self.assorted, scene, objects, name)
                if place and place.seconds and cubes > 0:
                    ratio = place.seconds / cubes
                    fits = low / TOLERANCE <= ratio <= high * TOLERANCE
                    figures = f"{_number(ratio)} times as long {_at(scene, objects)}"
                    parts.append(Part(fits, name, figures))
                    break
        return parts or [Part(None, name, "no assorted objects beside as many cubes")]


TITLES = {scene.name: scene.title for scene in SCENES}


def _at(scene: str, objects: int) -> str:
    return f"at {objects:,} in {TITLES[scene]}"


def _seconds(seconds: float) -> str:
    return f"{seconds:.2g} s"


def _number(ratio: float) -> str:
    return f"{ratio:.2f}" if ratio < 9.995 else f"{ratio:.0f}"


def _and(names: list[str]) -> str:
    return ", ".join(names) if len(names) < 5 else f"the other {len(names)}"
