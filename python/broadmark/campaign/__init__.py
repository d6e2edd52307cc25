"""Campaigns: many cases, stated in one file, run over hours or on many machines.

    description   the campaign file, read and checked
    plan          its recordings, as plain values
    ledger        its cases: which are finished, which the cap leaves out, which are to be run
    attempts      results of the program, read while and after they are written
    folder        where everything lies
    runner        bakes and runs what is missing
    estimate      how long that will take
    progress      what is shown meanwhile
    summary       the table of how it stands
    slurm         the same as jobs of a cluster
"""
