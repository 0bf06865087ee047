#include "domain/faces.hpp"

#include "lattice/vec3.hpp"

namespace lbm {
namespace {

constexpr int kAlongX = 1;  // the subset of axes that is x alone

}  // namespace

template <class L>
Faces::Faces(const Layout<L>& layout, const std::array<FaceCondition, 6>& conditions)
    : stride_{1, layout.row, layout.plane}
{
    for (int i = 1; i < L::Q; ++i) {
        const auto& c = L::c[i];
        // f_i comes in across each non-empty subset of the axes along which it moves.
        for (int subset = 1; subset < 8; ++subset) {
            std::array<int, 3> ghost{}, wrapped{}, extent = layout.n;
            Vec3 wall_velocity{};
            int walls = 0;
            bool moves = true;
            for (int d = 0; d < 3; ++d) {
                if (subset >> d & 1) {
                    if (c[d] == 0) moves = false;
                    const FaceCondition& face = conditions[2 * d + (c[d] > 0 ? 0 : 1)];
                    ghost[d] = c[d] > 0 ? -1 : layout.n[d];
                    wrapped[d] = c[d] > 0 ? layout.n[d] - 1 : 0;
                    extent[d] = 1;
                    if (face.type != FaceType::periodic) {
                        ++walls;
                        wall_velocity += face.velocity;
                    }
                } else {
                    // Ghosts next to an edge of this face send into the box along its inner part only.
                    ghost[d] = wrapped[d] = c[d] < 0 ? 1 : 0;
                    extent[d] = layout.n[d] - (c[d] == 0 ? 0 : 1);
                }
            }
            if (!moves) continue;
            const int back = L::opposite(i);
            const Slot outside = layout.slot(back, ghost[0], ghost[1], ghost[2]);
            const Slot across = layout.slot(back, wrapped[0], wrapped[1], wrapped[2]);
            const Slot reflected = layout.slot(i, ghost[0] + c[0], ghost[1] + c[1], ghost[2] + c[2]);
            const double push = c[0] * wall_velocity[0] + c[1] * wall_velocity[1] + c[2] * wall_velocity[2];
            const Links links{outside,
                              walls ? reflected : across,
                              ghost,
                              extent,
                              L::c[i],
                              walls > 0,
                              walls ? 6 * L::w(i) * push / walls : 0.0};
            (subset == kAlongX ? x_links_ : links_).push_back(links);
        }
    }
}

template <class T, class Move>
void Faces::for_links(const std::vector<Links>& all, const std::array<Slot, 3>& stride, T* f, Move move)
{
    for (const Links& links : all) {
        const int nx = links.extent[0], ny = links.extent[1], nz = links.extent[2];
        const bool threads = static_cast<Slot>(nx) * ny * nz > 4096;
#pragma omp parallel for collapse(2) schedule(static) if (threads)
        for (int z = 0; z < nz; ++z)
            for (int y = 0; y < ny; ++y) {
                const Slot at = z * stride[2] + y * stride[1];
                T* const ghost = f + links.ghost + at;
                T* const partner = f + links.partner + at;
                for (int x = 0; x < nx; ++x) move(ghost[x], partner[x], static_cast<T>(links.gain));
            }
    }
}

template <class T, class Move>
void Faces::for_links_of_row(T* f, int y, int z, bool fill, Move move) const
{
    for (const Links& links : x_links_) {
        // The row of the cell that the link leads into; to fill across the box, the row itself, whose far end is the source.
        const bool own = fill && !links.wall;
        const int j = y - links.first[1] - (own ? 0 : links.c[1]), k = z - links.first[2] - (own ? 0 : links.c[2]);
        if (j < 0 || j >= links.extent[1] || k < 0 || k >= links.extent[2]) continue;
        const Slot at = k * stride_[2] + j * stride_[1];
        move(f[links.ghost + at], f[links.partner + at], static_cast<T>(links.gain));
    }
}

namespace {

constexpr auto kFill = [](auto& ghost, const auto& partner, auto gain) { ghost = partner + gain; };
constexpr auto kDrain = [](const auto& ghost, auto& partner, auto gain) { partner = ghost + gain; };

}  // namespace

template <class T>
void Faces::fill_row(T* f, int y, int z) const
{
    for_links_of_row(f, y, z, true, kFill);
}

template <class T>
void Faces::drain_row(T* f, int y, int z) const
{
    for_links_of_row(f, y, z, false, kDrain);
}

template <class T>
void Faces::fill(T* f) const
{
    for_links(links_, stride_, f, kFill);
}

template <class T>
void Faces::drain(T* f) const
{
    for_links(links_, stride_, f, kDrain);
}

template <class T>
void Faces::restore(T* f, bool odd) const
{
    for (const auto* all : {&x_links_, &links_}) {
        if (odd) for_links(*all, stride_, f, [](const T& ghost, T& partner, T gain) { partner = ghost - gain; });
        else for_links(*all, stride_, f, [](T& ghost, const T& partner, T gain) { ghost = partner - gain; });
    }
}

template Faces::Faces(const Layout<D3Q19>&, const std::array<FaceCondition, 6>&);
template Faces::Faces(const Layout<D3Q27>&, const std::array<FaceCondition, 6>&);
template void Faces::fill_row(double*, int, int) const;
template void Faces::drain_row(double*, int, int) const;
template void Faces::fill(double*) const;
template void Faces::drain(double*) const;
template void Faces::restore(double*, bool) const;
template void Faces::fill_row(float*, int, int) const;
template void Faces::drain_row(float*, int, int) const;
template void Faces::fill(float*) const;
template void Faces::drain(float*) const;
template void Faces::restore(float*, bool) const;

}  // namespace lbm
