#include "domain/faces.hpp"

#include "lattice/vec3.hpp"

namespace lbm {

Faces::Faces(const Layout& layout, const std::array<FaceCondition, 6>& conditions)
    : stride_{1, layout.row, layout.plane}
{
    for (int i = 1; i < D3Q19::Q; ++i) {
        const auto& c = D3Q19::c[i];
        // f_i comes in across each non-empty subset of the axes along which it moves.
        for (int subset = 1; subset < 8; ++subset) {
            Links links{0, 0, layout.n, 0};
            std::array<int, 3> ghost{}, wrapped{};
            Vec3 wall_velocity{};
            int walls = 0;
            bool moves = true;
            for (int d = 0; d < 3; ++d) {
                if (subset >> d & 1) {
                    if (c[d] == 0) moves = false;
                    const FaceCondition& face = conditions[2 * d + (c[d] > 0 ? 0 : 1)];
                    ghost[d] = c[d] > 0 ? -1 : layout.n[d];
                    wrapped[d] = c[d] > 0 ? layout.n[d] - 1 : 0;
                    links.extent[d] = 1;
                    if (face.type != FaceType::periodic) {
                        ++walls;
                        wall_velocity += face.velocity;
                    }
                } else {
                    // Ghosts next to an edge of this face send into the box along its inner part only.
                    ghost[d] = wrapped[d] = c[d] < 0 ? 1 : 0;
                    links.extent[d] = layout.n[d] - (c[d] == 0 ? 0 : 1);
                }
            }
            if (!moves) continue;
            const int back = D3Q19::opposite(i);
            links.ghost = layout.slot(back, ghost[0], ghost[1], ghost[2]);
            if (walls == 0) {
                links.partner = layout.slot(back, wrapped[0], wrapped[1], wrapped[2]);
            } else {
                links.partner = layout.slot(i, ghost[0] + c[0], ghost[1] + c[1], ghost[2] + c[2]);
                links.gain = 6 * D3Q19::w(i) / walls *
                             (c[0] * wall_velocity[0] + c[1] * wall_velocity[1] + c[2] * wall_velocity[2]);
            }
            links_.push_back(links);
        }
    }
}

template <class T, class Move>
void Faces::for_links(T* f, Move move) const
{
    for (const Links& links : links_) {
        const int nx = links.extent[0], ny = links.extent[1], nz = links.extent[2];
        const bool threads = static_cast<Layout::Index>(nx) * ny * nz > 4096;
#pragma omp parallel for collapse(2) schedule(static) if (threads)
        for (int z = 0; z < nz; ++z)
            for (int y = 0; y < ny; ++y) {
                const Layout::Index at = z * stride_[2] + y * stride_[1];
                T* const ghost = f + links.ghost + at;
                T* const partner = f + links.partner + at;
                for (int x = 0; x < nx; ++x) move(ghost[x], partner[x], static_cast<T>(links.gain));
            }
    }
}

template <class T>
void Faces::fill(T* f) const
{
    for_links(f, [](T& ghost, const T& partner, T gain) { ghost = partner + gain; });
}

template <class T>
void Faces::drain(T* f) const
{
    for_links(f, [](const T& ghost, T& partner, T gain) { partner = ghost + gain; });
}

template void Faces::fill(double*) const;
template void Faces::fill(float*) const;
template void Faces::drain(double*) const;
template void Faces::drain(float*) const;

}  // namespace lbm
