#!/usr/bin/env python3
"""Soak test of the inspector: detects growing memory, leaked descriptors and slow-downs over hours.

    tests/soak/soak.py --program FILE --plugins FOLDER [--minutes M] [--seed S] [--output DIR]

An off-screen inspector performs rounds of random actions (rounds.py) until the time is over, while
small headless runs are executed in sequence. In every round, in the same state, the inspector's
memory, descriptors, threads and worker processes are sampled, and the processor time of the reference
work. Finally, a table lists the trends (trends.py); samples.csv, runs.csv and soak.png are in the
output folder. The exit status is 1 for growth, leaks or slow-downs, or if the inspector ends early.
"""

from __future__ import annotations

import argparse
import csv
import os
import pathlib
import shutil
import subprocess
import sys
import time
from dataclasses import asdict, astuple, dataclass, fields

from rounds import BEGIN, END, RECORDINGS, Rounds
from trends import Trend, grows, leaks, slows_down

#: The minimum duration of a round in seconds, for the number of rounds in the script.
MIN_ROUND_SECONDS = 1.0
MIN_ROUNDS = 2
#: A longer gap in seconds means that the test itself was stopped.
MAX_GAP = 5
#: The delay in seconds after which the file of the mark is closed.
MARK_DELAY = 0.2
#: The maximum duration of a round in seconds; a longer round hangs.
MAX_ROUND_SECONDS = 300
MIB = 1 << 20


@dataclass(frozen=True)
class Sample:
    """A sample of the inspector in a round."""

    minutes: float  #: since the start
    resident_mib: float
    anonymous_mib: float  #: the anonymous part: heap and stacks
    descriptors: int
    threads: int
    workers: int  #: running child processes
    processor_seconds: float  #: of the reference work
    seconds: float  #: of the reference work, wall clock


class Process:
    """A process in /proc."""

    def __init__(self, pid: int) -> None:
        self._folder = pathlib.Path(f"/proc/{pid}")
        self._pid = pid

    def mib(self, name: str) -> float:
        for line in (self._folder / "status").read_text().splitlines():
            if line.startswith(name + ":"):
                return int(line.split()[1]) * 1024 / MIB
        return 0.0

    def count(self, folder: str) -> int:
        return len(list((self._folder / folder).iterdir()))

    def children(self) -> int:
        tasks = (self._folder / "task").glob("*/children")
        return sum(len(task.read_text().split()) for task in tasks)

    def processor_seconds(self) -> float:
        numbers = (self._folder / "stat").read_text().rsplit(")", 1)[1].split()
        return (int(numbers[11]) + int(numbers[12])) / os.sysconf("SC_CLK_TCK")


class Inspector:
    """The inspector and its samples."""

    def __init__(self, options: argparse.Namespace, folder: pathlib.Path) -> None:
        self.samples: list[Sample] = []
        self._marks = {name: folder / name for name in (BEGIN, END)}
        for mark in self._marks.values():
            mark.write_text("")
        self._seen = {name: self._time(name) for name in self._marks}
        self._begun: Sample | None = None
        self._begun_at = 0.0  # in processor seconds
        self._due: float | None = None  # the time of the next sample
        with open(folder / "output.txt", "wb") as output:
            self._process = subprocess.Popen(
                [options.program, "--headless", "--ui", "--script", "script.txt"]
                + ["--plugin", options.plugins / "libfaulty_algorithm.so"]
                + ["--plugin", options.plugins / "libunruly_algorithm.so"],
                cwd=folder,
                stdin=subprocess.DEVNULL,
                stdout=output,
                stderr=subprocess.STDOUT,
            )
        self._system = Process(self._process.pid)
        self._start = self._last = self._polled = time.monotonic()

    def poll(self) -> None:
        """Samples the inspector when a mark has changed."""
        now = time.monotonic()
        if now > self._polled + MAX_GAP:
            self._last += now - self._polled  # all processes were stopped
        self._polled = now
        if self._changed(BEGIN):
            self._changed(END)
            self._begun = None
            self._begun_at = self._system.processor_seconds()
            self._due = time.monotonic() + MARK_DELAY
        elif self._due and time.monotonic() > self._due:
            self._begun = self._sample()
            self._due = None
        elif self._begun and self._changed(END):
            seconds = (self._seen[END] - self._seen[BEGIN]) / 1e9
            processor = self._system.processor_seconds() - self._begun_at
            known = asdict(self._begun) | {
                "seconds": seconds,
                "processor_seconds": processor,
            }
            self.samples.append(Sample(**known))
            self._begun = None
            self._last = time.monotonic()

    def failure(self) -> str:
        """The reason to stop early; "" to continue."""
        if self._process.poll() is not None:
            return f"ended early with status {self._process.returncode}: see output.txt"
        if time.monotonic() - self._last > MAX_ROUND_SECONDS:
            return f"has not finished a round for {MAX_ROUND_SECONDS} s"
        return ""

    def end(self) -> None:
        self._process.kill()
        self._process.wait()

    def _time(self, mark: str) -> int:
        return self._marks[mark].stat().st_mtime_ns

    def _changed(self, mark: str) -> bool:
        try:
            now = self._time(mark)
        except FileNotFoundError:
            return False  # while the file is replaced
        changed = now != self._seen[mark]
        self._seen[mark] = now
        return changed

    def _sample(self) -> Sample:
        return Sample(
            minutes=(time.monotonic() - self._start) / 60,
            resident_mib=self._system.mib("VmRSS"),
            anonymous_mib=self._system.mib("RssAnon"),
            descriptors=self._system.count("fd"),
            threads=self._system.count("task"),
            workers=self._system.children(),
            processor_seconds=0,
            seconds=0,
        )


