#!/usr/bin/env python3
"""Truth of the reference cases that have a closed form: truth.csv and events.csv beside scene.toml.

    pip install mpmath                     (nothing else; Python 3.11 or later for tomllib)
    python3 make_truth.py                  write all cases of OWN
    python3 make_truth.py CASE ...         write these
    python3 make_truth.py --check [CASE]   write nothing; compare with the files that are there, text for text,
                                           those of GIVEN too, which another program computed

It reads a scene and shares no code with carom. The numbers of the scene are taken as the nearest doubles of their
decimals; arithmetic has DIGITS decimal digits; what is printed has 25 (states) and 20 (events).
Three solutions, chosen by the effects of the scene:
  springs      equal masses on a line, equal springs, any damping: normal modes      (spring_line)
  attraction   two bodies on circles                                                  (circle)
  the rest     flight in closed form from event to event, contacts, cushions, rests   (Table)
A scene outside of what these solve exactly is refused.
"""
import sys
import tomllib
from decimal import Decimal, localcontext
from pathlib import Path

from mpmath import cosh, cos, cospi, exp, inf, log, mp, mpf, sin, sinh, sqrt

DIGITS = 60
TINY = mpf(10) ** -40  # far above rounding at 60 digits, far below anything that a scene contains
HERE = Path(__file__).resolve().parent
OWN = """headon-3-to-1 oblique-elastic inelastic-e05 inelastic-e01 bullet-block billiard-pair cushion-one corner-billiards
    drag-to-rest shot-2-96 shot-minus-0-94 shot-0-41 shot-0-75 shot-2-61 rack-break bounce-floor kepler-circle
    spring-under-line spring-under-simple spring-critical spring-over spring-chain""".split()
GIVEN = "billiards-a bounce-cushion corner-double headon-equal oblique-inelastic".split()
WALLS = [("-x", 0, -1), ("+x", 0, 1), ("-z", 2, -1), ("+z", 2, 1), ("-y", 1, -1), ("+y", 1, 1)]


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def plus(a, s, b):
    """a + s b"""
    return [p + s * q for p, q in zip(a, b)]


class Body:
    def __init__(self, entry):
        self.name = entry["name"]
        self.mass, self.radius = mpf(entry["mass"]), mpf(entry["radius"])
        self.position = [mpf(x) for x in entry["position"]]
        self.velocity = [mpf(x) for x in entry["velocity"]]

    def speed(self):
        return sqrt(dot(self.velocity, self.velocity))


