#pragma once

#include <stdexcept>

namespace lbm {

/// Bad input, found before anything ran. The message stands alone: rule, value, remedy.
class ConfigError : public std::invalid_argument {
    using std::invalid_argument::invalid_argument;
};

/// A run that cannot go on: divergence, a limit violated on the way, input or output that failed.
class RunError : public std::runtime_error {
    using std::runtime_error::runtime_error;
};

}  // namespace lbm
