"""What a validation case is: runs, and what their results say about a claim."""

import json
import math
from dataclasses import dataclass, field
from typing import Callable


@dataclass(frozen=True)
class Run:
    """One computation on one thread, independent of all others.

    function   of this package; called with `arguments`, returns a dictionary of JSON values that holds at least `cells` and `steps`
    arguments  JSON values; a stored result belongs to a run with the same function and arguments
    cost       expected number of cell updates [1e9], for the order of the runs and the time left
    """

    function: Callable
    arguments: dict
    cost: float

    def __post_init__(self):
        object.__setattr__(self, "arguments", json.loads(json.dumps(self.arguments)))  # as they are read back: lists, not tuples


@dataclass(frozen=True)
class Row:
    """A line of the summary: one quantity beside its target.

    quantity    what is compared
    resolution  in cells, with the length it counts
    tau         relaxation time(s)
    error       signed relative error of the mean, or the measured size of what should be zero
    worst       what is judged: the largest size of the error among sub-cell offsets (default: of `error`)
    scatter     half the range of the error over sub-cell offsets, if there were several
    target      bound on `worst`; None: nothing was asked
    scatter_target  bound on `scatter`
    """

    quantity: str
    resolution: str
    tau: str
    error: float
    target: float = None
    worst: float = None
    scatter: float = None
    scatter_target: float = None

    @property
    def met(self):
        """True or False; None where nothing was asked. A number that is not finite never meets a target."""
        judged = abs(self.error) if self.worst is None else self.worst
        verdicts = [value <= bound for value, bound in ((judged, self.target), (self.scatter, self.scatter_target))
                    if bound is not None and value is not None]
        return all(verdicts) if verdicts else None


@dataclass(frozen=True)
class Figure:
    """A plot of the report: `draw` is called with a new matplotlib figure; `size` in inches."""

    name: str
    caption: str
    draw: Callable
    size: tuple = (7.0, 4.2)


@dataclass(frozen=True)
class Case:
    """A claim about physics, how it is put to the test, and what became of it.

    name, title  for the command line, and for the report
    solved       what is solved, and how (Markdown)
    reference    what it is compared with, and how that was obtained (Markdown)
    runs         quick -> the runs
    rows         results -> lines of the summary; results are those of runs that ended well, see `Result`
    text         results -> tables and comments for the report (Markdown)
    figures      results -> list of `Figure`
    """

    name: str
    title: str
    solved: str
    reference: str
    runs: Callable
    rows: Callable
    text: Callable = lambda results: ""
    figures: Callable = lambda results: []


@dataclass
class Result:
    """A finished run, as it is stored: what went in, what came out (or why nothing did), and what it took."""

    function: str
    arguments: dict
    values: dict = field(default_factory=dict)
    failure: str = ""
    seconds: float = 0.0
    session: int = 0

    def __getitem__(self, key):
        """A value that came out, or else an argument that went in."""
        return self.values[key] if key in self.values else self.arguments[key]


def groups(results, *keys):
    """Results by the values of some keys: {(value, ...): [result, ...]}, in order of first appearance."""
    found = {}
    for result in results:
        found.setdefault(tuple(result[key] for key in keys), []).append(result)
    return found


@dataclass(frozen=True)
class Spread:
    """Errors of one quantity over several runs."""

    mean: float
    worst: float   # largest size
    scatter: float  # half the range; None of a single one
    count: int

    @staticmethod
    def of(errors):
        errors = list(errors)
        if not errors or not all(math.isfinite(e) for e in errors):
            return Spread(math.nan, math.nan, math.nan, len(errors))
        scatter = (max(errors) - min(errors)) / 2 if len(errors) > 1 else None
        return Spread(sum(errors) / len(errors), max(map(abs, errors)), scatter, len(errors))


def observed_order(sizes, errors):
    """Least-squares slope of -log|error| over log(size); nan for fewer than two."""
    points = [(math.log(n), math.log(abs(e))) for n, e in zip(sizes, errors) if e]
    if len(points) < 2:
        return math.nan
    x = sum(p[0] for p in points) / len(points)
    y = sum(p[1] for p in points) / len(points)
    return -sum((p[0] - x) * (p[1] - y) for p in points) / sum((p[0] - x) ** 2 for p in points)