class Table:
    """Spheres in free flight between contacts, cushions and rests.

    Drag -k v, all with the same c = k/m: v = v0 exp(-c t), x = x0 + v0 u with u = (1 - exp(-c t))/c. In the clock u
    every flight is straight, so that a contact is a root of a quadratic. Without drag u = t, and uniform
    acceleration adds g t^2/2 to each body and nothing to the difference of two.
    """

    def __init__(self, scene):
        effects = scene["effects"]
        self.bodies = [Body(entry) for entry in scene["bodies"]]
        drag = mpf(effects.get("drag", {}).get("coefficient", 0))
        self.gravity = [mpf(a) for a in effects.get("gravity", {}).get("acceleration", [0, 0, 0])]
        self.c = drag / self.bodies[0].mass
        if drag and (any(b.mass != self.bodies[0].mass for b in self.bodies) or any(self.gravity)):
            raise ValueError("drag: equal masses and no gravity only")
        self.e = mpf(effects["contact"]["restitution"]) if "contact" in effects else None
        self.rest = mpf(effects["rest"]["speed"]) if "rest" in effects else None
        self.walls, cushions = [], effects.get("cushions", {})
        for name, axis, side in WALLS:
            half = cushions.get(("half_width", "half_height", "half_length")[axis])
            if half is not None:
                self.walls.append((name, axis, side, mpf(half)))
        self.wall_e = mpf(cushions["restitution"]) if cushions else None
        self.now, self.events = mpf(0), []
        self.settle()

    def clock(self, t):
        return (1 - exp(-self.c * t)) / self.c if self.c else t

    def unclock(self, u):
        if not self.c:
            return u
        return -log(1 - self.c * u) / self.c if self.c * u < 1 else inf

    def state_in(self, body, t):
        u, decay = self.clock(t), exp(-self.c * t)
        x = plus(plus(body.position, u, body.velocity), t * t / 2, self.gravity)
        return x, plus([decay * v for v in body.velocity], t, self.gravity)

    def state_at(self, time):
        """Position and velocity of every body; `time` not after the next event."""
        return [self.state_in(body, time - self.now) for body in self.bodies]

    def contact_in(self, a, b):
        """Time until a and b touch while approaching: smaller root of |d + w u| = ra + rb."""
        d, w = plus(a.position, -1, b.position), plus(a.velocity, -1, b.velocity)
        ww, dw, gap = dot(w, w), dot(d, w), dot(d, d) - (a.radius + b.radius) ** 2
        if dw > -TINY or dw * dw < ww * gap:
            return inf
        return self.unclock(max(mpf(0), gap / (-dw + sqrt(dw * dw - ww * gap))))

    def wall_in(self, body, axis, side, half):
        """Time until the body touches the wall: gap - s u - g t^2/2 = 0, s and g towards the wall."""
        gap = half - body.radius - side * body.position[axis]
        s, g = side * body.velocity[axis], side * self.gravity[axis]
        if g == 0:
            return self.unclock(gap / s) if s > TINY else inf
        square = s * s + 2 * g * gap
        if g > 0:
            return (-s + sqrt(square)) / g
        return 2 * gap / (s + sqrt(square)) if s > TINY and square >= 0 else inf

    def rest_in(self, body):
        """Time until drag has slowed the body to the rest speed."""
        if self.rest is None or not self.c or body.speed() < TINY:
            return inf
        return max(mpf(0), log(body.speed() / self.rest) / self.c)

    def next_event(self):
        times = [self.rest_in(body) for body in self.bodies]
        times += [self.wall_in(body, *wall[1:]) for body in self.bodies for wall in self.walls]
        if self.e is not None:
            times += [self.contact_in(a, b) for _, a, _, b in self.pairs()]
        return self.now + min(times)

    def pairs(self):
        for i, a in enumerate(self.bodies):
            for j in range(i + 1, len(self.bodies)):
                yield i, a, j, self.bodies[j]

    def advance(self, time):
        for body, (x, v) in zip(self.bodies, self.state_at(time)):
            body.position, body.velocity = x, v
        self.now = time

    def settle(self):
        """All that happens at this instant: contacts, cushions, rests, again while anything does."""
        rested = False
        while True:
            before = len(self.events)
            if self.e is not None:
                for _, a, _, b in self.pairs():
                    self.contact(a, b)
            if rested and len(self.events) > before:
                raise ValueError(f"t = {self.now}: a partner approaches a ball that has just come to rest")
            for body in self.bodies:
                for wall in self.walls:
                    self.cushion(body, *wall)
            for body in self.bodies:
                rested |= self.stop(body)
            if len(self.events) == before:
                return

    def contact(self, a, b):
        """J = -(1 + e) v_N/(1/m1 + 1/m2) along N = (p1 - p2)/|p1 - p2|, v_N < 0 on approach."""
        n = plus(a.position, -1, b.position)
        distance = sqrt(dot(n, n))
        n = [x / distance for x in n]
        vn = dot(plus(a.velocity, -1, b.velocity), n)
        if distance - a.radius - b.radius < TINY and vn < -TINY:
            j = -(1 + self.e) * vn / (1 / a.mass + 1 / b.mass)
            a.velocity, b.velocity = plus(a.velocity, j / a.mass, n), plus(b.velocity, -j / b.mass, n)
            self.events.append((self.now, "contact", a.name, b.name, j))

    def cushion(self, body, name, axis, side, half):
        s = side * body.velocity[axis]
        if half - body.radius - side * body.position[axis] < TINY and s > TINY:
            body.position[axis] = side * (half - body.radius)
            body.velocity[axis] = -side * self.wall_e * s
            self.events.append((self.now, "cushion", body.name, name, body.mass * (1 + self.wall_e) * s))

    def stop(self, body):
        speed = body.speed()
        if self.rest is None or speed < TINY or speed > self.rest + TINY:
            return False
        body.velocity = [mpf(0)] * 3
        self.events.append((self.now, "rest", body.name, "", body.mass * speed))
        return True


