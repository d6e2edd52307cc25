"""Uses the installed Python package: argument 1 is the folder that it was installed to."""

import sys

import broadmark

assert broadmark.__file__.startswith(sys.argv[1]), broadmark.__file__
pairs = broadmark.overlaps([[0, 0, 0, 1, 1, 1], [1, 1, 1, 2, 2, 2], [3, 3, 3, 4, 4, 4]], "sap")
assert pairs.tolist() == [[0, 1]]
results = broadmark.run("brownian", algorithm="sap", objects=20, frames=2)
assert list(results.cases["status"]) == ["ok"]
