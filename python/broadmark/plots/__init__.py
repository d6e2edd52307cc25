"""Plots of results. Each kind is a module with a function that is listed in KINDS."""

from __future__ import annotations

from collections.abc import Callable

from matplotlib.figure import Figure

from broadmark.plots.bars import bars
from broadmark.plots.cases import Cases
from broadmark.plots.frames import frames, pairs, phases
from broadmark.plots.memory import memory
from broadmark.plots.scaling import scaling
from broadmark.plots.violins import violins

#: The kinds and their functions. The docstring of a function is its help.
KINDS: dict[str, Callable[[Cases], Figure]] = {
    "bars": bars,
    "violins": violins,
    "frames": frames,
    "scaling": scaling,
    "memory": memory,
    "phases": phases,
    "pairs": pairs,
}

#: The kinds that are divided into pages (panels.pages_of).
PAGED = ["bars", "violins"]
