"""What the example scripts share: reference tables, progress on long runs, the look of plots."""

import csv
import os
import time

import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot as plt  # noqa: E402  (the backend comes first)

ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
REFERENCE = os.path.join(ROOT, "tests", "reference")

plt.rcParams.update({
    "figure.dpi": 130,
    "font.size": 10,
    "axes.grid": True,
    "grid.color": "0.9",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.axisbelow": True,
    "legend.frameon": False,
})


def reference_rows(name):
    """Rows of tests/reference/NAME as dictionaries of strings; lines that start with # are comments."""
    with open(os.path.join(REFERENCE, name), encoding="utf-8") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def write_rows(path, names, rows, comment=""):
    """Writes a table with an optional comment line on top."""
    with open(path, "w", encoding="utf-8", newline="") as file:
        if comment:
            file.write(f"# {comment}\n")
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(names)
        writer.writerows([f"{value:.8g}" if isinstance(value, float) else value for value in row] for row in rows)


def output_folder(path):
    """Absolute path of a folder that exists from now on."""
    path = os.path.abspath(path)
    os.makedirs(path, exist_ok=True)
    return path


class Progress:
    """Prints how far a run is, at most every `period` seconds of wall-clock time."""

    def __init__(self, name, period=2.0):
        self.name, self.period = name, period
        self.start = self.last = time.monotonic()

    @property
    def elapsed(self):
        """Wall-clock time since the start [s]."""
        return time.monotonic() - self.start

    def show(self, fraction, text, force=False):
        """A line with the fraction done (0 to 1), `text` and the time left, if it is time for one."""
        now = time.monotonic()
        if not force and now - self.last < self.period:
            return
        self.last = now
        left = self.elapsed * (1 - fraction) / fraction if fraction > 0.005 else float("nan")
        eta = "" if force else f", {left:4.0f} s left"
        print(f"{self.name}  {100 * fraction:5.1f} %  {text}  [{self.elapsed:.0f} s{eta}]", flush=True)
