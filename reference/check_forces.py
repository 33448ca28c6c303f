#!/usr/bin/env python3
"""Right values of scenes with springs or attraction, in multiple precision; shares no code with carom.

    pip install mpmath                     (nothing else; Python 3.11 or later for tomllib)
    python3 check_forces.py FOLDER ...     compute scene.toml there, compare with truth.csv and events.csv beside it
    python3 check_forces.py --write FOLDER write them, where there are none

Method: Taylor series of order ORDER, step by step, in DIGITS decimal digits; an event is the first root of a gap's or
a contact force's polynomial within a step, found on a grid of GRID points and by bisection and Newton's steps. A
closed gap is held if the first of its derivatives that is not 0 closes it, and let go when its force falls through 0.
Valid for: springs with dampers, attraction, drag, gravity; contacts and walls, one impact at an instant; held contacts
one a body, all on one line. Where another scene is asked for it ends with a line that says so.
"""
import sys
import tomllib
from pathlib import Path

from mpmath import mp, mpf, sqrt

DIGITS, ORDER, GRID = 50, 36, 48
mp.dps = DIGITS
ZERO = mpf(10) ** -36  # derivatives and gaps below are 0: far above rounding, far below any number of a scene
WALLS = [("-x", 0, -1), ("+x", 0, 1), ("-z", 2, -1), ("+z", 2, 1), ("-y", 1, -1), ("+y", 1, 1)]
HALVES = {0: "half_width", 1: "half_height", 2: "half_length"}


def product(a, b, k):
    """Coefficient k of the product of two series."""
    return sum(a[j] * b[k - j] for j in range(k + 1))


