"""Plots of results. A kind is a function here and a line in KINDS; its module tells what it shows."""

from __future__ import annotations

from collections.abc import Callable

from matplotlib.figure import Figure

from broadmark.plots.bars import bars
from broadmark.plots.cases import Cases
from broadmark.plots.frames import frames, pairs, phases
from broadmark.plots.memory import memory
from broadmark.plots.scaling import scaling
from broadmark.plots.violins import violins

#: One line per kind: its function, whose docstring is the help.
KINDS: dict[str, Callable[[Cases], Figure]] = {
    "bars": bars,
    "violins": violins,
    "frames": frames,
    "scaling": scaling,
    "memory": memory,
    "phases": phases,
    "pairs": pairs,
}
