#include "bench.hpp"

#include "bandwidth.hpp"

#include "lbm/fluid.hpp"

#include <omp.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>
#include <random>
#include <sstream>

namespace lbm {
namespace {

constexpr double kPopulations = 19;
constexpr int kStepsBetweenTurns = 10;
constexpr double kSpeed = 0.01;   // [cells per step]
constexpr double kSlice = 0.05;   // [s]
constexpr int kStepsAtOnce = 16;  // around fixed solids, as lbm run makes them

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

std::vector<std::string> split(const std::string& option, const std::string& list)
{
    std::vector<std::string> parts;
    std::stringstream stream(list);
    for (std::string part; std::getline(stream, part, ',');) parts.push_back(part);
    if (parts.empty()) throw ConfigError(option + ": needs a value");
    return parts;
}

std::vector<double> numbers(const std::string& option, const std::string& list, double low, double high)
{
    std::vector<double> values;
    for (const std::string& part : split(option, list)) {
        std::size_t used = 0;
        double value = std::nan("");
        try {
            value = std::stod(part, &used);
        } catch (const std::exception&) {
        }
        if (used != part.size() || !(value >= low && value <= high)) {
            std::ostringstream text;
            text << option << " " << part << ": must be a number from " << low << " to " << high;
            throw ConfigError(text.str());
        }
        values.push_back(value);
    }
    return values;
}

std::vector<int> whole_numbers(const std::string& option, const std::string& list, int low, int high)
{
    const std::vector<double> values = numbers(option, list, low, high);
    for (const double value : values)
        if (value != std::floor(value))
            throw ConfigError(std::string(option).append(" ").append(list).append(": must be whole numbers"));
    return {values.begin(), values.end()};
}

std::vector<std::string> words(const std::string& option, const std::string& list,
                               const std::vector<std::string>& allowed)
{
    std::vector<std::string> parts = split(option, list);
    for (const std::string& part : parts)
        if (std::find(allowed.begin(), allowed.end(), part) == allowed.end())
            throw ConfigError(std::string(option).append(" ").append(part).append(": unknown"));
    return parts;
}

template <class... Value>
std::string formatted(const char* format, Value... value)
{
    char text[256];
    std::snprintf(text, sizeof(text), format, value...);
    return text;
}

/// Spheres of about this diameter on a face-centred cubic lattice that fits the box, moved at random within their gaps.
std::vector<Solid> spheres(int n, double diameter, double solid_fraction)
{
    const double volume = std::numbers::pi / 6 * std::pow(diameter, 3);
    const int m = std::max(1, static_cast<int>(std::lround(n / std::cbrt(4 * volume / solid_fraction))));
    const double a = static_cast<double>(n) / m;
    const double R = 0.5 * std::cbrt(solid_fraction * a * a * a / 4 * 6 / std::numbers::pi);
    if (R < kMinRadiusInCells) {
        const double needed = m * 2 * kMinRadiusInCells * std::cbrt(4 * std::numbers::pi / 6 / solid_fraction);
        throw ConfigError("--cells " + std::to_string(n) +
                          ": too few for spheres of four cells or more at a solid fraction of " +
                          formatted("%g", solid_fraction) + "; use at least " + formatted("%.0f", std::ceil(needed)));
    }
    const double gap = a / std::numbers::sqrt2 - 2 * R;
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(-0.5, 0.5);
    std::vector<Solid> all;
    for (int k = 0; k < 2 * m; ++k)
        for (int j = 0; j < 2 * m; ++j)
            for (int i = 0; i < 2 * m; ++i) {
                if ((i + j + k) % 2) continue;
                Solid s;
                s.id = static_cast<std::int64_t>(all.size());
                s.radius = R;
                const int at[] = {i, j, k};
                for (int d = 0; d < 3; ++d) {
                    s.position[d] = (at[d] + 0.5) * a / 2 + 0.5 * gap * uniform(random);
                    s.velocity[d] = 2 * kSpeed * uniform(random);
                    s.angular_velocity[d] = kSpeed / R * uniform(random);
                }
                all.push_back(s);
            }
    return all;
}

/// A case, and what it is compared with.
struct Run {
    std::string name, storage;
    int cells, threads;
    double diameter, solid_fraction;
    bool moving;
};

FluidConfig config(const Run& run)
{
    FluidConfig c;
    c.cells = {run.cells, run.cells, run.cells};
    c.dx = c.density = 1;
    c.tau = 0.6;
    c.viscosity = (c.tau - 0.5) / 3;
    c.acceleration = {1e-7, 0, 0};
    c.threads = run.threads;
    c.storage = run.storage == "single" ? Storage::single_precision : Storage::double_precision;
    return c;
}

/// A fluid that makes steps.
class Bench {
public:
    explicit Bench(const Run& run) : run_(run), begin_(now()), fluid_(config(run))
    {
        if (run.solid_fraction > 0) solids_ = spheres(run.cells, run.diameter, run.solid_fraction);
        for (Solid& s : solids_) {
            if (!run.moving) {
                s.velocity = s.angular_velocity = {};
                continue;
            }
            s.mass = 2.6 * (4 * std::numbers::pi / 3) * std::pow(s.radius, 3);
            s.inertia = 0.4 * s.mass * s.radius * s.radius;
        }
        fluid_.place_solids(solids_);
        seconds_to_start_ = now() - begin_;
        for (int i = 0; i < 4; ++i) step();
        before_ = fluid_.times();
        const double start = now();
        step();
        steps_of_slice_ = std::clamp(static_cast<int>(kSlice / (now() - start)), is_bed() ? kStepsAtOnce : 1, 10000);
    }