class Scene:
    def __init__(self, folder):
        scene = tomllib.loads((folder / "scene.toml").read_text())
        effects = scene.get("effects", {})
        self.name, self.every = scene["name"], scene["sample_every"]
        self.samples = round(scene["duration"] / scene["sample_every"])
        bodies = scene["bodies"]
        self.names = [body["name"] for body in bodies]
        self.mass = [mpf(body["mass"]) for body in bodies]
        self.radius = [mpf(body["radius"]) for body in bodies]
        self.x = [[mpf(c) for c in body["position"]] for body in bodies]
        self.v = [[mpf(c) for c in body["velocity"]] for body in bodies]
        self.gravity = [mpf(g) for g in effects.get("gravity", {}).get("acceleration", [0, 0, 0])]
        self.drag = mpf(effects.get("drag", {}).get("coefficient", 0))
        self.springs = [
            (*(self.names.index(end) for end in s["between"]), mpf(s["stiffness"]), mpf(s["rest_length"]), mpf(s["damping"]))
            for s in effects.get("springs", [])
        ]
        self.attraction = effects.get("attraction")
        count = len(bodies)
        self.touches = []
        if "contact" in effects:
            self.e_contact = mpf(effects["contact"]["restitution"])
            self.touches += [("contact", a, b) for a in range(count) for b in range(a + 1, count)]
        if "cushions" in effects:
            self.e_cushion = mpf(effects["cushions"]["restitution"])
            self.half = {axis: mpf(effects["cushions"][key]) for axis, key in HALVES.items() if key in effects["cushions"]}
            self.touches += [("cushion", b, w) for b in range(count) for w in range(6) if WALLS[w][1] in self.half]
        self.held = []
        self.time = mpf(0)
        self.events = []

    def series(self):
        """Coefficients x[body][axis][k] of the motion from here, and the series of the held contacts' forces."""
        count = len(self.mass)
        x = [[[c] for c in body] for body in self.x]
        v = [[[c] for c in body] for body in self.v]
        squares, powers, forces = {}, {}, {touch: [] for touch in self.held}
        links = [(("s", i), a, b, mpf(-1) / 2, mpf(0)) for i, (a, b, *_) in enumerate(self.springs)]
        if self.attraction:
            soft = mpf(self.attraction.get("softening", 0)) ** 2
            links += [(("g", a, b), a, b, mpf(-3) / 2, soft) for a in range(count) for b in range(a + 1, count)]
        for k in range(ORDER):
            acc = [[g if k == 0 else mpf(0) for g in self.gravity] for _ in range(count)]
            for body in range(count):
                for axis in range(3):
                    acc[body][axis] -= self.drag / self.mass[body] * v[body][axis][k]
            for key, a, b, power, soft in links:
                d = [[q - p for p, q in zip(x[a][axis], x[b][axis])] for axis in range(3)]
                s, q = squares.setdefault(key, []), powers.setdefault(key, [])
                s.append(sum(product(d[axis], d[axis], k) for axis in range(3)) + (soft if k == 0 else 0))
                if k == 0:
                    q.append(s[0] ** power)
                else:
                    q.append(sum((power * (k - j) - j) * s[k - j] * q[j] for j in range(k)) / (k * s[0]))
                for axis in range(3):
                    pull = product(q, d[axis], k)
                    if key[0] == "s":
                        _, _, stiffness, rest, damping = self.springs[key[1]]
                        force = stiffness * (d[axis][k] - rest * pull) + damping * (v[b][axis][k] - v[a][axis][k])
                    else:
                        force = mpf(self.attraction["constant"]) * self.mass[a] * self.mass[b] * pull
                    acc[a][axis] += force / self.mass[a]
                    acc[b][axis] -= force / self.mass[b]
            for touch in self.held:
                kind, a, b = touch
                if kind == "cushion":
                    _, axis, side = WALLS[b]
                    forces[touch].append(self.mass[a] * acc[a][axis] * side)
                    acc[a][axis] = mpf(0)
                else:
                    n = self.normal(a, b)
                    total = self.mass[a] + self.mass[b]
                    closing = -sum(n[i] * (acc[b][i] - acc[a][i]) for i in range(3))
                    push = closing * self.mass[a] * self.mass[b] / total
                    forces[touch].append(push)
                    for i in range(3):
                        acc[a][i] -= push * n[i] / self.mass[a]
                        acc[b][i] += push * n[i] / self.mass[b]
            for body in range(count):
                for axis in range(3):
                    x[body][axis].append(v[body][axis][k] / (k + 1))
                    v[body][axis].append(acc[body][axis] / (k + 1))
        return x, v, forces

    def normal(self, a, b):
        d = [q - p for p, q in zip(self.x[a], self.x[b])]
        length = sqrt(sum(c * c for c in d))
        return [c / length for c in d]

    def gap(self, touch, x):
        """The gap's polynomial; of a pair that of its squared distance."""
        kind, a, b = touch
        if kind == "cushion":
            _, axis, side = WALLS[b]
            gap = [-side * c for c in x[a][axis]]
            gap[0] += self.half[axis] - self.radius[a]
            return gap
        d = [[q - p for p, q in zip(x[a][axis], x[b][axis])] for axis in range(3)]
        gap = [sum(product(d[axis], d[axis], k) for axis in range(3)) for k in range(ORDER + 1)]
        gap[0] -= (self.radius[a] + self.radius[b]) ** 2
        return gap

    def step_length(self, x):
        """So long that the last coefficients do not matter at the digits computed with."""
        last = max(abs(body[axis][k]) ** (mpf(1) / k) for body in x for axis in range(3) for k in range(ORDER - 5, ORDER + 1))
        return min(mpf(self.every), mpf(10) ** (-mpf(42) / ORDER) / last) if last else mpf(self.every)

    def impact(self, touch):
        kind, a, b = touch
        if kind == "cushion":
            _, axis, side = WALLS[b]
            speed = self.v[a][axis] * side
            self.v[a][axis] = -self.e_cushion * self.v[a][axis]
            impulse = self.mass[a] * (1 + self.e_cushion) * speed
        else:
            n = self.normal(a, b)
            speed = -sum(n[i] * (self.v[b][i] - self.v[a][i]) for i in range(3))
            impulse = (1 + self.e_contact) * speed / (1 / self.mass[a] + 1 / self.mass[b])
            for i in range(3):
                self.v[a][i] -= impulse / self.mass[a] * n[i]
                self.v[b][i] += impulse / self.mass[b] * n[i]
        self.events.append((self.time, touch, impulse))

    def settle(self):
        """Impacts of closed gaps that approach, and which contacts are held from here on."""
        for _ in range(100):
            x, _, _ = self.series()
            changed = False
            for touch in self.touches:
                gap = self.gap(touch, x)
                if touch in self.held or abs(gap[0]) > ZERO:
                    continue
                first = next((k for k in range(1, ORDER) if abs(gap[k]) > ZERO), None)
                if first == 1 and gap[1] < 0:
                    self.impact(touch)
                    changed = True
                    break
                if first and first > 1 and gap[first] < 0:
                    self.held.append(touch)
                    changed = True
                    break
            if not changed:
                return
        raise SystemExit(f"{self.name}: an instant without an end; not for this program")

    def advance(self, until):
        while self.time < until:
            x, v, forces = self.series()
            h = min(self.step_length(x), until - self.time)
            first = None
            for touch in self.touches:
                if touch not in self.held:
                    first = earlier(first, fall(self.gap(touch, x), h), touch)
            for touch, force in forces.items():
                first = earlier(first, fall(force, h), touch)
            if first:
                h = first[0]
            for body in range(len(self.mass)):
                self.x[body] = [value(x[body][axis], h) for axis in range(3)]
                self.v[body] = [value(v[body][axis], h) for axis in range(3)]
            self.time += h
            if first:
                if first[1] in self.held:
                    self.held.remove(first[1])
                else:
                    kind, a, b = first[1]
                    self.close(kind, a, b)
                    self.impact(first[1])
                self.settle()

    def close(self, kind, a, b):
        """Takes the rounding of an impact's time out of its gap, so that it is 0 and no more than that."""
        if kind == "cushion":
            _, axis, side = WALLS[b]
            self.x[a][axis] = side * (self.half[axis] - self.radius[a])


