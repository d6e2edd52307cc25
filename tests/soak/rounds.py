"""The actions of the soak test: rounds of an inspector script, generated from a seed.

A round consists of random actions with random values, followed by the reference work, which is the
same in every round and enclosed by two marks, so that its samples are comparable between rounds. An
action leaves no algorithm and no unsaved changes behind, so actions can follow in any order. Actions
contain `expect` commands: an unexpected state ends the script with the line number.
"""

from __future__ import annotations

import pathlib
import random
import re
from collections.abc import Callable, Iterator

#: Algorithms of every build.
ALGORITHMS = [
    "sap",
    "kd",
    "kd-mt",
    "columns",
    "columns-mt",
    "tide",
    "dbvt-d",
    "grid-bf",
    "tracy",
]
SCENES = [
    "brownian",
    "freefall",
    "gravity",
    "explosion",
    "conveyor",
    "swarm",
    "fountain",
]
#: The names that the inspector's panels state.
PANELS = sorted(
    name
    for file in (pathlib.Path(__file__).parents[2] / "app/inspector/panels").glob("*.cpp")
    for name in re.findall(r'PanelSpec spec = {\s*"(\w+)"', file.read_text())
)
#: Recordings to prepare, with the arguments of `bake`.
RECORDINGS = {
    "reference.broadmark": [
        "--scenes",
        "brownian",
        "--objects",
        "400",
        "--frames",
        "20",
        "--engine",
        "kinematic",
    ],
    "many.broadmark": ["--scenes", "swarm", "--objects", "2000", "--frames", "10"],
    "changing.broadmark": [
        "--scenes",
        "fountain",
        "--objects",
        "300",
        "--frames",
        "30",
    ],
}
#: The marks before and after the reference work.
BEGIN, END = "begun", "ended"

REFERENCE_WORK = f"""
resize 1280x720
open reference.broadmark
wait idle
key Home
click Algorithms/Add…
click Algorithms/add/sap
wait idle
write frame {BEGIN}
wait 40
key End
wait idle
write frame {END}
expect algorithm.sap.status = ok
click Algorithms/sap/Remove
expect algorithms = 0
expect error = ""
"""


