"""Closed forms of what is left at the end of a scene, in DIGITS decimal digits.

Flights between impacts by `Table` of reference/make_truth.py, two attracting bodies by Kepler's equation, springs by
their modes. The numbers of a scene are taken as the nearest doubles of their decimals.
"""
import sys
from pathlib import Path

from mpmath import asinh, atan2, cos, cosh, exp, findroot, mp, mpf, sin, sinh, sqrt

sys.dont_write_bytecode = True  # no folders of Python's own among the cases
sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "reference"))
from make_truth import TINY, Table, dot, plus  # noqa: E402

DIGITS = 60
mp.dps = DIGITS


def flights(scene):
    """Flights in closed form from impact to impact."""
    run, last = Table(scene), mpf(scene["duration"])
    due = run.next_event()
    while due <= last + TINY:
        run.advance(due)
        run.settle()
        due = run.next_event()
    kinds = [kind for _, kind, *_ in run.events]
    return run.state_at(last), kinds.count("contact"), kinds.count("cushion")


def relative(scene):
    """Centre of mass, its velocity, and the second body as seen from the first."""
    a, b = scene["bodies"]
    ma, mb = mpf(a["mass"]), mpf(b["mass"])
    both = lambda key: [(ma * mpf(p) + mb * mpf(q)) / (ma + mb) for p, q in zip(a[key], b[key])]  # noqa: E731
    seen = lambda key: [mpf(q) - mpf(p) for p, q in zip(a[key], b[key])]  # noqa: E731
    return both("position"), both("velocity"), seen("position"), seen("velocity"), (ma, mb)


def both_ends(scene, d, w):
    """The states of two bodies from the relative one at the end."""
    centre, drift, _, _, (ma, mb) = relative(scene)
    at = plus(centre, mpf(scene["duration"]), drift)
    shares = (-mb / (ma + mb), ma / (ma + mb))
    return [(plus(at, share, d), plus(drift, share, w)) for share in shares]


def kepler(scene):
    """Two bodies under attraction, on an ellipse or a hyperbola: Kepler's equation from the state at the start."""
    _, _, d, w, (ma, mb) = relative(scene)
    gm = mpf(scene["effects"]["attraction"]["constant"]) * (ma + mb)
    t, r, rv = mpf(scene["duration"]), sqrt(dot(d, d)), dot(d, w)
    a = 1 / (2 / r - dot(w, w) / gm)
    size = abs(a)
    n = sqrt(gm / size**3)
    if a > 0:
        c, s = 1 - r / a, rv / sqrt(gm * a)
        e, start = sqrt(c * c + s * s), atan2(s, c)
        mean = start - s + n * t
        anomaly = findroot(lambda x: x - e * sin(x) - mean, mean + e * sin(mean))
        turn, ds, dc = anomaly - start, sin(anomaly - start), cos(anomaly - start)
        f, g = 1 - a / r * (1 - dc), t + (ds - turn) / n
        far = a * (1 - e * cos(anomaly))
        fdot, gdot = -sqrt(gm * a) / (far * r) * ds, 1 - a / far * (1 - dc)
    else:
        c, s = 1 + r / size, rv / sqrt(gm * size)
        e, start = sqrt(c * c - s * s), asinh(s / sqrt(c * c - s * s))
        mean = e * sinh(start) - start + n * t
        anomaly = findroot(lambda x: e * sinh(x) - x - mean, asinh(mean / e))
        turn, ds, dc = anomaly - start, sinh(anomaly - start), cosh(anomaly - start)
        f, g = 1 - size / r * (dc - 1), t - (ds - turn) / n
        far = size * (e * cosh(anomaly) - 1)
        fdot, gdot = -sqrt(gm * size) / (far * r) * ds, 1 - size / far * (dc - 1)
    return both_ends(scene, plus([f * x for x in d], g, w), plus([fdot * x for x in d], gdot, w))


def stretched(scene):
    """A spring along x without damping, whose length starts at rest or whose rest length is 0."""
    _, _, d, w, (ma, mb) = relative(scene)
    one, t = scene["effects"]["springs"][0], mpf(scene["duration"])
    omega = sqrt(mpf(one["stiffness"]) * (ma + mb) / (ma * mb))
    l0, (x, u) = mpf(one["rest_length"]), (d[0], w[0])
    length = l0 + (x - l0) * cos(omega * t) + u * sin(omega * t) / omega
    pace = -(x - l0) * omega * sin(omega * t) + u * cos(omega * t)
    return both_ends(scene, [length, mpf(0), mpf(0)], [pace, mpf(0), mpf(0)])


def damped(scene):
    """A damper alone: the relative velocity decays as exp(-c t) with c = kd (1/ma + 1/mb)."""
    _, _, d, w, (ma, mb) = relative(scene)
    c = mpf(scene["effects"]["springs"][0]["damping"]) * (ma + mb) / (ma * mb)
    decay = exp(-c * mpf(scene["duration"]))
    return both_ends(scene, plus(d, (1 - decay) / c, w), [decay * x for x in w])
