#include "parse_json.hpp"

#include "lbm/errors.hpp"

#include <nlohmann/json.hpp>

#include <set>
#include <string>
#include <vector>

namespace lbm {
namespace {

/// An object or a list that is being read.
struct Level {
    std::string path;            ///< of the object or list
    std::set<std::string> keys;  ///< so far, of an object
    std::string key{};           ///< of the value that comes next, of an object
    int index = 0;               ///< the same, of a list
    bool is_list = false;

    std::string path_of_next() const
    {
        if (is_list) return path + "[" + std::to_string(index) + "]";
        return path.empty() ? key : path + "." + key;
    }
};

}  // namespace

nlohmann::json parse_json(std::istream& text)
{
    using Event = nlohmann::json::parse_event_t;
    std::vector<Level> levels;
    return nlohmann::json::parse(text, [&](int, Event event, nlohmann::json& parsed) {
        switch (event) {
        case Event::object_start:
        case Event::array_start:
            levels.push_back({levels.empty() ? "" : levels.back().path_of_next(), {}});
            levels.back().is_list = event == Event::array_start;
            break;
        case Event::key:
            levels.back().key = parsed.get<std::string>();
            if (!levels.back().keys.insert(levels.back().key).second)
                throw ConfigError(levels.back().path_of_next() + ": stands twice; leave one of them");
            break;
        case Event::object_end:
        case Event::array_end:
            levels.pop_back();
            [[fallthrough]];
        case Event::value:
            if (!levels.empty()) ++levels.back().index;
            break;
        }
        return true;
    });
}

}  // namespace lbm
