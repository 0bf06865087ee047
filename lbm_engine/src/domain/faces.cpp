#include "domain/faces.hpp"

#include "lattice/vec3.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace lbm {
namespace {

constexpr int kAlongX = 1;  // the subset of axes that is x alone

bool bounces(FaceType type) { return type == FaceType::no_slip || type == FaceType::velocity; }

template <class L>
int direction(const std::array<int, 3>& c)
{
    int i = 0;
    while (c[0] != L::c[i][0] || c[1] != L::c[i][1] || c[2] != L::c[i][2]) ++i;
    return i;
}

/**
 * The velocity of what a link bounces back from. Along the normal of each face it crosses, that face's own, so that the flux through
 * every face is as prescribed; a pressure face leaves its normal to the others. Else the mean of those that bounce, nothing where a pressure face
 * forbids tangential velocity.
 */
Vec3 wall_velocity(const std::array<int, 3>& crossed, const std::array<FaceCondition, 6>& conditions)
{
    Vec3 sum{}, u{};
    int walls = 0;
    bool pressure = false;
    for (const int face : crossed) {
        if (face < 0) continue;
        pressure = pressure || conditions[face].type == FaceType::pressure;
        if (!bounces(conditions[face].type)) continue;
        sum += conditions[face].velocity;
        ++walls;
    }
    for (int d = 0; d < 3; ++d) {
        const FaceType type = crossed[d] < 0 ? FaceType::periodic : conditions[crossed[d]].type;
        if (type == FaceType::periodic) u[d] = pressure ? 0 : sum[d] / walls;
        else if (type == FaceType::pressure) u[d] = sum[d] / walls;
        else u[d] = conditions[crossed[d]].velocity[d];
    }
    return u;
}

}  // namespace

template <class L>
Faces::Faces(const Layout<L>& layout, const std::array<FaceCondition, 6>& conditions, bool inertia)
    : stride_{1, layout.row, layout.plane}
{
    std::array<int, 6> mouth_of{};
    for (int face = 0; face < 6; ++face) {
        types_[face] = conditions[face].type;
        mouth_of[face] = -1;
        if (types_[face] != FaceType::pressure || !inertia) continue;
        mouth_of[face] = static_cast<int>(mouths_.size());
        Mouth mouth{face / 2, layout.n, {}, 1 + conditions[face].pressure, {}};
        mouth.extent[mouth.axis] = 1;
        mouth.dynamic.assign(static_cast<std::size_t>(mouth.extent[0]) * mouth.extent[1] * mouth.extent[2], 0.0);
        std::array<int, 3> cell{};
        if (face % 2) cell[mouth.axis] = layout.n[mouth.axis] - 1;
        for (int i = 1; i < L::Q; ++i)
            if (L::c[i][mouth.axis] == (face % 2 ? -1 : 1)) {
                const Slot inner = layout.slot(i, cell[0], cell[1], cell[2]);
                mouth.ends.push_back({layout.incoming(i, cell[0], cell[1], cell[2], true), inner});
            }
        mouths_.push_back(std::move(mouth));
    }
    for (int i = 1; i < L::Q; ++i) {
        // f_i comes in across each non-empty subset of the axes along which it moves.
        for (int subset = 1; subset < 8; ++subset) {
            Links links{};
            std::array<int, 3>& to = links.to_cell;
            std::array<int, 3> from{}, back{};  // where the source's particle leaves the box, and minus its direction
            bool moves = true, reversed = false;
            int pressures = 0, mouth = -1;
            double pressure = 0;
            links.extent = layout.n;
            for (int d = 0; d < 3; ++d) {
                const int c = L::c[i][d];
                links.c[d] = c;
                links.face[d] = -1;
                if (subset >> d & 1) {
                    if (c == 0) moves = false;
                    const int face = 2 * d + (c > 0 ? 0 : 1);
                    const FaceType type = conditions[face].type;
                    links.face[d] = face;
                    links.extent[d] = 1;
                    to[d] = c > 0 ? 0 : layout.n[d] - 1;
                    from[d] = type == FaceType::periodic ? layout.n[d] - 1 - to[d] : to[d];
                    back[d] = type == FaceType::periodic ? -c : c;
                    reversed = reversed || bounces(type);
                    if (type == FaceType::pressure) {
                        ++pressures;
                        pressure += conditions[face].pressure;
                        mouth = mouth_of[face];
                    }
                } else {
                    // Next to an edge, links across this face alone lead into its inner part.
                    to[d] = c > 0 ? 1 : 0;
                    links.extent[d] = layout.n[d] - (c == 0 ? 0 : 1);
                    from[d] = to[d] - c;
                    back[d] = -c;
                }
            }
            if (!moves) continue;
            const auto ends = [&](int k, const std::array<int, 3>& x) {
                return Ends{layout.incoming(k, x[0], x[1], x[2], true), layout.slot(k, x[0], x[1], x[2])};
            };
            links.w = L::w(i);
            links.to = ends(i, to);
            links.from_cell = reversed ? to : from;
            links.from = reversed ? links.to : ends(direction<L>(back), from);
            links.sign = 1;
            links.bounces = reversed;
            links.mouth = -1;
            if (reversed) {
                links.wall_velocity = wall_velocity(links.face, conditions);
                for (int d = 0; d < 3; ++d) links.gain += 6 * links.w * links.c[d] * links.wall_velocity[d];
            } else if (pressures % 2) {
                links.sign = -1;
                links.gain = 2 * links.w * pressure / pressures;
                if (pressures == 1) links.mouth = mouth;
            }
            (subset == kAlongX ? x_links_ : links_).push_back(links);
        }
    }
}

