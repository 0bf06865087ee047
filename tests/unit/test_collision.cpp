#include "close.hpp"
#include "lattice/d3q19.hpp"
#include "lattice/d3q27.hpp"
#include "lattice/pack.hpp"
#include "lattice/vec3.hpp"
#include "physics/collision.hpp"

#include <cppunit/extensions/HelperMacros.h>

#include <algorithm>
#include <array>
#include <random>

namespace {

using namespace lbm;

constexpr double kRoundOff = 1e-15;

using Populations = double[D3Q19::Q];

void lopsided(Populations& f)
{
    for (int i = 0; i < D3Q19::Q; ++i) f[i] = 1e-3 * D3Q19::w(i) * ((i * 7) % 11 - 4);
}

CollisionParameters parameters(double tau, double lambda)
{
    return {TrtRates(tau, lambda), {1e-5, -2e-5, 3e-5}, Weighting(Lattice::d3q19, lambda).low_noise};
}

class Collision : public CppUnit::TestFixture {
    CPPUNIT_TEST_SUITE(Collision);
    CPPUNIT_TEST(rates_follow_from_tau_and_lambda);
    CPPUNIT_TEST(fluid_keeps_mass_and_gains_the_body_force);
    CPPUNIT_TEST(solid_gains_what_the_fluid_loses);
    CPPUNIT_TEST(empty_cell_collides_as_fluid);
    CPPUNIT_TEST(full_cell_follows_the_solid);
    CPPUNIT_TEST(fluid_at_the_velocity_of_the_solid_feels_nothing);
    CPPUNIT_TEST(lanes_give_the_bits_of_single_cells);
    CPPUNIT_TEST(in_32_bits_mass_and_momentum_are_kept_without_bias);
    CPPUNIT_TEST_SUITE_END();

    void rates_follow_from_tau_and_lambda()
    {
        const TrtRates rates(0.8, 0.1875);
        LBM_ASSERT_CLOSE(1 / 0.8, rates.omega_plus, kRoundOff, 1.0);
        LBM_ASSERT_CLOSE(0.1875, (1 / rates.omega_plus - 0.5) * (1 / rates.omega_minus - 0.5), 1e-14, 0.1875);
    }

    void fluid_keeps_mass_and_gains_the_body_force()
    {
        for (const double tau : {0.51, 0.8, 5.0}) {
            const auto p = parameters(tau, 0.125);
            Populations f;
            lopsided(f);
            const auto before = moments<D3Q19>(f);
            collide_fluid<D3Q19, true>(f, p);
            const auto after = moments<D3Q19>(f);
            LBM_ASSERT_CLOSE(before.drho, after.drho, kRoundOff, 1.0);
            for (int d = 0; d < 3; ++d) LBM_ASSERT_CLOSE(before.j[d] + p.body_force[d], after.j[d], kRoundOff, 1.0);
        }
    }

    void solid_gains_what_the_fluid_loses()
    {
        for (const double lambda : {0.125, 0.25})
            for (const double epsilon : {0.0, 1e-6, 0.3, 0.9, 1.0}) {
                const auto p = parameters(0.7, lambda);
                Populations f;
                lopsided(f);
                const auto before = moments<D3Q19>(f);
                Exchange<double> out;
                collide_saturated<D3Q19, true>(f, p, cut_cell<double>(p, {epsilon, 3 * epsilon, {0.02, 0.0, -0.01}}),
                                               out);
                const auto after = moments<D3Q19>(f);
                LBM_ASSERT_CLOSE(before.drho, after.drho, kRoundOff, 1.0);
                for (int d = 0; d < 3; ++d) {
                    LBM_ASSERT_CLOSE(before.j[d] + p.body_force[d] + out.force[d], after.j[d], kRoundOff, 1.0);
                    LBM_ASSERT_CLOSE(after.j[d], out.momentum[d], kRoundOff, 1.0);
                }
            }
    }

    void empty_cell_collides_as_fluid()
    {
        for (const double lambda : {0.125, 0.25}) {
            const auto p = parameters(0.9, lambda);
            Populations f, g;
            lopsided(f);
            lopsided(g);
            Exchange<double> out;
            collide_saturated<D3Q19, true>(f, p, cut_cell<double>(p, {0, 0, {0, 0, 0}}), out);
            collide_fluid<D3Q19, true>(g, p);
            for (int i = 0; i < D3Q19::Q; ++i) LBM_ASSERT_CLOSE(g[i], f[i], kRoundOff, 1.0);
            for (const double force : out.force) CPPUNIT_ASSERT_EQUAL(0.0, force);
        }
    }

