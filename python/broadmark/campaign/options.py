"""The program's view of a campaign: run requests, and the variants and file names it derives."""

from __future__ import annotations

import itertools
import os
import re
import tempfile
from typing import Any

from broadmark.campaign.description import Campaign, Selection
from broadmark.campaign.plan import as_text
from broadmark.errors import InputError
from broadmark.program import as_options, call, request_file
from broadmark.recordings import write_recording

#: Campaign options that belong to every selection; the others set how cases are measured.
SELECTION_OPTIONS = ("plugin", "device", "answer", "queries")


def plugin_options(campaign: Campaign) -> list[str]:
    """The options that load the campaign's plug-ins."""
    return list(
        itertools.chain(*(("--plugin", path) for path in campaign.options.get("plugin", ())))
    )


def selection_request(campaign: Campaign, selection: Selection) -> dict[str, Any]:
    """The part of a run request that selects cases."""
    return {
        "algorithm": selection.algorithms,
        "threads": selection.threads,
        "isa": selection.isas,
        "param": dict(selection.parameters),
        **{name: campaign.options.get(name) for name in SELECTION_OPTIONS},
    }


def measuring_request(campaign: Campaign) -> dict[str, Any]:
    """The part of a run request that sets how cases are measured."""
    options = campaign.options.items()
    return {name: value for name, value in options if name not in SELECTION_OPTIONS}


def planned_variants(campaign: Campaign) -> dict[str, Selection]:
    """The variants, listed by the program, each with the first selection that contains it."""
    with tempfile.TemporaryDirectory(prefix="broadmark-") as folder:
        path = os.path.join(folder, "pair.aabbs")
        write_recording(path, [[[0, 0, 0, 1, 1, 1]]] * 2, name="X", object_type="X")
        variants: dict[str, Selection] = {}
        for selection in campaign.selections:
            try:
                with request_file(source=path, **selection_request(campaign, selection)) as request:
                    listed = call("--headless", "--request", request, "--list")
            except InputError as error:
                raise InputError(f"{campaign.path}: {selection.where}: {error}") from None
            for case in listed.splitlines():
                variants.setdefault(case.removeprefix("X/X/N1/F1/"), selection)
        return variants


def recording_names(campaign: Campaign) -> dict[tuple[str, str], str]:
    """The prefix of recordings' file names, by scene and object type. The program also validates the
    campaign's recordings."""
    names: dict[tuple[str, str], str] = {}
    for block in campaign.blocks:
        try:
            listed = call(
                *("bake", "--list", "--quiet", "--output", "nonexistent recordings"),
                *as_options(scenes=block.scenes, object_type=block.object_types),
                *as_options(objects=block.objects, frames=block.frames, seed=block.seeds),
                *as_options(engine=",".join(filter(None, block.engines)) or None),
                *plugin_options(campaign),
                *as_options(
                    param={name: map(as_text, values) for name, values in block.parameters}
                ),
            )
        except InputError as error:
            raise InputError(f"{campaign.path}: {block.where}: {error}") from None
        found = re.findall(
            r"/(([^/ ]+) ([^/ ]+)) N\d+ F\d+frames.*\.(?:aabbs|broadmark)$", listed, re.MULTILINE
        )
        names |= {(scene.lower(), object_type.lower()): name for name, scene, object_type in found}
    return names


def filter_for(variants: list[str]) -> str:
    """A regular expression that matches only the ids of these variants' cases."""
    names = (re.sub(r"([.*+?^${}()|\[\]\\])", r"\\\1", variant) for variant in variants)
    return f"/F[0-9]+/({'|'.join(names)})$"
