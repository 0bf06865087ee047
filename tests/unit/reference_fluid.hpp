#pragma once

#include "lattice/d3q19.hpp"
#include "lattice/vec3.hpp"
#include "lbm/fluid_config.hpp"
#include "physics/rates.hpp"
#include "physics/sphere_fraction.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace lbm::test {

/**
 * The plain twin of the engine: two grids, one cell after the other, formulas as on the physics page. Lattice units. It is
 * checkable by hand and slow; the engine must agree with it.
 */
template <class L>
class ReferenceFluid {
public:
    struct Load {
        Vec3 force{}, torque{}, inside{}, angular_inside{};
        double coupling = 0;
    };

    /// The configuration must be in lattice units: dx = 1, density = 1, viscosity = (tau - 1/2) / 3.
    explicit ReferenceFluid(const FluidConfig& c)
        : c_(c)
        , f_(L::Q, std::vector<double>(static_cast<std::size_t>(c.cells[0]) * c.cells[1] * c.cells[2], 0.0))
        , next_(f_)
        , post_(f_)
        , Lambda_(std::isnan(c.magic_parameter) ? 0.125 : c.magic_parameter)
    {
        double pressure = 0;
        int faces = 0;
        for (const FaceCondition& face : c.faces)
            if (face.type == FaceType::pressure) {
                pressure += face.pressure;
                ++faces;
            }
        for (int i = 0; i < L::Q; ++i) {
            const Vec3 c_i{double(L::c[i][0]), double(L::c[i][1]), double(L::c[i][2])};
            const double drho = faces > 0 ? 3 * pressure / faces : 0;
            for (double& f : f_[i]) f = L::w(i) * (drho - 1.5 * dot(c_i, c.acceleration));
        }
    }

    /// What solids hold of the fluid at the start: at rest it lacks half of the drive.
    std::vector<Load> at_the_start(const std::vector<Solid>& solids)
    {
        map(solids);
        std::vector<Load> start(solids.size());
        for (const auto& shares : shares_) {
            double sum = 0;
            for (const Share& share : shares) sum += share.epsilon;
            for (const Share& share : shares) {
                const Vec3 P = (-0.5 * share.epsilon / std::max(sum, 1.0)) * c_.acceleration;
                start[share.solid].inside += P;
                start[share.solid].angular_inside += cross(share.r, P);
            }
        }
        return start;
    }

    std::vector<double>& population(int i) { return f_[i]; }
    const std::vector<Load>& loads() const { return loads_; }

    void step(const std::vector<Solid>& solids)
    {
        const auto [nx, ny, nz] = c_.cells;
        map(solids);
        loads_.assign(solids.size(), {});
        through_.clear();
        for (int z = 0; z < nz; ++z)
            for (int y = 0; y < ny; ++y)
                for (int x = 0; x < nx; ++x) collide_and_push(x, y, z, solids);
        if (c_.inertia) add_dynamic_pressure();
        f_.swap(next_);
    }

    std::size_t cell(int x, int y, int z) const
    {
        return (static_cast<std::size_t>(z) * c_.cells[1] + y) * c_.cells[0] + x;
    }

private:
    struct Share {
        std::size_t solid;
        double epsilon;
        Vec3 r;  ///< from the solid's centre
    };

    void map(const std::vector<Solid>& solids)
    {
        shares_.assign(f_[0].size(), {});
        for (std::size_t s = 0; s < solids.size(); ++s) {
            SphereFraction fraction;
            const Vec3& centre = solids[s].position;
            fraction.evaluate(centre, solids[s].radius);
            const auto first = fraction.first(), count = fraction.count();
            for (int z = 0; z < count[2]; ++z)
                for (int y = 0; y < count[1]; ++y)
                    for (int x = 0; x < count[0]; ++x) {
                        const double epsilon = fraction.row(y, z)[x];
                        if (epsilon == 0) continue;
                        std::array<int, 3> at{first[0] + x, first[1] + y, first[2] + z};
                        const Vec3 r = Vec3{at[0] + 0.5, at[1] + 0.5, at[2] + 0.5} - centre;
                        bool inside = true;
                        for (int d = 0; d < 3; ++d) {
                            if (c_.faces[2 * d].type == FaceType::periodic)
                                at[d] = (at[d] % c_.cells[d] + c_.cells[d]) % c_.cells[d];
                            else inside = inside && at[d] >= 0 && at[d] < c_.cells[d];
                        }
                        if (inside) shares_[cell(at[0], at[1], at[2])].push_back({s, epsilon, r});
                    }
        }
        thicken(solids);
    }