    void full_cell_follows_the_solid()
    {
        // After one collision what is left of the difference in velocity is 1 - kk/2, with kk = k Lp / (0.02 + k Lp / 2).
        for (const double tau : {0.52, 0.7, 5.0}) {
            Populations f;
            lopsided(f);
            const double u_s[3] = {0.02, 0.0, -0.01}, k = 3, kLp = k * (tau - 0.5);
            const auto before = moments<D3Q19>(f);
            Exchange<double> out;
            const auto p = parameters(tau, 0.125);
            collide_saturated<D3Q19, true>(f, p, cut_cell<double>(p, {1, k, {u_s[0], u_s[1], u_s[2]}}), out);
            const double rho = 1 + before.drho, left = 0.02 / (0.02 + 0.5 * kLp);
            for (int d = 0; d < 3; ++d) {
                const double u = 0.5 * (before.j[d] + out.momentum[d]) / rho;
                const double driven = (before.j[d] + 0.5 * p.body_force[d]) / rho;
                LBM_ASSERT_CLOSE(left * (driven - u_s[d]), u - u_s[d], kRoundOff, 1.0);
            }
            LBM_ASSERT_CLOSE(2 * (1 - left) * rho, out.weight, kRoundOff, 1.0);
        }
    }

    void fluid_at_the_velocity_of_the_solid_feels_nothing()
    {
        CollisionParameters p = parameters(0.7, 0.125);
        for (double& F : p.body_force) F = 0;
        Populations f{};
        const Vec3 u{0.03, -0.02, 0.01};
        for (int i = 0; i < D3Q19::Q; ++i) {
            const auto& c = D3Q19::c[i];
            f[i] = 3 * D3Q19::w(i) * (c[0] * u[0] + c[1] * u[1] + c[2] * u[2]);
        }
        Exchange<double> out;
        collide_saturated<D3Q19, false>(f, p, cut_cell<double>(p, {0.4, 1.2, {u[0], u[1], u[2]}}), out);
        for (const double force : out.force) LBM_ASSERT_CLOSE(0.0, force, kRoundOff, 1.0);
    }

    void lanes_give_the_bits_of_single_cells()
    {
        const auto p = parameters(0.62, 0.125);
        Pack<4> pack[D3Q19::Q];
        Saturation<Pack<4>> s{};
        std::array<Saturation<double>, 4> single_s{};
        double single[4][D3Q19::Q];
        for (int l = 0; l < 4; ++l) {
            lopsided(single[l]);
            for (int i = 0; i < D3Q19::Q; ++i) pack[i][l] = single[l][i] *= 1 + 0.3 * l;
            single_s[l] = {0.3 * l, 0.8 * l, {0.01 * l, 0.02, -0.01}};
            s.epsilon[l] = single_s[l].epsilon;
            s.strength[l] = single_s[l].strength;
            for (int d = 0; d < 3; ++d) s.u_s[d][l] = single_s[l].u_s[d];
        }
        Exchange<Pack<4>> out;
        collide_saturated<D3Q19, true>(pack, p, cut_cell(p, s), out);
        for (int l = 0; l < 4; ++l) {
            Exchange<double> single_out;
            collide_saturated<D3Q19, true>(single[l], p, cut_cell(p, single_s[l]), single_out);
            for (int i = 0; i < D3Q19::Q; ++i) CPPUNIT_ASSERT_EQUAL(single[l][i], double(pack[i][l]));
            CPPUNIT_ASSERT_EQUAL(single_out.force[0], double(out.force[0][l]));
        }
    }

    /// Round-off of single cells is 1e-7; weights that do not add up would gain 3e-8 on average.
    template <class L>
    static void no_bias_in_32_bits(double tau)
    {
        CollisionParameters p = parameters(tau, 0.125);
        for (double& F : p.body_force) F = 0;
        std::mt19937 random(1);
        std::uniform_real_distribution<float> uniform(-0.01F, 0.01F);
        double mass = 0, mass_gained = 0, momentum = 0, momentum_gained = 0;
        for (int cell = 0; cell < 50000; ++cell) {
            float f[L::Q];
            double before[L::Q], after[L::Q];
            for (int i = 0; i < L::Q; ++i) before[i] = f[i] = uniform(random);
            collide_fluid<L, true>(f, p);
            std::copy_n(f, L::Q, after);
            const auto from = moments<L>(before), to = moments<L>(after);
            mass += from.drho * from.drho;
            mass_gained += from.drho * (to.drho - from.drho);
            for (int d = 0; d < 3; ++d) {
                momentum += from.j[d] * from.j[d];
                momentum_gained += from.j[d] * (to.j[d] - from.j[d]);
            }
        }
        LBM_ASSERT_CLOSE(0.0, mass_gained / mass, 5e-9, 1.0);
        LBM_ASSERT_CLOSE(0.0, momentum_gained / momentum, 5e-9, 1.0);
    }

    void in_32_bits_mass_and_momentum_are_kept_without_bias()
    {
        for (const double tau : {0.52, 0.77, 5.0}) {
            no_bias_in_32_bits<D3Q19>(tau);
            no_bias_in_32_bits<D3Q27>(tau);
        }
    }
};

CPPUNIT_TEST_SUITE_REGISTRATION(Collision);

}  // namespace
