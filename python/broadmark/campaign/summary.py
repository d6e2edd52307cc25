"""The state of a campaign as a table."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from broadmark.campaign.ledger import Ledger
from broadmark.campaign.plan import Recording
from broadmark.text_tables import aligned

COLUMNS = ["ok", "timeout", "mismatch", "unsupported", "error", "not run", "pending"]


def table(
    ledger: Ledger, recordings: list[Recording], is_baked: Callable[[Recording], bool]
) -> str:
    """A row per recording, and a line per cap."""
    rows = [["recording", "file", *COLUMNS]]
    for recording in recordings:
        counts = ledger.tally(recording)
        file = "baked" if is_baked(recording) else "to split" if recording.source else "to bake"
        rows.append([recording.name, file, *(str(counts[name] or "–") for name in COLUMNS)])
    return "\n".join([*aligned(rows, left=2), *_caps(ledger, recordings)])


def _caps(ledger: Ledger, recordings: list[Recording]) -> Iterator[str]:
    """A line per series and cap with the variants that were not run beyond it."""
    beyond: dict[str, list[str]] = {}
    for recording in recordings:
        series = recording.series
        for variant in ledger.variants:
            cap = ledger.cap(recording, variant)
            if cap is not None:
                limit = f"{series.scene} {series.object_type} {series.variation} beyond {cap}"
                if variant not in beyond.setdefault(limit, []):
                    beyond[limit].append(variant)
    for limit, variants in beyond.items():
        yield f"not run, past the cap: {limit}: {', '.join(variants)}"
