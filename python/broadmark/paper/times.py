"""Our times by the paper's scenes, numbers of objects and algorithms, one case each.

Among several numbers of threads and instruction sets, the case with the most threads and then the
widest instruction set is used; cases with parameters, where there is none without. Only a complete
case without wrong answers has a time; others have their status. Where only spans of a recording were
run, a time is the mean over their frames.
"""

from __future__ import annotations

import math
import statistics
from collections import defaultdict
from dataclasses import dataclass
from typing import Any

import pandas as pd

from broadmark.errors import InputError
from broadmark.paper.algorithms import ALGORITHMS, BY_ID, CAP_SECONDS, SCENES, TITLES
from broadmark.results import SELF_CHECK_FAMILY, Results, commit_name
from broadmark.selection import RECORDING, best_variants, by_machine

#: The column of a case's span of frames.
SPAN = "span"

SCENE_NAMES = [scene.name for scene in SCENES]

#: Half the width of a time's 95 % interval, relative to it: at least, and if it was measured once.
MIN_NOISE, NOISE_OF_ONE = 0.02, 0.1

#: A frame is a spike if it takes this many times as long as the median frame around it.
SPIKE_FACTOR, SPIKE_WINDOW = 3, 11


@dataclass(frozen=True)
class Measurement:
    """The result of an algorithm in a scene of one size."""

    status: str  #: of the case, or "incomplete"
    seconds: float | None  #: per frame, if the status is "ok"
    threads: int
    limit: float  #: the time limit in seconds per frame
    extra_share: float | None  #: false pairs per overlapping pair; None: unknown
    noise: float  #: half the width of the 95 % interval of `seconds`, relative to it
    repeated: bool  #: so that the interval was measured
    median: float  #: seconds
    spike_share: float  #: of the time, that spikes take longer than the frames around them

    @property
    def exceeds_cap(self) -> bool:
        """Whether a frame takes longer than the paper's cap, so that larger sizes are not shown."""
        if self.seconds is not None:
            return self.seconds > CAP_SECONDS
        return self.status == "timeout" and self.limit >= CAP_SECONDS


class Times:
    """The times of one machine on objects of one type."""

    def __init__(self, machine: str, results: Results, object_type: str = "Cubes") -> None:
        self.machine = machine
        #: The machine's OpenCL devices, the used device first.
        environment = results.environments.set_index("machine").loc[machine].to_dict()
        devices = environment.get("compute_devices")
        self.devices: list[str] = devices if isinstance(devices, list) else []
        #: Commit, compiler and options of the program; "" if the commit is unknown.
        self.build = ", ".join(
            str(text).strip()
            for text in (
                commit_name(environment),
                environment.get("compiler"),
                environment.get("compiler_flags"),
            )
            if commit_name(environment) and isinstance(text, str)
        )
        cases = results.cases
        mask = (
            cases["scene"].isin(SCENE_NAMES)
            & (cases["object_type"] == object_type)
            & (cases["family"] != SELF_CHECK_FAMILY)
        )
        cases = _with_spans(cases[mask])
        #: The spans of frames that were run, such as "100-199", by scene and objects; [""]: all.
        self.spans: dict[tuple[str, int], list[str]] = {
            size: sorted(spans.unique(), key=lambda span: int(span.split("-")[0] or 0))
            for size, spans in cases.groupby(["scene", "objects"])[SPAN]
        }
        given = cases.apply(_given_parameters, axis=1) if len(cases) else cases["id"]
        original = cases["algorithm"].map({id_: own.settings for id_, own in BY_ID.items()})
        #: Of the paper's algorithms with the settings of the original.
        self.originals = self._measurements(cases[given == original], results)
        plain = given == ""
        has_plain = plain.groupby([cases[key] for key in [*RECORDING, "algorithm"]]).transform(
            "any"
        )
        cases = cases[plain | ~has_plain]
        self.measurements = self._measurements(cases, results)
        self.families: dict[str, str] = dict(zip(cases["algorithm"], cases["family"]))

    def _measurements(
        self, cases: pd.DataFrame, results: Results
    ) -> dict[tuple[str, int, str], Measurement]:
        """By scene, objects and algorithm."""
        found: dict[tuple[str, int, str], Measurement] = {}
        if not len(cases):
            return found
        best = pd.concat(best_variants(of_span) for _, of_span in cases.groupby(SPAN))
        for cell, rows in best.groupby(["scene", "objects", "algorithm"]):
            details = [results.details[number] for number in rows.index]
            parts = [self._measurement(row, own) for (_, row), own in zip(rows.iterrows(), details)]
            if len(parts) < len(self.spans[cell[:2]]):
                continue  # some spans were not run
            times = [time for own in details for run in own["frames"]["total"] for time in run]
            found[cell] = (
                parts[0] if len(parts) == 1 else _joined(parts, list(rows["frames"]), times)
            )
        return found

    @staticmethod
    def _measurement(row: pd.Series, details: dict[str, Any]) -> Measurement:
        status = row["status"] if row["complete"] else "incomplete"
        extra = row["allowed_extra"] / row["frames"]
        seconds, repeated = row["seconds_per_frame"], not pd.isna(row["ci95_low_seconds"])
        half_width = (row["ci95_high_seconds"] - row["ci95_low_seconds"]) / 2
        return Measurement(
            status,
            seconds if status == "ok" else None,
            row["threads"],
            details.get("conditions", {}).get("frame_limit_seconds") or CAP_SECONDS,
            None if pd.isna(extra) else extra / max(row["pairs_mean"] - extra, 1),
            max(half_width / seconds if seconds else 0, MIN_NOISE) if repeated else NOISE_OF_ONE,
            repeated,
            row["median_seconds"],
            _spike_share(details["frames"]["total"]),
        )

    @property
    def other_algorithms(self) -> list[str]:
        """The algorithms that are not in the paper."""
        return sorted(self.families.keys() - {algorithm.id for algorithm in ALGORITHMS})

    def sizes(self, scene: str) -> list[int]:
        """The measured numbers of objects."""
        return sorted({objects for name, objects, _ in self.measurements if name == scene})

    def shown(self, scene: str, algorithm: str) -> dict[int, Measurement]:
        """An algorithm's measurements by number of objects, up to the first past the cap."""
        measurements = {}
        for objects in self.sizes(scene):
            measurement = self.measurements.get((scene, objects, algorithm))
            if measurement is not None:
                measurements[objects] = measurement
                if measurement.exceeds_cap:
                    break
        return measurements

    def threads_of(self, algorithm: str) -> int:
        """The most threads of an algorithm; 0 without a result."""
        return max(
            (p.threads for (_, _, id_), p in self.measurements.items() if id_ == algorithm),
            default=0,
        )

    def is_parallel(self, algorithm: str) -> bool:
        """Whether the algorithm uses several threads or a device, by its name and results."""
        return (
            algorithm.endswith("-mt") or self.on_device(algorithm) or self.threads_of(algorithm) > 1
        )

    def on_device(self, algorithm: str) -> bool:
        """Whether the algorithm runs on an OpenCL device."""
        return self.families[algorithm] == "GPU"

    @property
    def conditions(self) -> list[str]:
        """The conditions of the times besides the machine, a line each."""
        threads = {p.threads for (_, _, a), p in self.measurements.items() if not self.on_device(a)}
        lines = (
            [f"Multi-threaded algorithms: {max(threads)} threads"]
            if max(threads, default=1) > 1
            else []
        )
        sizes: dict[str, list[str]] = defaultdict(list)
        for (scene, objects), spans in self.spans.items():
            if spans != [""]:
                frames = " and ".join(span.replace("-", " to ") for span in spans)
                sizes[f"{TITLES[scene]}, {{}} objects: frames {frames}"].append(f"{objects:,}")
        lines += [line.format(" and ".join(of_line)) for line, of_line in sizes.items()]
        lines += [f"Commit {self.build}"] if self.build else []
        return lines + ([f"OpenCL device: {self.device}"] if self.device else [])

    @property
    def device(self) -> str:
        """The short name of the OpenCL device; "" if no algorithm used a device."""
        if not any(family == "GPU" for family in self.families.values()) or not self.devices:
            return ""
        name, _, about = self.devices[0].partition(" (")
        return name + (" (a CPU)" if ", CPU," in about else "")


