"""What times depend on besides the code: the machine, its compiler, and how a case was measured."""

from __future__ import annotations

import re
from typing import Any

#: What distinguishes machines: the key in the environment, and its form in labels. Host names and
#: kernel versions are left out: they change from one container to the next.
FACTS: dict[str, str] = {
    "cpu": "{}",
    "logical_cores": "{} cores",
    "physical_cores": "{} physical cores",
    "memory_bytes": "{} GiB",
    "isa": "{}",
    "governor": "governor {}",
    "compiler": "{}",
    "compiler_flags": "{}",
    "build_type": "{}",
}

#: Facts that are shown even if they are the same on all machines.
_ALWAYS = ("cpu", "logical_cores")

#: What distinguishes measurements of a case on one machine: the key in its conditions and its name.
CONDITIONS = {"check": "check", "in_process": "in process", "pinned": "pinned"}

Machine = tuple[Any, ...]


def machine_of(environment: dict[str, Any], by_host: bool) -> Machine:
    """The facts of an environment, in the order of FACTS, and the host if machines differ by it."""
    facts = [_fact(environment, key) for key in FACTS]
    return (*facts, str(environment.get("host") or "") if by_host else "")


def _fact(environment: dict[str, Any], key: str) -> str:
    value = environment.get(key)
    if value is None or value != value:
        return ""
    if key == "memory_bytes":
        return f"{float(value) / 2**30:.0f}"  # what the kernel reserves varies
    if isinstance(value, float) and value.is_integer():
        value = int(value)  # a column of a table in which other rows lack the value
    return " ".join(str(value).split())


def machine_labels(machines: list[Machine]) -> list[str]:
    """A short label of each machine: processor, cores and the facts that differ between machines."""
    labels = []
    for machine in machines:
        parts = [machine[-1]] if machine[-1] else []
        for i, (key, form) in enumerate(FACTS.items()):
            differs = len({other[i] for other in machines}) > 1
            if machine[i] and (differs or key in _ALWAYS):
                text = _short_processor(machine[i]) if key == "cpu" else machine[i]
                parts.append(form.format(text))
        labels.append(", ".join(parts) or "unknown machine")
    return [
        label if labels.count(label) == 1 else f"{label} #{labels[:i].count(label) + 1}"
        for i, label in enumerate(labels)
    ]


def _short_processor(name: str) -> str:
    """The short name of a processor: `AMD EPYC 9B14` for `AMD EPYC 9B14 96-Core Processor`."""
    name = re.sub(r"\((R|TM|r|tm)\)", "", name)
    name = re.sub(r"(\s\d+-Core)?\s(Processor|CPU)\b|\s@.*", "", name)
    return " ".join(name.split())


def conditions_of(case: dict[str, Any]) -> tuple[tuple[str, str], ...]:
    """The conditions under which a case was measured, by name. Times under others are not
    comparable."""
    conditions = case.get("conditions", {})
    plugin = conditions.get("plugin")
    return (
        ("recording", str(case["recording"]["hash"])[:7]),
        ("device", str(case.get("device") or "")),
        *((name, str(conditions.get(key, ""))) for key, name in CONDITIONS.items()),
        ("plug-in's options", str(plugin.get("flags", "")) if isinstance(plugin, dict) else ""),
    )
