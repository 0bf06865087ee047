#pragma once

#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace lbm::test {

/**
 * The rows of a table of tests/reference: lines with # are notes, the first other line names the columns.
 * @throws std::runtime_error  if there is no such table
 */
inline std::vector<std::map<std::string, std::string>> reference_table(const std::string& name)
{
    std::ifstream in(std::string(LBM_REFERENCE_FOLDER) + "/" + name);
    if (!in) throw std::runtime_error(name + ": not among the reference tables");
    const auto split = [](const std::string& line) {
        std::vector<std::string> words;
        std::istringstream words_of(line);
        for (std::string word; std::getline(words_of, word, ',');) words.push_back(word);
        return words;
    };
    std::vector<std::string> columns;
    std::vector<std::map<std::string, std::string>> rows;
    for (std::string line; std::getline(in, line);) {
        if (line.empty() || line[0] == '#') continue;
        const auto words = split(line);
        if (columns.empty()) {
            columns = words;
            continue;
        }
        auto& row = rows.emplace_back();
        for (std::size_t i = 0; i < columns.size() && i < words.size(); ++i) row[columns[i]] = words[i];
    }
    return rows;
}

}  // namespace lbm::test
