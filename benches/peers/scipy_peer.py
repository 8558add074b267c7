"""SciPy's solvers; a location of the hopper ends with a terminal event of solve_ivp."""

import scipy
from scipy.integrate import BDF, DOP853, LSODA, Radau, solve_ivp
from scipy.sparse import diags

from problems import HOPPER, LEAVES, RATES, START, reset
from serve import serve

EVERY = ["oscillator", "stiff pair", "hopper", "front"]
NOT_STIFF = ["oscillator", "hopper", "front"]
METHOD = {"DOP853": DOP853, "LSODA": LSODA, "BDF": BDF, "Radau": Radau}
METHODS = {"DOP853": NOT_STIFF, "LSODA": EVERY, "BDF": ["stiff pair", "front"], "Radau": ["stiff pair", "front"]}


def prepare(request):
    options = {"method": request["method"], "rtol": request["tolerance"], "atol": request["tolerance"]}
    if request["problem"] == "hopper":
        return lambda: hopper(request["stop"], options)
    if request["problem"] == "front":
        if request["method"] == "LSODA":
            options.update(lband=1, uband=0)
        elif request["method"] in ("BDF", "Radau"):
            options.update(jac_sparsity=diags([1.0, 1.0], [0, -1], shape=(1000, 1000), format="csc"))
    return lambda: smooth(request, options)


def smooth(request, options):
    name = request["problem"]
    method = METHOD[options.pop("method")]
    solver = method(RATES[name], 0.0, START[name], request["stop"], **options)
    states, steps, instants = [], 0, request["instants"]
    # As solve_ivp does it, which does not tell the number of steps.
    while solver.status == "running":
        message = solver.step()
        steps += 1
        if solver.status == "failed":
            raise RuntimeError(message)
        if len(states) < len(instants) and instants[len(states)] <= solver.t:
            between = solver.dense_output()
            while len(states) < len(instants) and instants[len(states)] <= solver.t:
                states.append(between(instants[len(states)]))
    return states, [], steps


def leaving(location):
    # A function of its own for each: its attribute is what solve_ivp reads.
    def event(t, x):
        return LEAVES[location](t, x)

    event.terminal = True
    return event


def hopper(stop, options):
    events = [leaving(location) for location in range(4)]
    t, x, location = 0.0, START["hopper"], 0
    transitions, steps = [], 0
    while True:
        found = solve_ivp(HOPPER[location], (t, stop), x, events=events[location], **options)
        steps += len(found.t) - 1
        if found.status == 0:
            return [], transitions, steps
        if found.status < 0:
            raise RuntimeError(found.message)
        t, x = found.t_events[0][0], reset(location, found.y_events[0][0])
        transitions.append(t)
        location = (location + 1) % 4


serve(scipy.__version__, METHODS, prepare)
