#!/usr/bin/env python3
"""The hard cases: scene.toml and expected.toml of every folder beside this file.

    pip install mpmath                     (nothing else; Python 3.11 or later)
    python3 make_cases.py                  write all cases
    python3 make_cases.py CASE ...         write these

It shares no code with carom. `closed_forms` has what holds at the end, `statements` the bounds and the files; random
scenes come from a seed.
"""
import random
import sys
from pathlib import Path

from mpmath import acos, mpf, pi, quad, sqrt

sys.dont_write_bytecode = True  # no folders of Python's own among the cases
from closed_forms import damped, flights, kepler, stretched  # noqa: E402
from statements import (  # noqa: E402
    ALONE, DISSIPATES, ELASTIC, FLIGHTS_WHY, KEPT, KEPT_WHY, ORDER, RIGHT, SEEN,
    apart, body, box, contact, end, energy, flown, impacts, joined, mirror, spring, toml,
)

HERE = Path(__file__).resolve().parent

CASES = {}


def case(
    name, title, watch, duration, bodies, effects, expect, every=0.1, dt=None, unit=None, source="carom: hard/make_cases.py"
):
    """Registers a case; `expect` gives what must hold from the scene."""
    head = dict(name=name, title=title, source=source, watch=watch, duration=float(duration), sample_every=float(every))
    units = dict(units=dict(length=unit)) if unit else {}
    scene = dict(**head, **units, bodies=bodies, effects=joined(*effects))
    CASES[name] = (scene, dict(dt=dt or [0.1, 0.01, 0.001]), expect)


def starts():
    pairs = lambda gap: [  # noqa: E731
        body("together-a", 1, 0.5, (0, 0, 0), (1, 0, 0)),
        body("together-b", 1, 0.5, (gap, 0, 0), (1, 0, 0)),
        body("through-a", 1, 0.5, (0, 0, 10), (1, 0, 0)),
        body("through-b", 1, 0.5, (gap, 0, 10), (-1, 0, 0)),
    ]
    parted = apart(1.0, "a push-out or a contact parts them within a second")
    case(
        "coincident-centres",
        "two pairs of balls with one centre each",
        "A line of action from a point to itself: 0/0 in the slides. One pair travels together, the other through each other.",
        2,
        pairs(0.0),
        [contact(0.5)],
        lambda scene: joined(DISSIPATES, ALONE, parted),
    )
    case(
        "coincident-nearly",
        "two pairs of balls whose centres are 1e-12 apart",
        "A line of action of twelve lost digits: does it send anyone off at a great speed?",
        2,
        pairs(1e-12),
        [contact(0.5)],
        lambda scene: joined(DISSIPATES, ALONE, parted),
    )
    drawn = random.Random(1)

    def in_ball(radius):
        while True:
            point = [drawn.uniform(-1, 1) for _ in range(3)]
            if sum(x * x for x in point) <= 1:
                return [round(radius * x, 4) for x in point]

    case(
        "overlap-1000",
        "a thousand balls, all deep in each other at the start",
        "Every ball overlaps some twenty others. Does parting them make kinetic energy out of nothing?",
        2,
        [body(f"b{i}", 1, 0.5, in_ball(4.0), in_ball(1.0)) for i in range(1000)],
        [contact(0.5)],
        lambda scene: joined(
            DISSIPATES,
            ALONE,
            apart(1.5, "the overlaps are gone after 150 steps of 0.01 s, to a fifth of a radius", 0.2),
        ),
        source="carom: hard/make_cases.py, random.Random(1)",
    )


