#!/usr/bin/env python3
"""Exact decay of the velocity and of the spin of a sphere that is set in motion at t = 0 in a periodic box of viscous fluid at rest.

The problem
-----------
A sphere of radius a and density q rho in a cube of side L, periodic in all directions, in fluid of density rho and kinematic viscosity
nu = mu / rho at rest. At t = 0 a blow gives it the momentum q rho V_p U0 or the angular momentum I W0, I = 2/5 q rho V_p a^2; nothing
acts on it afterwards. Stokes flow: inertia enters through d/dt only.

Velocity
--------
The fluid being incompressible, its added mass takes a part of the blow at once, so U(0+) < U0. The momentum of sphere and fluid stays P = q rho V_p U0,
and U -> P / M, M = rho L^3 m, m = 1 + (q - 1) c. With R(s) of periodic_bbo.py, which has its derivation (an impulse is the
derivative of a constant force):

    U(s) - P / (M s) = q rho V_p U0 / (m (R m + (q - 1) rho V_p s))

Spin
----
Continue the fluid into the sphere and drive it there with forces on the shell r = a of the resultant torque D, such that it turns with the sphere;
a = 1, alpha^2 = s / nu, I_f = 2/5 rho V_p a^2. The isolated sphere has D = 1 / G_0 times its spin,

    1 / G_0 = 8 pi mu a^3 (1 + alpha^2 / (3 (1 + alpha))) + s I_f        (Lamb's rotating sphere, plus the fluid inside)

In the box the vorticity that the images make at the sphere is, from the Fourier sum over k /= 0 of (1 - (k_z/k)^2) k^2 S(k)^2 / (k^2 + alpha^2)
less its integral, S(k) = 3 j_1(k) / k,

    G = G_0 - alpha^2 S(i alpha)^2 / (6 mu) sum_{n /= 0} exp(-alpha |n| L) / (4 pi |n| L)

(S(i alpha) = 3 i_1(alpha) / alpha; shells that do not overlap see each other's screened field only.) Then I (s W - W0) = - (D - s I_f W):

    W(s) = I W0 / (s (I - I_f) + 1 / G)

What is left out are the forces of order l = 3 and above that images induce, of order c^(7/3).
"""

import argparse
import math
import os
import sys
from functools import lru_cache

import numpy as np
import periodic_bbo as bbo
from scipy.special import erfc, wofz