class HeadlessRuns:
    """Identical small runs in sequence, with pauses."""

    PAUSE_SECONDS = 2.0

    def __init__(self, options: argparse.Namespace, folder: pathlib.Path) -> None:
        self.processor_seconds: list[float] = []
        self._command = (
            [
                options.program,
                "--headless",
                "reference.broadmark",
                "--quiet",
                "--check",
                "full",
            ]
            + ["--algorithm", "sap,kd-mt,columns,tide", "--threads", "2"]
            + ["--json", "results.json", "--csv", "results.csv"]
            # The machine may be busy.
            + ["--allow-timeout", "--hard-limit", "600"]
        )
        self._folder = folder
        self._process: subprocess.Popen[bytes] | None = None
        self._next = time.monotonic()

    def poll(self) -> None:
        """Records a finished run, or starts the next."""
        if self._process is None:
            if time.monotonic() >= self._next:
                self._process = subprocess.Popen(
                    self._command,
                    cwd=self._folder,
                    stdin=subprocess.DEVNULL,
                    stdout=subprocess.DEVNULL,
                    stderr=subprocess.DEVNULL,
                )
            return
        pid, status, usage = os.wait4(self._process.pid, os.WNOHANG)
        if pid == 0:
            return
        self._process = None
        if status != 0:
            raise SystemExit(f"soak: a headless run ended with status {status}")
        self.processor_seconds.append(usage.ru_utime + usage.ru_stime)
        self._next = time.monotonic() + self.PAUSE_SECONDS

    def end(self) -> None:
        if self._process:
            self._process.kill()
            self._process.wait()


def prepare(options: argparse.Namespace, folder: pathlib.Path) -> None:
    """Bakes the recordings and writes a script for the whole duration."""
    for name, arguments in RECORDINGS.items():
        command = [options.program, "bake", *arguments, "--quiet"]
        into = folder / "baked"
        subprocess.run([*command, "--output", into], check=True, stdout=subprocess.DEVNULL)
        [baked] = [path for path in into.rglob("*") if path.suffix in (".aabbs", ".broadmark")]
        subprocess.run(
            [options.program, "convert", baked, folder / name, "--quiet"],
            check=True,
            stdout=subprocess.DEVNULL,
        )
        shutil.rmtree(into)
    rounds = iter(Rounds(options.seed))
    with open(folder / "script.txt", "w", encoding="utf-8") as script:
        for _ in range(2 + round(60 * options.minutes / MIN_ROUND_SECONDS)):
            script.write(next(rounds))


