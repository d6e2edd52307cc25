"""Two files as before and after, with the verdicts of `broadmark compare`."""

from __future__ import annotations

import json
import os
import tempfile
from typing import Any

from broadmark.errors import InputError
from broadmark.program import call
from broadmark.results import Results

#: Exit statuses of `broadmark compare` with a comparison: success, a wrong answer, a regression.
WITH_COMPARISON = (0, 1, 3)


def comparison(results: Results) -> tuple[dict[str, Any] | None, list[str]]:
    """The comparison of the first with the second file, if there are two that have comparable cases,
    and sentences on why there is none."""
    names = list(dict.fromkeys(results.files["file"])) if len(results.files) else []
    if len(names) != 2 or results.cases["file"].nunique() != 2:
        return None, []
    with tempfile.TemporaryDirectory(prefix="broadmark-") as folder:
        paths = [os.path.join(folder, f"{side}.json") for side in ("before", "after")]
        for name, path in zip(names, paths):
            results.select(results.cases["file"] == name).save(path)

        def named(text: str) -> str:
            """The text with the names of the files instead of the temporary paths."""
            for name, path in zip(names, paths):
                text = text.replace(path, name)
            return text

        try:
            text = call("compare", *paths, "--json", "-", accept=WITH_COMPARISON)
        except InputError as error:
            return None, [f"The two files are not compared: {named(str(error))}."]
    document = json.loads(text)
    number = {
        (file, id_): i
        for i, (file, id_) in enumerate(zip(results.cases["file"], results.cases["id"]))
    }
    rows = []
    for case in document["cases"]:
        index = number.get((names[1], case["id"]), number.get((names[0], case["baseline"])))
        if index is not None:
            low, high = case["ci95"] or (None, None)
            keys = ("verdict", "seconds_before", "seconds_after", "ratio", "reason")
            rows.append(
                {key: case[key] for key in keys} | {"case": index, "low": low, "high": high}
            )
    if all(row["ratio"] is None for row in rows):
        return None, []
    notes = [named(note) for note in document["notes"]]
    differences = {text for case in document["cases"] for text in case["conditions"]}
    return {
        "before": names[0],
        "after": names[1],
        "summary": document["summary"],
        "notes": [*notes, *sorted(differences)],
        "rows": rows,
    }, []
