#!/usr/bin/env python3
"""The inspector for hours: does it take more and more memory, keep descriptors, become slower?

    tests/soak/soak.py --program FILE --plugins FOLDER [--minutes M] [--seed S] [--output DIR]

One process of the inspector, off-screen, plays rounds of random deeds (rounds.py) until the time is
over; beside it small headless runs follow each other. In each round, in the same state, the
inspector's memory, descriptors, threads and worker processes are sampled, and the processor time
that a small piece of work takes. In the end a table judges them (judgement.py); samples.csv,
runs.csv and soak.png are in the output folder. Exit status 1 if anything grows, is left behind or
becomes slower, or if the inspector ends by itself.
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

from judgement import Judgement, grows, leaks, slows_down
from rounds import BEGIN, END, RECORDINGS, Rounds

#: No round takes less, in seconds: so many are written into the script.
SHORTEST_ROUND = 1.0
FEWEST_ROUNDS = 2
#: A pause of so many seconds is none of ours.
STOPPED = 5
#: After so many seconds what wrote the mark is closed again.
CALM = 0.2
#: A round that takes longer hangs.
LONGEST_ROUND = 300
MIB = 1 << 20


@dataclass(frozen=True)
class Sample:
    """Of the inspector, in a round."""

    minutes: float  #: since the beginning
    resident_mib: float
    anonymous_mib: float  #: of that what is not of files: heap and stacks
    descriptors: int
    threads: int
    workers: int  #: processes that it has started and that are there
    processor_seconds: float  #: of the small piece of work
    seconds: float  #: the same by the clock


class Process:
    """What the system tells of a process."""

    def __init__(self, pid: int) -> None:
        self._folder = pathlib.Path(f"/proc/{pid}")
        self._pid = pid

    def mib(self, name: str) -> float:
        for line in (self._folder / "status").read_text().splitlines():
            if line.startswith(name + ":"):
                return int(line.split()[1]) * 1024 / MIB
        return 0.0

    def count(self, of: str) -> int:
        return len(list((self._folder / of).iterdir()))

    def children(self) -> int:
        tasks = (self._folder / "task").glob("*/children")
        return sum(len(task.read_text().split()) for task in tasks)

    def processor_seconds(self) -> float:
        numbers = (self._folder / "stat").read_text().rsplit(")", 1)[1].split()
        return (int(numbers[11]) + int(numbers[12])) / os.sysconf("SC_CLK_TCK")


class Inspector:
    """The inspector, and what has been sampled of it."""

    def __init__(self, options: argparse.Namespace, folder: pathlib.Path) -> None:
        self.samples: list[Sample] = []
        self._marks = {name: folder / name for name in (BEGIN, END)}
        for mark in self._marks.values():
            mark.write_text("")
        self._seen = {name: self._time(name) for name in self._marks}
        self._begun: Sample | None = None
        self._begun_at = 0.0  # in processor seconds
        self._due: float | None = None  # when it is to be sampled
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
        self._start = self._last = self._looked = time.monotonic()

    def look(self) -> None:
        """Takes note of what has happened since."""
        now = time.monotonic()
        if now > self._looked + STOPPED:
            self._last += now - self._looked  # somebody has stopped us all for a while
        self._looked = now
        if self._changed(BEGIN):
            self._changed(END)
            self._begun = None
            self._begun_at = self._system.processor_seconds()
            self._due = time.monotonic() + CALM
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

    def wrong(self) -> str:
        """Why it is no use going on."""
        if self._process.poll() is not None:
            return f"has ended by itself, with {self._process.returncode}: see output.txt"
        if time.monotonic() - self._last > LONGEST_ROUND:
            return f"has not ended a round for {LONGEST_ROUND} s"
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
            return False  # while another takes its name
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
    """Small runs, one after the other with pauses; each is the same as the first."""

    PAUSE = 2.0

    def __init__(self, options: argparse.Namespace, folder: pathlib.Path) -> None:
        self.processor_seconds: list[float] = []
        self._command = (
            [
                options.program,
                "--headless",
                "yardstick.broadmark",
                "--quiet",
                "--check",
                "full",
            ]
            + ["--algorithm", "sap,kd-mt,columns,tide", "--threads", "2"]
            + ["--json", "results.json", "--csv", "results.csv"]
            # How busy the machine is is no fault of theirs.
            + ["--allow-timeout", "--hard-limit", "600"]
        )
        self._folder = folder
        self._process: subprocess.Popen[bytes] | None = None
        self._next = time.monotonic()

    def look(self) -> None:
        """Takes note of one that has ended, or begins another."""
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
            raise SystemExit(f"soak: a headless run has ended with status {status}")
        self.processor_seconds.append(usage.ru_utime + usage.ru_stime)
        self._next = time.monotonic() + self.PAUSE

    def end(self) -> None:
        if self._process:
            self._process.kill()
            self._process.wait()


def prepare(options: argparse.Namespace, folder: pathlib.Path) -> None:
    """Recordings, and a script that is longer than the time."""
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
        for _ in range(2 + round(60 * options.minutes / SHORTEST_ROUND)):
            script.write(next(rounds))


def judged(inspector: Inspector, runs: HeadlessRuns, allowed_mib: float) -> list[Judgement]:
    def of(name: str) -> list[float]:
        return [getattr(sample, name) for sample in inspector.samples]

    allowed_share = 0.1
    return [
        grows("resident memory, MiB", of("resident_mib"), allowed_mib),
        grows("of that heap and stacks, MiB", of("anonymous_mib"), allowed_mib),
        leaks("descriptors", of("descriptors")),
        leaks("threads", of("threads")),
        leaks("worker processes", of("workers")),
        slows_down("inspector's yardstick, s", of("processor_seconds"), allowed_share),
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
        "yardstick, s": ["processor_seconds", "seconds"],
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


def report(judgements: list[Judgement], rounds: int, runs: int) -> None:
    print(f"{rounds} rounds of the inspector, {runs} headless runs")
    print(f"{'':32} {'at first':>10} {'at last':>10}")
    for one in judgements:
        print(f"{one.what:32} {one.first:10.2f} {one.last:10.2f}  {one.wrong or 'ok'}")


def parsed() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--program", type=pathlib.Path, required=True, help="broadmark")
    parser.add_argument(
        "--plugins",
        type=pathlib.Path,
        required=True,
        help="where the tests' plug-ins are",
    )
    parser.add_argument("--minutes", type=float, default=120, help="how long (default: 120)")
    parser.add_argument("--seed", type=int, default=1, help="same seed, same deeds")
    parser.add_argument(
        "--allowed-mib", type=float, default=16, help="growth of memory that is allowed"
    )
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
    start = told = time.monotonic()
    try:
        while not (wrong := inspector.wrong()):
            is_over = time.monotonic() > start + 60 * options.minutes
            if is_over and len(inspector.samples) >= FEWEST_ROUNDS:
                break
            inspector.look()
            runs.look()
            time.sleep(0.01)
            if time.monotonic() > told + 60:
                told = time.monotonic()
                write_csv(folder, inspector, runs)
                minutes = (told - start) / 60
                print(f"soak: {minutes:.0f} of {options.minutes:g} min", file=sys.stderr)
    finally:
        inspector.end()
        runs.end()
    write_csv(folder, inspector, runs)
    judgements = judged(inspector, runs, options.allowed_mib)
    report(judgements, len(inspector.samples), len(runs.processor_seconds))
    if inspector.samples:
        draw(folder / "soak.png", inspector.samples)
    if wrong:
        print(f"soak: the inspector {wrong}", file=sys.stderr)
        print((work / "output.txt").read_text(errors="replace")[-2000:], file=sys.stderr)
    return 1 if wrong or any(one.wrong for one in judgements) else 0


if __name__ == "__main__":
    sys.exit(main())
