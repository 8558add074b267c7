#!/usr/bin/env python3
"""Writes values.csv: elementary functions at doubles, to 30 significant digits.

Needs mpmath (1.3 or later). Usage: python3 generate.py
"""

import math
import random

import mpmath as mp

mp.mp.dps = 60
random.seed(20240501)

COUNT = 130


def logarithmic(lo, hi, signed=True):
    """A double whose magnitude is log-uniform in [lo, hi]."""
    x = math.exp(random.uniform(math.log(lo), math.log(hi)))
    return random.choice((-x, x)) if signed else x


def near(centre, signed=True):
    """A double near `centre`, relatively or absolutely, at a random distance."""
    x = centre + logarithmic(1e-15, 0.3) * max(1.0, abs(centre))
    return random.choice((-x, x)) if signed else x


def angle():
    choice = random.random()
    if choice < 0.4:
        return logarithmic(1e-8, 10.0)
    if choice < 0.8:  # nearest doubles to multiples of a quarter turn, and close to them
        k = random.choice((1, 2, 3, 4, 5, 100, random.randint(1, 10**6)))
        return random.choice((-1, 1)) * float(k * mp.pi / 2) * (1 + random.choice((0, 0, 1e-15, 1e-9, 1e-4)))
    return logarithmic(10.0, 1e14)


def mixed(*choices):
    return lambda: random.choice(choices)()


def tiny_to(hi):
    return lambda: logarithmic(1e-12, hi)


def unit():
    x = mixed(tiny_to(1.0), lambda: random.uniform(-1, 1), lambda: 1 - logarithmic(1e-15, 0.5, False))()
    return random.choice((-x, x))


def above_one():
    return 1 + mixed(lambda: logarithmic(1e-15, 1, False), lambda: logarithmic(1, 1e300, False))()


def positive():
    return mixed(lambda: logarithmic(1e-300, 1e300, False), lambda: near(1.0, False), lambda: logarithmic(0.1, 10, False))()


UNARY = {
    "exp": (mp.exp, mixed(tiny_to(708), lambda: random.uniform(-708, 709))),
    "ln": (mp.log, positive),
    "log10": (mp.log10, mixed(positive, lambda: 10.0 ** random.randint(-20, 20))),
    "sin": (mp.sin, angle),
    "cos": (mp.cos, angle),
    "tan": (mp.tan, angle),
    "asin": (mp.asin, unit),
    "acos": (mp.acos, unit),
    "atan": (mp.atan, mixed(tiny_to(1e6), lambda: near(1.0), lambda: logarithmic(1e-3, 10))),
    "sinh": (mp.sinh, mixed(tiny_to(709), lambda: near(22.0), lambda: logarithmic(1e-3, 3))),
    "cosh": (mp.cosh, mixed(tiny_to(709), lambda: near(22.0), lambda: logarithmic(1e-3, 3))),
    "tanh": (mp.tanh, mixed(tiny_to(25), lambda: near(0.55), lambda: logarithmic(1e-3, 3))),
    "asinh": (mp.asinh, mixed(tiny_to(1e300), lambda: logarithmic(0.05, 4))),
    "acosh": (mp.acosh, mixed(above_one, lambda: random.uniform(1, 3))),
    "atanh": (mp.atanh, unit),
    "sqrt": (mp.sqrt, positive),
}


def power():
    while True:
        x, y = positive(), mixed(lambda: random.uniform(-5, 5), tiny_to(700), lambda: random.choice((0.5, -0.5, 1.5, 1 / 3)))()
        if abs(y * math.log(x)) < 700:
            return x, y


def vector():
    return logarithmic(1e-6, 1e6), logarithmic(1e-6, 1e6)


BINARY = {"pow": (mp.power, power), "atan2": (mp.atan2, vector)}

# Constants of a model look like this; so do values at kinks and symmetric places.
COMMON = [0.1, 0.2, 0.25, 0.3, 0.5, 0.7, 0.75, 0.9, 1.1, 1.25, 1.5, 2.0, 3.0, 5.0, 9.81, 10.0, 100.0, 273.15]


def text(value):
    """30 significant digits, written as Rust's {:.29e} does: 1.25…0e-3."""
    mantissa, _, exponent = mp.nstr(value, 30, strip_zeros=False, min_fixed=0, max_fixed=0).partition("e")
    return f"{mantissa if value else '0.' + 29 * '0'}e{int(exponent or 0)}"


with open("values.csv", "w") as out:
    out.write("function,x,y,value\n")
    for name, (f, sample) in UNARY.items():
        points = [x for x in COMMON if isinstance(f(mp.mpf(x)), mp.mpf)]
        points += [sample() for _ in range(COUNT - len(points))]
        for x in sorted(set(points)):
            out.write(f"{name},{x!r},,{text(f(mp.mpf(x)))}\n")
    for name, (f, sample) in BINARY.items():
        for x, y in sorted({sample() for _ in range(2 * COUNT)}):
            out.write(f"{name},{x!r},{y!r},{text(f(mp.mpf(x), mp.mpf(y)))}\n")
