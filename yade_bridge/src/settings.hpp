#pragma once

#include "lbm/fluid_config.hpp"

#include <array>
#include <limits>
#include <string>
#include <vector>

namespace yadelbm {

/// The attributes of an LbmEngine as the user sets them: plain values in SI units, NaN where nothing was said.
struct Settings {
    static constexpr double kUnset = std::numeric_limits<double>::quiet_NaN();

    lbm::Vec3 lower{};
    lbm::Vec3 upper{kUnset, kUnset, kUnset};
    double dx = kUnset;
    double density = kUnset;
    double viscosity = kUnset;
    lbm::Vec3 gravity{};
    lbm::Vec3 acceleration{};
    lbm::Vec3 initial_velocity{};
    std::vector<std::string> boundary = std::vector<std::string>(6, "noSlip");
    std::vector<lbm::Vec3> boundary_velocity = std::vector<lbm::Vec3>(6);
    std::vector<double> boundary_pressure = std::vector<double>(6);
    double tau = kUnset;
    double magic_parameter = kUnset;
    bool inertia = true;
    std::string scheme = "exact";
    std::string collision = "trt";
    std::string lattice = "D3Q19";
    std::string storage = "double";
    int mask = 0;
    std::vector<int> ids;
    bool lubrication = true;
    double lubrication_roughness = 1e-3;
    double max_mach = 0.2;
    double accuracy = 0.02;
    std::string stop_file = "lbm-stopped.vti";
    int ranks = 0;
};

/**
 * Checks every value on its own; what is not set passes.
 * @throws lbm::ConfigError  the message names the attribute, its value, the rule, and what would do
 */
void check_values(const Settings& settings);

/**
 * Checks values and how they fit together, as far as that is possible without a scene.
 * @param complete  whether values that have no default (upper, dx, density, viscosity) must be there
 * @throws lbm::ConfigError  as `check_values`
 */
void check(const Settings& settings, bool complete);

/**
 * Cells along x, y, z.
 * @throws lbm::ConfigError  unless upper - lower is a whole number of cells (1e-6 relative) in every direction
 */
std::array<int, 3> cells(const Settings& settings);

/// The six faces of the engine's configuration.
std::array<lbm::FaceCondition, 6> face_conditions(const Settings& settings);

/**
 * The engine's configuration.
 * @param tau      relaxation time, planned or given
 * @param threads  of the fluid's loops, 0: as OpenMP decides
 * @throws lbm::ConfigError  as `check` with `complete`
 */
lbm::FluidConfig fluid_config(const Settings& settings, double tau, int threads);

}  // namespace yadelbm
