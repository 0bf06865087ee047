"""Random packings of equal spheres in a cube, periodic or between two plates."""

import math

import numpy as np
from scipy.optimize import minimize
from scipy.spatial import cKDTree


def _period(plates):
    """Box of the search tree; 0 is no period."""
    return [1.0, 1.0, 0.0 if plates else 1.0]


def _inside(x, plates):
    """Points wrapped into the cube along the periodic axes."""
    wrapped = x % 1.0
    if plates:
        wrapped[..., 2] = x[..., 2]
    return wrapped


def _nearest(apart, plates):
    """Distance vectors to the nearest images."""
    images = np.round(apart)
    if plates:
        images[..., 2] = 0
    return apart - images


def _energy(x, diameter, count, plates):
    """Sum of squared overlaps, and its gradient."""
    x = _inside(x.reshape(count, 3), plates)
    pairs = cKDTree(x, boxsize=_period(plates)).query_pairs(diameter, output_type="ndarray")
    gradient = np.zeros_like(x)
    energy = 0.0
    if plates:
        low, high = np.maximum(diameter / 2 - x[:, 2], 0), np.maximum(x[:, 2] - 1 + diameter / 2, 0)
        gradient[:, 2] = 2 * (high - low)
        energy = float((low**2 + high**2).sum())
    if not len(pairs):
        return energy, gradient.ravel()
    apart = x[pairs[:, 0]] - x[pairs[:, 1]]
    apart = _nearest(apart, plates)
    distance = np.linalg.norm(apart, axis=1)
    overlap = diameter - distance
    push = -2 * (overlap / np.maximum(distance, 1e-12))[:, None] * apart
    np.add.at(gradient, pairs[:, 0], push)
    np.add.at(gradient, pairs[:, 1], -push)
    return energy + float((overlap**2).sum()), gradient.ravel()


def packing(count, fraction, seed, sweeps=400, plates=False):
    """Centres and radius, in sides of the cube, of `count` equal hard spheres at random that fill `fraction` of it.

    Overlaps of random points are relaxed; then Monte Carlo moves of hard spheres (`sweeps` tries for each) forget how. The same seed gives
    the same packing. With `plates` z = 0 and 1 are walls. @raise ValueError if no packing was found
    """
    random = np.random.default_rng(seed)
    radius = (3 * fraction / (4 * math.pi * count)) ** (1 / 3)
    wanted = 2 * radius
    low, high = (radius, 1 - radius) if plates else (-1, 2)
    for _ in range(20):
        found = minimize(_energy, random.random((count, 3)).ravel(), args=(wanted * (1 + 1e-4), count, plates), jac=True,
                         method="L-BFGS-B", options={"maxiter": 5000, "ftol": 0, "gtol": 1e-13})
        x = _inside(found.x.reshape(count, 3), plates)
        inside = x[:, 2].min() >= low and x[:, 2].max() <= high
        if inside and not len(cKDTree(x, boxsize=_period(plates)).query_pairs(wanted)):
            break
    else:
        raise ValueError(f"no packing of {count} spheres with a solid fraction of {fraction} found")
    step = 0.2 * max(0.02, (0.66 / fraction) ** (1 / 3) - 1) * wanted * 5
    for _ in range(sweeps):
        for i in range(count):
            moved = _inside(x[i] + step * (random.random(3) - 0.5), plates)
            apart = _nearest(x - moved, plates)
            square = np.einsum("ij,ij->i", apart, apart)
            square[i] = 1.0
            if square.min() >= wanted**2 and low <= moved[2] <= high:
                x[i] = moved
    return x.tolist(), radius
