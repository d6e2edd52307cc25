"""Histories: times or counts of cases over the commits, by machine, with change points."""