    /// @return seconds per step
    double slice()
    {
        const double start = now();
        if (is_bed())
            for (int left = steps_of_slice_; left > 0; left -= kStepsAtOnce) fluid_.step(std::min(left, kStepsAtOnce));
        else
            for (int i = 0; i < steps_of_slice_; ++i) step();
        return (now() - start) / steps_of_slice_;
    }

    const Run& run() const { return run_; }
    bool is_bed() const { return !solids_.empty() && !run_.moving; }
    double cells() const { return std::pow(run_.cells, 3); }
    /// One read and one write of each population.
    double traffic_of_step() const { return 2 * kPopulations * (run_.storage == "single" ? 4 : 8) * cells(); }

    /// @param seconds  per step
    nlohmann::json result(double seconds) const
    {
        const StepTimes after = fluid_.times();
        const double map = after.map - before_.map, exchange = after.exchange - before_.exchange,
                     sweep = after.collide_stream - before_.collide_stream, loads = after.loads - before_.loads,
                     films = after.films - before_.films, all = map + exchange + sweep + loads + films;
        return {{"case", run_.name},
                {"cells", run_.cells},
                {"threads", run_.threads},
                {"storage", run_.storage},
                {"solids", solids_.size()},
                {"diameter", solids_.empty() ? 0 : 2 * solids_[0].radius},
                {"mlups", cells() / seconds / 1e6},
                {"nanoseconds_per_cell", 1e9 * seconds / cells()},
                {"bytes_per_cell", static_cast<double>(fluid_.memory_bytes()) / cells()},
                {"traffic", traffic_of_step() / seconds},
                {"seconds_to_start", seconds_to_start_},
                {"parts",
                 {{"map", map / all},
                  {"exchange", exchange / all},
                  {"collide_stream", sweep / all},
                  {"loads", loads / all},
                  {"films", films / all}}}};
    }

private:
    void step()
    {
        if (run_.moving) {
            const double direction = steps_ / kStepsBetweenTurns % 2 ? -1 : 1;
            for (Solid& s : solids_)
                for (int d = 0; d < 3; ++d) s.position[d] += direction * s.velocity[d];
            fluid_.place_solids(solids_);
        }
        fluid_.step();
        if (run_.moving) fluid_.film_loads(solids_, fluid_.dt());
        ++steps_;
    }

