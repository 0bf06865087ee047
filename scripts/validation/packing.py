"""Random packings of equal hard spheres in a periodic cube or between two plates."""

import math

import numpy as np
from scipy.spatial import cKDTree

CHAIN = 0.5  # displacement of a chain, in sides of the cube
DENSEST = 0.62  # below random close packing, where chains get stuck


def _largest_diameter(x, gap):
    """Diameter at which the first two spheres, or a sphere and a plate, touch."""
    distances, _ = cKDTree(x, boxsize=[1.0, 1.0, 0.0 if gap else 1.0]).query(x, k=2)  # 0: no period
    nearest = min(distances[:, 1].min(), 1.0)
    return min(nearest, 2 * x[:, 2].min(), 2 * (gap - x[:, 2].max())) if gap else nearest


def _chain(x, diameter, random, gap):
    """One event chain: a sphere moves along an axis until it meets another, which moves on instead.

    Chains have the same displacement altogether, and turn round at plates: so they sample hard spheres in equilibrium [Bernard, Krauth & Wilson, Phys. Rev. E 80, 056704 (2009)].
    """
    axis, moving = random.integers(3), random.integers(len(x))
    walls = gap and axis == 2
    way = random.choice((-1, 1)) if walls else 1
    left = CHAIN
    while left > 0:
        apart = x - x[moving]
        apart -= np.round(apart) * ((1, 1, 0) if gap else 1)
        along = apart[:, axis] * way if walls else apart[:, axis] % 1.0
        reach = diameter**2 - np.einsum("ij,ij->i", apart, apart) + apart[:, axis] ** 2
        free = along - np.sqrt(np.maximum(reach, 0))
        free[(reach <= 0) | (along < 0)] = math.inf
        free[moving] = math.inf
        met = int(free.argmin())
        path = min(max(free[met], 0.0), left)
        if walls:
            path = min(path, (gap - x[moving, 2] if way > 0 else x[moving, 2]) - diameter / 2)
        x[moving, axis] += way * path
        if not walls:
            x[moving, axis] %= 1.0
        left -= path
        if path == free[met] or free[met] < 0:
            moving = met
        else:
            way = -way  # at a plate, or at the end


def packing(count, fraction, seed, sweeps=25, gap=None):
    """Centres and radius, in sides of the box's square base, of `count` equal hard spheres at random that fill `fraction` of the box: a periodic cube, or with `gap`, in sides, between plates at z = 0 and gap.

    Random points grow into spheres as fast as event chains make room for them; `sweeps` chains per sphere then bring them to equilibrium. Above a fraction of
    some 0.55, where equilibrium is a crystal, few chains leave them in the amorphous state in which they grew. The same seed gives the same packing.
    @raise ValueError if there is no such packing
    """
    if not 0 < fraction <= DENSEST:
        raise ValueError(f"fraction = {fraction}: must be > 0 and <= {DENSEST}, spheres at random do not get denser")
    random = np.random.default_rng(seed)
    radius = (3 * fraction * (gap or 1) / (4 * math.pi * count)) ** (1 / 3)
    x = random.random((count, 3)) * (1, 1, gap or 1)
    for _ in range(1000 * count):
        diameter = _largest_diameter(x, gap)
        if diameter >= 2 * radius:
            break
        _chain(x, diameter, random, gap)
    else:
        raise ValueError(f"no packing of {count} spheres with a solid fraction of {fraction} found")
    for _ in range(sweeps * count):
        _chain(x, 2 * radius, random, gap)
    return x.tolist(), radius
