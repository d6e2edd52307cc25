"""The paper's claims, judged by results: a sentence and a function for each claim.

A claim has parts; its outcome is the first in the order of `Outcome` among theirs. Numbers of the paper
that "hardly change" differ by factors of up to 1.75, so HARDLY allows 2.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from broadmark.paper.algorithms import ALGORITHMS, MAX_SECONDS, SINGLE, is_gpu
from broadmark.paper.evidence import (
    FASTER,
    FIRST,
    SLOWER,
    TOLERANCE,
    Evidence,
    Outcome,
    PartVerdict,
    Range,
    about,
    between,
)
from broadmark.paper.times import MIN_NOISE, NOISE_OF_ONE

HARDLY = Range(1 / 2, 2)

TERMS = (
    "Comparisons are judged at every size at which all their algorithms have a time and the paper "
    "prints more than 0.00 s. A time is known within its 95 % interval over repetitions, at least "
    f"{100 * MIN_NOISE:g} %, and within {100 * NOISE_OF_ONE:g} % if it was measured once; where that "
    "leaves it open whether a size fits, it is undecided; where sizes contradict each other, the "
    f"claim is mixed. A number counts as reproduced within a factor of {TOLERANCE:g}, a range as it "
    f"rounds, as hardly changed within a factor of {HARDLY.high:g}. The cap is {MAX_SECONDS:g} s per "
    "frame, the top of the paper's figures."
)

SINGLES = [algorithm.name for algorithm in ALGORITHMS if algorithm.panel == SINGLE]
ON_CPU = [algorithm.name for algorithm in ALGORITHMS if not is_gpu(algorithm)]
GPUS = [algorithm.name for algorithm in ALGORITHMS if is_gpu(algorithm)]
SLOWEST = ["BF ST", "SAP ST"]
NEXT = ["DBVT F", "Tracy ST"]
FASTEST = ["GPU LBVH", "GPU Grid"]


def _without(names: list[str], *others: list[str]) -> list[str]:
    return [name for name in names if not any(name in other for other in others)]


def slowest(e: Evidence) -> list[PartVerdict]:
    return e.faster("Brownian", _without(SINGLES, SLOWEST), SLOWEST)


def gains_of_vectors_and_threads(e: Evidence) -> list[PartVerdict]:
    return [
        e.gain_up_to("Brownian", ["BF ST"], ["BF MT"], 40),
        e.gain_up_to("Brownian", ["SAP ST"], ["SAP MT"], 12),
    ]


def next_slowest(e: Evidence) -> list[PartVerdict]:
    order = e.faster("Brownian", _without(SINGLES, SLOWEST, NEXT), NEXT)
    return [*order, e.gain_up_to("Brownian", NEXT, ["DBVT D", "CGAL"], 3)]


def tracy_threads(e: Evidence) -> list[PartVerdict]:
    return [e.gain("Brownian", "Tracy ST", "Tracy MT", about(2.2))]


def grids(e: Evidence) -> list[PartVerdict]:
    bf, sap = ("Grid BF ST", "Grid BF MT"), ("Grid SAP ST", "Grid SAP MT")
    return [
        *(part for i in (0, 1) for part in e.faster("Brownian", [sap[i]], [bf[i]])),
        *(e.gain("Brownian", *grid, between(2, 3)) for grid in (bf, sap)),
    ]


def kd_like_grid_sap(e: Evidence) -> list[PartVerdict]:
    return [e.gain("Brownian", "Grid SAP ST", "KD", about(1))]


def gpu_fastest(e: Evidence) -> list[PartVerdict]:
    names = [algorithm.name for algorithm in ALGORITHMS]
    return [
        *e.faster("Brownian", FASTEST, _without(names, FASTEST)),
        *(e.gain("Brownian", "Grid SAP MT", name, about(2)) for name in FASTEST),
        *(e.gain("Brownian", "KD", name, about(3)) for name in FASTEST),
    ]


def free_fall_favours(e: Evidence) -> list[PartVerdict]:
    gain = ["AxisSweep", "Tracy ST", "DBVT F", "KD"]
    lose = ["Grid BF ST", "Grid SAP ST", "CGAL", "DBVT D"]
    same = [*SLOWEST, *GPUS]
    return [
        *(e.changes("FreeFall", name, FASTER) for name in gain),
        *(e.changes("FreeFall", name, SLOWER) for name in lose),
        *(e.changes("FreeFall", name, HARDLY) for name in same),
    ]


def free_fall_a_million(e: Evidence) -> list[PartVerdict]:
    return [
        e.reaches_a_million("FreeFall", "DBVT F", True),
        *e.faster("FreeFall", ["KD"], GPUS),
    ]


def gravity_hardest(e: Evidence) -> list[PartVerdict]:
    return [
        *(e.reaches_a_million("Gravity", name, False) for name in ON_CPU),
        *(e.changes("Gravity", name, HARDLY) for name in FASTEST),
    ]


def gpu_sap_fails(e: Evidence) -> list[PartVerdict]:
    return [e.fails_above("GPU SAP", 512_000)]


def extra_pairs(e: Evidence) -> list[PartVerdict]:
    return [e.extra_pairs("AxisSweep", 0.05), e.extra_pairs("KD", 0.05)]


def assorted_objects(e: Evidence) -> list[PartVerdict]:
    return [
        *(part for name in ("DBVT F", "DBVT D") for part in e.assorted_takes(name, between(2, 3))),
        *(
            part
            for name in ("KD", "Tracy ST", "CGAL")
            for part in e.assorted_takes(name, between(1.2, 1.4, 1))
        ),
    ]


@dataclass(frozen=True)
class Claim:
    """A sentence of the paper and the function that judges it."""

    sentence: str
    parts: Callable[[Evidence], list[PartVerdict]]


#: In the paper's order.
CLAIMS = [
    Claim("Brownian, one thread: BF and SAP are slowest", slowest),
    Claim(
        "Brownian: BF gains up to 40 times and SAP up to 12 from AVX and four threads",
        gains_of_vectors_and_threads,
    ),
    Claim(
        "Brownian, one thread: DBVT F and Tracy come next; DBVT D and CGAL are up to three times "
        "faster than those",
        next_slowest,
    ),
    Claim("Tracy MT is 2.2 times as fast as Tracy ST", tracy_threads),
    Claim("Grid SAP beats Grid BF; both gain two to three times from threads", grids),
    Claim("Brownian: KD is about as fast as Grid SAP on one thread", kd_like_grid_sap),
    Claim(
        "Brownian: GPU Grid and GPU LBVH are fastest, twice as fast as the best multi-threaded "
        "algorithm (Grid SAP MT), three times as fast as KD",
        gpu_fastest,
    ),
    Claim(
        "Free Fall favours AxisSweep, Tracy, DBVT F and KD; Grid BF, Grid SAP, CGAL and DBVT D "
        "lose; BF, SAP and the GPU ones hardly change",
        free_fall_favours,
    ),
    Claim(
        "Free Fall: DBVT F reaches a million objects within the cap; KD beats the GPU algorithms",
        free_fall_a_million,
    ),
    Claim(
        "Gravity is hardest: no CPU algorithm reaches a million within the cap; the GPU's Grid and "
        "LBVH hardly notice",
        gravity_hardest,
    ),
    Claim("GPU SAP fails above 512,000", gpu_sap_fails),
    Claim("AxisSweep and KD report about 5 % more pairs than there are", extra_pairs),
    Claim(
        "Assorted objects: DBVT takes two to three times longer, KD, Tracy and CGAL 1.2 to 1.4 times",
        assorted_objects,
    ),
]


@dataclass(frozen=True)
class Judgement:
    """A claim, judged by the results of one machine."""

    number: int
    claim: str
    verdict: Outcome
    parts: list[PartVerdict]


def judge(evidence: Evidence) -> list[Judgement]:
    """Judges all claims."""
    judgements = []
    for number, claim in enumerate(CLAIMS, 1):
        parts = claim.parts(evidence)
        verdict = min((part.outcome for part in parts), key=FIRST.index)
        judgements.append(Judgement(number, claim.sentence, verdict, parts))
    return judgements