def at_once():
    touching = impacts("the way of the first ball leads through another: it cannot pass", contacts_min=1)
    radius, mass = 40.75, 0.16
    rows = []
    for row in range(5):
        for place in range(row + 1):
            z = -row * 2 * radius * 0.75**0.5
            rows.append(body(f"ball{len(rows) + 1}", mass, radius, ((2 * place - row) * radius, radius, z)))
    case(
        "rack-touching",
        "fifteen touching balls, broken",
        "One impact meets thirty contacts. Energy, momentum and the mirror image hold for any order of them.",
        0.5,
        [body("cue", mass, radius, (0, radius, 600), (0, 0, -5000)), *rows],
        [contact()],
        lambda scene: joined(ELASTIC, ALONE, apart(), touching, mirror("x", 1e-3 * radius)),
        unit="mm",
    )
    case(
        "two-at-once",
        "one ball meets two touching ones at the same instant",
        "The pairwise answer depends on the order; the symmetric one sends the cue ball back at a fifth of its speed.",
        2,
        [
            body("cue", 1, 0.5, (0, 0, -2), (0, 0, 2)),
            body("left", 1, 0.5, (-0.5, 0, 0)),
            body("right", 1, 0.5, (0.5, 0, 0)),
        ],
        [contact()],
        lambda scene: joined(ELASTIC, ALONE, apart(), touching, mirror("x", 0.01)),
    )
    for name, gap, said in [
        ("cradle-0", 0.0, "no gap"),
        ("cradle-1nm", 1e-9, "gaps of 1 nm"),
        ("cradle-1um", 1e-6, "gaps of 1 um"),
        ("cradle-1mm", 1e-3, "gaps of 1 mm"),
    ]:
        step = 0.125 + gap
        row = [body("b0", 1, 0.0625, (-1, 0, 0), (1, 0, 0))]
        row += [body(f"b{i}", 1, 0.0625, ((i - 1) * step, 0, 0)) for i in range(1, 5)]
        case(
            name,
            f"five balls in a row, {said}",
            "The impact runs through the row: the last ball leaves alone, at the speed of the first.",
            2,
            row,
            [contact()],
            lambda scene: flown(scene, ELASTIC, ALONE, apart()),
        )
    case(
        "ball-ball-cushion",
        "a ball against a ball 1 mm from a cushion",
        "Contact, cushion and contact again within 0.2 ms: three impacts in one step.",
        0.2,
        [body("a", 1, 0.0625, (0, 0, 0), (10, 0, 0)), body("b", 1, 0.0625, (0.9365, 0, 0))],
        [contact(), box(1, 1)],
        lambda scene: flown(scene, ELASTIC, apart()),
    )
    case(
        "wedge",
        "a light ball between two heavy ones and a cushion",
        "The light ball is squeezed ever faster until the heavy ones, a thousand times its mass, give way.",
        4,
        [
            body("light", 1, 0.2, (1.8, 0, 0)),
            body("near", 1000, 0.5, (0, 0, -0.505), (1, 0, 0)),
            body("far", 1000, 0.5, (0, 0, 0.505), (1, 0, 0)),
        ],
        [contact(), box(2, 5)],
        lambda scene: joined(ELASTIC, apart(), touching, mirror("z", 0.01)),
    )
    case(
        "corner-both-walls",
        "a ball meets both walls of a corner at one instant",
        "The slides' else-if chain turns one velocity a step; the ball must come back along its diagonal.",
        0.5,
        [body("ball", 1, 0.125, (0, 0, 0), (3, 0, 3))],
        [box(1, 1)],
        lambda scene: flown(scene, ELASTIC, apart()),
    )


