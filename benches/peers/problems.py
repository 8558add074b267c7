"""The problems of the bench, as plain functions; benches/src/problem.rs has the same."""

import numpy

G, L, ETA, TAU, GAMMA, TP = 9.82, 0.5, 8.0, 40.0, 0.2, 0.1

START = {
    "oscillator": [1.0, 0.0],
    "stiff pair": [0.0, 20.0],
    "hopper": [1.9, 0.1, 0.0, 0.0],
    "front": [1.0] * 300 + [0.0] * 700,
}


def oscillator(t, x):
    return numpy.array([x[1], -x[0]])


def stiff_pair(t, x):
    return numpy.array([0.01 * x[1], 2020.0 - 100.0 * (x[0] + x[1])])


def front(t, u):
    before = numpy.empty_like(u)
    before[0] = 1.0
    before[1:] = u[:-1]
    return 1000.0 * (before - u) - 1000.0 * u * (u - 0.5) * (u - 1.0)


RATES = {"oscillator": oscillator, "stiff pair": stiff_pair, "front": front}

# Flight, Compression, Thrust, Decompression: the rates of y, ẏ, the timer and η₂.
HOPPER = [
    lambda t, x: [x[1], -G, 0.0, 0.0],
    lambda t, x: [x[1], ETA / x[0] - GAMMA * x[1] - G, 0.0, 0.0],
    lambda t, x: [x[1], TAU - GAMMA * x[1] - G, 1.0, 0.0],
    lambda t, x: [x[1], x[3] / x[0] - GAMMA * x[1] - G, 0.0, 0.0],
]

# What falls or rises through zero where a location is left. While a hopper rises its foot has just left the ground, and
# y − l may be a rounding below zero.
LEAVES = [
    lambda t, x: max(x[1], x[0] - L),
    lambda t, x: x[1],
    lambda t, x: max(x[2] - TP, x[0] - L),
    lambda t, x: x[0] - L,
]


def reset(location, x):
    """The state after leaving a location."""
    x = list(x)
    if location == 1:
        x[2] = 0.0
    elif location == 2:
        x[3] = TAU * x[0]
    return x
