"""The colours by their meaning, read from assets/palette.txt as by the program."""

from __future__ import annotations

import pathlib
from collections.abc import Iterable

_MODULE = pathlib.Path(__file__).resolve()
_CANDIDATES = [_MODULE.with_name("palette.txt"), _MODULE.parents[2] / "assets/palette.txt"]

#: Colours by name, for light and for dark backgrounds.
LIGHT: dict[str, list[str]] = {}
DARK: dict[str, list[str]] = {}

#: The index of each algorithm family's curve colour.
CURVES: dict[str, int] = {}

for _line in next(path for path in _CANDIDATES if path.exists()).read_text("utf-8").splitlines():
    if _line and not _line.startswith("#"):
        _name, _light, _dark, *_meaning = _line.split(maxsplit=3)
        if _name == "curve":
            CURVES |= dict.fromkeys(_meaning[0].split(", "), len(LIGHT.get("curve", [])))
        LIGHT.setdefault(_name, []).append(f"#{_light}")
        DARK.setdefault(_name, []).append(f"#{_dark}")


def light(name: str) -> str:
    """The colour `name` on light backgrounds."""
    (colour,) = LIGHT[name]
    return colour


def curves_of(families: Iterable[str]) -> dict[str, int]:
    """The index of each family's curve colour. Families that the palette does not list share the
    colours that the others leave unused."""
    names = sorted(set(families))
    used = {CURVES[name] for name in names if name in CURVES}
    indices = range(len(LIGHT["curve"]))
    unused = [i for i in indices if i not in used] or list(indices)
    unlisted = [name for name in names if name not in CURVES]
    return {
        name: CURVES[name] if name in CURVES else unused[unlisted.index(name) % len(unused)]
        for name in names
    }


def css(colours: dict[str, list[str]]) -> str:
    """CSS custom properties: --NAME, or --NAME-0, --NAME-1, … for a list of colours."""
    named = [
        (name if len(values) == 1 else f"{name}-{i}", colour)
        for name, values in colours.items()
        for i, colour in enumerate(values)
    ]
    return " ".join(f"--{name}: {colour};" for name, colour in named)
