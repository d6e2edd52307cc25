"""What a campaign file is to the program: requests, and the cases and names that it makes of them."""

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

#: Options of a campaign that are part of its selections; the others tell how cases are measured.
OF_SELECTIONS = ("plugin", "device", "answer")


def plugin_options(campaign: Campaign) -> list[str]:
    """The program's options that load the campaign's libraries."""
    return list(itertools.chain(*(("--plugin", one) for one in campaign.options.get("plugin", ()))))


def selection_request(campaign: Campaign, selection: Selection) -> dict[str, Any]:
    """What a run request says of the cases of a selection."""
    return {
        "algorithm": selection.algorithms,
        "threads": selection.threads,
        "isa": selection.isas,
        "param": dict(selection.parameters),
        **{name: campaign.options.get(name) for name in OF_SELECTIONS},
    }


def measuring_request(campaign: Campaign) -> dict[str, Any]:
    """What a run request says of how each case is measured."""
    options = campaign.options.items()
    return {name: value for name, value in options if name not in OF_SELECTIONS}


def planned_variants(campaign: Campaign) -> dict[str, Selection]:
    """Every variant once, with the first selection that has it. The program makes them."""
    with tempfile.TemporaryDirectory(prefix="broadmark-") as folder:
        path = os.path.join(folder, "one.aabbs")
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
    """What files of recordings begin with, by scene and object type. The program checks what the
    file says of recordings on the way."""
    names: dict[tuple[str, str], str] = {}
    for block in campaign.blocks:
        try:
            listed = call(
                *("bake", "--list", "--quiet", "--output", "recordings that are not there"),
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
        names |= {(scene.lower(), kind.lower()): name for name, scene, kind in found}
    return names


def filter_for(variants: list[str]) -> str:
    """A regular expression that only the ids of these cases match."""
    names = (re.sub(r"([.*+?^${}()|\[\]\\])", r"\\\1", one) for one in variants)
    return f"/F[0-9]+/({'|'.join(names)})$"
