"""The look of the report's figures."""

import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot as plt  # noqa: E402  (the backend comes first)

COLOURS = ("#1b4965", "#c8553d", "#2a9d8f", "#e9a03b", "#7b5ea7", "#6c757d", "#a23e68", "#588157")
MARKERS = "osD^v<>p"

plt.rcParams.update({
    "figure.dpi": 110,
    "font.size": 9.5,
    "axes.grid": True,
    "grid.color": "0.9",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.axisbelow": True,
    "legend.frameon": False,
    "legend.fontsize": 8.5,
    "lines.markersize": 4.5,
})


def against(axes, exact, found, colour, marker, **style):
    """A solution as a thin line, and what was found as markers of its colour; each as (x, y)."""
    axes.plot(*exact, color=colour, lw=1)
    axes.plot(*found, marker, color=colour, **style)


def save(figure, path):
    """Draws and writes a `Figure` of a case."""
    canvas = plt.figure(figsize=figure.size, constrained_layout=True)
    figure.draw(canvas)
    canvas.savefig(path)
    plt.close(canvas)
