#include "bench.hpp"

#include "bandwidth.hpp"

#include "lbm/fluid.hpp"

#include <omp.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>
#include <sstream>

namespace lbm {
namespace {

constexpr double kPopulations = 19;
constexpr int kStepsBetweenTurns = 10;
constexpr double kSpeed = 0.01;  // [cells per step]

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

std::vector<std::string> split(const std::string& list)
{
    std::vector<std::string> parts;
    std::stringstream stream(list);
    for (std::string part; std::getline(stream, part, ',');) parts.push_back(part);
    return parts;
}

std::vector<double> numbers(const std::string& option, const std::string& list, double low, double high)
{
    std::vector<double> values;
    for (const std::string& part : split(list)) {
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

std::vector<std::string> words(const std::string& option, const std::string& list,
                               const std::vector<std::string>& allowed)
{
    for (const std::string& part : split(list))
        if (std::find(allowed.begin(), allowed.end(), part) == allowed.end())
            throw ConfigError(std::string(option).append(" ").append(part).append(": unknown"));
    return split(list);
}

/// Spheres of about this diameter on a face-centred cubic lattice that fits the box, moved at random within their gaps.
std::vector<Solid> spheres(int n, double diameter, double solid_fraction)
{
    const double volume = std::numbers::pi / 6 * std::pow(diameter, 3);
    const int m = std::max(1, static_cast<int>(std::lround(n / std::cbrt(4 * volume / solid_fraction))));
    const double a = static_cast<double>(n) / m;
    const double R = 0.5 * std::cbrt(solid_fraction * a * a * a / 4 * 6 / std::numbers::pi);
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

struct Run {
    std::string name, storage;
    int cells, threads;
    double diameter, solid_fraction;
    bool moving;
};

nlohmann::json measure(const Run& run, double seconds)
{
    FluidConfig c;
    c.cells = {run.cells, run.cells, run.cells};
    c.dx = c.density = 1;
    c.tau = 0.6;
    c.viscosity = (c.tau - 0.5) / 3;
    c.acceleration = {1e-7, 0, 0};
    c.threads = run.threads;
    c.storage = run.storage == "single" ? Storage::single_precision : Storage::double_precision;
    const double start = now();
    Fluid fluid(c);
    std::vector<Solid> solids;
    if (run.solid_fraction > 0) solids = spheres(run.cells, run.diameter, run.solid_fraction);
    if (!run.moving)
        for (Solid& s : solids) s.velocity = s.angular_velocity = {};
    fluid.place_solids(solids);
    const double ready = now() - start;

    int steps = 0;
    const auto step = [&] {
        if (run.moving) {
            const double direction = steps / kStepsBetweenTurns % 2 ? -1 : 1;
            for (Solid& s : solids)
                for (int d = 0; d < 3; ++d) s.position[d] += direction * s.velocity[d];
            fluid.place_solids(solids);
        }
        fluid.step();
        if (run.moving) fluid.film_loads(solids, fluid.dt());
        ++steps;
    };
    for (int i = 0; i < 4; ++i) step();
    const StepTimes before = fluid.times();
    const int first = steps;
    const double begin = now();
    while (now() - begin < seconds || steps - first < 4) step();
    const double elapsed = now() - begin;
    const StepTimes after = fluid.times();

    const double cells = std::pow(run.cells, 3);
    const double updates = cells * (steps - first);
    const double bytes = run.storage == "single" ? 4 : 8;
    return {{"case", run.name},
            {"cells", run.cells},
            {"threads", run.threads},
            {"storage", run.storage},
            {"solids", solids.size()},
            {"diameter", solids.empty() ? 0 : 2 * solids[0].radius},
            {"mlups", updates / elapsed / 1e6},
            {"nanoseconds_per_cell", 1e9 * elapsed / updates},
            {"bytes_per_cell", static_cast<double>(fluid.memory_bytes()) / cells},
            {"traffic", 2 * kPopulations * bytes * updates / elapsed},
            {"seconds_to_start", ready},
            {"parts",
             {{"map", (after.map - before.map) / elapsed},
              {"exchange", (after.exchange - before.exchange) / elapsed},
              {"collide_stream", (after.collide_stream - before.collide_stream) / elapsed},
              {"loads", (after.loads - before.loads) / elapsed}}}};
}

nlohmann::json in_json(const Bandwidth& b) { return {{"copy", b.copy}, {"triad", b.triad}, {"in_place", b.in_place}}; }

template <class... Value>
std::string formatted(const char* format, Value... value)
{
    char text[256];
    std::snprintf(text, sizeof(text), format, value...);
    return text;
}

std::vector<Run> runs(const BenchOptions& o, int threads)
{
    std::vector<Run> all;
    for (const std::string& storage : o.storages)
        for (const int cells : o.cells)
            for (const std::string& name : o.cases) {
                if (name == "fluid") {
                    all.push_back({name, storage, cells, threads, 0, 0, false});
                    continue;
                }
                const double solid_fraction = name == "bed" ? 0.6 : name == "suspension" ? 0.3 : 0.02;
                for (const double diameter : o.diameters)
                    all.push_back({name, storage, cells, threads, diameter, solid_fraction, name != "bed"});
            }
    return all;
}

}  // namespace

BenchOptions read_bench_options(const std::vector<std::string>& arguments)
{
    BenchOptions o;
    const auto whole = [](const std::vector<double>& values) { return std::vector<int>(values.begin(), values.end()); };
    for (std::size_t i = 0; i < arguments.size(); i += 2) {
        const std::string& option = arguments[i];
        if (i + 1 == arguments.size()) throw ConfigError(option + ": needs a value");
        const std::string& list = arguments[i + 1];
        if (option == "--cases") o.cases = words(option, list, {"fluid", "bed", "suspension", "dilute"});
        else if (option == "--storage") o.storages = words(option, list, {"double", "single"});
        else if (option == "--cells") o.cells = whole(numbers(option, list, 8, 2000));
        else if (option == "--threads") o.threads = whole(numbers(option, list, 1, 1024));
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
    nlohmann::json json;
    for (const int threads : options.threads) {
        nlohmann::json part;
        const Bandwidth before = measure_bandwidth(threads);
        line(formatted("%d thread(s): copy %.1f, triad %.1f, in place %.1f GB/s", threads, before.copy / 1e9,
                       before.triad / 1e9, before.in_place / 1e9));
        line("case         cells storage     d  MLUPS  ns/cell  B/cell  share   map exch sweep loads  ready");
        for (const Run& run : runs(options, threads)) {
            nlohmann::json result = measure(run, options.seconds);
            result["share"] = result["traffic"].get<double>() / before.triad;
            const auto number = [&](const char* key) { return result[key].get<double>(); };
            const auto percent = [&](const char* key) { return 100 * result["parts"][key].get<double>(); };
            line(formatted("%-12s %5d %-7s %5.1f %6.1f %8.2f %7.1f %5.0f%% %4.0f%% %3.0f%% %4.0f%% %4.0f%% %5.2f s",
                           run.name.c_str(), run.cells, run.storage.c_str(), number("diameter"), number("mlups"),
                           number("nanoseconds_per_cell"), number("bytes_per_cell"), 100 * number("share"),
                           percent("map"), percent("exchange"), percent("collide_stream"), percent("loads"),
                           number("seconds_to_start")));
            part["runs"].push_back(result);
        }
        const Bandwidth after = measure_bandwidth(threads);
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