def scales():
    for power in (3, 6, 9):
        heavy = 10.0**power
        case(
            f"mass-ratio-1e{power}",
            f"a heavy ball against a light one and the other way round, masses 1e{power} : 1",
            "The light ball leaves at twice the heavy one's speed, or comes back as from a wall.",
            3,
            [
                body("heavy", heavy, 0.5, (0, 0, 0), (1, 0, 0)),
                body("target", 1, 0.125, (3, 0, 0)),
                body("light", 1, 0.125, (3, 0, 5), (-1, 0, 0)),
                body("block", heavy, 0.5, (0, 0, 5)),
            ],
            [contact()],
            lambda scene: flown(scene, ELASTIC, ALONE, apart()),
        )
    for power in (2, 4, 6):
        v = 10.0**power
        case(
            f"tunnel-1e{power}",
            f"head-on at {v:g} a second, balls of diameter 1",
            f"A step of 0.01 s is {v / 100:g} diameters long: who sees the ball in the way?",
            1,
            [body("bullet", 1, 0.5, (0, 0, 0), (v, 0, 0)), body("target", 1, 0.5, (1 + 0.505 * v, 0, 0))],
            [contact()],
            lambda scene: flown(scene, ELASTIC, ALONE, apart()),
        )
    case(
        "tunnel-box",
        "a ball at 1e6 a second between walls 200 apart",
        "A step of 0.01 s is fifty times as long as the box: does the ball stay inside?",
        0.1,
        [body("ball", 1, 0.5, (0, 0, 0), (1e6, 0, 0))],
        [box(100, 100)],
        lambda scene: flown(scene, ELASTIC, apart()),
        dt=[0.1, 0.01, 0.001, 0.0001],
    )

    def oblique(size, offset=0.0):
        near = [body("a", 1, 0.5 * size, (offset - 2 * size, 0, offset), (2 * size, 0, 0))]
        return [*near, body("b", 3, 0.5 * size, (offset, 0, offset + 0.25 * size))]

    for power in (-6, 6):
        case(
            f"radius-1e{power}",
            f"an oblique impact of balls of radius 5e{power - 1}",
            "The same scene in another unit of length: a solver without a length of its own cannot tell.",
            2,
            oblique(10.0**power),
            [contact()],
            lambda scene: flown(scene, ELASTIC, ALONE, apart()),
        )
    case(
        "far-1e7",
        "an oblique impact 1e7 from the origin",
        "Doubles know places there to 2e-9, single precision to 1: a radius is half of that.",
        2,
        oblique(1.0, 1e7),
        [contact()],
        lambda scene: flown(scene, ELASTIC, ALONE, apart()),
    )


def springs():
    pair = lambda half, u: [  # noqa: E731
        body("a", 1, 0.05, (-half, 0, 0), (-u, 0, 1)),
        body("b", 1, 0.05, (half, 0, 0), (u, 0, 1)),
    ]
    steps = "k dt^2/mu = {:g} at dt = 0.01; symplectic Euler needs 4"
    # Below its limit w dt = 2 symplectic Euler swings by w dt/2 of the energy; past it the energy grows without bound.
    bounded = energy("a spring gives no energy; half of it is room for the swing of a symplectic step below its limit", 0.5)
    for name, stiffness, within in [("spring-tame", 2e3, 0.02), ("spring-100-times", 2e6, 0.2), ("spring-1e4-times", 2e8, 0.2)]:
        case(
            name,
            f"a spring {stiffness / 2e4:g} times as stiff as an explicit step allows",
            steps.format(stiffness * 1e-4 / 0.5),
            1,
            pair(0.6, 0),
            [spring(stiffness, 1, 0)],
            lambda scene, within=within: joined(
                bounded,
                ALONE,
                end(
                    scene,
                    stretched(scene),
                    "harmonic motion in closed form; "
                    + ("a fifth of the amplitude" if within < 0.1 else "twice the amplitude: bounded, whatever the phase"),
                    within,
                    velocities=False,
                ),
            ),
        )
    for name, damping in [("damper-tame", 10), ("damper-100-times", 1e4), ("damper-1e4-times", 1e6)]:
        case(
            name,
            f"a damper {damping / 100:g} times as strong as an explicit step allows",
            f"2 kd dt/mu = {2 * damping * 0.01 / 0.5:g} at dt = 0.01; an explicit step needs 4. The pair must come to go as one.",
            0.2,
            [body("a", 1, 0.05, (-0.5, 0, 0), (1, 0, 1)), body("b", 1, 0.05, (0.5, 0, 0), (0, 0, 1))],
            [spring(0, 1, damping)],
            lambda scene: joined(
                energy("a damper takes energy and gives none; rounding to single precision"),
                ALONE,
                end(scene, damped(scene), "exponential decay of the relative velocity in closed form"),
            ),
        )
    case(
        "spring-zero-length",
        "a spring of no length swings through its own middle",
        "Where both ends coincide the spring has no direction: 0/0 in the slides, at the start and twice a period.",
        1,
        pair(0, 1),
        [spring(100, 0, 0)],
        lambda scene: joined(
            bounded,
            ALONE,
            end(scene, stretched(scene), "harmonic motion in closed form; a tenth of the amplitude", 0.00707, velocities=False),
        ),
    )


