#pragma once

#include "lbm/fluid_config.hpp"

namespace lbm {

/**
 * Relaxation of the two-relaxation-time (TRT) collision, in lattice units.
 *
 *     Lp = tau - 1/2 = 3 nu,   Lm = lambda / Lp,   omega+- = 1 / (L+- + 1/2)
 *
 * @see Ginzburg, Verhaeghe & d'Humieres (2008), Commun. Comput. Phys. 3, 427
 */
struct TrtRates {
    double Lp, Lm;
    double omega_plus;   ///< of the even part of f; sets the viscosity
    double omega_minus;  ///< of the odd part of f; follows from lambda

    constexpr TrtRates(double tau, double lambda)
        : Lp(tau - 0.5)
        , Lm(lambda / Lp)
        , omega_plus(1 / tau)
        , omega_minus(1 / (Lm + 0.5))
    {
    }
};

/// The magic parameter of the low-noise parameter set (LN).
inline constexpr double kLambdaLowNoise = 0.125;
/// The one that the literature uses most, for its own schemes: half-way walls in a channel are exact.
inline constexpr double kLambdaPublished = 3.0 / 16;

/// The fluid fraction over the gain, (1 - eps) / g, that the weight of a cell sees is at least this. A full cell then is a solid with a
/// permeability of (1/480) dx^2 (R = 4): no flow to speak of, but its pressure settles in some hundred steps per unit of tau, where at 0 it would be frozen.
inline constexpr double kLeastFluidFraction = 0.02;

/// lam(eps) of set LN (Weighting).
template <class V>
[[nodiscard]] constexpr V low_noise_lam(const V& epsilon)
{
    const V m = 1 - epsilon;
    return 1 + epsilon * (8 * (m * m) - 0.96 * epsilon);
}

/// g(eps) of set LN (Weighting).
template <class V>
[[nodiscard]] constexpr V low_noise_gain(const V& epsilon)
{
    return 1 + 2 * (epsilon * epsilon);
}

/// How much more cut cells count in narrow pores between spheres (CutCells).
struct PoreLaw {
    double near;    ///< A
    double far;     ///< B
    double facing;  ///< C
    double widest;  ///< w, in radii of the smaller sphere
};

/**
 * The weighting of partially saturated cells: two parameter sets, both exact in tau.
 *
 *     LN  (lambda = 1/8)   lam(eps) = 1 + 8 eps (1 - eps)^2 - 0.96 eps^2,   g(eps) = 1 + 2 eps^2
 *                          D3Q19  k = 2.04 + 3.4 / R                                 D3Q27  k = 1.99 + 3.8 / R                                other surfaces  2.17
 *     R   (any lambda)     lam(eps) = g(eps) = 1
 *                          D3Q19  k = 1.84 + 10.2 lambda + (2.6 + 16 lambda) / R     D3Q27  k = 1.67 + 11.9 lambda + (2.7 + 16 lambda) / R
 *
 * lam scales Lm in a cut cell; k g is the strength of the solid force for a sphere of R cells; for other surfaces of set R that of an infinite one.
 * lam and g of set LN were fitted on exact solutions between planes of all orientations, k on the drag of dilute arrays (set R: of one with c = 0.125) with exact solid
 * fractions, and `pores` on dense arrays and a random pack; docs/physics.md has the derivation and the measurements.
 */
struct Weighting {
    bool low_noise;
    double k_flat, k_curved, k_other;
    PoreLaw pores;

    constexpr Weighting(Lattice lattice, double lambda) : low_noise(lambda == kLambdaLowNoise)
    {
        const bool d3q19 = lattice == Lattice::d3q19;
        if (low_noise) {
            k_flat = d3q19 ? 2.04 : 1.99;
            k_curved = d3q19 ? 3.4 : 3.8;
            k_other = 2.17;
            pores = {5, 0.4, 1.2, 2};
        } else {
            k_flat = d3q19 ? 1.84 + 10.2 * lambda : 1.67 + 11.9 * lambda;
            k_curved = d3q19 ? 2.6 + 16 * lambda : 2.7 + 16 * lambda;
            k_other = k_flat;
            pores = {7.1 - 10.4 * lambda, 0, 2, 1.5};
        }
    }

    /// Of a sphere. @param radius  [cells]
    [[nodiscard]] constexpr double k(double radius) const { return k_flat + k_curved / radius; }
};

}  // namespace lbm
