#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace yade {

struct TimingInfo {
    using delta = unsigned long long;
    long nExec = 0;
    delta nsec = 0;
    static bool enabled;
};

class TimingDeltas {
    TimingInfo::delta last = 0;
    std::size_t curr = 0;

public:
    std::vector<TimingInfo> data;
    std::vector<std::string> labels;
};

}  // namespace yade
