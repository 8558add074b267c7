"""The buck converter of examples/buck, solved piece by piece: pip install mpmath, then python generate.py.

Between two events the circuit is linear, z' = A z + b with z = (iL, uC): z(t) = rest + exp(A t) (z0 - rest). A pulse ends
and a period ends at known times; the diode's current crosses 0 where a scan of the pulse finds a change of sign,
narrowed by bisection.
"""

import mpmath as mp

mp.mp.dps = 30
C, L, R, U, T, DC = (mp.mpf(v) for v in ("1e-4", "1e-4", "10", "24", "1e-4", "0.5"))
ON, OFF = mp.mpf("1e-5"), mp.mpf("1e5")


def circuit(rs, rd):
    """A and b: uL = -iD Rd - uC with iD = (iL Rs - U)/(Rd + Rs)."""
    a = mp.matrix([[-rs * rd / (rd + rs) / L, -1 / L], [1 / C, -1 / (R * C)]])
    b = mp.matrix([U * rd / (rd + rs) / L, 0])
    return a, b


class Motion:
    """exp(A t) by the two eigenvalues of A."""

    def __init__(self, rs, rd, z):
        self.a, b = circuit(rs, rd)
        self.rest = -mp.lu_solve(self.a, b)
        self.offset = z - self.rest
        half, det = (self.a[0, 0] + self.a[1, 1]) / 2, mp.det(self.a)
        root = mp.sqrt(half * half - det)
        self.slow, self.fast = half + root, half - root

    def at(self, t):
        p, q = self.slow, self.fast
        ep, eq = mp.exp(p * t), mp.exp(q * t)
        unit = mp.eye(2)
        matrix = (ep * (self.a - q * unit) - eq * (self.a - p * unit)) / (p - q)
        return (self.rest + matrix * self.offset).apply(mp.re)


def current(rs, rd, z):
    return (z[0] * rs - U) / (rd + rs)


def change(motion, rs, rd, span):
    """When the diode's current changes its sign after the beginning; None if it does not within the span."""
    early = [mp.mpf(10) ** -k for k in range(14, 3, -1)]
    grid = sorted([s for s in early if s < span] + [span * k / 400 for k in range(1, 401)])
    low, sign = mp.mpf(0), mp.sign(current(rs, rd, motion.at(grid[0] / 2)))
    for high in grid:
        if mp.sign(current(rs, rd, motion.at(high))) != sign:
            for _ in range(90):
                middle = (low + high) / 2
                if mp.sign(current(rs, rd, motion.at(middle))) == sign:
                    low = middle
                else:
                    high = middle
            return high
        low = high
    return None


def run(periods):
    z, rd = mp.matrix([0, 0]), OFF
    events, starts = [], []
    for period in range(periods):
        starts.append((period * T, z[0], z[1]))
        for rs, begin, end in [(ON, period * T, (period + DC) * T), (OFF, (period + DC) * T, (period + 1) * T)]:
            t = begin
            while t < end:
                # A switch that jumps may turn the diode at once, and the diode itself jumps.
                conducts = current(rs, rd, z) > 0
                if conducts != (rd == ON):
                    rd = ON if conducts else OFF
                    events.append((t, "diode"))
                motion = Motion(rs, rd, z)
                span = change(motion, rs, rd, end - t)
                if span is None:
                    z, t = motion.at(end - t), end
                else:
                    z, t = motion.at(span), t + span
                    rd = OFF if rd == ON else ON
                    events.append((t, "diode"))
            events.append((end, "off" if rs == ON else "tick"))
    return events, starts


events, starts = run(100)
with open("events.csv", "w") as out:
    out.write("t,event\n")
    for t, name in events:
        out.write(f"{mp.nstr(t, 17)},{name}\n")
with open("states.csv", "w") as out:
    out.write("t,iL,uC\n")
    for row in starts:
        out.write(",".join(mp.nstr(v, 17) for v in row) + "\n")
