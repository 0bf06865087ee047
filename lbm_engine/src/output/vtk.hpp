#pragma once

#include "lbm/solid.hpp"

#include <array>
#include <string>
#include <vector>

namespace lbm {

/// A field of cell values, x fastest, with its components per cell.
struct CellField {
    std::string name;
    int components;
    const std::vector<double>* values;
};

/**
 * Writes cell data as VTK image data (.vti, appended raw binary, single precision), as ParaView and PyVista read it. The file
 * appears under its name only when it is complete.
 * @throws RunError if it cannot be written
 */
void write_vti(const std::string& path, const std::array<int, 3>& cells, const Vec3& lower, double dx,
               const std::vector<CellField>& fields);

}  // namespace lbm