template <class Body>
void Faces::for_links(const Links& links, Body body) const
{
    const int nx = links.extent[0], ny = links.extent[1], nz = links.extent[2];
    const bool threads = static_cast<Slot>(nx) * ny * nz > 4096;
#pragma omp parallel for collapse(2) schedule(static) if (threads)
    for (int z = 0; z < nz; ++z)
        for (int y = 0; y < ny; ++y) {
            const Slot at = z * stride_[2] + y * stride_[1];
            for (int x = 0; x < nx; ++x) body(at + x, x, y, z);
        }
}

template <class T>
void Faces::stream_row(T* f, int y, int z, bool odd) const
{
    for (const Links& links : x_links_) {
        const int j = y - links.from_cell[1], k = z - links.from_cell[2];
        if (j < 0 || j >= links.extent[1] || k < 0 || k >= links.extent[2]) continue;
        const Slot at = k * stride_[2] + j * stride_[1];
        f[links.to.in(odd) + at] =
            static_cast<T>(links.sign) * f[links.from.out(odd) + at] + static_cast<T>(links.gain);
    }
}

template <class T>
void Faces::stream(T* f, bool odd)
{
    for (const Links& links : links_) {
        T* const in = f + links.to.in(odd);
        const T* const out = f + links.from.out(odd);
        const T sign = static_cast<T>(links.sign), gain = static_cast<T>(links.gain);
        for_links(links, [=](Slot at, int, int, int) { in[at] = sign * out[at] + gain; });
    }
    if (!mouths_.empty()) see_dynamic_pressure(f, odd);
}

double Faces::dynamic_gain(const Links& links, int x, int y, int z) const
{
    const Mouth& mouth = mouths_[links.mouth];
    const auto& [a, b] = std::tie(links.to_cell, links.from_cell);
    return links.w * (mouth.dynamic[mouth.index(a[0] + x, a[1] + y, a[2] + z)] +
                      mouth.dynamic[mouth.index(b[0] + x, b[1] + y, b[2] + z)]);
}

/**
 * Half-way between in and out the even part is that of the equilibrium, with u normal to the face: w (drho + 3 rho u_n^2) for each link. What enters comes from a
 * fluid at rest at the given pressure (Bernoulli): drho is 3/2 rho u_n^2 lower then. (The given pressure itself would feed sound with the energy of the
 * inflow.) The flux j = rho u_n through the face is the sum of out - in, and what is added to `in` lowers it by j^2 / rho, by half of that
 * where it enters: a quadratic equation for j.
 */
template <class T>
void Faces::see_dynamic_pressure(T* f, bool odd)
{
    for (Mouth& mouth : mouths_) {
        const int nx = mouth.extent[0], ny = mouth.extent[1], nz = mouth.extent[2];
#pragma omp parallel for collapse(2) schedule(static) if (static_cast <Slot>(nx) * ny * nz > 4096)
        for (int z = 0; z < nz; ++z)
            for (int y = 0; y < ny; ++y)
                for (int x = 0; x < nx; ++x) {
                    const Slot at = z * stride_[2] + y * stride_[1] + x;
                    double flux = 0;
                    for (const Ends& ends : mouth.ends) flux += f[ends.out(odd) + at] - f[ends.in(odd) + at];
                    const double part = flux > 0 ? 1 : 0.5;
                    const double j = 2 * flux / (1 + std::sqrt(std::max(0.0, 1 + 4 * part * flux / mouth.rho)));
                    mouth.dynamic[mouth.index(x, y, z)] = 3 * part * j * j / mouth.rho;
                }
    }
    for (const auto* all : {&x_links_, &links_})
        for (const Links& links : *all) {
            if (links.mouth < 0) continue;
            T* const in = f + links.to.in(odd);
            for_links(links,
                      [&](Slot at, int x, int y, int z) { in[at] += static_cast<T>(dynamic_gain(links, x, y, z)); });
        }
}

void Faces::take_over(const Faces& before, double scale)
{
    for (std::size_t m = 0; m < mouths_.size(); ++m)
        for (std::size_t i = 0; i < mouths_[m].dynamic.size(); ++i)
            mouths_[m].dynamic[i] = scale * before.mouths_[m].dynamic[i];
}

