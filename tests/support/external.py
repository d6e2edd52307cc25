"""A program for --external that compares all boxes. Its argument is a fault to have."""

import json
import os
import struct
import sys
import time

fault = sys.argv[1]


def boxes_of(start, bodies):
    with open(start["frames_file"], "rb") as file:
        data = file.read(32 * bodies)
    return [struct.unpack_from("8f", data, 32 * i) for i in range(bodies)]


def overlap(a, b):
    return all(a[k] <= b[k + 4] and b[k] <= a[k + 4] for k in range(3))


def description():
    parameter = {"name": "slack", "doc": "a length", "value": 0, "min": 0, "max": 1}
    described = {
        "version": 1,
        "id": "outside",
        "family": "Outside",
        "summary": "all boxes",
        "parameters": [parameter],
    }
    if fault == "unknown key":
        described["paramters"] = []
    if fault == "newer":
        described["version"] = 2
    if fault == "margin":
        described["margin"] = "slacks"
    if fault == "silent":
        sys.exit(0)
    return described


def answer(start, call):
    boxes = boxes_of(start, call["bodies"])
    began = time.perf_counter()
    pairs = [(a, b) for b in range(len(boxes)) for a in range(b) if overlap(boxes[a], boxes[b])]
    seconds = time.perf_counter() - began
    if fault == "missed":
        pairs = pairs[1:]
    with open(start["pairs_file"], "r+b") as file:
        file.write(b"".join(struct.pack("2I", *pair) for pair in pairs))
    if fault == "raises":
        raise ValueError("on purpose")
    if fault == "crashes":
        os.abort()
    if fault == "hangs":
        sys.stdin = os.fdopen(os.pipe()[0])
        sys.stdin.read()
    if fault == "prints":
        print("hello", flush=True)
    if fault == "no time":
        return {"pairs": len(pairs)}
    if fault == "too long":
        seconds = 1e6
    if fault == "error":
        return {"error": "out of cheese"}
    return {"pairs": len(pairs) + (10**12 if fault == "too many" else 0), "seconds": seconds}


start = {}
for line in sys.stdin:
    call = json.loads(line)
    reply = {}
    if call["call"] == "describe":
        reply = description()
    elif call["call"] == "start":
        start = call
        if fault == "parameters":
            print(start["parameters"], start["threads"], file=sys.stderr)
    else:
        reply = answer(start, call)
    print(json.dumps(reply), flush=True)
