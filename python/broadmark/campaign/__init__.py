"""Campaigns: many cases described in one file, run for hours or on many machines.

- `description`: the campaign file, parsed and validated
- `plan`: the campaign's recordings
- `ledger`: the state of the campaign's cases: finished, past the cap, pending
- `attempts`: the program's results, read while and after they are written
- `folder`: the layout of the campaign's folder
- `runner`: bakes missing recordings, runs pending cases
- `estimate`: the remaining time
- `progress`: the progress line
- `summary`: the table of states
- `slurm`: jobs for a cluster
"""