def table(scene, times):
    run = Table(scene)
    due = run.next_event()
    for time in times:
        while due <= time + TINY:  # an event at the instant of a sample comes first
            run.advance(due)
            run.settle()
            due = run.next_event()
        yield run.state_at(time)
    scene["events"] = run.events


def oscillator(gamma, omega2, q0, p0, t):
    """q'' + gamma q' + omega2 q = 0 from (q0, p0): under-, critically or over-damped."""
    half, decay = gamma / 2, exp(-gamma * t / 2)
    square = half * half - omega2
    w = sqrt(abs(square))
    if square == 0:
        c, s = mpf(1), t
    else:
        c, s = (cosh(w * t), sinh(w * t) / w) if square > 0 else (cos(w * t), sin(w * t) / w)
    # q = decay (q0 c + (p0 + half q0) s), c' = square s, s' = c
    k = p0 + half * q0
    q = decay * (q0 * c + k * s)
    return q, decay * (q0 * square * s + k * c) - half * q


def spring_line(scene, times):
    """n equal masses on a line, equal springs between neighbours, drag -k v: normal modes of the free chain.

    Mode j, phi_j(i) = sqrt(2/n) cos(pi j (i + 1/2)/n), lambda_j = 2 - 2 cos(pi j/n):
    q'' + (k_drag + k_d lambda)/m q' + k lambda/m q = 0. The centre of mass moves with v = V exp(-k_drag t/m).
    """
    bodies, springs, effects = [Body(b) for b in scene["bodies"]], scene["effects"]["springs"], scene["effects"]
    n, m = len(bodies), bodies[0].mass
    drag = mpf(effects.get("drag", {}).get("coefficient", 0)) / m
    k, l0, kd = (mpf(springs[0][key]) for key in ("stiffness", "rest_length", "damping"))
    chain = [dict(springs[0], between=[a.name, b.name]) for a, b in zip(bodies, bodies[1:])]
    if set(effects) - {"springs", "drag"} or springs != chain or any(b.mass != m for b in bodies):
        raise ValueError("springs: equal masses in a chain of equal springs, drag at most")
    centre = [sum(b.position[a] for b in bodies) / n for a in range(3)]
    drift = [sum(b.velocity[a] for b in bodies) / n for a in range(3)]
    along = plus(bodies[-1].position, -1, bodies[0].position)
    along = [x / sqrt(dot(along, along)) for x in along]
    home = [l0 * (i - mpf(n - 1) / 2) for i in range(n)]
    r, w = [], []
    for i, b in enumerate(bodies):
        dx, dv = plus(b.position, -1, centre), plus(b.velocity, -1, drift)
        r.append(dot(dx, along) - home[i])
        w.append(dot(dv, along))
        off = plus(dx, -dot(dx, along), along) + plus(dv, -w[i], along)
        if max(map(abs, off)) > TINY:
            raise ValueError("springs: not on a line")
    modes = []
    for j in range(1, n):
        phi = [sqrt(mpf(2) / n) * cospi(mpf(2 * i + 1) * j / (2 * n)) for i in range(n)]
        stretch = 2 - 2 * cospi(mpf(j) / n)
        q0, p0 = (sum(f * s for f, s in zip(phi, start)) for start in (r, w))
        modes.append((phi, drag + kd * stretch / m, k * stretch / m, q0, p0))
    scene["events"] = []
    for t in times:
        decay = exp(-drag * t)
        x_centre = plus(centre, (1 - decay) / drag if drag else t, drift)
        amplitudes = [(phi, *oscillator(gamma, omega2, q0, p0, t)) for phi, gamma, omega2, q0, p0 in modes]
        states = []
        for i in range(n):
            place = home[i] + sum(phi[i] * q for phi, q, _ in amplitudes)
            pace = sum(phi[i] * p for phi, _, p in amplitudes)
            states.append((plus(x_centre, place, along), plus([decay * v for v in drift], pace, along)))
        if any(dot(plus(b[0], -1, a[0]), along) <= 0 for a, b in zip(states, states[1:])):
            raise ValueError("springs: two neighbours pass through each other")
        yield states


