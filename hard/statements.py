"""Scenes and what must hold on them, as the tables of scene.toml and expected.toml."""
import json

from mpmath import sqrt

from closed_forms import TINY, dot, flights

# What the bounds leave room for. An engine in single precision rounds by 6e-8 an impact, a thousand impacts are 6e-5.
KEPT = 1e-4
KEPT_WHY = "1e-4 is a thousand impacts rounded to single precision"
# A twentieth of a radius is what one begins to see.
SEEN = 0.05
# carom calls a position right within a hundredth of the scene's size.
RIGHT = 0.01


# --- scenes -------------------------------------------------------------------------------------------------------
def body(name, mass, radius, position, velocity=(0.0, 0.0, 0.0)):
    numbers = [float(x) for x in (*position, *velocity)]
    return dict(name=name, mass=float(mass), radius=float(radius), position=numbers[:3], velocity=numbers[3:])


def contact(e=1.0):
    return dict(contact=dict(restitution=e))


def box(width, length, e=1.0, height=None):
    walls = dict(half_width=float(width), half_length=float(length))
    if height is not None:
        walls["half_height"] = float(height)
    return dict(cushions=dict(**walls, restitution=e))


def spring(stiffness, rest_length, damping):
    ends = dict(between=["a", "b"], stiffness=float(stiffness), rest_length=float(rest_length), damping=float(damping))
    return dict(springs=[ends])


def joined(*parts):
    whole = {}
    for part in parts:
        whole |= part
    return whole


# --- what must hold -----------------------------------------------------------------------------------------------
def energy(why, gain_max=KEPT, loss_max=None, scale=None):
    bound = dict(gain_max=gain_max)
    if scale is not None:
        bound["scale"] = scale
    if loss_max is not None:
        bound["loss_max"] = loss_max
    return dict(energy=dict(**bound, why=why))


ELASTIC = energy(f"elastic impacts keep the energy; {KEPT_WHY}", loss_max=KEPT)
DISSIPATES = energy(f"impacts with e < 1 take energy and nothing gives any; {KEPT_WHY}")
ALONE = dict(
    momentum=dict(
        change_max=KEPT, why=f"only forces between the bodies act, and they are opposite; {KEPT_WHY}"
    )
)


def apart(after=0.0, why="hard spheres do not overlap, and walls hold", depth_max=SEEN):
    timed = dict(after=after) if after else {}
    reason = f"{why}; {depth_max:g} of a radius is what one begins to see" if depth_max == SEEN else why
    return dict(penetration=dict(depth_max=depth_max, **timed, why=reason))


def impacts(why, **counts):
    return dict(impacts=dict(**counts, why=why))


def mirror(axis, within, why="the start is its own mirror image and the laws know no side"):
    return dict(mirror=dict(axis=axis, within=within, why=why))


def end(scene, states, why, within=None, within_velocity=None, velocities=True):
    """The closed form at the end: within a hundredth of the box of all motion and of the largest speed."""
    if within is None:
        corners = [[float(x) for x in position] for position, _ in states] + [b["position"] for b in scene["bodies"]]
        spans = [max(c[axis] for c in corners) - min(c[axis] for c in corners) for axis in range(3)]
        within = RIGHT * sum(span * span for span in spans) ** 0.5
    if within_velocity is None:
        speeds = [float(sqrt(dot(v, v))) for _, v in states] + [dot(b["velocity"], b["velocity"]) ** 0.5 for b in scene["bodies"]]
        within_velocity = RIGHT * max(speeds)
    rows = []
    for b, (position, velocity) in zip(scene["bodies"], states):
        row = dict(name=b["name"], position=[number(x) for x in position])
        if velocities:
            row["velocity"] = [number(x) for x in velocity]
        rows.append(row)
    bounds = dict(within=significant(within))
    if velocities:
        bounds["within_velocity"] = significant(within_velocity)
    return dict(end=dict(**bounds, why=why, bodies=rows))


def number(x):
    """The nearest double; what is zero but for rounding is 0."""
    return 0.0 if abs(x) < TINY else float(x)


def significant(x):
    return float(f"{x:.2g}")


FLIGHTS_WHY = "flights in closed form from impact to impact, in 60 digits (reference/make_truth.py)"


def flown(scene, *more, counts=True, within=None):
    """What flights in closed form say about a scene, and more."""
    states, contacts, cushions = flights(scene)
    known = impacts(FLIGHTS_WHY, contacts=contacts, cushions=cushions) if counts else {}
    if counts and "cushions" not in scene["effects"]:
        del known["impacts"]["cushions"]
    if counts and "contact" not in scene["effects"]:
        del known["impacts"]["contacts"]
    return joined(known, *more, end(scene, states, FLIGHTS_WHY, within))


ORDER = ("energy", "momentum", "penetration", "impacts", "mirror", "speed", "end")


# --- writing ------------------------------------------------------------------------------------------------------
def value(x):
    return json.dumps(x, ensure_ascii=False)


def entries(table):
    """The plain keys of a table, one a line."""
    tables = lambda x: isinstance(x, dict) or isinstance(x, list) and x and isinstance(x[0], dict)  # noqa: E731
    plain = [f"{key} = {value(x)}" for key, x in table.items() if not tables(x)]
    return plain, [(key, x) for key, x in table.items() if tables(x)]


def toml(table, path=""):
    plain, tables = entries(table)
    lines = list(plain)
    for key, inner in tables:
        where = f"{path}{key}"
        for one in inner if isinstance(inner, list) else [inner]:
            text = toml(one, f"{where}.")
            if isinstance(inner, list):
                lines += ["", f"[[{where}]]", text]
            elif entries(one)[0]:
                lines += ["", f"[{where}]", text]
            else:
                lines.append(text)
    return "\n".join(lines)