    /// Cells that a sphere cuts count more where another sphere stands opposite (docs/physics.md, "Narrow pores").
    void thicken(const std::vector<Solid>& solids)
    {
        const bool low_noise = Lambda_ == 0.125;
        const double A = low_noise ? 5 : 7.1 - 10.4 * Lambda_, B = low_noise ? 0.4 : 0, C = low_noise ? 1.2 : 2,
                     reach = low_noise ? 2 : 1.5;
        std::vector<std::vector<Image>> images;
        for (std::size_t s = 0; s < solids.size(); ++s) images.push_back(images_of_others(solids, s));
        for (auto& shares : shares_)
            for (Share& share : shares) {
                const double R = solids[share.solid].radius, r2 = dot(share.r, share.r);
                double most = 0;
                for (const Image& other : images[share.solid]) {
                    const Vec3 s = share.r - other.from_me;
                    const double widest = reach * std::min(R, other.radius),
                                 facing = -C * dot(share.r, s) / (R * other.radius);
                    const double R2 = other.radius;
                    const double h = std::max(0.0, (r2 - R * R) / (2 * R) + (dot(s, s) - R2 * R2) / (2 * R2));
                    if (facing <= 0 || h >= widest) continue;
                    const double left = 1 - std::pow(h / widest, 2);
                    most = std::max(most, (A + B * h) * h / (1 + h * h * h) * left * std::min(facing, 1.0));
                }
                share.epsilon *= 1 + most * std::pow(1 - share.epsilon, 3);
            }
    }

    struct Image {
        Vec3 from_me;  ///< centre, from that of the solid
        double radius;
    };

    std::vector<Image> images_of_others(const std::vector<Solid>& solids, std::size_t me) const
    {
        std::vector<Image> images;
        for (std::size_t s = 0; s < solids.size(); ++s)
            for (int turns = 0; turns < 27; ++turns) {
                const int t[3] = {turns % 3 - 1, turns / 3 % 3 - 1, turns / 9 - 1};
                Vec3 at = solids[s].position - solids[me].position;
                bool exists = s != me || turns != 13;
                for (int d = 0; d < 3; ++d) {
                    exists = exists && (t[d] == 0 || c_.faces[2 * d].type == FaceType::periodic);
                    at[d] += t[d] * c_.cells[d];
                }
                if (exists) images.push_back({at, solids[s].radius});
                for (int face = 0; face < 6; ++face) {
                    const FaceType type = c_.faces[face].type;
                    if (turns != 13 || (type != FaceType::free_slip && type != FaceType::pressure)) continue;
                    const int d = face / 2;
                    Vec3 mirrored = solids[s].position - solids[me].position;
                    mirrored[d] =
                        (face % 2 == 0 ? 0 : 2 * c_.cells[d]) - solids[s].position[d] - solids[me].position[d];
                    images.push_back({mirrored, solids[s].radius});
                }
            }
        return images;
    }

