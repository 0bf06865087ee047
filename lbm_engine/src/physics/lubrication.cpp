#include "physics/lubrication.hpp"

#include <algorithm>
#include <numbers>

namespace lbm {
namespace {

/**
 * How much wider than it is a gap looks to the lattice: at contact, and the gap from which on it looks as it is [cells]. Measured with spheres of 4 and 6
 * cells, which agree; docs/physics.md has the tables. Two spheres that slide or roll at gaps of 0.4 to 1.2 cells are overdone by 5 to 7 %, which is left: films only take energy.
 */
struct Blur {
    double at_contact, until;

    double seen(double gap) const
    {
        const double left = std::max(0.0, 1 - gap / until);
        return gap + at_contact * left * left * left;
    }
};

constexpr Blur kSlide{0.211, 0.63}, kPump{0.124, kWidestFilm};
constexpr Blur kSqueezeAtWall{0.3, kWidestFilmAtWall}, kPumpAtWall{0.17, 1.2};

double seen_squeeze(double gap)
{
    const double left = std::max(0.0, 1 - gap / kWidestSqueeze);
    return gap + 0.205 * left * left;
}

/// Sliding along a wall is overdone between 0.2 and 0.85 cells, since the first layer of cells takes the sphere's velocity at its centre.
double seen_sliding_at_wall(double gap) { return gap < 0.85 ? gap + 0.39 * (gap - 0.2) * (gap - 0.85) : gap; }

}  // namespace

SeenGaps seen_gaps(double gap, bool wall)
{
    return {wall ? kSqueezeAtWall.seen(gap) : seen_squeeze(gap), wall ? seen_sliding_at_wall(gap) : kSlide.seen(gap),
            (wall ? kPumpAtWall : kPump).seen(gap)};
}

FilmResistance film_resistance(double viscosity, double a1, double a2, double gap, const SeenGaps& seen)
{
    const bool wall = std::isinf(a2);
    const double a = wall ? a1 : a1 * a2 / (a1 + a2);
    const double unlike = wall ? 0 : a1 * a2 / ((a1 + a2) * (a1 + a2));  // L / (1 + L)^2
    const double pi_mu = std::numbers::pi * viscosity;
    FilmResistance r;
    r.squeeze = 6 * pi_mu * a * (a * (1 / gap - 1 / seen.squeeze) + (0.2 + unlike) * std::log(seen.squeeze / gap));
    r.slide = 2 * pi_mu * a * std::log(seen.slide / gap);
    r.pump = 1.2 * pi_mu * a * std::log(seen.pump / gap);
    return r;
}

Film make_film(const Vec3& normal, double a1, double a2, double distance, const FilmResistance& r)
{
    Film film;
    film.normal = normal;
    film.resistance = r;
    if (std::isinf(a2)) {
        film.arm[0] = a1;
        film.part[1] = 1;
    } else {
        film.part[0] = a1 / (a1 + a2);
        film.part[1] = a2 / (a1 + a2);
        for (int i = 0; i < 2; ++i) film.arm[i] = film.part[i] * distance;
    }
    return film;
}

namespace {

/// Component by component.
Vec3 times(const Vec3& a, const Vec3& b) { return {a[0] * b[0], a[1] * b[1], a[2] * b[2]}; }

/// How a body answers to an impulse at the centre of one of its surfaces, and to one that turns it. Off its centre of mass the two go together: each is taken so
/// large that their sum is no less than the true answer, whatever the directions. A film that thinks its bodies lighter than they are takes energy all the same.
struct Lightness {
    double push;     ///< in any direction
    double squeeze;  ///< along the normal
    double turn;
};
Lightness lightness(const FilmBody& body, const Vec3& lever, const Vec3& normal)
{
    const double squeeze = body.inverse_mass * dot(normal, times(body.yields, normal));
    const double lever2 = dot(lever, lever);
    if (lever2 == 0) return {body.inverse_mass, squeeze, body.inverse_inertia};
    const double by_turning = 2 * lever2 * body.inverse_inertia;
    return {body.inverse_mass + by_turning, squeeze + by_turning, 2 * body.inverse_inertia};
}

}  // namespace

double Film::relax(FilmBody& first, FilmBody& second)
{
    const Lightness light[2] = {lightness(first, lever[0], normal), lightness(second, lever[1], normal)};
    const double push = light[0].push + light[1].push, push_along = light[0].squeeze + light[1].squeeze;
    const Vec3 v = second.velocity + cross(second.angular_velocity, lever[1]) - first.velocity -
                   cross(first.angular_velocity, lever[0]);
    const double separation = dot(v, normal);
    const Vec3 v_t = v - separation * normal;

    // N = -squeeze (w + push_along (N - N_before))
    const double squeeze = resistance.squeeze;
    const double squeezed_now = squeeze * (push_along * squeezed - separation) / (1 + squeeze * push_along);

    // S = -Z (u + K (S - S_before)), the same 2 x 2 for both tangential directions
    const Vec3 u[2] = {arm[0] * cross(first.angular_velocity, normal) - part[0] * v_t,
                       part[1] * v_t - arm[1] * cross(second.angular_velocity, normal)};
    const double k00 = arm[0] * arm[0] * light[0].turn + push * part[0] * part[0];
    const double k11 = arm[1] * arm[1] * light[1].turn + push * part[1] * part[1];
    const double k01 = -push * part[0] * part[1];
    // What the lattice overdoes is taken back (slide < 0), as far as inertia allows without becoming unstable.
    double slide = resistance.slide;
    if (slide < 0) slide /= 1 - 4 * slide * (k00 + k11);
    const double z_same = resistance.pump + slide, z_other = resistance.pump - slide;
    const Vec3 w0 = u[0] - k00 * sheared[0] - k01 * sheared[1];
    const Vec3 w1 = u[1] - k01 * sheared[0] - k11 * sheared[1];
    const double m00 = 1 + z_same * k00 + z_other * k01, m01 = z_same * k01 + z_other * k11;
    const double m10 = z_other * k00 + z_same * k01, m11 = 1 + z_other * k01 + z_same * k11;
    const double determinant = m00 * m11 - m01 * m10;
    const Vec3 b0 = -(z_same * w0 + z_other * w1), b1 = -(z_other * w0 + z_same * w1);
    const Vec3 sheared_now[2] = {(1 / determinant) * (m11 * b0 - m01 * b1), (1 / determinant) * (m00 * b1 - m10 * b0)};

    const double d_squeezed = squeezed_now - squeezed;
    const Vec3 d_sheared[2] = {sheared_now[0] - sheared[0], sheared_now[1] - sheared[1]};
    const Vec3 on_second = d_squeezed * normal + part[1] * d_sheared[1] - part[0] * d_sheared[0];
    first.velocity -= first.inverse_mass * times(first.yields, on_second);
    second.velocity += second.inverse_mass * times(second.yields, on_second);
    first.angular_velocity +=
        first.inverse_inertia * (arm[0] * cross(normal, d_sheared[0]) - cross(lever[0], on_second));
    second.angular_velocity +=
        second.inverse_inertia * (cross(lever[1], on_second) - arm[1] * cross(normal, d_sheared[1]));
    squeezed = squeezed_now;
    sheared[0] = sheared_now[0];
    sheared[1] = sheared_now[1];
    return d_squeezed * d_squeezed + dot(d_sheared[0], d_sheared[0]) + dot(d_sheared[1], d_sheared[1]);
}

Mat3 Film::stresslet_of(int which) const
{
    // Shear acts along the surface, pressure along its normals: of the tangential force the shear counts once, the pressure twice.
    const double sign = which == 0 ? -1 : 1;
    const Vec3 tangential = sign * (part[1] * sheared[1] - part[0] * sheared[0]);
    const Vec3 acting = (sign * squeezed) * normal + 2 * tangential - sheared[which];
    const Vec3 out = (which == 0 ? arm[0] : -arm[1]) * normal;
    const double third = dot(out, acting) / 3;
    Mat3 s{};
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) s[i][j] = 0.5 * (out[i] * acting[j] + out[j] * acting[i]) - (i == j ? third : 0);
    return s;
}

}  // namespace lbm
