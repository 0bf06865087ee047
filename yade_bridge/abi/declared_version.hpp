#pragma once

namespace yade {

inline constexpr const char* kDeclaredVersion = "2023.02a as in Debian 12 (x86-64, double precision)";

}  // namespace yade
