"""The commands of `python3 -m broadmark`.

Each command is a module: its docstring is the help, `add_options(parser)` declares the options, and
`main(options)` runs the command and returns the exit status, or None for 0.
"""

#: The commands in the order of the help.
COMMANDS = [
    "read",
    "table",
    "write",
    "report",
    "campaign",
    "table2",
    "figures",
    "figure3",
    "claims",
    "plot",
    "history",
]
