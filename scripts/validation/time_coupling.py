"""How loads reach grains that make several steps per fluid step."""

import math

from .case import Case, Figure, Row, Run, groups
from .channels import of
from .engine import yade
from .free import RADIUS, free_sphere, late
from .plotting import COLOURS, MARKERS
from .report import table

SCHEMES = ("held", "averaged", "extrapolated")
COUNTS = (1, 2, 5, 10, 50)
RATIOS = (0.5, 1.0, 2.5)
LIGHT = (1.0, 0.7, 0.5, 0.3, 0.2, 0.15, 0.1, 0.07, 0.05)
LIGHT_TAUS = (0.52, 0.6, 1.0, 2.0)
OMEGAS = (0.2, 0.5, 1.0, 1.4, 2.0, 3.0, 5.0)
AT_REST = 1e-3  # of the speed at touch-down


def lightest(scheme, tau):
    """The smallest stable density ratio."""
    return yade("lightest.py", {"scheme": scheme, "tau": tau, "ratios": LIGHT, "steps": 1500})


def fall(scheme, n):
    """Trajectory of a sphere that falls towards the floor."""
    return yade("fall.py", {"scheme": scheme, "n": n, "tau": 0.7})


def touch_down(scheme, omega_step, lubrication):
    """Motion left after a sphere has lain down on the floor, over its largest speed."""
    return yade("touch_down.py", {"scheme": scheme, "omega_step": omega_step, "lubrication": lubrication})


def runs(quick):
    for scheme in SCHEMES:
        counts = (1, 10) if quick or scheme != "held" else COUNTS
        for n in counts:
            for q in RATIOS:
                yield Run(free_sphere, {"motion": "release", "q": q, "tau": 0.6, "n": n, "scheme": scheme}, 0.085 + 0.003 * n)
            yield Run(fall, {"scheme": scheme, "n": n}, 0.025 + 0.003 * n)
        for tau in (0.6,) if quick else LIGHT_TAUS:
            yield Run(lightest, {"scheme": scheme, "tau": tau}, 0.1)
        for omega in (0.5, 2.0) if quick else OMEGAS:
            for lubrication in (False, True) if scheme == "held" else (False,):
                yield Run(touch_down, {"scheme": scheme, "omega_step": omega, "lubrication": lubrication}, 0.012 + 0.02 * omega)


def base(results):
    """The fall with loads held and one grain step per fluid step."""
    return next(r for r in of(results, fall) if r["scheme"] == "held" and r["n"] == 1)


def apart(run, other):
    """Largest distance of two trajectories, in diameters."""
    def at(r, time):
        i = min(max(next((k for k, t in enumerate(r["times"]) if t >= time), len(r["times"]) - 1), 1), len(r["times"]) - 1)
        part = (time - r["times"][i - 1]) / (r["times"][i] - r["times"][i - 1])
        return (1 - part) * r["heights"][i - 1] + part * r["heights"][i]

    until = min(run["times"][-1], other["times"][-1])
    return max(abs(at(run, t) - at(other, t)) for t in other["times"] if t < until)


def releases(results, scheme):
    """{density ratio: {n: late error}}."""
    return {q: {r["n"]: late(r) for r in group} for (q,), group in
            groups([r for r in of(results, free_sphere) if r["scheme"] == scheme], "q").items()}


def rows(results):
    found = []
    start = base(results)
    held = [r for r in of(results, fall) if r["scheme"] == "held"]
    counts = f"{min(r['n'] for r in held)} ... {max(r['n'] for r in held)} grain steps per fluid step"
    found.append(Row(f"peak velocity of a falling sphere (Re = {start['reynolds']:.1f}), loads held, {counts}", "d = 8", "0.7",
                     max((r["peak"] / start["peak"] - 1 for r in held), key=abs), 0.005))
    found.append(Row(f"its trajectory, in d, loads held, {counts}", "d = 8", "0.7", max(apart(r, start) for r in held), 0.01))
    for q, by_count in releases(results, "held").items():
        found.append(Row(f"change with {counts}, velocity after release, density ratio {q:g}", f"d = {2 * RADIUS:g}", "0.6",
                         max(by_count.values()) - min(by_count.values())))
    return found


def landings(results, scheme, lubrication=False):
    """Runs on the floor, by omega dt."""
    return sorted((r for r in of(results, touch_down) if (r["scheme"], r["lubrication"]) == (scheme, lubrication)), key=lambda r: r["omega_step"])


