#pragma once

#include "lbm/solid.hpp"

namespace lbm {

/**
 * The one converter between SI and lattice units (cell, fluid step, density of the fluid at rest).
 * Each member is one lattice unit of its quantity in SI: divide to go in, multiply to come out.
 */
struct Units {
    double length;        ///< dx [m]
    double time;          ///< dt [s]
    double density;       ///< rho_0 [kg/m3]
    double velocity;      ///< [m/s]
    double acceleration;  ///< [m/s2]
    double viscosity;     ///< kinematic [m2/s]
    double mass;          ///< [kg]
    double inertia;       ///< moment of inertia [kg m2]
    double momentum;      ///< [kg m/s]
    double force;         ///< [N]
    double torque;        ///< [N m]
    double pressure;      ///< [Pa]
    double energy;        ///< [J]

    constexpr Units(double dx, double dt, double rho_0)
        : length(dx)
        , time(dt)
        , density(rho_0)
        , velocity(dx / dt)
        , acceleration(dx / (dt * dt))
        , viscosity(dx * dx / dt)
        , mass(rho_0 * dx * dx * dx)
        , inertia(mass * dx * dx)
        , momentum(mass * velocity)
        , force(mass * acceleration)
        , torque(force * dx)
        , pressure(force / (dx * dx))
        , energy(torque)
    {
    }
};

/// nu = (tau - 1/2) / 3 in lattice units, so this tau makes a cell of size dx step by dt = (tau - 1/2) dx^2 / (3 nu).
[[nodiscard]] constexpr double fluid_time_step(double tau, double dx, double nu)
{
    return (tau - 0.5) * dx * dx / (3 * nu);
}
[[nodiscard]] constexpr double relaxation_time(double dt, double dx, double nu)
{
    return 0.5 + 3 * nu * dt / (dx * dx);
}

}  // namespace lbm