    void collide_and_push(int x, int y, int z, const std::vector<Solid>& solids)
    {
        const std::size_t here = cell(x, y, z);
        const double Lp = c_.tau - 0.5, Lm = Lambda_ / Lp;
        double sum = 0, k_eps = 0;
        Vec3 u_s{};
        for (const Share& share : shares_[here]) {
            const Solid& solid = solids[share.solid];
            const Vec3 &W = solid.angular_velocity, &r = share.r;
            const Vec3 spin{W[1] * r[2] - W[2] * r[1], W[2] * r[0] - W[0] * r[2], W[0] * r[1] - W[1] * r[0]};
            const double R = solid.radius;
            const double k = Weighting(L::Q == 19 ? Lattice::d3q19 : Lattice::d3q27, Lambda_).k(R);
            sum += share.epsilon;
            k_eps += k * share.epsilon;
            u_s += share.epsilon * (solid.velocity + spin);
        }
        const double eps = std::min(sum, 1.0), m = 1 - eps;
        if (sum > 0) {
            k_eps *= eps / sum;
            u_s = (1 / sum) * u_s;
        }
        const bool low_noise = Lambda_ == 0.125;
        const double lam = low_noise ? 1 + 8 * eps * std::pow(1 - eps, 2) - 0.96 * eps * eps : 1;
        const double g = low_noise ? 1 + 2 * eps * eps : 1;
        const double kk = g * k_eps * Lp / (std::max(m, 0.02 * g) + g * k_eps * Lp / 2);
        const double omega_plus = 1 / c_.tau, omega_minus = 1 / (Lm * lam + 0.5);

        double rho = 1;
        Vec3 j{};
        for (int i = 0; i < L::Q; ++i) {
            rho += f_[i][here];
            for (int d = 0; d < 3; ++d) j[d] += L::c[i][d] * f_[i][here];
        }
        const double drho = rho - 1;
        if (!c_.inertia) rho = 1;
        const Vec3& drive = c_.acceleration;
        const Vec3 u = (1 / rho) * (j + 0.5 * drive);
        const Vec3 F_s = (kk * rho) * (u_s - u);
        const Vec3 u_phys = u + (0.5 / rho) * F_s;
        const Vec3 F_t = drive + F_s;

        double post[L::Q];
        Vec3 j_post{};
        for (int i = 0; i < L::Q; ++i) {
            const int o = L::opposite(i);
            const Vec3 c{double(L::c[i][0]), double(L::c[i][1]), double(L::c[i][2])};
            const double w = L::w(i), cu = dot(c, u_phys);
            const double even = 0.5 * (f_[i][here] + f_[o][here]), odd = 0.5 * (f_[i][here] - f_[o][here]);
            double even_eq = w * drho, even_source = 0;
            if (c_.inertia) {
                even_eq += w * rho * (4.5 * cu * cu - 1.5 * dot(u_phys, u_phys));
                even_source = (1 - omega_plus / 2) * w * (9 * cu * dot(c, F_t) - 3 * dot(u_phys, F_t));
            }
            const double odd_eq = 3 * w * rho * dot(c, u);
            post[i] = f_[i][here] - omega_plus * (even - even_eq) + even_source - omega_minus * (odd - odd_eq) +
                      (1 - omega_minus / 2) * 3 * w * dot(c, drive) + 3 * w * dot(c, F_s);
            j_post += post[i] * c;
        }
        for (const Share& share : shares_[here]) {
            const double part = share.epsilon / sum;
            const Vec3 &r = share.r, F = part * F_s, P = (part * eps) * j_post;
            Load& load = loads_[share.solid];
            load.force += F;
            load.torque += Vec3{r[1] * F[2] - r[2] * F[1], r[2] * F[0] - r[0] * F[2], r[0] * F[1] - r[1] * F[0]};
            load.inside += P;
            load.angular_inside +=
                Vec3{r[1] * P[2] - r[2] * P[1], r[2] * P[0] - r[0] * P[2], r[0] * P[1] - r[1] * P[0]};
            load.coupling += part * m * kk * rho;
        }
        for (int i = 0; i < L::Q; ++i) {
            post_[i][here] = post[i];
            push(i, post[i], x, y, z);
        }
    }