def value(series, h):
    total = mpf(0)
    for c in reversed(series):
        total = total * h + c
    return total


def earlier(first, at, touch):
    return (at, touch) if at is not None and (first is None or at < first[0]) else first


def fall(p, h):
    """Where a polynomial goes from positive to negative on 0 < t <= h; coefficients that are 0 at the start left out."""
    first = next((k for k, c in enumerate(p) if abs(c) > ZERO), None)
    if first is None:
        return None
    p = p[first:]
    low, at_low = mpf(0), p[0]
    for i in range(1, GRID + 1):
        high = h * i / GRID
        at_high = value(p, high)
        if at_low > 0 and at_high <= 0:
            for _ in range(190):
                middle = (low + high) / 2
                if value(p, middle) > 0:
                    low = middle
                else:
                    high = middle
            return high
        low, at_low = high, at_high
    return None


def compute(folder):
    scene = Scene(folder)
    scene.settle()
    rows = []
    for sample in range(scene.samples + 1):
        scene.advance(mpf(sample * scene.every))
        rows += [(sample * scene.every, name, scene.x[i] + scene.v[i]) for i, name in enumerate(scene.names)]
    return scene, rows


def main(arguments):
    write = "--write" in arguments
    worst = 0
    for name in (a for a in arguments if not a.startswith("--")):
        folder = Path(name)
        scene, rows = compute(folder)
        events = [
            (t, kind, scene.names[a], WALLS[b][0] if kind == "cushion" else scene.names[b], j)
            for t, (kind, a, b), j in scene.events
        ]
        if write:
            text = "time,body,x,y,z,vx,vy,vz\n"
            text += "".join(f"{t!r},{body}," + ",".join(mp.nstr(c, 20) for c in state) + "\n" for t, body, state in rows)
            (folder / "truth.csv").write_text(text)
            text = "time,kind,a,b,impulse\n"
            text += "".join(f"{mp.nstr(t, 20)},{kind},{a},{b},{mp.nstr(j, 20)}\n" for t, kind, a, b, j in events)
            (folder / "events.csv").write_text(text)
            continue
        given = [line.split(",") for line in (folder / "truth.csv").read_text().split()[1:]]
        size = max(max(abs(mpf(c)) for c in line[2:]) for line in given)
        off = max(abs(mpf(c) - own) / size for line, (_, _, state) in zip(given, rows) for c, own in zip(line[2:], state))
        listed = [line.split(",") for line in (folder / "events.csv").read_text().split()[1:]]
        before = [e for e in events if e[0] <= mpf(given[-1][0])]
        same = [line[1:4] for line in listed] == [list(e[1:4]) for e in before]
        print(f"{folder.name}: {len(given)} rows, off by {mp.nstr(off, 3)} of the size; {len(listed)} events {'the same' if same else 'OTHER'}")
        worst = max(worst, off if same else 1)
    return 0 if worst < 1e-18 else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
