"""The colours, each by its meaning: assets/palette.txt, from which the program has them, too."""

from __future__ import annotations

import pathlib
from collections.abc import Iterable

_HERE = pathlib.Path(__file__).resolve()
_PLACES = [_HERE.with_name("palette.txt"), _HERE.parents[2] / "assets/palette.txt"]

#: By name, for light and for dark backgrounds.
LIGHT: dict[str, list[str]] = {}
DARK: dict[str, list[str]] = {}

#: Which of the curve colours a family of algorithms has.
CURVES: dict[str, int] = {}

for _line in next(one for one in _PLACES if one.exists()).read_text("utf-8").splitlines():
    if _line and not _line.startswith("#"):
        _name, _light, _dark, *_meaning = _line.split(maxsplit=3)
        if _name == "curve":
            CURVES |= dict.fromkeys(_meaning[0].split(", "), len(LIGHT.get("curve", [])))
        LIGHT.setdefault(_name, []).append(f"#{_light}")
        DARK.setdefault(_name, []).append(f"#{_dark}")


def light(name: str) -> str:
    """The single colour of this name, on light backgrounds."""
    (colour,) = LIGHT[name]
    return colour


def curves_of(families: Iterable[str]) -> dict[str, int]:
    """Which curve colour each family has. Those that the palette does not list have what the others
    leave, and repeat it."""
    names = sorted(set(families))
    taken = {CURVES[name] for name in names if name in CURVES}
    every = range(len(LIGHT["curve"]))
    left = [one for one in every if one not in taken] or list(every)
    others = [name for name in names if name not in CURVES]
    return {
        name: CURVES[name] if name in CURVES else left[others.index(name) % len(left)]
        for name in names
    }


def css(colours: dict[str, list[str]]) -> str:
    """Custom properties: --NAME, of a list --NAME-0 and so on."""
    named = [
        (name if len(several) == 1 else f"{name}-{i}", colour)
        for name, several in colours.items()
        for i, colour in enumerate(several)
    ]
    return " ".join(f"--{name}: {colour};" for name, colour in named)