def attraction_of(g, softening=0.0):
    return dict(attraction=dict(constant=float(g), **(dict(softening=softening) if softening else {})))


STILL_AT_FIRST = dict(
    momentum=dict(
        change_max=KEPT,
        scale=1.0,
        why=f"opposite forces, from rest; a thirtieth of what the pair carries at the least distance is 1; {KEPT_WHY}",
    )
)
FORCES_KEEP = energy("attraction keeps the energy; a hundredth of its scale is what carom calls right", RIGHT, RIGHT)


def falls():
    e, period = mpf("0.999"), 10
    gm = 4 * pi**2 / period**2
    m = mpf("1e-6")
    apo, pace = 1 + e, sqrt(gm * (1 - e) / (1 + e))
    shares = (-m / (1 + m), 1 / (1 + m))
    case(
        "kepler-e0999",
        "a comet of eccentricity 0.999",
        "The pericentre is 1/1999 of the apocentre and passed at 2000 times the speed: one period must end where it began.",
        period,
        [
            body("sun", 1, 1e-4, (shares[0] * apo, 0, 0), (0, 0, shares[0] * pace)),
            body("comet", m, 1e-5, (shares[1] * apo, 0, 0), (0, 0, shares[1] * pace)),
        ],
        [attraction_of(gm / (1 + m))],
        lambda scene: joined(FORCES_KEEP, ALONE, end(scene, kepler(scene), "Kepler's equation in 60 digits", 0.02)),
    )
    # From rest at distance 1: t = sqrt(1/(2 GM)) (acos(sqrt q) + sqrt(q (1 - q))) at distance q. Contact after 1 s.
    q = mpf("0.002")
    total = (acos(sqrt(q)) + sqrt(q * (1 - q))) ** 2 / 2
    pair = lambda r: [body("a", 1, r, (-0.5, 0, 0)), body("b", 1, r, (0.5, 0, 0))]  # noqa: E731
    still = lambda scene: [(b["position"], b["velocity"]) for b in scene["bodies"]]  # noqa: E731
    case(
        "fall-contact",
        "a head-on fall of two small balls, with bounces",
        "From a distance of 500 diameters into an elastic contact at 35 a second, twice; then back at rest where they began.",
        4,
        pair(0.001),
        [contact(), attraction_of(total / 2)],
        lambda scene: joined(
            FORCES_KEEP,
            STILL_AT_FIRST,
            impacts("the fall takes 1 s in closed form, so contacts fall on 1 s and 3 s", contacts=2),
            end(scene, still(scene), "the start again after two falls and two rises of 1 s each", RIGHT, 0.1),
        ),
    )
    s = mpf("0.01")
    # dt = dr/sqrt(2 GM (h(r) - h(1))), h = 1/sqrt(r^2 + s^2); r = 1 - x^2 takes the root out of the start.
    def pace_of(x):
        far, near = sqrt(1 + s * s), sqrt((1 - x * x) ** 2 + s * s)
        return 2 * sqrt(far * near * (far + near) / (2 * (2 - x * x)))

    fall = quad(pace_of, [0, 0.5, 0.9, 0.99, 1])
    case(
        "fall-softened",
        "a head-on fall through each other, softened",
        "No contact: at softening 0.01 the bodies pass through each other at twenty a second, and back, to rest where they began.",
        4,
        pair(0.001),
        [attraction_of(fall**2 / 2, 0.01)],
        lambda scene: joined(
            FORCES_KEEP,
            STILL_AT_FIRST,
            end(scene, still(scene), "one period; the constant makes the quarter by quadrature in 60 digits 1 s", RIGHT, 0.1),
        ),
    )
    case(
        "slingshot",
        "a probe round a moving planet",
        "The pericentre is a quarter away at 90 a second. The probe leaves with another speed, at the planet's expense.",
        10,
        [body("planet", 1000, 0.05, (0, 0, 0), (-1, 0, 0)), body("probe", 0.001, 0.01, (-50, 0, 2), (10, 0, 0))],
        [attraction_of(1)],
        lambda scene: joined(
            energy("attraction keeps the energy; the probe has 1e-4 of it, and a hundredth of that is 1e-6", 1e-6, 1e-6),
            ALONE,
            end(scene, kepler(scene), "Kepler's equation on a hyperbola, in 60 digits"),
        ),
    )


