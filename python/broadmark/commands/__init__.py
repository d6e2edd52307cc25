"""The commands of `python3 -m broadmark`.

A command is a module here: its docstring is the help, `add_options(parser)` declares options, and
`main(options)` does the work and returns the exit status, or None for 0.
"""

#: One line per command, in the order of the help.
COMMANDS = [
    "read",
    "write",
    "report",
    "campaign",
    "table2",
    "figures",
    "figure3",
    "claims",
    "plot",
]
