"""PathSim: blocks of Python with a solver of their own choice, and located events."""

import numpy
import pathsim
from pathsim import Simulation
from pathsim.blocks import ODE
from pathsim.events import ZeroCrossing
from pathsim.solvers import ESDIRK43, RKDP54

from problems import HOPPER, LEAVES, RATES, START, reset
from serve import serve

SOLVERS = {"RKDP54": RKDP54, "ESDIRK43": ESDIRK43}
METHODS = {"RKDP54": ["oscillator", "hopper", "front"], "ESDIRK43": ["stiff pair"]}


def prepare(request):
    return (lambda: hopper(request)) if request["problem"] == "hopper" else (lambda: smooth(request))


def simulation(request, block, events):
    tolerance = request["tolerance"]
    tolerances = {"tolerance_lte_abs": tolerance, "tolerance_lte_rel": tolerance}
    solver = SOLVERS[request["method"]]
    return Simulation([block], events=events, dt=1e-4, Solver=solver, log=False, **tolerances)


def smooth(request):
    rates = RATES[request["problem"]]
    block = ODE(lambda x, u, t: rates(t, x), numpy.array(START[request["problem"]]))
    run = simulation(request, block, [])
    states, steps, begin = [], 0, 0.0
    for instant in request["instants"]:
        steps += run.run(instant - begin)["successful_steps"]
        states.append(block.engine.state.copy())
        begin = instant
    return states, [], steps


def hopper(request):
    location, transitions = 0, []

    def leave(t):
        nonlocal location
        transitions.append(t)
        block.engine.set(numpy.array(reset(location, block.engine.state)))
        location = (location + 1) % 4

    block = ODE(lambda x, u, t: numpy.array(HOPPER[location](t, x)), numpy.array(START["hopper"]))
    event = ZeroCrossing(lambda t: LEAVES[location](t, block.engine.state), leave, request["tolerance"])
    steps = simulation(request, block, [event]).run(request["stop"])["successful_steps"]
    return [], transitions, steps


serve(pathsim.__version__, METHODS, prepare)
