"""The report, made from stored results alone."""

import math
import os

from . import plotting
from .store import Store

HEAD = """\
# Validation

Made by `scripts/validate` from the results in [{folder}/]({folder}/), which hold every run with its input, commit, date and time taken.
`scripts/validate --report` makes this page and its figures again from them, `scripts/validate` the results themselves{cost}.

- **error**: signed, mean over sub-cell offsets where there are several; a spread or a residual where the quantity says so.
- **worst**: the largest error among the offsets. The target applies to it, not to the mean.
- **scatter**: half the range over the offsets.
- **tau**: the cheapest one for steady Stokes flow. The result does not depend on it; the case `tau` proves that.
- **cost** of a case: at its end, with where and when it was run. A commit that the history does not have was rebased before it landed, with changes beside it.
- A verdict is given only where a target was set before the runs. No target was changed to fit a number.
"""

# When the scheme itself changed last: results made before are of another one.
SCHEME_SINCE = "2026-12-01T04:25"
OLDER = """\
**Made with earlier functions of eps** (lam, g, k and the law of narrow pores of set LN, [physics](physics.md)), and to be run again: {cases}.
"""

NOT_COVERED = """\
## Not covered yet

- Minimum fluidisation at other Archimedes numbers, and of higher beds.
- Consolidation of a random bed of grains that roll and slide; a column that only gets shorter stands for it.
- Suspensions that have settled over hundreds of radii in large boxes.
"""


def table(names, rows):
    """A Markdown table."""
    lines = ["| " + " | ".join(names) + " |", "|" + " --- |" * len(names)]
    return "\n".join(lines + ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows])


def percent(value, signed=True):
    """A relative error for eyes: in % with three figures, small ones as powers of ten."""
    if value is None:
        return ""
    if not math.isfinite(value):
        return "none"
    if value == 0:
        return "0"
    if abs(value) < 1e-5:
        return f"{value:{'+' if signed else ''}.1e}"
    digits = max(0, min(4, 2 - math.floor(math.log10(abs(100 * value)))))
    return f"{100 * value:{'+' if signed else ''}.{digits}f} %"


def bound(row):
    """The target of a row for eyes."""
    parts = [percent(row.target, signed=False)] if row.target is not None else []
    if row.scatter_target is not None:
        parts.append(f"scatter {percent(row.scatter_target, signed=False)}")
    return ", ".join(parts)


def verdict(row):
    return {True: "met", False: "**falls short**", None: ""}[row.met]


def summary(rows):
    """The table of all lines of a case, or of several."""
    return table(
        ("case", "quantity", "resolution", "tau", "error", "worst", "scatter", "target", "verdict"),
        [(name, row.quantity, row.resolution, row.tau, percent(row.error), percent(row.worst, signed=False),
          percent(row.scatter, signed=False), bound(row), verdict(row)) for name, row in rows])


def provenance(case, store):
    """What the results of a case took, and where they were made."""
    seconds = sum(result.seconds for result in store.results)
    updates = sum(result.values.get("cells", 0) * result.values.get("steps", 0) for result in store.results) / 1e9
    commits = ", ".join(dict.fromkeys(session["commit"] for session in store.sessions))
    dates = ", ".join(dict.fromkeys(session["date"][:10] for session in store.sessions))
    cpus = ", ".join(dict.fromkeys(session["cpu"] for session in store.sessions))
    planned = case.runs(False)
    done = sum(store.find(run) is not None for run in planned)
    return (f"{done} of {len(planned)} runs of the full tier, {updates:.3g} x 10^9 cell updates, {seconds:.0f} s of one core ({cpus}); "
            f"commit {commits}; {dates}.")


def has_changed(result):
    """Whether a run, made now, would be one of another scheme than before SCHEME_SINCE: not without solids, nor with published schemes, nor with set R."""
    chosen = result.arguments
    if chosen.get("scheme", "exact") != "exact" or chosen.get("variant") == "R" or chosen.get("magic_parameter", 0) not in (0, 0.125):
        return False
    return result.function not in ("poiseuille", "duct", "transient", "oscillating")


def older(case, store):
    """The name of a case with results of the scheme before, and how many of its runs they are; nothing if there are none."""
    count = sum(has_changed(result) and store.sessions[result.session]["date"] < SCHEME_SINCE for result in store.results)
    if not count:
        return ""
    return f"`{case.name}`" + ("" if count == len(store.results) else f" ({count} of {len(store.results)} runs)")


def section(case, store, rows, good, images, folder):
    """The part of the report about one case."""
    parts = [f"## {case.title}", f"*Case `{case.name}`.* {case.solved.strip()}", f"**Reference.** {case.reference.strip()}",
             summary([(case.name, row) for row in rows])]
    parts += [f"![{figure.caption}]({folder}/{figure.name}.png)\n\n*{figure.caption}*" for figure in images]
    parts.append(case.text(good).strip())
    failed = [result for result in store.results if result.failure]
    if failed:
        parts.append("Runs that ended without a result:\n\n" + "\n".join(
            f"- {', '.join(f'{key} {value}' for key, value in result.arguments.items())}: {result.failure}" for result in failed))
    parts.append(provenance(case, store))
    return "\n\n".join(part for part in parts if part)


def make(cases, folder, path, figures=True):
    """Draws the figures into `folder` (unless told not to) and writes the report; returns its path. Cases without results are left out."""
    link = os.path.basename(folder)
    sections, lines, before, seconds = [], [], [], 0.0
    for case in cases:
        store = Store(folder, case.name)
        good = [result for result in store.results if not result.failure]
        if not good:
            continue
        rows, images = case.rows(good), case.figures(good)
        for figure in images if figures else ():
            plotting.save(figure, os.path.join(folder, figure.name + ".png"))
        sections.append(section(case, store, rows, good, images, link))
        lines += [(f"[{case.name}](#{anchor(case.title)})", row) for row in rows]
        before += filter(None, [older(case, store)])
        seconds += sum(result.seconds for result in store.results)
    cost = f" (about {seconds / 60:.0f} minutes of one core)"
    judged = [row.met for _, row in lines if row.met is not None]
    count = f"{sum(judged)} of {len(judged)} targets are met." if judged else ""
    text = [HEAD.format(folder=link, cost=cost), OLDER.format(cases=", ".join(before)) if before else "", "## Summary", count, summary([line for line in lines if line[1].met is not None]),
            *sections, NOT_COVERED]
    with open(path, "w", encoding="utf-8") as file:
        file.write("\n\n".join(part.strip() for part in text if part) + "\n")
    return path


def anchor(title):
    """The name that Markdown gives a heading."""
    kept = "".join(character for character in title.lower() if character.isalnum() or character in " -_")
    return kept.replace(" ", "-")
