#!/usr/bin/env python3
"""The randomly created particles of cluster-8 and cluster-30: prints the [[bodies]] of a scene.

    python3 make_clusters.py COUNT RADIUS SPEED SEED
    python3 make_clusters.py 8 12 0.5 8        cluster-8
    python3 make_clusters.py 30 15 1 30        cluster-30

Masses uniform in 5..20 kg, radius 0.3 m (mass/kg)^(1/3), places uniform in a ball of RADIUS m at least 1.5 of the sum
of the radii apart, velocities uniform in a ball of SPEED m/s; rounded to three decimals. Python's own random.Random.
"""
import math
import random
import sys


def in_ball(rng, radius):
    while True:
        point = [rng.uniform(-radius, radius) for _ in range(3)]
        if math.hypot(*point) <= radius:
            return [round(x, 3) for x in point]


def main(count, radius, speed, seed):
    rng, bodies = random.Random(seed), []
    while len(bodies) < count:
        mass = round(rng.uniform(5.0, 20.0), 3)
        size, place = round(0.3 * mass ** (1 / 3), 3), in_ball(rng, radius)
        if all(math.dist(place, other) > 1.5 * (size + wide) for _, wide, other, _ in bodies):
            bodies.append((mass, size, place, in_ball(rng, speed)))
    for i, (mass, size, place, velocity) in enumerate(bodies):
        print(f'[[bodies]]\nname = "p{i}"\nmass = {mass}\nradius = {size}\nposition = {place}\nvelocity = {velocity}\n')


if __name__ == "__main__":
    main(int(sys.argv[1]), *map(float, sys.argv[2:4]), int(sys.argv[4]))