    /// Streams one population: across the box where it is periodic, turned round at faces.
    void push(int i, double value, int x, int y, int z)
    {
        std::array<int, 3> to{x + L::c[i][0], y + L::c[i][1], z + L::c[i][2]};
        std::array<int, 3> turned{L::c[i][0], L::c[i][1], L::c[i][2]};
        std::array<FaceType, 3> type{};  // periodic where no face is crossed
        int walls = 0, pressures = 0, pressure_face = -1;
        Vec3 wall_velocity{}, own_velocity{};
        double pressure = 0;
        for (int d = 0; d < 3; ++d) {
            if (to[d] >= 0 && to[d] < c_.cells[d]) continue;
            const int index = 2 * d + (to[d] < 0 ? 0 : 1);
            const FaceCondition& face = c_.faces[index];
            type[d] = face.type;
            own_velocity[d] = face.velocity[d];
            if (face.type == FaceType::periodic) {
                to[d] = (to[d] + c_.cells[d]) % c_.cells[d];
                continue;
            }
            to[d] -= L::c[i][d];
            turned[d] = -turned[d];
            if (face.type == FaceType::no_slip || face.type == FaceType::velocity) {
                ++walls;
                wall_velocity += face.velocity;
            }
            if (face.type == FaceType::pressure) {
                ++pressures;
                pressure += face.pressure;
                pressure_face = index;
            }
        }
        const std::size_t here = cell(x, y, z);
        if (walls > 0) {
            double c_u = 0;
            for (int d = 0; d < 3; ++d) {
                if (type[d] == FaceType::no_slip || type[d] == FaceType::velocity) c_u += L::c[i][d] * own_velocity[d];
                else if (type[d] == FaceType::pressure || (type[d] == FaceType::periodic && pressures == 0))
                    c_u += L::c[i][d] * wall_velocity[d] / walls;
            }
            next_[L::opposite(i)][here] = value - 6 * L::w(i) * c_u;
            return;
        }
        int k = 0;
        while (turned != std::array<int, 3>{L::c[k][0], L::c[k][1], L::c[k][2]}) ++k;
        const std::size_t there = cell(to[0], to[1], to[2]);
        if (pressures % 2 == 0) next_[k][there] = value;
        else next_[k][there] = -value + 6 * L::w(i) * pressure / pressures;
        if (pressures == 1) through_.push_back({k, there, here, pressure_face});
    }

    /// What pressure faces let in knows the dynamic pressure 1/2 rho u_n^2 behind the face.
    void add_dynamic_pressure()
    {
        std::array<std::vector<double>, 6> dynamic;
        for (int face = 0; face < 6; ++face) {
            if (c_.faces[face].type != FaceType::pressure) continue;
            dynamic[face].resize(f_[0].size());
            const double rho = 1 + 3 * c_.faces[face].pressure;
            for (std::size_t at = 0; at < f_[0].size(); ++at) {
                double flux = 0;
                for (int i = 0; i < L::Q; ++i)
                    if (L::c[i][face / 2] == (face % 2 ? -1 : 1)) flux += post_[L::opposite(i)][at] - next_[i][at];
                // leaving: flux = j + j^2 / rho; entering, from rest at the pressure of the face: flux = j + 1/2 j^2 / rho
                const double a = (flux > 0 ? 1 : 0.5) / rho;
                const double j = (std::sqrt(std::max(0.0, 1 + 4 * a * flux)) - 1) / (2 * a);
                dynamic[face][at] = 3 * a * j * j;
            }
        }
        for (const Through& t : through_)
            next_[t.i][t.to] += L::w(t.i) * (dynamic[t.face][t.to] + dynamic[t.face][t.from]);
    }

    struct Through {
        int i;
        std::size_t to, from;
        int face;
    };
    FluidConfig c_;
    std::vector<std::vector<double>> f_, next_, post_;
    std::vector<Through> through_;
    double Lambda_;
    std::vector<std::vector<Share>> shares_;
    std::vector<Load> loads_;
};

}  // namespace lbm::test
