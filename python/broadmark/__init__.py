"""Broadmark from Python: recordings as arrays, results as data frames, runs, tables and figures.

`python3 -m broadmark --help` lists the commands. The functions behind them:

- `read_recording`, `write_recording`: the boxes of a recording as numpy arrays
- `present`: which bodies are present; `EMPTY_BOX` is the box of an absent body
- `run`: runs algorithms on a scene, a recording or arrays with the program `broadmark`
- `measure`: times a Python function on a recording, and checks its answers
- `overlaps`: the overlapping pairs of an array of boxes
- `BroadPhase`: the overlapping pairs, or their changes, from frame to frame
- `read_results`: results files as pandas data frames
"""

import importlib.util
import sys

if _missing := [name for name in ("numpy", "pandas") if importlib.util.find_spec(name) is None]:
    raise ImportError(
        f"broadmark needs {' and '.join(_missing)}, which {sys.executable} lacks: Debian's "
        "packages are for /usr/bin/python3"
    )

from broadmark.arguments import EMPTY_BOX
from broadmark.broad_phase import BroadPhase
from broadmark.errors import InputError
from broadmark.measure import measure
from broadmark.native import overlaps
from broadmark.program import run
from broadmark.recording2 import ChangingRecording, Groups, present
from broadmark.recordings import PoseRecording, Recording, read_recording, write_recording
from broadmark.results import Results, read_results

__version__ = "0.1.0"  #: the program's

__all__ = [
    "EMPTY_BOX",
    "BroadPhase",
    "ChangingRecording",
    "Groups",
    "InputError",
    "PoseRecording",
    "Recording",
    "Results",
    "measure",
    "overlaps",
    "present",
    "read_recording",
    "read_results",
    "run",
    "write_recording",
]
