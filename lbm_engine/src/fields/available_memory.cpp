#include "fields/available_memory.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>
#include <sstream>

namespace lbm {
namespace {

/// The first number of a file; none if there is no such file, or it says "max".
std::optional<double> number_in(const std::filesystem::path& file)
{
    std::ifstream in(file);
    double value = 0;
    return in >> value ? std::optional(value) : std::nullopt;
}

/// The number behind a key at the beginning of a line.
std::optional<double> number_in(const std::filesystem::path& file, const std::string& key)
{
    std::ifstream in(file);
    for (std::string line; std::getline(in, line);) {
        std::istringstream words(line);
        std::string name;
        double value = 0;
        if (words >> name >> value && name == key) return value;
    }
    return {};
}

/// How files of control groups are called, in both versions of them.
struct Names {
    const char *folder, *limit, *usage, *inactive_file, *active_file;
};
constexpr Names kVersion1{"/sys/fs/cgroup/memory", "memory.limit_in_bytes", "memory.usage_in_bytes",
                          "total_inactive_file", "total_active_file"};
constexpr Names kVersion2{"/sys/fs/cgroup", "memory.max", "memory.current", "inactive_file", "active_file"};

/// What the limits of a group and of those around it leave. Cached files are given up when memory is needed.
double left_by(const Names& names, const std::string& root, std::string group)
{
    double left = std::numeric_limits<double>::infinity();
    while (true) {
        const std::filesystem::path folder = root + names.folder + group;
        const auto limit = number_in(folder / names.limit), usage = number_in(folder / names.usage);
        if (limit && usage) {
            const auto stat = folder / "memory.stat";
            const double cached =
                number_in(stat, names.inactive_file).value_or(0) + number_in(stat, names.active_file).value_or(0);
            left = std::min(left, *limit - *usage + cached);
        }
        if (group.empty()) return std::max(left, 0.0);
        group.erase(std::min(group.rfind('/'), group.size()));
    }
}

}  // namespace

double available_memory(const std::string& root)
{
    double left = std::numeric_limits<double>::infinity();
    const std::string meminfo = root + "/proc/meminfo";
    if (const auto available = number_in(meminfo, "MemAvailable:"))
        left = 1024 * (*available + number_in(meminfo, "SwapFree:").value_or(0));
    std::ifstream groups(root + "/proc/self/cgroup");
    for (std::string line; std::getline(groups, line);) {  // number:controllers:path
        const auto first = line.find(':'), second = line.find(':', first + 1);
        if (second == std::string::npos) continue;
        const std::string controllers = ',' + line.substr(first + 1, second - first - 1) + ',';
        std::string group = line.substr(second + 1);
        if (group == "/") group.clear();
        if (controllers == ",,") left = std::min(left, left_by(kVersion2, root, group));
        else if (controllers.find(",memory,") != std::string::npos)
            left = std::min(left, left_by(kVersion1, root, group));
    }
    return left;
}

}  // namespace lbm