def heaps():
    drawn = random.Random(2)
    grid = [(x, y, 0) for x in (-1, 0, 1) for y in (-1, 1)]
    shake = lambda: drawn.uniform(-0.2, 0.2)  # noqa: E731
    bodies = [
        body(f"b{i}", 1, 0.5, [round(1.6 * c + shake(), 3) for c in corner], [round(shake(), 3) for _ in range(3)])
        for i, corner in enumerate(grid)
    ]
    case(
        "collapse-cluster",
        "six attracting balls without bounce fall together",
        "Every impact is inelastic, and there is no end of them: the cluster must come together without blowing up.",
        3,
        bodies,
        [contact(0.0), attraction_of(5.5)],
        lambda scene: joined(
            energy("impacts with e = 0 take energy; a hundredth is room for the fall in steps", RIGHT),
            ALONE,
            apart(),
        ),
        source="carom: hard/make_cases.py, random.Random(2)",
    )
    floor = -0.5
    drawn = random.Random(3)
    shake = lambda: round(drawn.uniform(-0.02, 0.02), 4)  # noqa: E731
    bodies = [
        body(f"b{4 * layer + 2 * i + j}", 1, 0.1, (0.13 * (2 * i - 1) + shake(), floor + 0.15 + 0.25 * layer, 0.13 * (2 * j - 1) + shake()))
        for layer in range(3)
        for i in range(2)
        for j in range(2)
    ]
    still = "bounces, impacts and drag take all the energy that the walls and the floor do not hold"
    case(
        "pile-on-floor",
        "twelve balls fall on the floor of a closed box and come to rest",
        "Does the pile lie still, without sinking into itself or the floor?",
        6,
        bodies,
        [contact(0.3), box(0.25, 0.25, 0.3, 0.5), dict(drag=dict(coefficient=2.0)), dict(gravity=dict(acceleration=[0.0, -9.81, 0.0]))],
        lambda scene: joined(
            energy("impacts with e < 1 and drag take energy; a hundredth of what 1.2 kg lose in a metre of fall is room for the fall in steps", RIGHT, scale=11.772),
            apart(),
            dict(speed=dict(max=0.05, after=5.0, why=f"{still}; a fall by a fortieth of a radius makes this speed")),
        ),
        source="carom: hard/make_cases.py, random.Random(3)",
    )
    stack = [body(f"b{i}", 1, 0.125, (0, -1 + 0.125 + 0.25 * i, 0)) for i in range(5)]
    case(
        "stack-of-five",
        "five balls lie on each other on the floor",
        "Nothing moves: the floor carries five, and each ball those above it.",
        2,
        stack,
        [contact(0.5), box(1, 1, 0.5, 1), dict(gravity=dict(acceleration=[0.0, -9.81, 0.0]))],
        lambda scene: joined(
            energy("nothing moves, so nothing is gained; a hundredth of what 5 kg lose in 0.375 m of fall is room for a step of free fall", RIGHT, scale=18.39375),
            apart(),
            end(
                scene,
                [(b["position"], b["velocity"]) for b in scene["bodies"]],
                "the start: touching balls in a line above the floor are in balance",
                SEEN * 0.125,
                0.05,
            ),
        ),
    )


