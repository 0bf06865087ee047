#!/usr/bin/env python3
"""Exact unsteady velocity of a sphere released from rest in a triply periodic cube of viscous fluid (Stokes flow).

The problem
-----------
A sphere of radius a and density q rho in a cube of side L, periodic in all directions; solid fraction
c = 4/3 pi a^3 / L^3. Fluid of density rho and kinematic viscosity nu = mu / rho, all at rest for t < 0. From t = 0

- a constant external force F pulls the sphere (weight minus buoyancy, (q - 1) rho V_p g; any force when q = 1),
- a uniform mean pressure gradient -rho A with A = -F / (rho L^3) acts on the whole cell: rho A per volume on the fluid
  and rho A V_p on the sphere.

The total momentum of the cell is then zero at all times: rho * integral of u over the fluid + q rho V_p U = 0. That is
the frame. Inertia enters through d/dt only (Reynolds number -> 0; the convective terms are dropped).

One curve for every frame
-------------------------
U(t) / U_terminal is the same function of (t nu / a^2, q, c) for each of these velocities; only U_terminal differs:

    velocity                                               U_terminal / (F / (6 pi mu a))
    U, with the drive A (frame of zero total momentum)      1 / (K m)
    U - <u>, with the drive A                               1 / K
    U - P / M, without any drive (A = 0)                    1 / (K m^2)
    U - <u>, without any drive (A = 0)                      1 / (K m)

with m = 1 + (q - 1) c, the mean density of the cell over rho; <u> the mean velocity over the whole cell, sphere
included (the superficial velocity); P = F t the total momentum and M = rho L^3 m the total mass; K(c) the steady drag
of the simple cubic array (total force per sphere over 6 pi mu a (U - <u>), mean pressure gradient included).
Why: a uniform acceleration only shifts the frame, and adds (q - 1) rho V_p times itself to the force on the sphere.

The solution
------------
Laplace transform in time, alpha^2 = s / nu. The fluid is continued into the sphere and driven there by an induced force
density f with the resultant D, chosen such that the fluid moves with the sphere for r <= a. Momentum balances of cell
and sphere give

    D = R(s) (U - <u>),     F / s = D + (q - 1) rho V_p s U      =>      U(s) = F / s / (R m + (q - 1) rho V_p s)

f is expanded in forces on the shell r = a: every product of a harmonic of order l = 0, 2, 4 and a vector that shares
the symmetry of e_z in a cube, seven in all. With the velocity projected on the same seven functions set to that of the
sphere (Galerkin), R = (G^-1)_00 where 0 is the uniform shell and

    G_XY = 1 / (mu L^3) sum_{k /= 0} X(k)* . (1 - kk/k^2) . Y(k) / (k^2 + alpha^2),   X(k) = (-i)^l j_l(ka) x_l(k/|k|)

The slow sum is split in the manner of Ewald and Hasimoto: what a Gaussian leaves over is short-ranged in space, so that
it touches no image and its sum is an integral, known in closed form up to a smooth part. l = 0, 2 solve the isolated
sphere exactly: for c -> 0 Basset-Boussinesq-Oseen appears, R = 6 pi mu a (1 + alpha a + (alpha a)^2 / 9) + rho s V_p.
The method is variational: multipoles left out enter as the square of their coupling; see --check for the numbers.

The inverse transform is the trapezoidal rule on the parabola of Weideman and Trefethen (2007), Math. Comp. 76, 1341:
geometric convergence, all singularities being real and negative.
"""

import argparse
import csv
import math
import os
import sys
from functools import lru_cache

import numpy as np
from scipy.special import spherical_in, spherical_jn, spherical_kn

K_NODES = 24         # on the parabola; error about 2.85^-nodes until round-off
K_SPLIT = 9.0        # Ewald parameter times the gap between neighbours; exp(-K_SPLIT^2) is left out
K_REACH = 64         # largest wave number held [2 pi / L]
K_ORDERS = np.array([0, 2, 2, 4, 4, 4, 4])  # l of the seven force functions


def solid_fraction(box_over_radius):
    """Solid fraction c of one sphere in a cube of side `box_over_radius` radii [-]."""
    return 4 / 3 * math.pi / box_over_radius**3


