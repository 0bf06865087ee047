#pragma once

#include <nlohmann/json_fwd.hpp>

#include <istream>

namespace lbm {

/// @throws nlohmann::json::exception, and ConfigError naming a key that stands twice in an object: which of the two counts, nobody could tell
nlohmann::json parse_json(std::istream& text);

}  // namespace lbm
