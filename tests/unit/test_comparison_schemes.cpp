#include "close.hpp"
#include "lattice/d3q19.hpp"
#include "lattice/d3q27.hpp"
#include "lattice/vec3.hpp"
#include "physics/comparison_schemes.hpp"

#include <cppunit/extensions/HelperMacros.h>

namespace {

using namespace lbm;

constexpr double kRoundOff = 1e-15;
constexpr double kTau = 0.8;
constexpr double kU_s[3] = {0.02, 0.01, -0.015};
constexpr Scheme kPublished[] = {Scheme::noble_torczynski, Scheme::noble_torczynski_linear, Scheme::superposition,
                                 Scheme::bounce_back};

template <class L>
void lopsided(double (&f)[L::Q])
{
    for (int i = 0; i < L::Q; ++i) f[i] = 1e-3 * L::w(i) * ((i * 7) % 11 - 4);
}

CollisionParameters parameters(Scheme scheme, double force)
{
    return {TrtRates(kTau, 0.1875), {force, -2 * force, 3 * force}, false, scheme};
}

/// The whole equilibrium, less the weight.
template <class L>
double equilibrium(int i, double rho, const double (&u)[3])
{
    const double cu = L::c[i][0] * u[0] + L::c[i][1] * u[1] + L::c[i][2] * u[2];
    const double u2 = u[0] * u[0] + u[1] * u[1] + u[2] * u[2];
    return L::w(i) * rho * (1 + 3 * cu + 4.5 * cu * cu - 1.5 * u2) - L::w(i);
}

class ComparisonSchemes : public CppUnit::TestFixture {
    CPPUNIT_TEST_SUITE(ComparisonSchemes);
    CPPUNIT_TEST(operators_are_those_of_the_papers);
    CPPUNIT_TEST(bounce_back_returns_every_population);
    CPPUNIT_TEST(solid_gains_what_the_fluid_loses);
    CPPUNIT_TEST(empty_cell_collides_as_fluid);
    CPPUNIT_TEST(wall_cells_bounce_and_their_neighbours_do_not);
    CPPUNIT_TEST_SUITE_END();

    /// f + (1 - B) Omega + B Omega_s, population by population, as published (no body force; one relaxation time).
    template <class L>
    void as_published(Scheme scheme, double B)
    {
        CollisionParameters p = parameters(scheme, 0);
        p.rates.omega_minus = p.rates.omega_plus;
        const double omega = p.rates.omega_plus;
        const double epsilon = scheme == Scheme::noble_torczynski_linear ? B : B * (1 + p.rates.Lp) / (B + p.rates.Lp);
        double f[L::Q], expected[L::Q];
        lopsided<L>(f);
        const Moments<double> m = moments<L>(f);
        const double rho = 1 + m.drho;
        const double u[3] = {m.j[0] / rho, m.j[1] / rho, m.j[2] / rho};
        for (int i = 0; i < L::Q; ++i) {
            const int o = L::opposite(i);
            const double fluid = -omega * (f[i] - equilibrium<L>(i, rho, u));
            const double solid =
                scheme == Scheme::superposition
                    ? equilibrium<L>(i, rho, kU_s) - f[i] + (1 - omega) * (f[i] - equilibrium<L>(i, rho, u))
                    : f[o] - f[i] + equilibrium<L>(i, rho, kU_s) - equilibrium<L>(o, rho, u);
            expected[i] = f[i] + (1 - B) * fluid + B * solid;
        }
        Exchange<double> out;
        collide_with_solids<L, true>(f, p, cut_cell<double>(p, {epsilon, 0, {kU_s[0], kU_s[1], kU_s[2]}}), out);
        for (int i = 0; i < L::Q; ++i) LBM_ASSERT_CLOSE(expected[i], f[i], kRoundOff, 1.0);
    }

    void operators_are_those_of_the_papers()
    {
        for (const Scheme scheme : {Scheme::noble_torczynski, Scheme::noble_torczynski_linear, Scheme::superposition})
            for (const double B : {0.0, 0.3, 1.0}) {
                as_published<D3Q19>(scheme, B);
                as_published<D3Q27>(scheme, B);
            }
    }