def _given_parameters(case: pd.Series) -> str:
    """The parameters in a case's id: those that were given to the program."""
    parts = case["id"].split("/")
    variant = parts[parts.index(case["algorithm"]) :] if case["algorithm"] in parts else []
    return " ".join(part for part in variant if "=" in part)


def _with_spans(cases: pd.DataFrame) -> pd.DataFrame:
    """The cases with a column SPAN, "" for all frames; of the sizes that were run as a whole, only
    the cases that were."""
    cases = cases.assign(
        **{SPAN: cases["varied_params"].astype(str).str.extract(r"\bspan=(\d+-\d+)")[0].fillna("")}
    )
    is_whole = cases[SPAN] == ""
    has_whole = is_whole.groupby([cases["scene"], cases["objects"]]).transform("any")
    return cases[is_whole | ~has_whole]


def _joined(parts: list[Measurement], frames: list[int], times: list[float]) -> Measurement:
    """One measurement of several spans with these numbers of frames and all their times in
    nanoseconds."""
    total = sum(frames)

    def mean(values: list[float]) -> float:
        return sum(value * n for value, n in zip(values, frames)) / total

    status = next((part.status for part in parts if part.status != "ok"), "ok")
    known = [part.seconds for part in parts if part.seconds is not None]
    seconds = mean(known) if status == "ok" else None
    shares = [part.extra_share for part in parts if part.extra_share is not None]
    # Noise is independent between spans.
    variances = [(s * part.noise * n / total) ** 2 for s, part, n in zip(known, parts, frames)]
    return Measurement(
        status,
        seconds,
        max(part.threads for part in parts),
        min(part.limit for part in parts),
        mean(shares) if len(shares) == len(parts) else None,
        math.sqrt(sum(variances)) / seconds if seconds else 0,
        all(part.repeated for part in parts),
        statistics.median(times) / 1e9 if times else math.nan,
        mean([part.spike_share for part in parts]),
    )


def _spike_share(repetitions: list[Any]) -> float:
    total = excess = 0.0
    for repetition in repetitions:
        frames = pd.Series(repetition, dtype=float)
        around = frames.rolling(SPIKE_WINDOW, center=True, min_periods=1).median()
        excess += (frames - around)[frames > SPIKE_FACTOR * around].sum()
        total += frames.sum()
    return excess / total if total else 0.0


def times_by_machine(results: Results) -> list[Times]:
    """The times of each machine with cubes in the paper's scenes. InputError if there is none."""
    times = [Times(machine, machine_results) for machine, machine_results in by_machine(results)]
    times = [machine_times for machine_times in times if machine_times.measurements]
    if not times:
        raise InputError(
            f"no case with cubes in {', '.join(SCENE_NAMES)}: the paper's scenes are required"
        )
    return times
