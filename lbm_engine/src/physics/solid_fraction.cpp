#include "physics/solid_fraction.hpp"

#include "physics/box_fraction.hpp"

#include <algorithm>
#include <cmath>

namespace lbm {
namespace {

/// Surfaces this close to a plane of the lattice lie on it [cells].
constexpr double kOnLattice = 1e-6;

/// Lines through a cell along each of two axes.
constexpr int kLines = 8;

/// A piece of a line along x; empty where begin >= end.
struct Interval {
    double begin, end;
    double length() const { return std::max(0.0, end - begin); }
};

Interval overlap(const Interval& a, const Interval& b) { return {std::max(a.begin, b.begin), std::min(a.end, b.end)}; }

constexpr Interval kNothing{0, 0};

/// Where a line along x through (y, z) runs inside a sphere or a box.
Interval inside(const SolidGeometry& solid, double y, double z)
{
    const double ry = y - solid.centre[1], rz = z - solid.centre[2];
    if (solid.shape == Shape::sphere) {
        const double rest = solid.radius * solid.radius - ry * ry - rz * rz;
        if (rest <= 0) return kNothing;
        const double half = std::sqrt(rest);
        return {solid.centre[0] - half, solid.centre[0] + half};
    }
    Interval within{-1e12, 1e12};
    for (int a = 0; a < 3; ++a) {
        const Vec3& e = solid.axes[a];
        const double across = e[1] * ry + e[2] * rz, h = solid.half_extents[a];
        if (std::abs(e[0]) < 1e-14) {
            if (std::abs(across) > h) return kNothing;
            continue;
        }
        const double s = (-h - across) / e[0], t = (h - across) / e[0];
        within = overlap(within, {solid.centre[0] + std::min(s, t), solid.centre[0] + std::max(s, t)});
    }
    return within;
}

/// Length of `mine` that the union of others leaves, within a cell. Intervals of a few others: sorted as they come.
double left_over(const Interval& mine, std::vector<Interval>& others)
{
    std::sort(others.begin(), others.end(), [](const Interval& a, const Interval& b) { return a.begin < b.begin; });
    double left = mine.length(), reached = mine.begin;
    for (const Interval& other : others) {
        const Interval hidden = overlap(mine, {std::max(other.begin, reached), other.end});
        left -= hidden.length();
        reached = std::max(reached, other.end);
    }
    return left;
}

/// Calls body(y, z) for lines through the middles of equal parts of a cell.
template <class Body>
void for_lines(int y, int z, Body body)
{
    for (int k = 0; k < kLines; ++k)
        for (int j = 0; j < kLines; ++j) body(y + (j + 0.5) / kLines, z + (k + 0.5) / kLines);
}

/// Area that a disc at the origin shares with the rectangle from there to (a, b); odd in both.
double disc_area(double a, double b, double R)
{
    const double sign = (a < 0) != (b < 0) ? -1 : 1;
    a = std::min(std::abs(a), R);
    b = std::min(std::abs(b), R);
    if (a * a + b * b <= R * R) return sign * a * b;
    const auto under_arc = [R](double x) { return 0.5 * (x * std::sqrt(R * R - x * x) + R * R * std::asin(x / R)); };
    const double corner = std::sqrt(R * R - b * b);
    return sign * (corner * b + under_arc(a) - under_arc(corner));
}

/// Distances from a point to the nearest and farthest points of the cell at (x, y, z).
struct CellDistance {
    double nearest, farthest;
};

CellDistance distance(const Vec3& point, const Vec3& cell)
{
    double near2 = 0, far2 = 0;
    for (int d = 0; d < 3; ++d) {
        const double below = cell[d] - point[d], above = point[d] - (cell[d] + 1);
        const double out = std::max({below, above, 0.0}), across = std::max(-below, -above);
        near2 += out * out;
        far2 += across * across;
    }
    return {std::sqrt(near2), std::sqrt(far2)};
}

/// What a glance tells about a solid and a cell.
enum class Glance { apart, covered, unknown };

Glance glance(const SolidGeometry& solid, const Vec3& cell)
{
    const CellDistance d = distance(solid.centre, cell);
    if (solid.shape == Shape::sphere)
        return d.nearest >= solid.radius    ? Glance::apart
               : d.farthest <= solid.radius ? Glance::covered
                                            : Glance::unknown;
    return d.nearest >= norm(solid.half_extents) ? Glance::apart : Glance::unknown;
}

Vec3 nearest_point(const Vec3& cell, const Vec3& to)
{
    Vec3 p{};
    for (int d = 0; d < 3; ++d) p[d] = std::clamp(to[d], cell[d], cell[d] + 1);
    return p;
}

/// Whether a point lies in any of the solids.
bool is_hidden(const std::vector<SolidGeometry>& solids, const Vec3& p)
{
    return std::any_of(solids.begin(), solids.end(), [&](const SolidGeometry& solid) {
        const Interval line = inside(solid, p[1], p[2]);
        return line.begin <= p[0] && p[0] <= line.end && line.length() > 0;
    });
}

}  // namespace

void SolidFraction::evaluate(const SolidGeometry& solid, const std::vector<SolidGeometry>& others)
{
    Vec3 half{};
    for (int d = 0; d < 3; ++d) half[d] = half_reach(solid.axes, solid.half_extents, d);
    switch (solid.shape) {
    case Shape::sphere:
        sphere(solid);
        break;
    case Shape::box:
        is_along_axes(solid.axes) ? aligned_box(solid, half) : rotated_box(solid, half);
        break;
    case Shape::pipe:
        pipe(solid);
        break;
    }
    if (!others.empty()) leave_out(solid, others);
    if (data_ == own_.data()) find_ends();
}

void SolidFraction::find_ends()
{
    own_ends_.clear();
    for (int k = 0; k < count_[2]; ++k)
        for (int j = 0; j < count_[1]; ++j) {
            const double* const cells = row(j, k);
            RowEnds ends{0, 0, 0, count_[0]};
            while (ends.begin < ends.end && cells[ends.begin] == 0) ++ends.begin;
            while (ends.end > ends.begin && cells[ends.end - 1] == 0) --ends.end;
            ends.full_begin = static_cast<int>(std::find(cells + ends.begin, cells + ends.end, 1.0) - cells);
            ends.full_end = ends.full_begin;
            while (ends.full_end < ends.end && cells[ends.full_end] == 1) ++ends.full_end;
            own_ends_.push_back(ends);
        }
    ends_ = own_ends_.data();
}

void SolidFraction::make_own()
{
    if (data_ == own_.data()) return;
    own_.assign(data_, data_ + line_ * count_[1] * count_[2]);
    own_.resize(own_.size() + kReadAhead);
    data_ = own_.data();
}

void SolidFraction::sphere(const SolidGeometry& solid)
{
    sphere_.evaluate(solid.centre, solid.radius);
    first_ = sphere_.first();
    count_ = sphere_.count();
    data_ = sphere_.row(0, 0);
    ends_ = sphere_.ends();
    line_ = sphere_.line();
}

/// Cells around the centre; those of the lattice only where it ends, and all of a periodic axis that the solid fills.
void SolidFraction::bounds(const Vec3& centre, const Vec3& half)
{
    for (int d = 0; d < 3; ++d) {
        if (periodic_[d] && 2 * half[d] >= n_[d] - kOnLattice) {
            first_[d] = 0;
            count_[d] = n_[d];
            continue;
        }
        double begin = std::floor(centre[d] - half[d] + kOnLattice);
        double end = std::ceil(centre[d] + half[d] - kOnLattice);
        if (!periodic_[d]) {  // a box may be longer than integers reach
            begin = std::clamp(begin, 0.0, static_cast<double>(n_[d]));
            end = std::clamp(end, begin, static_cast<double>(n_[d]));
        }
        first_[d] = static_cast<int>(begin);
        count_[d] = static_cast<int>(end - begin);
    }
    line_ = count_[0];
    own_.assign(static_cast<std::size_t>(count_[0]) * count_[1] * count_[2] + kReadAhead, 0.0);
    data_ = own_.data();
}

void SolidFraction::aligned_box(const SolidGeometry& solid, const Vec3& half)
{
    bounds(solid.centre, half);
    for (int d = 0; d < 3; ++d) {
        const bool fills = periodic_[d] && 2 * half[d] >= n_[d] - kOnLattice;
        const Interval extent{solid.centre[d] - half[d], solid.centre[d] + half[d]};
        axis_[d].resize(count_[d]);
        for (int i = 0; i < count_[d]; ++i) {
            const double x = first_[d] + i;
            const double part = fills ? 1.0 : overlap(extent, {x, x + 1}).length();
            axis_[d][i] = part < kOnLattice ? 0 : part > 1 - kOnLattice ? 1 : part;
        }
    }
    for (int k = 0; k < count_[2]; ++k)
        for (int j = 0; j < count_[1]; ++j)
            for (int i = 0; i < count_[0]; ++i) own_row(j, k)[i] = axis_[0][i] * axis_[1][j] * axis_[2][k];
}

void SolidFraction::rotated_box(const SolidGeometry& solid, const Vec3& half)
{
    bounds(solid.centre, half);
    for (int k = 0; k < count_[2]; ++k)
        for (int j = 0; j < count_[1]; ++j)
            for (int i = 0; i < count_[0]; ++i)
                own_row(j, k)[i] =
                    box_fraction(solid, {double(first_[0] + i), double(first_[1] + j), double(first_[2] + k)});
}

void SolidFraction::pipe(const SolidGeometry& solid)
{
    const double all = 2.0 * std::max({n_[0], n_[1], n_[2]});
    bounds({0.5 * n_[0], 0.5 * n_[1], 0.5 * n_[2]}, {all, all, all});
    const int p = (solid.axis + 1) % 3, q = (solid.axis + 2) % 3;
    const double R = solid.radius;
    const auto bore = [&](int i, int j) {
        const double a = i - solid.centre[p], b = j - solid.centre[q];
        return disc_area(a + 1, b + 1, R) - disc_area(a, b + 1, R) - disc_area(a + 1, b, R) + disc_area(a, b, R);
    };
    std::vector<double> section(static_cast<std::size_t>(n_[p]) * n_[q]);
    for (int j = 0; j < n_[q]; ++j)
        for (int i = 0; i < n_[p]; ++i) section[static_cast<std::size_t>(j) * n_[p] + i] = 1 - bore(i, j);
    for (double& fraction : section) fraction = fraction < kOnLattice ? 0 : fraction > 1 - kOnLattice ? 1 : fraction;
    std::array<int, 3> at{};
    for (at[2] = 0; at[2] < n_[2]; ++at[2])
        for (at[1] = 0; at[1] < n_[1]; ++at[1])
            for (at[0] = 0; at[0] < n_[0]; ++at[0])
                own_row(at[1], at[2])[at[0]] = section[static_cast<std::size_t>(at[q]) * n_[p] + at[p]];
}

SolidGeometry SolidFraction::nearest_image(const SolidGeometry& other, const Vec3& centre) const
{
    SolidGeometry image = other;
    for (int d = 0; d < 3; ++d)
        if (periodic_[d]) image.centre[d] -= n_[d] * std::round((other.centre[d] - centre[d]) / n_[d]);
    return image;
}

/**
 * Takes the others' volume off. A cut cell keeps the part of its exact fraction that its lines say is left: so a solid without overlap keeps all,
 * and one that lies within another keeps nothing, exactly.
 */
void SolidFraction::leave_out(const SolidGeometry& solid, const std::vector<SolidGeometry>& others)
{
    make_own();
    std::vector<SolidGeometry> near;
    near.reserve(others.size());
    for (const SolidGeometry& other : others) near.push_back(nearest_image(other, solid.centre));
    std::vector<Interval> hidden;
    for (int k = 0; k < count_[2]; ++k)
        for (int j = 0; j < count_[1]; ++j) {
            double* const fraction = own_row(j, k);
            const int y = first_[1] + j, z = first_[2] + k;
            for (int i = 0; i < count_[0]; ++i) {
                if (fraction[i] == 0) continue;
                const double x = first_[0] + i;
                bool touched = false, covered = false;
                for (const SolidGeometry& other : near) {
                    const Glance g = glance(other, {x, double(y), double(z)});
                    touched = touched || g != Glance::apart;
                    covered = covered || g == Glance::covered;
                }
                if (covered) fraction[i] = 0;
                if (covered || !touched) continue;
                double mine = 0, left = 0;
                for_lines(y, z, [&](double line_y, double line_z) {
                    const Interval own = overlap(inside(solid, line_y, line_z), {x, x + 1});
                    if (own.length() == 0) return;
                    hidden.clear();
                    for (const SolidGeometry& other : near) hidden.push_back(inside(other, line_y, line_z));
                    mine += own.length();
                    left += left_over(own, hidden);
                });
                if (mine == 0) left = is_hidden(near, nearest_point({x, double(y), double(z)}, solid.centre)) ? 0 : 1;
                const double part = mine > 0 ? left / mine : left;
                fraction[i] *= part < 1e-12 ? 0 : part;
            }
        }
}

}  // namespace lbm