    void bounce_back_returns_every_population()
    {
        const CollisionParameters p = parameters(Scheme::bounce_back, 1e-5);
        double f[D3Q19::Q], before[D3Q19::Q];
        lopsided<D3Q19>(f);
        lopsided<D3Q19>(before);
        const double rho = 1 + moments<D3Q19>(f).drho;
        Exchange<double> out;
        collide_with_solids<D3Q19, true>(f, p, cut_cell<double>(p, {0.6, 0, {kU_s[0], kU_s[1], kU_s[2]}}), out);
        for (int i = 0; i < D3Q19::Q; ++i) {
            const auto& c = D3Q19::c[i];
            const double cu = c[0] * kU_s[0] + c[1] * kU_s[1] + c[2] * kU_s[2];
            LBM_ASSERT_CLOSE(before[D3Q19::opposite(i)] + 6 * D3Q19::w(i) * rho * cu, f[i], kRoundOff, 1.0);
        }
    }

    void solid_gains_what_the_fluid_loses()
    {
        for (const Scheme scheme : kPublished)
            for (const double epsilon : {0.0, 0.3, 0.7, 1.0}) {
                const CollisionParameters p = parameters(scheme, 1e-5);
                double f[D3Q19::Q];
                lopsided<D3Q19>(f);
                const auto before = moments<D3Q19>(f);
                Exchange<double> out;
                collide_with_solids<D3Q19, true>(f, p, cut_cell<double>(p, {epsilon, 0, {kU_s[0], kU_s[1], kU_s[2]}}),
                                                 out);
                const auto after = moments<D3Q19>(f);
                LBM_ASSERT_CLOSE(before.drho, after.drho, kRoundOff, 1.0);
                for (int d = 0; d < 3; ++d) {
                    LBM_ASSERT_CLOSE(after.j[d], out.momentum[d], kRoundOff, 1.0);
                    LBM_ASSERT_CLOSE(before.j[d] + p.body_force[d] + out.force[d], after.j[d], kRoundOff, 1.0);
                }
            }
    }

    void empty_cell_collides_as_fluid()
    {
        for (const Scheme scheme : kPublished) {
            const CollisionParameters p = parameters(scheme, 1e-5);
            double f[D3Q27::Q], g[D3Q27::Q];
            lopsided<D3Q27>(f);
            lopsided<D3Q27>(g);
            Exchange<double> out;
            collide_with_solids<D3Q27, true>(f, p, cut_cell<double>(p, {0, 0, {kU_s[0], kU_s[1], kU_s[2]}}), out);
            collide_fluid<D3Q27, true>(g, p);
            for (int i = 0; i < D3Q27::Q; ++i) LBM_ASSERT_CLOSE(g[i], f[i], kRoundOff, 1.0);
        }
    }

    void wall_cells_bounce_and_their_neighbours_do_not()
    {
        const CollisionParameters exact = parameters(Scheme::exact, 1e-5);
        const auto s = cut_cell<double>(exact, {0.4, 1.2, {kU_s[0], kU_s[1], kU_s[2]}});
        for (const double bounce : {0.0, 1.0}) {
            double f[D3Q19::Q], g[D3Q19::Q];
            lopsided<D3Q19>(f);
            lopsided<D3Q19>(g);
            Exchange<double> out, expected;
            collide_beside_wall<D3Q19, true>(f, exact, s, bounce, out);
            if (bounce == 0) collide_saturated<D3Q19, true>(g, exact, s, expected);
            else
                collide_with_solids<D3Q19, true>(g, parameters(Scheme::bounce_back, 1e-5),
                                                 cut_cell<double>(exact, {1, 0, {kU_s[0], kU_s[1], kU_s[2]}}),
                                                 expected);
            for (int i = 0; i < D3Q19::Q; ++i) LBM_ASSERT_CLOSE(g[i], f[i], kRoundOff, 1.0);
            for (int d = 0; d < 3; ++d) LBM_ASSERT_CLOSE(expected.force[d], out.force[d], kRoundOff, 1.0);
        }
    }
};

CPPUNIT_TEST_SUITE_REGISTRATION(ComparisonSchemes);

}  // namespace
