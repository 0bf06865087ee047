#pragma once

#include "lbm/solid.hpp"

#include <cstdio>
#include <string>

namespace yadelbm {

/// A number as a user would write it.
inline std::string text(double value)
{
    char buffer[32];
    std::snprintf(buffer, sizeof buffer, "%.10g", value);
    return buffer;
}

inline std::string text(const lbm::Vec3& v)
{
    return std::string("(")
        .append(text(v[0]))
        .append(", ")
        .append(text(v[1]))
        .append(", ")
        .append(text(v[2]))
        .append(")");
}

}  // namespace yadelbm