def resting(landed):
    """The largest omega dt up to which all that were tried come to rest."""
    largest = math.nan
    for r in landed:
        if r["left"] > AT_REST:
            break
        largest = r["omega_step"]
    return largest


def text(results):
    lines = []
    names = [s for s in SCHEMES if any(r["scheme"] == s for r in results)]
    late_errors = {s: releases(results, s) for s in names}
    lines.append((f"release from rest, error from 0.3 R^2/nu on, density ratio {' / '.join(f'{q:g}' for q in RATIOS)}",
                  *(" / ".join(f"{100 * late_errors[s][q][1]:.2f}" for q in RATIOS) + " %" for s in names)))
    lines.append(("change of this error with the number of grain steps",
                  *(f"{100 * max(max(e.values()) - min(e.values()) for e in late_errors[s].values()):.1g} %" for s in names)))
    start = base(results)
    lines.append(("fall: peak velocity against one grain step, held",
                  *(" / ".join(f"{100 * (r['peak'] / start['peak'] - 1):+.2g}" for r in sorted((r for r in of(results, fall) if r["scheme"] == s), key=lambda r: r["n"])) + " %" for s in names)))
    taus = sorted({r["tau"] for r in of(results, lightest)})
    light = {(r["scheme"], r["tau"]): r["smallest"] for r in of(results, lightest)}
    lines.append((f"smallest stable density ratio ({LIGHT[-1]:g} was the smallest tried), tau {' / '.join(f'{t:g}' for t in taus)}",
                  *(" / ".join(f"{light[s, t]:g}" if light.get((s, t)) else "above 1" for t in taus) for s in names)))
    landed = {s: landings(results, s) for s in names}
    lines.append(("sphere on the floor, undamped contact, rests up to omega dt of", *(f"{resting(landed[s]):g}" for s in names)))
    beyond = {s: [100 * r["left"] for r in landed[s] if not r["omega_step"] <= resting(landed[s])] for s in names}
    lines.append(("speed that is left beyond that, of the largest", *(f"{min(beyond[s]):.2g} ... {max(beyond[s]):.2g} %" if beyond[s] else "" for s in names)))
    films = landings(results, "held", True)
    moving = [r for r in films if r["left"] > AT_REST]
    worst_film = f", and keeps up to {100 * max(r['left'] for r in moving):.2g} % of its largest speed beyond" if moving else ", the most that was tried"
    return f"""
{table(("", *names), lines)}

omega^2 = k/m of the contact, dt the fluid's step; films are off there. With films (the default), loads held, the sphere rests up to omega dt = {resting(films):g}{worst_film}. The number of grain steps
changes nothing to speak of: the impulse is the same.
"""


def figures(results):
    def draw(canvas):
        left, right = canvas.subplots(1, 2)
        for scheme, colour, marker in zip(SCHEMES, COLOURS, MARKERS):
            for (q, by_count), style in zip(releases(results, scheme).items(), (":", "--", "-")):
                counts = sorted(by_count)
                left.plot(counts, [100 * by_count[n] for n in counts], style, color=colour, marker=marker, label=f"{scheme}, density ratio {q:g}")
            for lubrication, style in ((False, "-"), (True, ":")):
                mine = [(r["omega_step"], max(r["left"], 1e-12)) for r in landings(results, scheme, lubrication)]
                if mine:
                    right.loglog(*zip(*mine), style, color=colour, marker=marker, label=scheme + (", with films" if lubrication else ""))
        left.set(xscale="log", ylim=(0, None), xlabel="grain steps per fluid step", ylabel="error after release, from 0.3 R^2/nu on [%]")
        right.set(xlabel="contact frequency x fluid step", ylabel="speed left / largest speed")
        left.legend(fontsize=7)
        right.legend()

    return [Figure("time_coupling", "Loads held, averaged, or extrapolated: release of a sphere (left) and a sphere in undamped contact with the floor (right).", draw, (10.5, 4.2))]


TIME_COUPLING = Case(
    name="time_coupling",
    title="Loads in time: sub-cycles",
    solved="""
Grains make n steps per fluid step with the load of the fluid, in one of three ways: the last load held (what `LbmEngine` does), the mean of the last two, the last one extrapolated by half a step.
A free sphere is released in a periodic cube (R = 4.5, 36 cells, tau = 0.6); a sphere falls in a closed box; light spheres are released (stable or not); a sphere lies down on the floor in an undamped contact.""",
    reference="`periodic_bbo.csv` for the release; for the fall, one grain step per fluid step.",
    runs=lambda quick: list(runs(quick)),
    rows=rows,
    text=text,
    figures=figures,
)
