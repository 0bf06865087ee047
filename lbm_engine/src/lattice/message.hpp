#pragma once

#include "lbm/errors.hpp"
#include "lbm/fluid_config.hpp"

#include <cmath>
#include <sstream>
#include <string>

namespace lbm {

/// Text from parts, numbers as they are written in code.
template <class... Part>
[[nodiscard]] std::string message(const Part&... part)
{
    std::ostringstream out;
    out.precision(7);
    (out << ... << part);
    return out.str();
}

/// @throws ConfigError  "name = value: must be finite and > 0 [unit]" unless it is
inline void require_positive(const char* name, double value, const char* unit)
{
    if (!(std::isfinite(value) && value > 0))
        throw ConfigError(message(name, " = ", value, ": must be finite and > 0 [", unit, "]"));
}

/// @throws ConfigError  if there are more cells than kMaxCells
inline void require_countable(const std::array<int, 3>& cells)
{
    const double count = double(cells[0]) * cells[1] * cells[2];
    if (count > kMaxCells) throw ConfigError(message("cells = ", count, ": at most ", kMaxCells, "; use a larger dx"));
}

}  // namespace lbm
