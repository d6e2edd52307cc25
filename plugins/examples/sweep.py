"""An algorithm as a program, for --external: sort and sweep along one axis, with numpy.

The protocol: docs/external.md.

    broadmark --headless freefall --external '/usr/bin/python3 sweep.py' --algorithm py-sweep
"""

import json
import sys
import time

import numpy as np

DESCRIPTION = {
    "version": 1,
    "id": "py-sweep",
    "family": "Python sweep",
    "summary": "sort and sweep along one axis, written in Python with numpy",
    "principle": "sorting",
    "time": "O(n log n + w), w pairs that overlap on the axis",
    "space": "O(n + w)",
    "source": "Ericson 2005, 7.5",
    "parameters": [
        {
            "name": "axis",
            "doc": "the axis that is swept: 0, 1 or 2",
            "value": 0,
            "min": 0,
            "max": 2,
            "integer": True,
        }
    ],
}


def find_pairs(boxes, axis):
    """The overlapping pairs (a < b) of boxes, an array of n x (min x y z 0, max x y z 0)."""
    order = np.argsort(boxes[:, axis], kind="stable")
    low, high = boxes[order, :3], boxes[order, 4:7]
    # Candidates of box i: all that start on the axis before it ends.
    ends = np.searchsorted(low[:, axis], high[:, axis], side="right")
    counts = ends - np.arange(1, len(order) + 1)
    first = np.repeat(np.arange(len(order)), counts)
    second = np.arange(len(first)) - np.repeat(np.cumsum(counts) - counts, counts) + first + 1
    hit = np.ones(len(first), bool)
    for other in range(3):
        hit &= (low[first, other] <= high[second, other]) & (
            low[second, other] <= high[first, other]
        )
    pairs = np.stack((order[first[hit]], order[second[hit]]), axis=1)
    pairs.sort(axis=1)
    return pairs.astype(np.uint32)


def main():
    start = {}
    for line in sys.stdin:
        message = json.loads(line)
        reply = {}
        if message["call"] == "describe":
            reply = DESCRIPTION
        elif message["call"] == "start":
            start = message
            answers = open(start["pairs_file"], "r+b", buffering=0)
        elif message["call"] == "frame":
            boxes = np.fromfile(start["frames_file"], np.float32, 8 * message["bodies"]).reshape(
                -1, 8
            )
            began = time.perf_counter()
            pairs = find_pairs(boxes, start["parameters"]["axis"])
            reply = {"pairs": len(pairs), "seconds": time.perf_counter() - began}
            answers.seek(0)
            answers.write(pairs.tobytes())
        print(json.dumps(reply), flush=True)


if __name__ == "__main__":
    main()
