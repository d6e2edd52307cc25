"""The page: template, styles, d3, scripts and data in one file.

A Content-Security-Policy with the hash of every script and style forbids all other resources. The data
is JSON in an inert element, and scripts insert it only as text.
"""

from __future__ import annotations

import base64
import datetime
import hashlib
import json
import os
import pathlib
import string
from typing import Any

from broadmark.errors import InputError
from broadmark.files import atomic_write
from broadmark.palette import DARK, LIGHT, css
from broadmark.report.compared import comparison
from broadmark.report.data import page_data
from broadmark.report.pictures import draw_pictures
from broadmark.report.timelines import points_per_case, timeline
from broadmark.results import Results

FOLDER = pathlib.Path(__file__).parent / "web"

#: From Debian's package node-d3.
D3 = pathlib.Path("/usr/share/nodejs/d3/dist/d3.min.js")
D3_LICENCE = pathlib.Path("/usr/share/doc/node-d3/copyright")

#: The page's scripts in dependency order.
SCRIPTS = (
    "format elements cases ranking filters tooltip panels timeline details table summary ratios rows "
    "scaling memory frames worst failures compared main"
).split()


def write_report(
    results: Results,
    path: str | os.PathLike[str],
    *,
    title: str = "",
    pictures: bool = True,
    program_page: str = "",
) -> list[str]:
    """Writes the page and returns notes on missing parts, a sentence each.

    `pictures`: draws the scenes if the program `broadmark` is found. `program_page`: the address of the
    program for browsers, to which the cases link. Raises InputError, without a new
    file, if d3 is missing or the file cannot be written.
    """
    d3, licence = _read_text(D3), _read_text(D3_LICENCE)
    points = points_per_case(len(results.details))
    try:
        data = page_data(results, program_page=program_page)
        lines = "\n".join(timeline(case, points) for case in results.details)
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise InputError(
            f"the results do not match docs/results.md: {type(error).__name__} {error}"
        ) from None
    data["comparison"], notes = comparison(results)
    drawn: list[dict[str, Any]] = []
    words = [recording.pop("words") for recording in data["recordings"]]
    if pictures:
        drawn, missing = draw_pictures(data["recordings"], words)
        notes = [*notes, *missing]
    data |= {
        "title": title or "Broadmark results",
        "written": datetime.datetime.now(datetime.timezone.utc).isoformat(" ", "minutes")[:16],
        "pictures": drawn,
        "picture_notes": notes,
        "licence": licence,
    }
    with atomic_write(path) as file:
        file.write(_page(data, lines, d3).encode("utf-8", "replace"))
    return notes


def _page(data: dict[str, Any], timelines: str, d3: str) -> str:
    style = f":root {{ color-scheme: light; {css(LIGHT)} }}\n"
    style += (FOLDER / "report.css").read_text("utf-8")
    # The media attribute of the style element enables the dark theme.
    dark = f":root {{ color-scheme: dark; {css(DARK)} }}"
    scripts = "\n".join((FOLDER / f"{name}.js").read_text("utf-8") for name in SCRIPTS)
    script = f'(() => {{\n"use strict";\n{scripts}\n}})();\n'
    template = string.Template((FOLDER / "page.html").read_text("utf-8"))
    return template.substitute(
        policy=(
            f"default-src 'none'; script-src {_hash(d3)} {_hash(script)}; "
            f"style-src {_hash(style)} {_hash(dark)}; img-src data:; base-uri 'none'; form-action 'none'"
        ),
        title=_escaped(data["title"]),
        style=style,
        dark=dark,
        data=_json(data),
        d3=d3,
        script=script,
        timelines=timelines,
    )


def _json(data: Any) -> str:
    """JSON without < and >, so that the text cannot end its element."""
    text = json.dumps(data, separators=(",", ":"), allow_nan=False)
    return text.replace("<", "\\u003c").replace(">", "\\u003e")


def _escaped(text: str) -> str:
    return text.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")


def _hash(script: str) -> str:
    digest = hashlib.sha256(script.encode("utf-8")).digest()
    return f"'sha256-{base64.b64encode(digest).decode('ascii')}'"


def _read_text(path: pathlib.Path) -> str:
    try:
        return path.read_text("utf-8")
    except OSError:
        raise InputError(
            f"{path} was not found: the report's charts require Debian's package node-d3"
        ) from None