template <class T>
void Faces::restore(T* f, bool odd) const
{
    for (const auto* all : {&x_links_, &links_})
        for (const Links& links : *all) {
            const T* const in = f + links.to.in(odd);
            T* const out = f + links.from.out(odd);
            for_links(links, [&](Slot at, int x, int y, int z) {
                const double gain = links.gain + (links.mouth < 0 ? 0 : dynamic_gain(links, x, y, z));
                out[at] = static_cast<T>(links.sign * (in[at] - gain));
            });
        }
}

template <class T>
std::array<Faces::Passage, 6> Faces::passages(const T* f, bool odd,
                                              const std::function<double(int, int, int)>& drho) const
{
    std::array<Passage, 6> sums{};
    for (const auto* all : {&x_links_, &links_})
        for (const Links& links : *all) {
            const int crossed = (links.face[0] >= 0) + (links.face[1] >= 0) + (links.face[2] >= 0);
            for (int z = 0; z < links.extent[2]; ++z)
                for (int y = 0; y < links.extent[1]; ++y)
                    for (int x = 0; x < links.extent[0]; ++x) {
                        const Slot at = z * stride_[2] + y * stride_[1] + x;
                        const auto& cell = links.to_cell;
                        const double rho = crossed > 1 ? drho(cell[0] + x, cell[1] + y, cell[2] + z) : 0;
                        const Vec3 place{cell[0] + x + 0.5 - 0.5 * links.c[0], cell[1] + y + 0.5 - 0.5 * links.c[1],
                                         cell[2] + z + 0.5 - 0.5 * links.c[2]};
                        share(links, place, f[links.to.out(odd) + at], f[links.to.in(odd) + at], rho, sums);
                    }
        }
    return sums;
}

void Faces::share(const Links& links, const Vec3& place, double out, double in, double drho,
                  std::array<Passage, 6>& sums) const
{
    std::array<int, 3> walls{}, periodic{},
        bearers{};  // crossed, as flags per axis; bearers: of more than the pressure on a normal
    int pressures = 0;
    for (int d = 0; d < 3; ++d) {
        if (links.face[d] < 0) continue;
        const FaceType type = types_[links.face[d]];
        periodic[d] = type == FaceType::periodic;
        walls[d] = !periodic[d];
        pressures += type == FaceType::pressure;
    }
    for (int d = 0; d < 3; ++d) {
        const FaceType type = walls[d] ? types_[links.face[d]] : FaceType::periodic;
        bearers[d] = links.bounces ? bounces(type) : pressures > 0 ? type == FaceType::pressure : walls[d];
    }
    const auto count = [](const std::array<int, 3>& flags) { return flags[0] + flags[1] + flags[2]; };
    const auto add = [&](int d) -> Passage& { return sums[links.face[d]]; };

    double volume = out - in;
    for (int d = 0; d < 3; ++d)
        if (links.bounces && walls[d]) {
            const double through = -6 * links.w * links.c[d] * links.wall_velocity[d];
            add(d).volume += through;
            volume -= through;
        }
    const bool passes = !links.bounces && pressures == 0 && count(periodic) > 0;
    for (int d = 0; d < 3; ++d)
        if (passes && periodic[d]) add(d).volume += volume;
        else if (!passes && bearers[d]) add(d).volume += volume / count(bearers);

    const auto give = [&](int e, int d, double momentum) {
        Passage& face = add(e);
        face.momentum[d] += momentum;
        const int b = (d + 1) % 3, c = (d + 2) % 3;
        face.moment[b] += place[c] * momentum;
        face.moment[c] -= place[b] * momentum;
    };
    for (int d = 0; d < 3; ++d) {
        double momentum = count(walls) > 0 ? -links.c[d] * (out + in) : 0;
        if (walls[d]) {
            const bool whole = count(walls) == 1 || types_[links.face[d]] == FaceType::free_slip;
            const double normal = whole ? momentum : -2 * links.w * links.c[d] * drho;
            give(d, d, normal);
            momentum -= normal;
        }
        for (int e = 0; e < 3; ++e)
            if (bearers[e]) give(e, d, momentum / count(bearers));
    }
}

// NOLINTBEGIN(bugprone-macro-parentheses)
#define LBM_FACES_OF(T)                                                                                                \
    template void Faces::stream_row(T*, int, int, bool) const;                                                         \
    template void Faces::stream(T*, bool);                                                                             \
    template void Faces::restore(T*, bool) const;                                                                      \
    template std::array<Faces::Passage, 6> Faces::passages(const T*, bool,                                             \
                                                           const std::function<double(int, int, int)>&) const;
LBM_FACES_OF(double)
LBM_FACES_OF(float)
#undef LBM_FACES_OF
// NOLINTEND(bugprone-macro-parentheses)
template Faces::Faces(const Layout<D3Q19>&, const std::array<FaceCondition, 6>&, bool);
template Faces::Faces(const Layout<D3Q27>&, const std::array<FaceCondition, 6>&, bool);

}  // namespace lbm