def _invert(transform, t, nodes=bbo.K_NODES, integrals=0):
    """Inverse Laplace transform at the times t > 0 on the parabola of Weideman and Trefethen (2007), or its integral over time."""
    theta = math.pi * (2 * np.arange(nodes // 2) + 1) / nodes
    z = nodes * (0.1309 - 0.1194 * theta**2 + 0.2500j * theta)
    dz = nodes * (-0.2388 * theta + 0.2500j)
    values = [2 / nodes * (np.exp(z) * np.array([transform(s) / s**integrals for s in z / ti]) * dz / ti).imag.sum() for ti in t]
    return np.array(values)


def velocity(t, q, c, nodes=bbo.K_NODES, integrals=0):
    """U / U0 at the times t [a^2 / nu]; with integrals = 1 its integral, the displacement; c = 0: the isolated sphere."""
    m = 1 + (q - 1) * c

    def transform(s):
        drag = bbo.resistance(np.sqrt(s), c)
        return 2 / 9 * q / (m * (drag * m + 2 / 9 * (q - 1) * s))

    return q * c / m * np.asarray(t) ** integrals + _invert(transform, t, nodes, integrals)


@lru_cache(maxsize=1)
def _image_distances(reach=64):
    """|n| of the integer lattice, 0 < |n| <= reach, and how often each occurs."""
    n = np.arange(-reach, reach + 1)
    square = (n[:, None, None] ** 2 + n[None, :, None] ** 2 + n[None, None, :] ** 2).ravel()
    squares, count = np.unique(square[(square > 0) & (square <= reach**2)], return_counts=True)
    return np.sqrt(squares), count


def _screened_images(alpha, box):
    """sum_{n /= 0} exp(-alpha |n| L) / (4 pi |n| L), by Ewald's method: converges for every Re alpha >= 0, alpha /= 0."""
    eta = max(3.5 / box, abs(alpha) / 5)
    distance, count = _image_distances()
    close = distance <= 4
    low = distance <= 12 * eta * box / (2 * math.pi)
    r, k = distance[close] * box, 2 * math.pi / box * distance[low]

    def erfc_exp(sign):  # exp(sign alpha r) erfc(eta r + sign alpha / (2 eta)); wofz keeps the product finite
        x = eta * r + sign * alpha / (2 * eta)
        return np.exp(sign * alpha * r - x**2) * wofz(1j * x)

    near = ((erfc_exp(1) + erfc_exp(-1)) / (8 * math.pi * r) * count[close]).sum()
    gauss = np.exp(-(k**2 + alpha**2) / (4 * eta**2)) / (k**2 + alpha**2) * count[low]
    far = (gauss.sum() + np.exp(-alpha**2 / (4 * eta**2)) / alpha**2) / box**3
    x = alpha / (2 * eta)
    itself = (2 * eta / math.sqrt(math.pi) * np.exp(-x**2) - alpha * erfc(x)) / (4 * math.pi)
    return near + far - itself


def spin(t, q, c, nodes=bbo.K_NODES, integrals=0):
    """W / W0 at the times t [a^2 / nu]; with integrals = 1 its integral, the angle; c = 0: the isolated sphere."""
    fluid_inertia = 8 / 15 * math.pi
    box = bbo.box_over_radius(c) if c > 0 else math.inf

    def transform(s):
        alpha = np.sqrt(s)
        mobility = 1 / (8 * math.pi * (1 + s / (3 * (1 + alpha))) + s * fluid_inertia)
        if c > 0 and (alpha.real * (box - 2)) < 35:
            shape = 3 * (np.cosh(alpha) / alpha - np.sinh(alpha) / s) / alpha
            mobility = mobility - s * shape**2 / 6 * _screened_images(alpha, box)
        return q * fluid_inertia / (s * (q - 1) * fluid_inertia + 1 / mobility)

    return _invert(transform, t, nodes, integrals)


def isolated_spin(t, q):
    """The same in closed form: sum over the roots of x^3 + (1 + 5/q) x^2 + 15/q (x + 1), x = sqrt(s)."""
    roots = np.roots([1, 1 + 5 / q, 15 / q, 15 / q]).astype(complex)
    t = np.asarray(t, dtype=float)
    total = np.zeros_like(t, dtype=complex)
    for i, x in enumerate(roots):
        others = np.delete(roots, i)
        total += (1 + x) / np.prod(x - others) * x * wofz(-1j * x * np.sqrt(t))
    return total.real


def check():
    """Prints checks against independent results; returns True if all hold."""
    good = True

    def line(name, value, limit):
        nonlocal good
        good = good and value < limit
        print(f"  {'ok  ' if value < limit else 'FAIL'} {name:<88s} {value:.2e}  (limit {limit:.0e})")

    t = np.geomspace(0.003, 5, 12)
    for q in (0.1, 1, 8):
        line(f"spin of the isolated sphere, q = {q}: closed form", np.abs(spin(t, q, 0) - isolated_spin(t, q)).max(), 1e-9)
        step = 1e-4 * t
        slope = (bbo.isolated_bbo(t + step, q) - bbo.isolated_bbo(t - step, q)) / (2 * step)
        error = np.abs(velocity(t, q, 0) - 2 / 9 * q * slope).max()
        line(f"velocity of the isolated sphere, q = {q}: slope of the closed form of a release", error, 1e-6)
        line(f"velocity in a box, q = {q}: 24 against 28 nodes", np.abs(velocity(t, q, 0.0174) - velocity(t, q, 0.0174, 28)).max(), 1e-7)
        line(f"spin in a box, q = {q}: 24 against 28 nodes", np.abs(spin(t, q, 0.0174) - spin(t, q, 0.0174, 28)).max(), 1e-7)
    for alpha, box in ((1 + 0.5j, 6.0), (2.0 + 3j, 6.0), (0.8 + 0j, 8.0)):
        distance, count = _image_distances()
        r = distance * box
        direct = (np.exp(-alpha * r) / (4 * math.pi * r) * count).sum()
        line(f"screened images, alpha a = {alpha}: direct sum", abs(_screened_images(alpha, box) / direct - 1), 1e-9)
    small = 1e-3
    line("and times alpha^2 L^3 -> 1 for alpha -> 0", abs(_screened_images(small + 0j, 8.0) * small**2 * 512 - 1), 1e-4)
    return good


BOXES_IN_CELLS = (28, 36)
DENSITY_RATIOS = (0.1, 0.5, 1, 2.5, 8, 10)
TIMES = (0.003, 0.005, 0.01, 0.02, 0.03, 0.05, 0.07, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.7, 1, 1.5, 2, 3)
HEADER = """\
Unsteady Stokes flow: a sphere in a triply periodic cube of fluid at rest gets a blow at t = 0. COMPUTED by
scripts/reference/impulsive_decay.py (method and checks there: Laplace transform, induced forces, Ewald sums, contour).
velocity: U / U0, the blow is the momentum q rho V_p U0; added mass takes its part at once, so U(0+) < U0; U -> P / M.
spin: W / W0, the blow is the angular momentum 2/5 q rho V_p a^2 W0.
box_cells: side of the cube when a = 4.5 cells (only L/a matters).
integral: of ratio over t_nu_over_a2 from 0, the displacement or angle. It is what to compare a compressible fluid with: the blow
sends out sound, which crosses the box many times and makes U oscillate about the solution.
periodic_part: what the images change, U or W less that of the isolated sphere.
Error: below 1e-6 in the velocity; in the spin images of order c^(7/3) of periodic_part are left out.
Convection (finite Re) and compressibility are not in it."""


def write_table(path):
    with open(path, "w", encoding="utf-8") as file:
        for text in HEADER.splitlines():
            file.write(f"# {text}\n")
        file.write("motion,box_cells,c,q,t_nu_over_a2,ratio,integral,periodic_part\n")
        for motion, solution in (("velocity", velocity), ("spin", spin)):
            for cells in BOXES_IN_CELLS:
                c = bbo.solid_fraction(cells / bbo.RADIUS_IN_CELLS)
                for q in DENSITY_RATIOS:
                    alone = solution(TIMES, q, 0)
                    here, integral = solution(TIMES, q, c), solution(TIMES, q, c, integrals=1)
                    for t, *values in zip(TIMES, here, integral, here - alone):
                        file.write(f"{motion},{cells},{c:.9g},{q:g},{t:g}," + ",".join(f"{v:.8f}" for v in values) + "\n")


def main():
    folder = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "tests", "reference")
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--output", default=os.path.normpath(os.path.join(folder, "impulsive_decay.csv")), help="the table to write")
    parser.add_argument("--check", action="store_true", help="compare with independent results, write nothing")
    arguments = parser.parse_args()
    if arguments.check:
        sys.exit(0 if check() else 1)
    write_table(arguments.output)
    print(arguments.output)


if __name__ == "__main__":
    main()
