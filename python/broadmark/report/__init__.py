"""The report: results files as one HTML page that needs no network.

`data` turns results into what the page holds, with the help of `labels` (what tells recordings and
variants apart), `rerun` (commands that run a case again), `timelines` (times frame by frame) and
`pictures` (of the scenes). `page` puts that, d3 and the files of `web` into one file.
"""

from broadmark.report.page import write_report

__all__ = ["write_report"]
