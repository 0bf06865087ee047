"""Random packings of equal spheres in a periodic cube."""

import math

import numpy as np
from scipy.optimize import minimize
from scipy.spatial import cKDTree


def _energy(x, diameter, count):
    """Sum of squared overlaps, and its gradient."""
    x = x.reshape(count, 3) % 1.0
    pairs = cKDTree(x, boxsize=1.0).query_pairs(diameter, output_type="ndarray")
    gradient = np.zeros_like(x)
    if not len(pairs):
        return 0.0, gradient.ravel()
    apart = x[pairs[:, 0]] - x[pairs[:, 1]]
    apart -= np.round(apart)
    distance = np.linalg.norm(apart, axis=1)
    overlap = diameter - distance
    push = -2 * (overlap / np.maximum(distance, 1e-12))[:, None] * apart
    np.add.at(gradient, pairs[:, 0], push)
    np.add.at(gradient, pairs[:, 1], -push)
    return float((overlap**2).sum()), gradient.ravel()


def packing(count, fraction, seed, sweeps=400):
    """Centres and radius, in sides of the cube, of `count` equal hard spheres at random that fill `fraction` of it.

    Overlaps of random points are relaxed; then Monte Carlo moves of hard spheres (`sweeps` tries for each) forget how. The same seed gives
    the same packing. @raise ValueError if no packing was found
    """
    random = np.random.default_rng(seed)
    radius = (3 * fraction / (4 * math.pi * count)) ** (1 / 3)
    wanted = 2 * radius
    for _ in range(20):
        found = minimize(_energy, random.random((count, 3)).ravel(), args=(wanted * (1 + 1e-4), count), jac=True,
                         method="L-BFGS-B", options={"maxiter": 5000, "ftol": 0, "gtol": 1e-13})
        x = found.x.reshape(count, 3) % 1.0
        if not len(cKDTree(x, boxsize=1.0).query_pairs(wanted)):
            break
    else:
        raise ValueError(f"no packing of {count} spheres with a solid fraction of {fraction} found")
    step = 0.2 * max(0.02, (0.66 / fraction) ** (1 / 3) - 1) * wanted * 5
    for _ in range(sweeps):
        for i in range(count):
            moved = (x[i] + step * (random.random(3) - 0.5)) % 1.0
            apart = x - moved
            apart -= np.round(apart)
            square = np.einsum("ij,ij->i", apart, apart)
            square[i] = 1.0
            if square.min() >= wanted**2:
                x[i] = moved
    return x.tolist(), radius
