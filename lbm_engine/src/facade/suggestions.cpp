#include "facade/planning.hpp"

#include <algorithm>

namespace lbm {

using namespace planning;

namespace {

/// A request for cells of this size; the box becomes as many as it takes.
PlanRequest with_dx(PlanRequest r, const Vec3& lengths, double dx)
{
    r.dx = dx;
    for (int d = 0; d < 3; ++d) {
        const double n = std::max(1.0, std::round(lengths[d] / dx));
        r.cells[d] = static_cast<int>(std::min(n, 1e9));
    }
    return r;
}

struct Need {
    double memory_bytes, cost;
};

Need need(const PlanRequest& r)
{
    const Range range = step_range(r);
    // without a layout: too many cells for an address must not be an error here
    const double bytes = cell_count(r.cells) * populations(r.lattice) * bytes_per_population(r.storage);
    return {bytes, estimate(r, std::max(range.shortest, range.accurate)).cost};
}

/// The largest size up to dx with which all edges are whole numbers of cells.
double dividing(const Vec3& lengths, double dx)
{
    const double shortest = *std::min_element(lengths.begin(), lengths.end());
    const double first = std::max(1.0, std::ceil(shortest / dx * (1 - kHair)));
    for (double n = first; n <= 2 * first + 20; ++n) {
        const auto whole = [&](double length) {
            const double cells = length * n / shortest;
            return std::abs(cells - std::round(cells)) < 1e-6 * cells;
        };
        if (std::all_of(lengths.begin(), lengths.end(), whole)) return shortest / n;
    }
    throw ConfigError(message("no cell size near ", dx, " m divides the box of ", lengths[0], " x ", lengths[1], " x ",
                              lengths[2], " m; make it ", dx * std::ceil(lengths[0] / dx), " x ",
                              dx * std::ceil(lengths[1] / dx), " x ", dx * std::ceil(lengths[2] / dx),
                              " m for dx = ", dx));
}

void check(const Budget& budget)
{
    if (!(budget.memory_bytes > 0)) throw ConfigError(message("memory = ", budget.memory_bytes, ": must be > 0 bytes"));
    if (!(budget.cost > 0))
        throw ConfigError(message("seconds = ", budget.cost, ": must be > 0 s per simulated second"));
}

}  // namespace

double resolution_error(double cells_per_diameter, double reynolds, double solid_fraction)
{
    const double dense = std::min(1.0, solid_fraction / 0.3);
    const double error = 0.17 + 0.09 * reynolds + 0.9 * dense * dense * dense;
    return error / (cells_per_diameter * cells_per_diameter);
}

double suggest_dx(const PlanRequest& request, const Vec3& lengths, double solid_fraction, const Budget& budget)
{
    for (const double length : lengths) require_positive("length of the box", length, "m");
    require_positive("smallest radius", request.smallest_radius, "m");
    check(budget);
    PlanRequest start = with_dx(request, lengths, request.smallest_radius);
    start.grain_dt = 1;  // of no consequence
    check(start, false);
    if (!(solid_fraction >= 0 && solid_fraction < 1))
        throw ConfigError(message("solid fraction = ", solid_fraction, ": must be >= 0 and < 1"));
    const double diameter = 2 * request.smallest_radius;
    const double reynolds = request.speed * request.mean_diameter / kinematic_viscosity(request);
    const auto error = [&](double dx) { return resolution_error(diameter / dx, reynolds, solid_fraction); };
    const double accurate = diameter / std::max(kWantedCellsPerDiameter, std::sqrt(error(diameter) / request.accuracy));
    const double dx = dividing(lengths, accurate);
    const PlanRequest r = with_dx(start, lengths, dx);
    const auto fits = [&](double size) {
        const Need n = need(with_dx(r, lengths, size));
        return n.memory_bytes <= budget.memory_bytes && n.cost <= budget.cost;
    };
    if (fits(dx)) return dx;
    const Need wanted = need(r);
    double low = dx, high = *std::max_element(lengths.begin(), lengths.end());
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (fits(middle) ? high : low) = middle;
    }
    throw ConfigError(message("accuracy = ", request.accuracy, " takes dx = ", dx, " m, ", wanted.memory_bytes / 1e9,
                              " GB and ", wanted.cost, " s per simulated second: beyond the budget of ",
                              budget.memory_bytes / 1e9, " GB and ", budget.cost, " s; it allows dx = ", high, " m, ",
                              diameter / high, " cells per diameter (at least ", kWantedCellsPerDiameter,
                              " are wanted) and accuracy = ", error(high)));
}

double suggest_dt(const PlanRequest& request, double largest, const Budget& budget)
{
    require_positive("largest time step of the grains", largest, "s");
    check(budget);
    PlanRequest r = request;
    r.grain_dt = largest;
    check(r, true);
    const Range range = step_range(r);
    require_room(r, range);
    const double fluid_dt = std::max(range.shortest, range.accurate);
    if (const StepEstimate e = estimate(r, fluid_dt); e.cost > budget.cost)
        throw ConfigError(message("the longest fluid step within the accuracy of ", r.accuracy, ", ", fluid_dt,
                                  " s, costs ", e.cost, " s per simulated second: beyond the budget of ", budget.cost,
                                  " s; use dx >= ",
                                  // cells go with dx^-3, the step with dx to dx^2: the safe one
                                  r.dx * std::pow(e.cost / budget.cost, 0.25), " m, or a larger accuracy"));
    return fluid_dt / std::ceil(fluid_dt / largest * (1 - kHair));
}

}  // namespace lbm