class Rounds:
    """An endless script, determined by its seed."""

    def __init__(self, seed: int) -> None:
        self._random = random.Random(seed)
        self._saved: set[str] = set()
        self._actions: list[Callable[[], str]] = []

    def __iter__(self) -> Iterator[str]:
        yield "patience 20\nopen reference.broadmark\nclick Playback/Loop\nexpect loop = yes\n"
        yield "click Batch/scenes/freefall\nclick Batch/scenes/brownian\n"  # only one scene
        while True:
            yield "".join(self._next()() for _ in range(2)) + REFERENCE_WORK

    def _next(self) -> Callable[[], str]:
        """All actions once in random order, then again."""
        if not self._actions:
            self._actions = [
                self._open,
                self._simulate,
                self._save,
                self._compare,
                self._crash,
                self._change_view,
                self._author,
                self._export,
                self._batch,
            ]
            self._random.shuffle(self._actions)
        return self._actions.pop()

    def _number(self, minimum: int, maximum: int) -> int:
        return self._random.randint(minimum, maximum)

    def _open(self) -> str:
        name = self._random.choice(list(RECORDINGS))
        return f"open {name}\nwait idle\nexpect title = {name}\n" + self._seek() + self._play()

    def _seek(self) -> str:
        keys = self._random.choices(["Home", "End", "Left", "Right"], k=self._number(2, 6))
        jumps = "".join(f"key {key}\n" for key in keys)
        return jumps + "wait idle\nclick Playback/frame\nwait idle\n"

    def _play(self) -> str:
        return f"""
choose Playback/speed fastest
click Playback/Play
expect playing = yes
wait {self._number(10, 60)}
click Playback/Play
expect playing = no
wait idle
"""

    def _simulate(self) -> str:
        # The form of a new simulation is collapsed while a recording is open.
        return f"""
open reference.broadmark
wait idle
click Scene/draft
choose Scene/scene {self._random.choice(SCENES)}
enter Scene/objects {self._number(20, 300)}
enter Scene/frames {self._number(5, 40)}
click Scene/Simulate
wait idle
expect error = ""
{self._seek()}
"""

    def _save(self) -> str:
        name = f"saved-{self._number(1, 5)}.broadmark"
        replace = "expect dialog = yes\nclick File/Save\n" if name in self._saved else ""
        self._saved.add(name)
        return f"""
{self._simulate()}
key Ctrl+S
expect dialog = yes
enter File/name {name}
{replace}expect dialog = no
wait idle
open {name}
wait idle
expect title = {name}
"""

    def _compare(self) -> str:
        ids = self._random.sample(ALGORITHMS, self._number(2, 4))
        add = "".join(f"click Algorithms/Add…\nclick Algorithms/add/{id_}\n" for id_ in ids)
        remove = "".join(f"click Algorithms/{id_}/Remove\n" for id_ in ids)
        expectations = "".join(f"expect algorithm.{id_}.status = ok\n" for id_ in ids)
        return f"""
open changing.broadmark
wait idle
{add}wait idle
{self._seek()}
{expectations}panel Results
wait 3
panel Timeline
click Timeline/logarithmic
wait 5
{remove}expect algorithms = 0
"""

    def _crash(self) -> str:
        """An algorithm crashes its worker process."""
        return f"""
open reference.broadmark
wait idle
key Home
click Algorithms/Add…
click Algorithms/add/unruly
choose Algorithms/unruly/deed crash
enter Algorithms/unruly/frame {self._number(1, 19)}
key End
wait idle
expect algorithm.unruly.status = error
click Algorithms/unruly/Remove
expect error = ""
"""

    def _change_view(self) -> str:
        share = self._random.random
        return f"""
resize {self._number(300, 1900)}x{self._number(200, 1000)}
wait 2
resize 1280x720
wait 2
drag View/scene 0.5 0.5 {share():.2f} {share():.2f}
drag View/scene {share():.2f} {share():.2f} 0.5 0.5 1
wheel View/scene {self._number(-4, 4)}
drag View/scene 0.1 0.1 0.9 0.9 0 Shift
wait 2
key Escape
key C
key H
key H
click "Display/{self._random.choice(['top', 'front', 'left', 'figure', 'whole scene'])}"
wait 20
panel {self._random.choice(PANELS)}
wait 2
panel {self._random.choice(PANELS)}
screenshot picture.png
"""

    def _author(self) -> str:
        undo = "key Ctrl+Z\n" + "key Ctrl+Z\nkey Ctrl+Shift+Z\n" * self._number(1, 3)
        return f"""
click Author/New
wait idle
expect author.bodies = 0
choose Author/Brush/brush lattice
enter Author/Brush/count_x {self._number(1, 5)}
enter Author/Brush/count_y {self._number(1, 5)}
enter Author/Brush/count_z 2
click Author/Brush/Add
expect author.bodies > 1
enter "Author/Selection/by x" {self._number(1, 9)}
click Author/Selection/Move
enter Author/Selection/factor 0.5
click Author/Selection/Scale
enter "Author/Selection/velocity y" {self._number(-3, 3)}
enter "Author/Selection/by x" 20
click Author/Selection/Duplicate
{undo}wait idle
click Author/Simulate
wait idle
click "Author/From this frame"
click Unsaved/Discard
wait idle
expect author.modified = yes
click Author/New
click Unsaved/Discard
expect author.bodies = 0
expect author.modified = no
"""

    def _export(self) -> str:
        """Exports a reduced case of a wrong answer."""
        name = f"case-{self._number(1, 3)}.aabbs"
        replace = "expect dialog = yes\nclick File/Save\n" if name in self._saved else ""
        self._saved.add(name)
        return f"""
open many.broadmark
wait idle
key Home
click Algorithms/Add…
click Algorithms/add/faulty
enter Algorithms/faulty/fat_margin 0.5
wait idle
click "Mismatches/Next mismatch"
wait idle
expect mismatch_pairs > 0
click "Mismatches/Export case…"
enter File/name {name}
{replace}expect export.state = done
key Escape
click Algorithms/faulty/Remove
"""

    def _batch(self) -> str:
        return f"""
enter Batch/objects "{self._number(10, 40)}, {self._number(41, 90)}"
enter Batch/frames {self._number(2, 9)}
enter Batch/output batch
click Batch/Start
expect batch.state = done
expect batch.failed = 0
"""