    Run run_;
    double begin_;
    Fluid fluid_;
    std::vector<Solid> solids_;
    double seconds_to_start_ = 0;
    StepTimes before_;
    int steps_ = 0, steps_of_slice_ = 1;
};

double median(std::vector<double> values)
{
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/**
 * A machine's memory and clock wander, so slices of the triad, of what the case is compared with, and of the case take turns: ratios of neighbours are
 * right even so.
 */
nlohmann::json measure(const BandwidthMeter& meter, Bench* reference, Bench& bench, double seconds)
{
    std::vector<double> times, references, ratios, shares;
    const double begin = now();
    while (now() - begin < seconds || times.size() < 4) {
        const double triad = meter.triad_now();
        if (reference) references.push_back(reference->slice());
        times.push_back(bench.slice());
        if (reference) ratios.push_back(references.back() / times.back() * bench.cells() / reference->cells());
        shares.push_back(bench.traffic_of_step() / times.back() / triad);
    }
    nlohmann::json result = bench.result(median(times));
    result["share"] = median(shares);
    if (reference) {
        result["ratio"] = median(ratios);
        result["ratio_to"] = {{"case", reference->run().name},
                              {"threads", reference->run().threads},
                              {"mlups", reference->cells() / median(references) / 1e6}};
    }
    return result;
}

nlohmann::json in_json(const Bandwidth& b) { return {{"copy", b.copy}, {"triad", b.triad}, {"in_place", b.in_place}}; }

/// With solids; first in line is the fluid alone.
std::vector<Run> runs(const BenchOptions& o, const std::string& storage, int cells, int threads)
{
    std::vector<Run> all;
    for (const std::string& name : o.cases) {
        if (name == "fluid") continue;
        const double solid_fraction = name == "bed" ? 0.6 : name == "suspension" ? 0.3 : 0.02;
        for (const double diameter : o.diameters)
            all.push_back({name, storage, cells, threads, diameter, solid_fraction, name != "bed"});
    }
    return all;
}

std::string line_of(const nlohmann::json& result)
{
    const auto number = [&](const char* key) { return result[key].get<double>(); };
    const auto percent = [&](const char* key) { return 100 * result["parts"][key].get<double>(); };
    const std::string ratio = result.contains("ratio") ? formatted("%4.0f%% of %3.0f", 100 * number("ratio"),
                                                                   result["ratio_to"]["mlups"].get<double>())
                                                       : std::string(12, ' ');
    return formatted(
        "%-12s %5d %-7s %5.1f %6.1f %8.2f %7.1f %5.0f%% %s  %3.0f%% %3.0f%% %4.0f%% %4.0f%% %4.0f%% %5.2f s",
        result["case"].get<std::string>().c_str(), result["cells"].get<int>(),
        result["storage"].get<std::string>().c_str(), number("diameter"), number("mlups"),
        number("nanoseconds_per_cell"), number("bytes_per_cell"), 100 * number("share"), ratio.c_str(), percent("map"),
        percent("exchange"), percent("collide_stream"), percent("loads"), percent("films"), number("seconds_to_start"));
}

}  // namespace

BenchOptions read_bench_options(const std::vector<std::string>& arguments)
{
    BenchOptions o;
    for (std::size_t i = 0; i < arguments.size(); i += 2) {
        const std::string& option = arguments[i];
        if (i + 1 == arguments.size()) throw ConfigError(option + ": needs a value");
        const std::string& list = arguments[i + 1];
        if (option == "--cases") o.cases = words(option, list, {"fluid", "bed", "suspension", "dilute"});
        else if (option == "--storage") o.storages = words(option, list, {"double", "single"});
        else if (option == "--cells") o.cells = whole_numbers(option, list, 8, 2000);
        else if (option == "--threads") o.threads = whole_numbers(option, list, 1, omp_get_num_procs());
        else if (option == "--diameters") o.diameters = numbers(option, list, 4, 500);
        else if (option == "--seconds") o.seconds = numbers(option, list, 0.01, 3600).front();
        else throw ConfigError(option + ": unknown option");
    }
    if (o.threads.empty()) {
        o.threads = {1};
        if (omp_get_max_threads() > 1) o.threads.push_back(omp_get_max_threads());
    }
    return o;
}

nlohmann::json run_bench(const BenchOptions& options, const std::function<void(const std::string&)>& line)
{
    const bool has_fluid = std::find(options.cases.begin(), options.cases.end(), "fluid") != options.cases.end();
    nlohmann::json json;
    for (const int threads : options.threads) {
        nlohmann::json part;
        const BandwidthMeter meter(threads);
        const Bandwidth before = meter.best();
        line(formatted("%d thread(s): copy %.1f, triad %.1f, in place %.1f GB/s", threads, before.copy / 1e9,
                       before.triad / 1e9, before.in_place / 1e9));
        line("case         cells storage     d  MLUPS  ns/cell  B/cell  share         ratio   map exch sweep loads "
             "films  "
             "ready");
        const auto add = [&](Bench* reference, Bench& bench) {
            part["runs"].push_back(measure(meter, reference, bench, options.seconds));
            line(line_of(part["runs"].back()));
        };
        for (const std::string& storage : options.storages)
            for (const int cells : options.cells) {
                std::unique_ptr<Bench> fluid;
                if (has_fluid) {
                    fluid = std::make_unique<Bench>(Run{"fluid", storage, cells, threads, 0, 0, false});
                    std::unique_ptr<Bench> with_fewer;
                    if (threads != options.threads.front())
                        with_fewer =
                            std::make_unique<Bench>(Run{"fluid", storage, cells, options.threads.front(), 0, 0, false});
                    add(with_fewer.get(), *fluid);
                }
                for (const Run& run : runs(options, storage, cells, threads)) {
                    Bench bench(run);
                    add(fluid.get(), bench);
                }
            }
        const Bandwidth after = meter.best();
        line(formatted("after: copy %.1f, triad %.1f, in place %.1f GB/s", after.copy / 1e9, after.triad / 1e9,
                       after.in_place / 1e9));
        part["threads"] = threads;
        part["bandwidth_before"] = in_json(before);
        part["bandwidth_after"] = in_json(after);
        json.push_back(part);
    }
    return json;
}

}  // namespace lbm
