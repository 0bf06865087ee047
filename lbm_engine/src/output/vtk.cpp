#include "output/vtk.hpp"

#include "lattice/message.hpp"

#include <bit>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>

namespace lbm {

void write_vti(const std::string& path, const std::array<int, 3>& cells, const Vec3& lower, double dx,
               const std::vector<CellField>& fields)
{
    const std::string partial = path + ".partial";
    std::ofstream out(partial, std::ios::binary);
    const std::string extent = message("0 ", cells[0], " 0 ", cells[1], " 0 ", cells[2]);
    out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\""
        << (std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian") << "\" header_type=\"UInt64\">\n"
        << "<ImageData WholeExtent=\"" << extent << "\" Origin=\"" << message(lower[0], ' ', lower[1], ' ', lower[2])
        << "\" Spacing=\"" << message(dx, ' ', dx, ' ', dx) << "\">\n<Piece Extent=\"" << extent << "\">\n<CellData>\n";
    std::uint64_t offset = 0;
    for (const CellField& field : fields) {
        out << "<DataArray type=\"Float32\" Name=\"" << field.name << "\" NumberOfComponents=\"" << field.components
            << "\" format=\"appended\" offset=\"" << offset << "\"/>\n";
        offset += sizeof(std::uint64_t) + field.values->size() * sizeof(float);
    }
    out << "</CellData>\n</Piece>\n</ImageData>\n<AppendedData encoding=\"raw\">\n_";
    for (const CellField& field : fields) {
        const std::vector<float> values(field.values->begin(), field.values->end());
        const std::uint64_t bytes = values.size() * sizeof(float);
        out.write(reinterpret_cast<const char*>(&bytes), sizeof(bytes));
        out.write(reinterpret_cast<const char*>(values.data()), static_cast<std::streamsize>(bytes));
    }
    out << "\n</AppendedData>\n</VTKFile>\n";
    out.close();
    std::error_code failed;
    if (out) std::filesystem::rename(partial, path, failed);
    if (!out || failed) {
        std::remove(partial.c_str());
        throw RunError(message("cannot write ", path, ": check that its folder exists, is writable and has room"));
    }
}

}  // namespace lbm
