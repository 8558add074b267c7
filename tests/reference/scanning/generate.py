#!/usr/bin/env python3
"""Writes states.csv and events.csv: the deep space probe scans, by DOP853 with polished event times.

Needs numpy and scipy (1.10 or later). Usage: python3 generate.py
"""

import csv

import numpy as np
from scipy.integrate import solve_ivp

STOP, STEP = 60.0, 0.5
J = np.array([[30, -0.5, -1], [-0.5, 30, -1.5], [-1, -1.5, 50]])
J_INVERSE = np.linalg.inv(J)
ARM, A, L, EPS, BETA, K, U_MAX = 0.5, 2.0, 1.0, 0.2, 0.01, 0.475, 2.0
REFERENCE = {"Down": np.array([0.1, -0.5, 0.7]), "Up": np.array([0.1, -0.1, 0.7])}
# The second angle that ends each location, and the direction in which it is crossed.
END = {"Down": (-0.4, -1, "bottom", "Up"), "Up": (-0.2, 1, "top", "Down")}


def euler321(th):
    s, c, t = np.sin(th[0]), np.cos(th[0]), np.tan(th[1])
    return np.array([[1, s * t, c * t], [0, c, -s], [0, s / np.cos(th[1]), c / np.cos(th[1])]])


def rates(r):
    def f(_, x):
        th, w = x[:3], x[3:]
        s = w + A * (th - r)
        v = -K * np.abs(s) * s / L**2 - BETA * np.tanh(s / EPS)
        turning = np.cross(w, J @ w)
        th_dot = euler321(th) @ w
        u = np.clip((J @ (v - A * th_dot) + turning) / ARM, -U_MAX, U_MAX)
        return np.concatenate([th_dot, J_INVERSE @ (ARM * u - turning)])

    return f


def leg(place, t, x, until):
    """From t until the location ends or `until`: end, state there, whether it ended, samples on the way."""
    level, direction, _, _ = END[place]

    def end(_, x):
        return x[1] - level

    end.terminal, end.direction = True, direction
    grid = np.arange(np.floor(t / STEP) + 1, until / STEP + 0.5) * STEP
    run = solve_ivp(
        rates(REFERENCE[place]), (t, until), x, "DOP853", grid, events=end, rtol=2e-13, atol=1e-14, max_step=0.01
    )
    samples = list(zip(run.t, run.y.T))
    if run.status != 1:
        return until, run.y[:, -1], False, samples
    return run.t_events[0][0], run.y_events[0][0], True, samples


def main():
    t, x, place = 0.0, np.array([0, 0, 0, 0, 0, 0.21]), "Down"
    states, events = [(0.0, x)], []
    while t < STOP:
        t, x, ended, samples = leg(place, t, x, STOP)
        states += samples
        if ended:
            events.append((t, END[place][2]))
            place = END[place][3]
    with open("states.csv", "w", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(["t"] + [f"theta{k}" for k in (1, 2, 3)] + [f"w{k}" for k in (1, 2, 3)])
        out.writerows([f"{t:.6g}"] + [f"{v:.15g}" for v in x] for t, x in states)
    with open("events.csv", "w", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(["t", "transition"])
        out.writerows((f"{t:.15g}", name) for t, name in events)


main()
