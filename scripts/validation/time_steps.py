"""Does the fluid's step, or the number of grain steps in it, change the answer?"""

from .case import Case, Figure, Row, Run
from .channels import of
from .engine import yade
from .plotting import COLOURS, MARKERS
from .report import table

TAUS = (0.52, 0.6, 0.8, 1.0, 1.5, 2.0)
COUNTS = (1, 2, 5, 10, 50)
PARTS = (0.2, 0.4, 0.7, 1.5, 3.7)  # several fluid steps in a grain step, or counts that are not whole: of the settling sphere alone
TAU, COUNT = 0.8, 5  # what all others are compared with


def settling(tau, n):
    """Heights of a sphere that settles in a closed box, in diameters at ten times, and its velocity at the end over Stokes'."""
    return yade("settling.py", {"tau": tau, "n": n})


def bed(tau, n):
    """Permeability of a fixed bed."""
    return yade("bed.py", {"tau": tau, "n": n})


def pile(tau, n):
    """Largest speed of grains after they have come to rest, over a lone grain's."""
    return yade("pile.py", {"tau": tau, "n": n})


def runs(quick):
    for tau, n in [(tau, COUNT) for tau in TAUS] + [(TAU, n) for n in COUNTS if n != COUNT]:
        if quick and (tau < 0.6 or n > 10):
            continue
        both = {"tau": tau, "n": n}
        yield Run(settling, both, 0.028 / (tau - 0.5) * (1 + 0.02 * n))
        yield Run(bed, both, 8000 * max(1620 * 0.1 / (tau - 0.5), 6400 * (tau - 0.5)) / 1e9)
        yield Run(pile, both, 5632 * 450 / (tau - 0.5) / 1e9 * (1 + 0.02 * n))
    for n in PARTS:
        yield Run(settling, {"tau": TAU, "n": n}, 0.1)


def base(results, function):
    return next(r for r in of(results, function) if (r["tau"], r["n"]) == (TAU, COUNT))


def differences(results, function):
    """{(tau, n): (what changes, ...)} against the base: velocity and trajectory (in d), or permeability, or the motion left."""
    start = base(results, function) if function is not pile else None
    found = {}
    for r in of(results, function):
        if function is settling:
            found[r["tau"], r["n"]] = (r["velocity"] / start["velocity"] - 1, max(abs(a - b) for a, b in zip(r["heights"], start["heights"])))
        elif function is bed:
            found[r["tau"], r["n"]] = (r["permeability"] / start["permeability"] - 1,)
        else:
            found[r["tau"], r["n"]] = (r["left"],)
    return found


QUANTITIES = (  # function, index, name, resolution, target
    (settling, 0, "velocity of a settling sphere, Re = 0.04", "d = 6", 0.005),
    (settling, 1, "its trajectory from rest over 1.5 d, in d", "d = 6", 0.01),
    (bed, 0, "permeability of a bed of eight spheres", "d = 9", 0.005),
    (pile, 0, "motion left of five grains at rest, of a lone grain's speed", "d = 8", 1e-3),
)


def rows(results):
    found = []
    for function, i, name, resolution, target in QUANTITIES:
        changes = differences(results, function)
        taus, counts = sorted({t for t, _ in changes}), sorted({n for _, n in changes})
        by_tau = max((v[i] for (t, n), v in changes.items() if n == COUNT), key=abs)
        by_count = max((v[i] for (t, n), v in changes.items() if t == TAU), key=abs)
        verb = "" if function is pile else "change with tau: "
        found.append(Row(f"{verb}{name}", resolution, f"{taus[0]:g} ... {taus[-1]:g}", by_tau, target))
        verb = "" if function is pile else "change with grain steps: "
        found.append(Row(f"{verb}{name}, n = {counts[0]} ... {counts[-1]}", resolution, f"{TAU:g}", by_count, target))
    return found


def text(results):
    settings = sorted({(r["tau"], r["n"]) for r in results})
    lines = []
    for function, i, name, _, _ in QUANTITIES:
        changes = differences(results, function)
        lines.append((name, *(f"{100 * changes[s][i]:.2g} %" if s in changes else "" for s in settings)))
    return f"""
Against tau = {TAU:g} with {COUNT} grain steps per fluid step (motion left: as it is):

{table(("", *(f"{tau:g}, n = {n}" for tau, n in settings)), lines)}
"""


def figures(results):
    def draw(canvas):
        axis = canvas.subplots()
        for (function, i, name, _, target), colour, marker in zip(QUANTITIES[:3], COLOURS, MARKERS):
            changes = differences(results, function)
            mine = sorted((tau - 0.5, 100 * abs(v[i])) for (tau, n), v in changes.items() if n == COUNT and tau != TAU)
            axis.loglog(*zip(*mine), color=colour, marker=marker, label=name)
            axis.axhline(100 * target, color=colour, ls=":", lw=1)
        axis.set(xlabel="tau - 1/2, ratio of time steps", ylabel=f"change against tau = {TAU:g} [%]")
        axis.legend()

    return [Figure("time_steps", "What another fluid step changes; dotted: the targets.", draw)]


TIME_STEPS = Case(
    name="time_steps",
    title="The same cases with other time steps",
    solved="""
Through YADE, with tau from 0.52 to 2 and 1 to 50 grain steps per fluid step: a sphere settles in a closed box from rest (also with 0.2 to 3.7, where fluid steps begin within grain steps); flow through a fixed packed bed; grains come to rest on the floor in undamped contacts (tau up to 1.5,
since beyond it their weight would compress the lattice's fluid by more than the plan allows).""",
    reference="None is needed: the answer must not change.",
    runs=lambda quick: list(runs(quick)),
    rows=rows,
    text=text,
    figures=figures,
)
