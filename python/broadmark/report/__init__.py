"""The report: results files as a self-contained HTML page.

`data` converts results to the data of the page, using `labels` (short names of recordings and
variants), `rerun` (commands that run a case again), `timelines` (times by frame) and `pictures` (of
the scenes). `page` combines the data, d3 and the files of `web` in one file.
"""

from broadmark.report.page import write_report

__all__ = ["write_report"]
