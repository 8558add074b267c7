"""Answers one line of JSON with another: what to solve, what was found and what it took."""

import json
import signal
import sys
import time


def too_long(number, frame):
    raise TimeoutError("it takes too long")


def serve(version, methods, prepare):
    """`prepare(request)` gives a function that solves it: (states, transitions, steps). Only that function is timed."""
    signal.signal(signal.SIGALRM, too_long)
    answer({"version": version, "methods": methods})
    for line in sys.stdin:
        request = json.loads(line)
        try:
            solve = prepare(request)
            signal.alarm(int(request["patience"]))
            wall, cpu = time.perf_counter(), time.process_time()
            states, transitions, steps = solve()
            wall, cpu = time.perf_counter() - wall, time.process_time() - cpu
            signal.alarm(0)
        except Exception as error:
            signal.alarm(0)
            answer({"failure": str(error) or type(error).__name__})
            continue
        states = [[float(x) for x in state] for state in states]
        transitions = [float(t) for t in transitions]
        answer(
            {"states": states, "transitions": transitions, "steps": int(steps), "wall_ms": 1e3 * wall, "cpu_ms": 1e3 * cpu}
        )


def answer(message):
    print(json.dumps(message), flush=True)