def box_over_radius(c):
    """Side of the cube in radii for a solid fraction c [-]."""
    return (4 / 3 * math.pi / c) ** (1 / 3)


def _force_functions(x, y, z):
    """The seven vector functions of a direction that transform like e_z in a cube; shape (7, 3) + shape of x."""
    zero = 0 * x
    cubic = x**4 + y**4 + z**4 - 3 / 5
    tetragonal = z**4 - (x**4 + y**4) / 2 - 6 / 7 * (z**2 - (x**2 + y**2) / 2)
    return np.array([
        [zero, zero, zero + 1],
        [zero, zero, 3 * z**2 - 1],
        [x * z, y * z, zero],
        [zero, zero, cubic],
        [zero, zero, tetragonal],
        [x * z * (7 * y**2 - 1), y * z * (7 * x**2 - 1), zero],
        [x * z * (z**2 - x**2), y * z * (z**2 - y**2), zero],
    ])


def _products(x, y, z, weight):
    """Weighted X.Y and (X.k)(k.Y) of the force functions, (2, 7, 7, points), with the sign of i^(l_X - l_Y)."""
    functions = _force_functions(x, y, z)
    along = functions[:, 0] * x + functions[:, 1] * y + functions[:, 2] * z
    sign = (-1.0) ** ((K_ORDERS[:, None] - K_ORDERS[None, :]) // 2)
    full = np.einsum("aip,bip->abp", functions, functions)
    return np.array([full, along[:, None] * along[None, :]]) * sign[..., None] * weight


@lru_cache(maxsize=1)
def _lattice_products():
    """|n| of the shells of the integer lattice, 0 < |n| <= K_REACH, and the sums of the products, (shells, 2, 7, 7)."""
    sums, n = np.zeros((K_REACH**2 + 1, 2, 7, 7)), np.arange(K_REACH + 1)
    for nz in n:  # one octant: the products are even in every coordinate
        nx, ny = (m.ravel() for m in np.meshgrid(n, n))
        square = nx**2 + ny**2 + nz**2
        inside = (square > 0) & (square <= K_REACH**2)
        nx, ny, square = nx[inside], ny[inside], square[inside]
        r = np.sqrt(square)
        weight = 2.0 ** ((nx > 0).astype(int) + (ny > 0) + (nz > 0))
        products = _products(nx / r, ny / r, nz / r, weight).transpose(3, 0, 1, 2)
        np.add.at(sums, square, products)
    squares = np.nonzero(sums[:, 0, 0, 0])[0]
    return np.sqrt(squares), sums[squares]


@lru_cache(maxsize=1)
def _mean_products():
    """The products averaged over all directions, (2, 7, 7)."""
    cosine, weight = np.polynomial.legendre.leggauss(12)
    angle = 2 * math.pi * np.arange(24) / 24
    z, phi = (m.ravel() for m in np.meshgrid(cosine, angle, indexing="ij"))
    rho = np.sqrt(1 - z**2)
    return _products(rho * np.cos(phi), rho * np.sin(phi), z, np.repeat(weight, 24) / 48).sum(-1)


def _bessel_products(k):
    """j_lX(k) j_lY(k), (points, 7, 7)."""
    j = np.array([spherical_jn(order, k) for order in K_ORDERS]).T
    return j[:, :, None] * j[:, None, :]


def _free_matrix(alpha):
    """G without images, times mu a."""
    low = np.minimum(K_ORDERS[:, None], K_ORDERS[None, :])
    high = np.maximum(K_ORDERS[:, None], K_ORDERS[None, :])
    if alpha == 0:
        # i_high k_low alpha -> 0 unless high = low; then pi / (2 (2 l + 1))
        integral = np.where(low == high, math.pi / (2 * (2 * low + 1)), 0.0)
    else:
        integral = alpha * (-1.0) ** ((high - low) // 2) * spherical_in(high, alpha) * spherical_kn(low, alpha)
    mean = _mean_products()
    return (mean[0] - mean[1]) * integral / (2 * math.pi**2)


def _screened(k, alpha, eta, viscous_images):
    """The two factors of X.Y and -(X.k)(k.Y) that the Gaussian keeps in the sum over k."""
    gauss = np.exp(-(k**2) / (4 * eta**2))
    if not viscous_images:
        return 0 * gauss, gauss / alpha**2
    w = alpha**2 / (4 * eta**2)
    rest = 1 / (4 * eta**2) if alpha == 0 else -np.expm1(-w) / alpha**2
    return gauss * np.exp(-w) / (k**2 + alpha**2), gauss * (1 + k**2 * rest) / (k**2 + alpha**2)


def _matrix(alpha, box, split):
    """G in the cube of side `box` radii, times mu a."""
    gap = box - 2
    # images of the viscous part are below round-off when they decay within the gap
    viscous_images = alpha.real * gap < 35
    eta = split / gap
    if viscous_images:
        eta = max(eta, abs(alpha) / 5)
    n, lattice = _lattice_products()
    reach = 12 * eta
    k = 2 * math.pi / box * n
    if k[-1] < 0.999 * reach:
        raise ValueError(f"box / radius = {box:.3g}: the Fourier sum would need more than {K_REACH} wave numbers")
    held = k <= reach
    k, lattice = k[held], lattice[held]
    plain, along = _screened(k, alpha, eta, viscous_images)
    bessel = _bessel_products(k)
    total = (bessel * (plain[:, None, None] * lattice[:, 0] - along[:, None, None] * lattice[:, 1])).sum(0) / box**3

    # the same sum as an integral: what the images do not see
    node, weight = np.polynomial.legendre.leggauss(int(60 + 3 * reach))
    k, weight = reach / 2 * (node + 1), reach / 2 * weight
    plain, along = _screened(k, alpha, eta, viscous_images)
    radial = k**2 * weight / (2 * math.pi**2)
    mean = _mean_products()
    bessel = _bessel_products(k)
    total = total + _free_matrix(alpha)
    total = total - mean[0] * ((radial * plain)[:, None, None] * bessel).sum(0)
    total = total + mean[1] * ((radial * along)[:, None, None] * bessel).sum(0)

    # k = 0 of the short-ranged part
    zero = 1 / (4 * eta**2) if alpha == 0 else 1 / alpha**2
    if viscous_images and alpha != 0:
        zero = -np.expm1(-alpha**2 / (4 * eta**2)) / alpha**2
    total[0, 0] -= zero / box**3
    return total


def resistance(alpha, c, split=K_SPLIT, functions=7):
    """Transformed induced force D over 6 pi mu a (U - <u>).

    alpha      sqrt(s a^2 / nu): 0, or complex with a positive real part [-]
    c          solid fraction of the cube; 0: the isolated sphere
    split      Ewald parameter; the result must not depend on it
    functions  number of force functions used, 3 (l <= 2) or 7 (l <= 4)
    """
    alpha = complex(alpha)
    matrix = _matrix(alpha, box_over_radius(c), split) if c > 0 else _free_matrix(alpha)
    return np.linalg.inv(matrix[:functions, :functions])[0, 0] / (6 * math.pi)


@lru_cache(maxsize=None)
def _cached_resistance(alpha, c):
    return resistance(alpha, c)


def steady_drag(c):
    """Drag K of the steady simple cubic array: total force over 6 pi mu a (U - <u>) [-]. c = 0: the isolated sphere."""
    return _cached_resistance(0j, c).real


def unsteady_velocity(t_nu_over_a2, q, c, nodes=K_NODES):
    """U(t) / U_terminal of a sphere released from rest at t = 0 under a constant force.

    t_nu_over_a2  time(s), t nu / a^2 > 0 [-]; beyond 2 (L/a)^2 nothing changes any more
    q             density of the sphere over that of the fluid, > 0 [-]
    c             solid fraction of the periodic cube, 0 (isolated) to about 0.03 [-]
    nodes         of the inverse transform
    """
    t = np.atleast_1d(np.asarray(t_nu_over_a2, dtype=float))
    if not (np.all(np.isfinite(t)) and np.all(t > 0)):
        raise ValueError("t_nu_over_a2: every time must be finite and > 0")
    if not q > 0:
        raise ValueError(f"q = {q}: must be > 0")
    m = 1 + (q - 1) * c
    theta = math.pi * (2 * np.arange(nodes // 2) + 1) / nodes  # upper half; the lower half is its conjugate
    z = nodes * (0.1309 - 0.1194 * theta**2 + 0.2500j * theta)
    dz = nodes * (-0.2388 * theta + 0.2500j)
    result = np.empty_like(t)
    for i, ti in enumerate(t):
        s = z / ti
        drag = np.array([_cached_resistance(complex(alpha), c) for alpha in np.sqrt(s)])
        impedance = drag * m + 2 / 9 * (q - 1) * s  # over 6 pi mu a
        transform = steady_drag(c) * m / (s * impedance)
        result[i] = 2 / nodes * (np.exp(z) * transform * dz / ti).imag.sum()
    return result if np.ndim(t_nu_over_a2) else float(result[0])


def terminal_velocity(q, c):
    """Terminal velocity over F / (6 pi mu a) in the frame of zero total momentum, drive included [-]."""
    return 1 / (steady_drag(c) * (1 + (q - 1) * c))


def isolated_bbo(t, q):
    """U / U_terminal of an isolated sphere in closed form (Basset-Boussinesq-Oseen; the roots may be complex)."""
    from scipy.special import wofz

    # s-plane: 1 + x + x^2 (1 + 2 q) / 9 with x = sqrt(s a^2 / nu); partial fractions in x
    k = (1 + 2 * q) / 9
    root = np.sqrt(complex(1 - 4 * k))
    if abs(root) < 1e-6:  # double root, q = 5/8
        return (isolated_bbo(t, q - 1e-5) + isolated_bbo(t, q + 1e-5)) / 2
    x1, x2 = (-1 + root) / (2 * k), (-1 - root) / (2 * k)

    def term(x):  # inverse transform of 1 / (s (sqrt(s) - x)) = -1/x + exp(x^2 t) erfc(-x sqrt(t)) / x
        return (wofz(-1j * x * np.sqrt(t)) - 1) / x

    return ((term(x1) - term(x2)) / (k * (x1 - x2))).real


def _reference_drag(path):
    with open(path, encoding="utf-8") as file:
        rows = csv.DictReader(line for line in file if not line.startswith("#"))
        return [(float(row["c"]), float(row["K"])) for row in rows if row["lattice"] == "SC"]


def check(reference):
    """Prints the checks against independent results; returns True if all hold."""
    good = True

    def line(name, value, limit):
        nonlocal good
        good = good and value < limit
        print(f"  {'ok  ' if value < limit else 'FAIL'} {name:<88s} {value:.2e}  (limit {limit:.0e})")

    print("isolated sphere, Laplace space: 6 pi mu a (1 + x + x^2/9) + rho s V_p")
    for alpha in (0.3, 3 + 2j, 20 + 15j):
        exact = 1 + alpha + alpha**2 / 3
        line(f"alpha a = {alpha}", abs(resistance(alpha, 0) / exact - 1), 1e-9)
    print("isolated sphere, time: closed form")
    t = np.geomspace(0.001, 30, 40)
    for q in (0.5, 1, 1.05, 2.5, 8):
        line(f"q = {q}, t = 0.001 ... 30", np.abs(unsteady_velocity(t, q, 0) - isolated_bbo(t, q)).max(), 1e-7)
    print("steady drag of the simple cubic array, against Lamb multipoles")
    for c, k in _reference_drag(reference):
        if c <= 0.0336:
            line(f"c = {c:<12g} K = {k:<10g} here {steady_drag(c):.7f}", abs(steady_drag(c) / k - 1), 1e-6)
    print("unsteady: split of the sum moved (9 to 12), and what l = 4 changes (the part left out is smaller)")
    for c in (0.0035, 0.0276):
        for alpha in (0.0, 0.5, 2 + 1j, 3 + 6j, 7 + 10j, 20 + 30j):
            value = resistance(alpha, c)
            line(f"c = {c}, alpha a = {alpha}: split", abs(resistance(alpha, c, split=12) / value - 1), 1e-7)
            line(f"c = {c}, alpha a = {alpha}: l = 4", abs(resistance(alpha, c, functions=3) / value - 1), 1e-4)
    print("inverse transform: 24 against 16, 20 and 28 nodes")
    t = np.geomspace(0.003, 10, 30)
    for c in (0.0035, 0.0276):
        for q in (0.5, 1.05, 8):
            fine = unsteady_velocity(t, q, c)
            worst = [np.abs(unsteady_velocity(t, q, c, n) - fine).max() for n in (16, 20, 28)]
            line(f"c = {c}, q = {q}: 16 nodes {worst[0]:.1e}, 20 nodes {worst[1]:.1e}, 28 nodes", worst[2], 1e-7)
    return good


RADIUS_IN_CELLS = 4.5
BOXES_IN_CELLS = (24, 28, 32, 36, 40, 48)
DENSITY_RATIOS = (0.1, 0.5, 1, 1.05, 1.5, 2.5, 8)
TIMES = (0.003, 0.005, 0.007, 0.01, 0.015, 0.02, 0.03, 0.04, 0.05, 0.07, 0.1, 0.15, 0.2, 0.25, 0.3, 0.4, 0.5, 0.6, 0.7,
         0.85, 1, 1.25, 1.5, 2, 2.5, 3, 3.5, 4, 5, 6, 7, 8, 10)

HEADER = """\
Unsteady Stokes flow: sphere released from rest under a constant force F in a triply periodic cube. COMPUTED by
scripts/reference/periodic_bbo.py (method and checks there: Laplace transform, induced forces, Ewald sum, contour).
Frame: A = -F / (rho L^3) drives the whole cell (rho A per volume on the fluid, rho A V_p on the sphere);
the total momentum of fluid and sphere is 0 at all times. F = (q-1) rho V_p g; for q = 1 any constant force.
U_over_Ut is the same for U - <u>, with or without the drive, and without it for U - P/M, where
<u>: mean over the cell, sphere included; P = F t: total momentum, M: total mass. Only the terminal value differs:
Ut_over_stokes = Ut / (F / (6 pi mu a)) = 1 / (K m) with the drive, m = 1 + (q-1) c; U - <u>: 1 / K with the drive,
1 / (K m) without; U - P/M without: 1 / (K m^2).
box_cells: side of the cube when a = 4.5 cells (only L/a matters). K: steady drag of the array.
Error of U_over_Ut: below ERROR (from K against 02_cubic_arrays_stokes.csv, change by l = 4, nodes of the inversion).
Convection (finite Re) and compressibility are not in it."""


def write_table(path, reference):
    """Writes the table; the error in its header is that of K against the array reference."""
    largest = solid_fraction(min(BOXES_IN_CELLS) / RADIUS_IN_CELLS)
    error = max(abs(steady_drag(c) / k - 1) for c, k in _reference_drag(reference) if c <= 1.1 * largest)
    with open(path, "w", encoding="utf-8") as file:
        for text in HEADER.replace("ERROR", f"{max(error, 1e-6):.0e}").splitlines():
            file.write(f"# {text}\n")
        file.write("box_cells,box_over_radius,c,K,q,Ut_over_stokes,t_nu_over_a2,U_over_Ut\n")
        for cells in BOXES_IN_CELLS:
            ratio = cells / RADIUS_IN_CELLS
            c = solid_fraction(ratio)
            for q in DENSITY_RATIOS:
                start = f"{cells},{ratio:.9g},{c:.9g},{steady_drag(c):.8g},{q:g},{terminal_velocity(q, c):.8g}"
                for t, u in zip(TIMES, unsteady_velocity(TIMES, q, c)):
                    file.write(f"{start},{t:g},{u:.8f}\n")


def main():
    root = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
    folder = os.path.normpath(os.path.join(root, "tests", "reference"))
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--output", default=os.path.join(folder, "periodic_bbo.csv"), help="the table to write")
    parser.add_argument("--reference", default=os.path.join(folder, "02_cubic_arrays_stokes.csv"),
                        help="steady drag of arrays")
    parser.add_argument("--check", action="store_true", help="compare with independent results, write nothing")
    arguments = parser.parse_args()
    if arguments.check:
        sys.exit(0 if check(arguments.reference) else 1)
    write_table(arguments.output, arguments.reference)
    print(arguments.output)


if __name__ == "__main__":
    main()