def steps():
    case(
        "million-steps",
        "one ball between walls, a million steps",
        "Ten seconds at dt = 1e-5: what do a million roundings add up to?",
        10,
        [body("ball", 1, 0.125, (0, 0, 0), (1.3, 0, 0.7))],
        [box(1, 2)],
        lambda scene: flown(scene, ELASTIC, apart(), within=1e-4),
        dt=[1e-5],
    )
    case(
        "single-step",
        "one step for the whole second",
        "A ball crosses a wall and another passes its target within a single step of 1 s.",
        1,
        [
            body("bouncer", 1, 0.125, (0, 0, 0), (3, 0, 0)),
            body("a", 1, 0.125, (-1, 0, 5), (2, 0, 0)),
            body("b", 1, 0.125, (0.8, 0, 5)),
        ],
        [contact(), box(2, 10)],
        lambda scene: flown(scene, ELASTIC, apart()),
        every=1,
        dt=[1.0],
    )
    case(
        "e-zero",
        "no bounce at all, on a ball and on a cushion",
        "With e = 0 the normal velocity is gone and the tangential one stays: a ball slides along the wall.",
        3,
        [
            body("a", 1, 0.25, (-1, 0, 0), (1, 0, 0)),
            body("b", 1, 0.25, (0.5, 0, 0.15)),
            body("c", 1, 0.25, (0, 0, 3), (1, 0, 0.5)),
        ],
        [contact(0.0), box(2, 6, 0.0)],
        lambda scene: flown(scene, DISSIPATES, apart()),
    )
    drawn = random.Random(4)
    corners = [(x, y, z) for x in (-1, 0, 1) for y in (-1, 0, 1) for z in (-1, 0, 1)]
    case(
        "e-one-gas",
        "an elastic gas of 27 balls in a closed box",
        "Some hundred impacts at e = 1 exactly: the energy stays, to the last digits.",
        2,
        [body(f"s{i}", 1, 0.5, [1.4 * c for c in corner], [round(drawn.gauss(0, 1), 3) for _ in range(3)]) for i, corner in enumerate(corners)],
        [contact(), box(2, 2, 1.0, 2)],
        lambda scene: joined(ELASTIC, apart()),
        source="carom: hard/make_cases.py, random.Random(4)",
    )
    for name, miss, said in [("graze-inside", -1e-12, "touches"), ("graze-outside", 1e-12, "misses")]:
        case(
            name,
            f"a ball {said} another by 1e-12",
            "A chord of 3e-6 and a kick of 1e-6 of the speed: hit or not, the paths must be all but straight.",
            4,
            [body("a", 1, 0.5, (-2, 0, 1 + miss), (1, 0, 0)), body("b", 1, 0.5, (0, 0, 0))],
            [contact()],
            lambda scene, miss=miss: flown(scene, ELASTIC, ALONE, apart(), counts=miss > 0),
        )
    for k, digits in enumerate((3, 31, 314, 3141, 31415, 314159)):
        heavy = 100.0**k
        case(
            f"pi-{k}",
            f"a ball of mass 100^{k}, a light one and a wall: {digits} impacts",
            "The impacts between the two balls and the wall count out the digits of pi.",
            8,
            [body("heavy", heavy, 0.5, (3.5, 0, 0), (1, 0, 0)), body("light", 1, 0.125, (5, 0, 0))],
            [contact(), box(6, 2)],
            lambda scene, digits=digits: joined(
                ELASTIC,
                apart(),
                impacts(
                    "ceil(pi/atan(sqrt(m/M))) - 1: each pair of impacts turns (sqrt(M) V, sqrt(m) v) by twice that angle",
                    contacts=(digits + 1) // 2,
                    cushions=digits // 2,
                ),
                end(scene, flights(scene)[0], FLIGHTS_WHY) if digits < 5000 else {},
            ),
            source="G. Galperin 2003, Playing pool with pi; carom: hard/make_cases.py",
        )


def main(names):
    for group in (starts, at_once, scales, springs, falls, heaps, steps):
        group()
    for name in names or CASES:
        scene, ladder, expect = CASES[name]
        holds = expect(scene)
        expected = joined(ladder, {key: holds[key] for key in ORDER if key in holds})
        folder = HERE / name
        folder.mkdir(exist_ok=True)
        for file, table in (("scene.toml", scene), ("expected.toml", expected)):
            text = toml(table).strip() + "\n"
            (folder / file).write_text(text, encoding="utf-8", newline="\n")
        print(name)


if __name__ == "__main__":
    main(sys.argv[1:])
