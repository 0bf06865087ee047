#!/usr/bin/python3
"""Where the lattice puts walls: exact flow between parallel planes of any orientation.

Cells with the same n.x (n: the normal, with whole components) are alike, so the steady Stokes flow that a pressure gradient G
drives along two planes is a linear problem in one dimension. It is solved for two widths h, in the mean over places of the
planes on the lattice, and written as

    flow = (G / mu) (h^3 / 12 + h S + h^2 / 2 delta)

S is the slip [cells^2], delta how much too far apart the walls stand, both together [cells] (docs/physics.md, "Where walls
stand"). Lattice units, D3Q19, the exact scheme; nothing here depends on tau.
"""

import argparse
import itertools
import math

import numpy as np

C = np.array([(0, 0, 0)] + [c for c in itertools.product((-1, 0, 1), repeat=3) if 1 <= sum(map(abs, c)) <= 2])
W = np.array([{0: 1 / 3, 1: 1 / 18, 2: 1 / 36}[abs(c).sum()] for c in C])
OPPOSITE = np.array([np.flatnonzero((C == -c).all(1))[0] for c in C])
Q = len(W)
TAU = 1.0
LEAST_FLUID = 0.02  # of the fluid fraction over the gain that the weight of a cell sees
WIDTHS = (7, 16)
BEHIND = 7  # cells of solid between a pair of planes and the next

PLANES = [((1, 0, 0), (0, 1, 0)), ((2, 1, 0), (1, -2, 0)), ((2, 1, 0), (0, 0, 1)), ((1, 1, 0), (1, -1, 0)), ((1, 1, 0), (0, 0, 1)),
          ((1, 1, 1), (1, -1, 0)), ((2, 1, 1), (1, -1, -1)), ((2, 1, 1), (0, 1, -1)), ((2, 2, 1), (1, -1, 0)), ((2, 2, 1), (1, 1, -4))]


def fraction_below(n, t):
    """Volume of the unit cube around 0 with n.y < t, for n >= 0."""
    n = [c for c in n if c]
    corners = itertools.product((0, 1), repeat=len(n))
    t += sum(n) / 2
    volume = sum((-1) ** sum(corner) * max(t - np.dot(n, corner), 0.0) ** len(n) for corner in corners)
    return min(1.0, max(0.0, volume / (math.factorial(len(n)) * math.prod(n))))


def flow(n, along, width, place, k, lam, gain, magic_parameter):
    """Flow per depth, in units of G / mu.

    place: of the first plane, as n.x; lam and gain: functions of the solid fraction.
    """
    length = math.sqrt(np.dot(n, n))
    count = math.ceil((width + BEHIND) * length)
    eps = np.array([fraction_below(n, place - s) + fraction_below(n, s - place - width * length) - fraction_below(n, s - place - count)
                    for s in range(count)])
    Lp = TAU - 0.5
    omega_plus, omega_minus = 1 / TAU, 1 / (magic_parameter / Lp * lam(eps) + 0.5)
    strength = k * gain(eps) * eps * Lp
    kk = strength / (np.maximum(1 - eps, LEAST_FLUID * gain(eps)) + 0.5 * strength)
    direction = np.array(along) / math.sqrt(np.dot(along, along))

    odd = 0.5 * (np.eye(Q) - np.eye(Q)[OPPOSITE])
    density, momentum = np.outer(W, np.ones(Q)), 3 * W[:, None] * (C @ C.T)
    drive = 3 * W * (C @ direction)
    steps, sources = np.zeros((count * Q, count * Q)), np.zeros(count * Q)
    for s in range(count):
        collide = (np.eye(Q) - odd) * (1 - omega_plus) + omega_plus * density + (1 - omega_minus[s]) * odd \
            + (omega_minus[s] - kk[s]) * momentum
        to = [(s + int(np.dot(n, c))) % count * Q + i for i, c in enumerate(C)]
        steps[to, s * Q:(s + 1) * Q] = collide
        sources[to] = (1 - 0.5 * kk[s]) * drive
    # The mean density is free: it is set to zero.
    free = np.outer(np.ones(count * Q), np.tile(W, count))
    f = np.linalg.solve(np.eye(count * Q) - steps + free, sources).reshape(count, Q)
    u = (f @ C @ direction + 0.5) * (1 - 0.5 * kk)
    return u.sum() / length * Lp / 3


def wall(n, along, k, lam, gain, magic_parameter, places=8):
    """Slip S, delta, and the standard deviation of delta over places of the planes."""
    first = BEHIND / 2 * math.sqrt(np.dot(n, n))
    excess = np.array([[flow(n, along, h, first + i / places, k, lam, gain, magic_parameter) - h**3 / 12 for i in range(places)]
                       for h in WIDTHS])
    S, half = np.linalg.solve([[h, h * h] for h in WIDTHS], excess.mean(1))
    return S, 2 * half, np.std(2 * excess[1] / WIDTHS[1] ** 2)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--k", type=float, default=2.17, metavar="K", help="strength (default: of boxes and pipes)")
    parser.add_argument("--lam", type=float, nargs=2, default=(8, 0.96), metavar=("A", "B"), help="lam = 1 + A eps (1 - eps)^2 - B eps^2")
    parser.add_argument("--gain", type=float, default=2, metavar="C", help="g = 1 + C eps^2")
    parser.add_argument("--magic-parameter", type=float, default=0.125, metavar="LAMBDA")
    args = parser.parse_args()

    def lam(eps):
        return 1 + args.lam[0] * eps * (1 - eps) ** 2 - args.lam[1] * eps**2

    def gain(eps):
        return 1 + args.gain * eps**2

    found = []
    for n, along in PLANES:
        found.append(wall(n, along, args.k, lam, gain, args.magic_parameter))
        print("{} along {}: delta {:+.3f}, S {:.3f}; standard deviation of delta over places {:.3f}".format(n, along, *np.array(found[-1])[[1, 0, 2]]), flush=True)
    S, delta, _ = np.transpose(found)
    print(f"all: delta {delta.mean():+.4f} +- {delta.std():.4f}, S {S.mean():.3f}")


if __name__ == "__main__":
    main()
