"""The picture of the settling grains: seen from the front, with the flow in the mid-plane, and on their way to rest."""

import numpy as np
from matplotlib.collections import PatchCollection
from matplotlib.colors import LinearSegmentedColormap, Normalize
from matplotlib.patches import Circle

from tools import plt

WATER = LinearSegmentedColormap.from_list("water", ["#f4f8fb", "#a9cfe6", "#3f8fc4", "#12507f", "#08243f"])
SPEED = LinearSegmentedColormap.from_list("speed", ["#d9c7a3", "#e0a458", "#d1603d", "#8c1c4b"])


def _frame(axes, box, title):
    axes.set(xlim=(0, 1e3 * box[0]), ylim=(0, 1e3 * box[1]), aspect="equal", xticks=(0, 5, 10), title=title)
    axes.grid(False)
    for spine in axes.spines.values():
        spine.set(visible=True, color="0.25", linewidth=1.2)
    axes.tick_params(labelsize=8)
    axes.title.set_fontsize(9.5)


def _balls(axes, x, z, r, colours, order):
    """Shaded balls, drawn in the given order: a dark rim and a light spot, up and to the left."""
    patches, faces, edges = [], [], []
    for i in order:
        base = np.array(colours[i][:3])
        for scale, light in ((1.0, -0.22), (0.9, 0.0), (0.62, 0.10), (0.34, 0.24)):
            tone = base + light * ((1 - base) if light > 0 else base)
            patches.append(Circle((x[i] - 0.30 * (1 - scale) * r[i], z[i] + 0.34 * (1 - scale) * r[i]), scale * r[i]))
            faces.append(tone)
            edges.append((0.12, 0.10, 0.08, 0.9) if scale == 1.0 else (0, 0, 0, 0))
    axes.add_collection(PatchCollection(patches, facecolors=faces, edgecolors=edges, linewidths=0.5, zorder=3))


def _front(axes, picture, norm):
    """All grains, seen from the front."""
    x, y, z, r, speed = picture["grains"].T
    axes.set_facecolor("#e8f1f7")
    depth = (y - y.min()) / max(np.ptp(y), 1e-12)
    colours = SPEED(norm(speed))
    colours[:, :3] *= (1 - 0.45 * depth)[:, None]  # darker towards the back
    _balls(axes, 1e3 * x, 1e3 * z, 1e3 * r, colours, np.argsort(-y))
    _frame(axes, picture["box"], f"{picture['title']}, t = {picture['time']:.2f} s")


def _slice(axes, picture, norm, water):
    """The mid-plane: speed of the liquid, streamlines, and the cut grains."""
    width, height = picture["box"]
    u, w = 1e3 * picture["velocity"][..., 0], 1e3 * picture["velocity"][..., 1]
    magnitude = np.hypot(u, w)
    image = axes.imshow(magnitude, origin="lower", extent=(0, 1e3 * width, 0, 1e3 * height), cmap=WATER, norm=water,
                        interpolation="bilinear")
    solid = picture["solid"] > 0.5
    if magnitude.max() > 0.05 * water.vmax:
        centres = [(np.arange(n) + 0.5) * 1e3 * picture["dx"] for n in magnitude.shape]
        moving = (magnitude > 0.03 * water.vmax) & ~solid
        axes.streamplot(centres[1], centres[0], np.where(moving, u, np.nan), np.where(moving, w, np.nan),
                        color=(1, 1, 1, 0.75), density=(0.9, 2.0), linewidth=0.7, arrowsize=0.6, zorder=2)
    x, y, z, r, speed = picture["grains"].T
    offset = y - picture["plane"]
    cut = np.abs(offset) < r
    radius = np.sqrt(r[cut] ** 2 - offset[cut] ** 2)
    _balls(axes, 1e3 * x[cut], 1e3 * z[cut], 1e3 * radius, SPEED(norm(speed[cut])), range(cut.sum()))
    _frame(axes, picture["box"], f"mid-plane, t = {picture['time']:.2f} s")
    return image


def draw(path, pictures, history, speed_scale):
    """Draws the picture.

    pictures     dictionaries with title, time, grains (n, 5: position, radius, speed), box, dx; all but the
                 first also with the mid-plane: plane (its y), velocity (nz, nx, 2), solid (nz, nx)
    history      rows of time, kinetic energy, unbalanced force, mean height, largest speed
    speed_scale  speed of a lone grain [m/s]
    """
    columns = [("front", p) for p in pictures[:1]]
    for picture in pictures[1:]:
        columns += [("slice", picture), ("front", picture)]
    norm = Normalize(0, 0.8 * speed_scale)
    water = Normalize(0, 0.6e3 * speed_scale)
    figure = plt.figure(figsize=(2.35 * len(columns) + 4.3, 6.0), constrained_layout=True)
    grid = figure.add_gridspec(2, len(columns) + 1, width_ratios=[1] * len(columns) + [1.75])
    image, panels = None, []
    for i, (kind, picture) in enumerate(columns):
        axes = figure.add_subplot(grid[:, i])
        if kind == "front":
            _front(axes, picture, norm)
        else:
            image = _slice(axes, picture, norm, water)
        axes.set_xlabel("x [mm]", fontsize=8)
        if i == 0:
            axes.set_ylabel("z [mm]", fontsize=8)
        panels.append(axes)
    scalar = plt.cm.ScalarMappable(Normalize(0, 1e3 * norm.vmax), SPEED)
    half = len(panels) // 2
    bars = dict(orientation="horizontal", shrink=0.8, aspect=32, pad=0.02)
    figure.colorbar(scalar, ax=panels[:half], label="speed of grains [mm/s]", **bars)
    if image is not None:
        figure.colorbar(image, ax=panels[half:], label="speed of the liquid [mm/s]", **bars)

    time, energy, unbalanced, height, _ = np.array(history).T
    upper, lower = figure.add_subplot(grid[0, -1]), figure.add_subplot(grid[1, -1])
    upper.semilogy(time, 1e9 * np.maximum(energy, 1e-30), color="#8c1c4b", lw=1.8)
    upper.set(xlabel="time [s]", title="kinetic energy of the grains [nJ]")
    lower.semilogy(time, unbalanced, color="#12507f", lw=1.2)
    lower.set(xlabel="time [s]", title="unbalanced force [-]")
    for axes in (upper, lower):
        axes.title.set_fontsize(9.5)
        axes.tick_params(labelsize=8)
        for picture in pictures[1:]:
            axes.axvline(picture["time"], color="0.6", lw=0.8, ls="--")
    figure.savefig(path)
    plt.close(figure)
