#include "output/vtk.hpp"

#include "lattice/message.hpp"

#include <bit>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <system_error>

namespace lbm {
namespace {

/// The file behind symbolic links, so that they are kept.
std::filesystem::path where_links_lead(const std::string& path)
{
    std::error_code failed;
    const auto canonical = std::filesystem::weakly_canonical(path, failed);
    return failed ? std::filesystem::path(path) : canonical;
}

/// A file is replaced as a whole once all is written; devices and pipes (/dev/null) are written as they are.
bool is_replaced(const std::filesystem::path& path)
{
    std::error_code failed;
    const auto status = std::filesystem::status(path, failed);
    return !std::filesystem::exists(status) || std::filesystem::is_regular_file(status);
}

}  // namespace

void write_vti(const std::string& path, const std::array<int, 3>& cells, const Vec3& lower, double dx,
               const std::vector<CellField>& fields)
{
    const std::filesystem::path target = where_links_lead(path);
    const std::filesystem::path partial =
        is_replaced(target) ? std::filesystem::path(target).concat(".partial") : target;
    std::ofstream out(partial, std::ios::binary);
    out.precision(15);  // a box may stand far from the origin
    const std::string extent = message("0 ", cells[0], " 0 ", cells[1], " 0 ", cells[2]);
    out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\""
        << (std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian") << "\" header_type=\"UInt64\">\n"
        << "<ImageData WholeExtent=\"" << extent << "\" Origin=\"" << lower[0] << ' ' << lower[1] << ' ' << lower[2]
        << "\" Spacing=\"" << dx << ' ' << dx << ' ' << dx << "\">\n<Piece Extent=\"" << extent << "\">\n<CellData>\n";
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
    std::error_code failed, ignored;
    if (out && partial != target) std::filesystem::rename(partial, target, failed);
    if (!out || failed) {
        if (partial != target) std::filesystem::remove(partial, ignored);
        throw RunError(message("cannot write ", path, ": check that its folder exists, is writable and has room"));
    }
}

}  // namespace lbm
