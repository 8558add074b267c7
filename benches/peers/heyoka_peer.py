"""heyoka: Taylor series of high order, compiled by LLVM; a location of the hopper is an integrator with a terminal event."""

import math

import heyoka
from heyoka import event_direction, expression, make_vars, taylor_adaptive, t_event

from problems import ETA, G, GAMMA, L, START, TAU, TP, reset
from serve import serve

EVERY = ["oscillator", "stiff pair", "hopper", "front"]

# Compiling takes longer than solving: the integrators of each problem and tolerance are kept.
MADE = {}


def prepare(request):
    key = (request["problem"], request["tolerance"])
    if key not in MADE:
        MADE[key] = MAKE[request["problem"]](request["tolerance"])
    if request["problem"] == "hopper":
        return lambda: hopper(MADE[key], request["stop"])
    return lambda: smooth(MADE[key], START[request["problem"]], request["instants"])


def smooth(integrator, start, instants):
    integrator.time = 0.0
    integrator.state[:] = start
    _, _, _, steps, _, states = integrator.propagate_grid([0.0] + instants)
    return states[1:], [], steps


def oscillator(tolerance):
    x, v = make_vars("x", "v")
    return taylor_adaptive([(x, v), (v, -x)], START["oscillator"], tol=tolerance)


def stiff_pair(tolerance):
    x, v = make_vars("x", "v")
    rates = [(x, 0.01 * v), (v, 2020.0 - 100.0 * (x + v))]
    return taylor_adaptive(rates, START["stiff pair"], tol=tolerance)


def front(tolerance):
    cells = make_vars(*[f"u{i}" for i in range(1000)])
    before = [expression(1.0)] + list(cells[:-1])
    rates = [(u, 1000.0 * (b - u) - 1000.0 * u * (u - 0.5) * (u - 1.0)) for b, u in zip(before, cells)]
    # A thousand equations are too many to unroll.
    return taylor_adaptive(rates, START["front"], tol=tolerance, compact_mode=True)


def hopper_locations(tolerance):
    y, v, timer, eta2 = make_vars("y", "v", "timer", "eta2")
    zero = expression(0.0)
    accelerations = [
        expression(-G),
        ETA / y - GAMMA * v - G,
        TAU - GAMMA * v - G,
        eta2 / y - GAMMA * v - G,
    ]
    rising, falling = event_direction.positive, event_direction.negative
    leaves = [
        [t_event(y - L, direction=falling)],
        [t_event(v, direction=rising)],
        [t_event(timer - TP, direction=rising), t_event(y - L, direction=rising)],
        [t_event(y - L, direction=rising)],
    ]
    return [
        taylor_adaptive(
            [(y, v), (v, a), (timer, expression(1.0) if location == 2 else zero), (eta2, zero)],
            START["hopper"],
            t_events=leaves[location],
            tol=tolerance,
        )
        for location, a in enumerate(accelerations)
    ]


def hopper(integrators, stop):
    t, x, location = 0.0, START["hopper"], 0
    transitions, steps = [], 0
    while True:
        integrator = integrators[location]
        integrator.time = t
        integrator.state[:] = x
        integrator.reset_cooldowns()
        outcome, _, _, count, _, _ = integrator.propagate_until(stop)
        steps += count
        if outcome == heyoka.taylor_outcome.time_limit:
            return [], transitions, steps
        # A terminal event that no callback lets go on is told as −(its number) − 1.
        if not -3 < int(outcome) < 0:
            raise RuntimeError(str(outcome))
        t, x = integrator.time, reset(location, integrator.state)
        transitions.append(t)
        location = (location + 1) % 4
        if location == 0:
            # An event that begins at exactly zero hides the next one.
            x[0] = max(x[0], math.nextafter(L, 1.0))


MAKE = {"oscillator": oscillator, "stiff pair": stiff_pair, "front": front, "hopper": hopper_locations}

serve(heyoka.__version__, {"Taylor": EVERY}, prepare)
