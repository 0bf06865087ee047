#include "bench.hpp"
#include "parse_json.hpp"
#include "run_case.hpp"

#include <nlohmann/json.hpp>

#include <omp.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <new>

namespace {

constexpr int kBadInput = 2;
constexpr int kFailedRun = 3;
constexpr double kSecondsBetweenReports = 1;

constexpr char kUsage[] =
    R"(usage: lbm run CASE.json
       lbm bench [--help] [OPTION VALUE ...]

run:   Runs the fluid of CASE.json until it is steady (or for stop.max_steps steps). Result as JSON on standard output,
       progress on standard error. "-" reads the case from standard input. docs/user-guide.md describes the keys.
bench: Measures memory bandwidth and throughput on this machine.

exit status: 0, 2 for bad input, 3 for a run that diverged or did not become steady
)";

nlohmann::json parse(const std::string& path)
{
    try {
        if (path == "-") return lbm::parse_json(std::cin);
        std::ifstream file(path);
        if (!file || std::filesystem::is_directory(path)) throw lbm::ConfigError(path + ": cannot be read");
        return lbm::parse_json(file);
    } catch (const nlohmann::json::exception& error) {
        throw lbm::ConfigError(path + ": not valid JSON: " + error.what());
    } catch (const std::ios_base::failure& error) {
        throw lbm::ConfigError(path + ": cannot be read: " + error.what());
    }
}

/// More threads than processors only get into each other's way; results do not depend on them.
void limit_threads(int& threads)
{
    const int processors = omp_get_num_procs();
    if (threads <= processors) return;
    std::fprintf(stderr, "lbm: threads = %d: there are %d processors, so %d are used\n", threads, processors,
                 processors);
    threads = processors;
}

void print(const nlohmann::json& result)
{
    std::cout << result.dump(2) << std::endl;
    if (!std::cout) throw lbm::RunError("the result cannot be written to standard output");
}

int run(const std::string& path)
{
    lbm::Case input = lbm::read_case(parse(path));
    limit_threads(input.fluid.threads);
    double last = 0;
    bool shown = false;
    const bool terminal = isatty(STDERR_FILENO);
    const auto report = [&](const lbm::Progress& p) {
        if (p.seconds - last < kSecondsBetweenReports) return;
        last = p.seconds;
        shown = true;
        std::fprintf(stderr, "%sstep %lld of at most %lld, %.0f s, change %.1e%s", terminal ? "\r" : "",
                     static_cast<long long>(p.step), static_cast<long long>(p.max_steps), p.seconds, p.change,
                     terminal ? "   " : "\n");
    };
    const auto warn = [](const std::string& what) { std::fprintf(stderr, "lbm: warning: %s\n", what.c_str()); };
    const auto result = lbm::run_case(input, report, warn);
    if (shown && terminal) std::fputc('\n', stderr);
    print(result.json);
    if (!result.not_written.empty()) throw lbm::RunError(result.not_written);
    if (input.steady > 0 && !result.converged) {
        std::fprintf(stderr, "lbm: not steady to %g after %lld steps: raise stop.max_steps\n", input.steady,
                     static_cast<long long>(input.max_steps));
        return kFailedRun;
    }
    return 0;
}

bool asks_for_help(const std::string& argument) { return argument == "--help" || argument == "-h"; }

int bench(const std::vector<std::string>& arguments)
{
    if (arguments.size() == 1 && asks_for_help(arguments[0])) {
        std::fputs(lbm::kBenchUsage, stdout);
        return 0;
    }
    const auto options = lbm::read_bench_options(arguments);
    print(lbm::run_bench(options, [](const std::string& line) { std::cerr << line << std::endl; }));
    return 0;
}

}  // namespace

int main(int argc, char** argv)
{
    const std::vector<std::string> arguments(argv + 1, argv + argc);
    const bool run_help = arguments.size() == 2 && arguments[0] == "run" && asks_for_help(arguments[1]);
    if (run_help || (arguments.size() == 1 && asks_for_help(arguments[0]))) {
        std::fputs(kUsage, stdout);
        return 0;
    }
    const bool benchmark = !arguments.empty() && arguments[0] == "bench";
    if (!benchmark && (arguments.size() != 2 || arguments[0] != "run")) {
        std::fputs(kUsage, stderr);
        return kBadInput;
    }
    try {
        return benchmark ? bench({arguments.begin() + 1, arguments.end()}) : run(arguments[1]);
    } catch (const lbm::ConfigError& error) {
        std::fprintf(stderr, "lbm: %s\n", error.what());
        return kBadInput;
    } catch (const std::bad_alloc&) {
        std::fputs("lbm: there is no memory left: use a larger dx, or single storage\n", stderr);
        return kFailedRun;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "lbm: %s\n", error.what());
        return kFailedRun;
    }
}
