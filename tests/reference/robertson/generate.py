"""Robertson's reaction to 4e10 s, by two programs: pip install numpy scipy, then python generate.py."""

import numpy as np
from scipy.integrate import solve_ivp


def rates(t, y):
    slow, fast, dimer = 0.04 * y[0], 1e4 * y[1] * y[2], 3e7 * y[1] ** 2
    return [-slow + fast, slow - fast - dimer, dimer]


def jacobian(t, y):
    return [
        [-0.04, 1e4 * y[2], 1e4 * y[1]],
        [0.04, -1e4 * y[2] - 6e7 * y[1], -1e4 * y[1]],
        [0.0, 6e7 * y[1], 0.0],
    ]


times = np.array([0.4 * 10.0**k for k in range(12)])


def solve(method, rtol):
    span = (0.0, times[-1])
    atol = [1e-16, 1e-20, 1e-16]
    return solve_ivp(rates, span, [1.0, 0.0, 0.0], method, times, jac=jacobian, rtol=rtol, atol=atol).y


radau, bdf = solve("Radau", 1e-13), solve("LSODA", 1e-12)
print("largest relative difference", np.max(np.abs(radau - bdf) / radau))
np.savetxt(
    "states.csv", np.column_stack([times, radau.T]), fmt="%.15g", delimiter=",", header="t,y1,y2,y3", comments=""
)
