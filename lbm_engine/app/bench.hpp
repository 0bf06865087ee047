#pragma once

#include <nlohmann/json.hpp>

#include <functional>
#include <string>
#include <vector>

namespace lbm {

/// What `lbm bench` is asked for.
struct BenchOptions {
    std::vector<std::string> cases = {"fluid", "bed", "suspension", "dilute"};
    std::vector<int> cells = {256};            ///< of a cubic box
    std::vector<double> diameters = {12, 20};  ///< of the solids [cells]
    std::vector<int> threads;                  ///< empty: one, and all
    std::vector<std::string> storages = {"double"};
    double seconds = 5;  ///< for each run
};

inline constexpr char kBenchUsage[] =
    R"(usage: lbm bench [--cases fluid,bed,suspension,dilute] [--cells 256,...] [--diameters 12,20] [--threads 1,2]
                 [--storage double,single] [--seconds 5]

Measures the memory bandwidth, then the throughput of the fluid alone (fluid), in a fixed bed of 60 % solids (bed), with
30 % (suspension) and 2 % (dilute) of moving spheres, then the bandwidth again. Table on standard error, JSON on standard output.
Spheres stand about the places of a face-centred lattice that fits the box: d is the diameter nearest to what was asked for.
In beds sixteen steps are made at once, as lbm run does: loads are those of the last of them.
Slices of the triad, the fluid alone and the case take turns, so that share and ratio hold where the machine's speed wanders.
MLUPS: million cells updated per second. share: traffic of one read and one write of each population, over the triad's. ratio: over the fluid alone,
and its MLUPS meanwhile; of the fluid itself: over that with the first number of threads. The rest: parts of a step, and time until the first one.
)";

/// @throws ConfigError for an argument that is unknown or out of range
BenchOptions read_bench_options(const std::vector<std::string>& arguments);

/// @param line  called with each line of the table as soon as it is known
nlohmann::json run_bench(const BenchOptions& options, const std::function<void(const std::string&)>& line);

}  // namespace lbm