def find_trends(inspector: Inspector, runs: HeadlessRuns, allowed_mib: float) -> list[Trend]:
    def values(name: str) -> list[float]:
        return [getattr(sample, name) for sample in inspector.samples]

    allowed_share = 0.1
    return [
        grows("resident memory, MiB", values("resident_mib"), allowed_mib),
        grows("heap and stacks, MiB", values("anonymous_mib"), allowed_mib),
        leaks("descriptors", values("descriptors")),
        leaks("threads", values("threads")),
        leaks("worker processes", values("workers")),
        slows_down("reference work, s", values("processor_seconds"), allowed_share),
        slows_down("headless run, s", runs.processor_seconds, allowed_share),
    ]


def write_csv(folder: pathlib.Path, inspector: Inspector, runs: HeadlessRuns) -> None:
    with open(folder / "samples.csv", "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(field.name for field in fields(Sample))
        writer.writerows(map(astuple, inspector.samples))
    with open(folder / "runs.csv", "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["processor_seconds"])
        writer.writerows([seconds] for seconds in runs.processor_seconds)


def draw(path: pathlib.Path, samples: list[Sample]) -> None:
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    rows = {
        "memory, MiB": ["resident_mib", "anonymous_mib"],
        "count": ["descriptors", "threads", "workers"],
        "reference work, s": ["processor_seconds", "seconds"],
    }
    figure, axes = pyplot.subplots(len(rows), 1, figsize=(9, 8), sharex=True)
    for axis, (label, names) in zip(axes, rows.items()):
        for name in names:
            shown = name.replace("_mib", "").replace("_", " ")
            values = [getattr(sample, name) for sample in samples]
            axis.plot([sample.minutes for sample in samples], values, label=shown, linewidth=1)
        axis.set_ylabel(label)
        axis.set_ylim(bottom=0)
        axis.legend(loc="lower right")
        axis.grid(alpha=0.3)
    axes[-1].set_xlabel("minutes")
    figure.tight_layout()
    figure.savefig(path)


def report(trends: list[Trend], rounds: int, runs: int) -> None:
    print(f"{rounds} rounds of the inspector, {runs} headless runs")
    print(f"{'':32} {'first':>10} {'last':>10}")
    for trend in trends:
        print(
            f"{trend.quantity:32} {trend.first:10.2f} {trend.last:10.2f}  {trend.problem or 'ok'}"
        )


def parsed() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--program", type=pathlib.Path, required=True, help="the program broadmark")
    parser.add_argument(
        "--plugins",
        type=pathlib.Path,
        required=True,
        help="folder with the tests' plug-ins",
    )
    parser.add_argument("--minutes", type=float, default=120, help="duration (default: 120)")
    parser.add_argument("--seed", type=int, default=1, help="seed of the actions")
    parser.add_argument("--allowed-mib", type=float, default=16, help="allowed growth of memory")
    parser.add_argument("--output", type=pathlib.Path, default=pathlib.Path("soak"))
    options = parser.parse_args()
    options.program = options.program.resolve()
    options.plugins = options.plugins.resolve()
    return options


def main() -> int:
    options = parsed()
    folder = options.output
    shutil.rmtree(folder / "work", ignore_errors=True)
    work = folder / "work"
    work.mkdir(parents=True)
    prepare(options, work)
    inspector = Inspector(options, work)
    runs = HeadlessRuns(options, work)
    start = last_report = time.monotonic()
    try:
        while not (failure := inspector.failure()):
            is_over = time.monotonic() > start + 60 * options.minutes
            if is_over and len(inspector.samples) >= MIN_ROUNDS:
                break
            inspector.poll()
            runs.poll()
            time.sleep(0.01)
            if time.monotonic() > last_report + 60:
                last_report = time.monotonic()
                write_csv(folder, inspector, runs)
                minutes = (last_report - start) / 60
                print(f"soak: {minutes:.0f} of {options.minutes:g} min", file=sys.stderr)
    finally:
        inspector.end()
        runs.end()
    write_csv(folder, inspector, runs)
    trends = find_trends(inspector, runs, options.allowed_mib)
    report(trends, len(inspector.samples), len(runs.processor_seconds))
    if inspector.samples:
        draw(folder / "soak.png", inspector.samples)
    if failure:
        print(f"soak: the inspector {failure}", file=sys.stderr)
        print((work / "output.txt").read_text(errors="replace")[-2000:], file=sys.stderr)
    return 1 if failure or any(trend.problem for trend in trends) else 0


if __name__ == "__main__":
    sys.exit(main())