def circle(scene, times):
    """Two bodies on circles: d perpendicular to w, w^2 = G (m1 + m2)/d, checked exactly; angle |w| t/|d|."""
    a, b = (Body(entry) for entry in scene["bodies"])
    attraction, m = scene["effects"]["attraction"], a.mass + b.mass
    centre = [(a.mass * p + b.mass * q) / m for p, q in zip(a.position, b.position)]
    drift = [(a.mass * p + b.mass * q) / m for p, q in zip(a.velocity, b.velocity)]
    d, w = plus(b.position, -1, a.position), plus(b.velocity, -1, a.velocity)
    radius, speed = sqrt(dot(d, d)), sqrt(dot(w, w))
    if set(scene["effects"]) != {"attraction"} or attraction.get("softening", 0) != 0:
        raise ValueError("circle: attraction alone, not softened")
    if dot(d, w) != 0 or abs(dot(w, w) * radius - mpf(attraction["constant"]) * m) > TINY:
        raise ValueError("circle: not a circular orbit")
    scene["events"] = []
    for t in times:
        c, s = cos(speed / radius * t), sin(speed / radius * t)
        dt = plus([c * x for x in d], s * radius / speed, w)
        wt = plus([c * x for x in w], -s * speed / radius, d)
        at = plus(centre, t, drift)
        yield [(plus(at, share, dt), plus(drift, share, wt)) for share in (-b.mass / m, a.mass / m)]


def digits(x, count):
    """`count` significant digits, half to even, exponent of two digits; what is zero but for rounding is 0."""
    if abs(x) < TINY:
        return "0"
    sign, mantissa, exponent, _ = x._mpf_
    with localcontext() as context:
        context.prec = 2000  # exact: 2^-n has n digits
        value = Decimal(int(mantissa)) * Decimal(2) ** int(exponent)
        head, _, power = f"{value:.{count - 1}e}".partition("e")
    return f"{'-' if sign else ''}{head}e{int(power):+03d}"


def solve(case, digits_used=DIGITS):
    """The text of truth.csv and of events.csv."""
    mp.dps = digits_used
    scene = tomllib.loads((HERE / case / "scene.toml").read_text(encoding="utf-8"))
    every = scene["sample_every"]
    samples = round(scene["duration"] / every)
    if mpf(samples) * mpf(every) != mpf(scene["duration"]):
        raise ValueError(f"{case}: the duration is no exact multiple of sample_every")
    times = [mpf(n) * mpf(every) for n in range(samples + 1)]
    effects = scene["effects"]
    law = spring_line if "springs" in effects else circle if "attraction" in effects else table
    truth = ["time,body,x,y,z,vx,vy,vz"]
    for n, states in enumerate(law(scene, times)):
        label = repr(n * every).removesuffix(".0")
        for body, (x, v) in zip(scene["bodies"], states):
            truth.append(",".join([label, body["name"], *(digits(q, 25) for q in x + v)]))
    events = ["time,kind,a,b,impulse"]
    for time, kind, a, b, impulse in scene["events"]:
        events.append(",".join([digits(time, 20), kind, a, b, digits(impulse, 20)]))
    return {"truth.csv": "\n".join(truth) + "\n", "events.csv": "\n".join(events) + "\n"}


def same(text, other):
    """Equal texts, but for true zeros that the other program prints as its rounding, 1e-80 or so."""
    if text == other:
        return True
    rows, others = text.splitlines(), other.splitlines()
    return len(rows) == len(others) and all(
        p == q or (p == "0" and abs(float(q)) < TINY)
        for row, line in zip(rows, others)
        for p, q in zip(row.split(","), line.split(","), strict=True)
    )


def main(arguments):
    check = "--check" in arguments
    cases = [a for a in arguments if a != "--check"] or OWN + (GIVEN if check else [])
    differing = 0
    for case in cases:
        files = solve(case)
        for name, text in files.items():
            path = HERE / case / name
            if not check:
                path.write_text(text, encoding="utf-8", newline="\n")
            elif not same(text, path.read_text(encoding="utf-8")):
                differing += 1
                print(f"{path}: differs")
        kinds = [line.split(",")[1] for line in files["events.csv"].splitlines()[1:]]
        counts = ", ".join(f"{kinds.count(kind)} {kind}" for kind in ("contact", "cushion", "rest"))
        print(f"{case}: {counts}")
    return 1 if differing else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
