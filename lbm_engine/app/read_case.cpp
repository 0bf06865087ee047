#include "read_case.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <tuple>

namespace lbm {
namespace {

using Json = nlohmann::json;

constexpr double kLargestCount = 1e15;  // doubles still know it from its neighbours

/// An object of the case, with its place in it for messages. Every key must be asked for: those left over are unknown.
class Section {
public:
    Section(const Json& json, std::string path) : json_(json), path_(std::move(path))
    {
        if (!json.is_object()) throw ConfigError((path_.empty() ? "the case" : path_) + ": must be an object");
    }

    bool has(const char* key)
    {
        known_.insert(key);
        return json_.contains(key);
    }
    const Json& at(const char* key)
    {
        if (!has(key)) throw ConfigError(name(key) + ": missing");
        return json_.at(key);
    }
    Section section(const char* key) { return {at(key), name(key)}; }
    std::string name(const std::string& key) const { return path_.empty() ? key : path_ + "." + key; }

    double number(const char* key)
    {
        const Json& value = at(key);
        if (!value.is_number()) throw ConfigError(name(key) + ": must be a number");
        return value.get<double>();
    }
    double number(const char* key, double otherwise) { return has(key) ? number(key) : otherwise; }
    std::int64_t count(const char* key, std::int64_t otherwise)
    {
        if (!has(key)) return otherwise;
        const double value = number(key);
        if (!(value == std::floor(value) && value >= 0 && value <= kLargestCount))
            throw ConfigError(name(key) + ": must be a whole number from 0 to 1e15");
        return static_cast<std::int64_t>(value);
    }
    bool flag(const char* key, bool otherwise)
    {
        if (!has(key)) return otherwise;
        if (!json_.at(key).is_boolean()) throw ConfigError(name(key) + ": must be true or false");
        return json_.at(key).get<bool>();
    }
    std::string text(const char* key, const std::string& otherwise)
    {
        if (!has(key)) return otherwise;
        if (!json_.at(key).is_string()) throw ConfigError(name(key) + ": must be a string");
        return json_.at(key).get<std::string>();
    }
    /// @throws ConfigError unless the value is one of those listed
    std::string choice(const char* key, const std::string& otherwise, std::initializer_list<const char*> allowed)
    {
        std::string value = text(key, otherwise);
        std::string list;
        for (const char* one : allowed) {
            if (value == one) return value;
            list += list.empty() ? one : std::string(", ") + one;
        }
        throw ConfigError(name(key) + " = \"" + value + "\": must be one of " + list);
    }
    Vec3 vector(const char* key)
    {
        const Json& value = at(key);
        if (!value.is_array() || value.size() != 3) throw ConfigError(name(key) + ": must be a list of three numbers");
        Vec3 v{};
        for (int d = 0; d < 3; ++d) {
            if (!value[d].is_number()) throw ConfigError(name(key) + ": must be a list of three numbers");
            v[d] = value[d].get<double>();
        }
        return v;
    }
    Vec3 vector(const char* key, const Vec3& otherwise) { return has(key) ? vector(key) : otherwise; }

    /// @throws ConfigError if there is a key that nobody asked for
    void close() const
    {
        for (const auto& item : json_.items())
            if (!known_.count(item.key())) {
                std::string list;
                for (const std::string& key : known_) list += (list.empty() ? "" : ", ") + key;
                throw ConfigError(name(item.key()) + ": unknown key; known here: " + list);
            }
    }

private:
    const Json& json_;
    std::string path_;
    std::set<std::string> known_;
};

void read_face(Section face, FaceCondition& condition)
{
    const std::string type = face.choice("type", "noSlip", {"noSlip", "freeSlip", "velocity", "pressure"});
    if (type == "noSlip") {
        condition.type = FaceType::no_slip;
        condition.velocity = face.vector("velocity", {});
    } else if (type == "freeSlip") {
        condition.type = FaceType::free_slip;
    } else if (type == "velocity") {
        condition.type = FaceType::velocity;
        condition.velocity = face.vector("velocity");
    } else {
        condition.type = FaceType::pressure;
        condition.pressure = face.number("pressure");
    }
    face.close();
}

void read_boundaries(Section boundaries, FluidConfig& fluid)
{
    for (int d = 0; d < 3; ++d) {
        const char axis[] = {"xyz"[d], 0};
        if (!boundaries.has(axis)) continue;
        if (boundaries.at(axis).is_string()) {
            if (boundaries.at(axis) != "periodic")
                throw ConfigError(boundaries.name(axis) +
                                  R"(: must be "periodic" or {"min": {"type": "noSlip"}, "max": {"type": "noSlip"}})");
            continue;
        }
        Section pair = boundaries.section(axis);
        read_face(pair.section("min"), fluid.faces[2 * d]);
        read_face(pair.section("max"), fluid.faces[2 * d + 1]);
        pair.close();
    }
    boundaries.close();
}

Scheme read_scheme(Section& root)
{
    const std::string name = root.choice(
        "scheme", "exact", {"exact", "nobleTorczynski", "nobleTorczynskiLinear", "superposition", "bounceBack"});
    if (name == "nobleTorczynski") return Scheme::noble_torczynski;
    if (name == "nobleTorczynskiLinear") return Scheme::noble_torczynski_linear;
    if (name == "superposition") return Scheme::superposition;
    if (name == "bounceBack") return Scheme::bounce_back;
    return Scheme::exact;
}

void read_shape(Section& s, Solid& solid)
{
    const std::string shape = s.choice("shape", "sphere", {"sphere", "box", "pipe"});
    if (shape == "box") {
        solid.shape = Shape::box;
        solid.half_extents = s.vector("half_extents");
        if (!s.has("orientation")) return;
        const Json& q = s.at("orientation");
        if (!q.is_array() || q.size() != 4 ||
            !std::all_of(q.begin(), q.end(), [](const Json& n) { return n.is_number(); }))
            throw ConfigError(s.name("orientation") +
                              ": must be a list of four numbers, the unit quaternion (w, x, y, z)");
        for (int i = 0; i < 4; ++i) solid.orientation[i] = q[i].get<double>();
        return;
    }
    solid.radius = s.number("radius");
    if (shape == "pipe") {
        solid.shape = Shape::pipe;
        solid.axis = s.choice("axis", "x", {"x", "y", "z"})[0] - 'x';
    }
}

/// What the mass of a free solid follows from; the engine checks the rest.
void require_a_volume(const Section& s, const Solid& solid)
{
    const auto positive = [](double length) { return std::isfinite(length) && length > 0; };
    if (solid.shape == Shape::sphere && !positive(solid.radius))
        throw ConfigError(s.name("radius") + ": must be finite and > 0 [m]");
    const Vec3& h = solid.half_extents;
    if (solid.shape == Shape::box && !std::all_of(h.begin(), h.end(), positive))
        throw ConfigError(s.name("half_extents") + ": must be finite and > 0 [m]");
    double square = 0;
    for (const double q : solid.orientation) square += q * q;
    if (!(std::abs(square - 1) < 1e-6))
        throw ConfigError(s.name("orientation") + ": must be a unit quaternion (w, x, y, z)");
}

CaseSolid read_solid(Section s, std::int64_t id)
{
    CaseSolid entry;
    Solid& solid = entry.solid;
    solid.id = id;
    solid.position = s.vector("center");
    read_shape(s, solid);
    solid.velocity = s.vector("velocity", {});
    solid.angular_velocity = s.vector("angular_velocity", {});
    if (s.has("body")) solid.body = s.count("body", 0);
    entry.moving = s.flag("moving", false);
    entry.free = s.flag("free", false);
    if (entry.free && entry.moving)
        throw ConfigError(s.name("free") + ": a solid is free or moving at its velocity, not both");
    if (entry.free) {
        if (solid.shape == Shape::pipe) throw ConfigError(s.name("free") + ": a pipe cannot be free");
        require_a_volume(s, solid);
        entry.density = s.number("density");
        if (!(std::isfinite(entry.density) && entry.density > 0))
            throw ConfigError(s.name("density") + ": must be finite and > 0 [kg/m3]");
    } else if (s.has("density")) {
        throw ConfigError(s.name("density") + ": only a free solid has one; add \"free\": true");
    }
    s.close();
    return entry;
}

/// Parts of a rigid body are all fixed, all moving or all free.
void require_bodies_move_as_one(const std::vector<CaseSolid>& solids)
{
    for (std::size_t s = 0; s < solids.size(); ++s)
        for (std::size_t before = 0; before < s; ++before) {
            const CaseSolid &one = solids[s], &other = solids[before];
            if (one.solid.body < 0 || one.solid.body != other.solid.body) continue;
            if (one.free != other.free || one.moving != other.moving)
                throw ConfigError("solids[" + std::to_string(s) + "].body: is free or moving otherwise than solids[" +
                                  std::to_string(before) + "], which is a part of the same body");
        }
}

/// Two solids in the same place are one that was listed twice; as one body they count once.
void require_different(const std::vector<CaseSolid>& solids)
{
    std::map<std::tuple<Shape, Vec3, double, Vec3, std::array<double, 4>, int>, std::size_t> seen;
    for (std::size_t s = 0; s < solids.size(); ++s) {
        const Solid& solid = solids[s].solid;
        const auto [place, is_new] = seen.emplace(
            std::tuple(solid.shape, solid.position, solid.radius, solid.half_extents, solid.orientation, solid.axis),
            s);
        if (!is_new && (solid.body < 0 || solid.body != solids[place->second].solid.body))
            throw ConfigError("solids[" + std::to_string(s) + "]: has the place and size of solids[" +
                              std::to_string(place->second) + "]; leave one of them, or make them one body");
    }
}

/// Walls and no grains: a flow along corners or through a pipe, for which D3Q19 is not isotropic enough (docs/physics.md, "Ducts").
bool is_duct(const FluidConfig& fluid, const std::vector<CaseSolid>& solids)
{
    const bool grains = std::any_of(solids.begin(), solids.end(), [](const CaseSolid& s) {
        return s.solid.shape == Shape::sphere || s.free || s.moving;
    });
    int walls = 0;  // pairs of faces
    for (std::size_t d = 0; d < 3; ++d)
        walls += fluid.faces[2 * d].type == FaceType::no_slip || fluid.faces[2 * d + 1].type == FaceType::no_slip;
    return !grains && (!solids.empty() || walls > 1);
}

}  // namespace

Case read_case(const Json& json)
{
    Case result;
    FluidConfig& fluid = result.fluid;
    Section root(json, "");

    Section domain = root.section("domain");
    const Vec3 cells = domain.vector("cells");
    for (int d = 0; d < 3; ++d) {
        if (cells[d] != std::floor(cells[d]) || cells[d] < 1 || cells[d] > 1e6)
            throw ConfigError("domain.cells: must be three whole numbers from 1 to 1e6");
        fluid.cells[d] = static_cast<int>(cells[d]);
    }
    fluid.dx = domain.number("dx");
    fluid.lower = domain.vector("lower", {});
    domain.close();

    Section material = root.section("fluid");
    fluid.density = material.number("density");
    fluid.viscosity = material.number("viscosity");
    material.close();

    fluid.tau = root.number("tau");
    fluid.magic_parameter = root.number("magic_parameter", fluid.magic_parameter);
    fluid.scheme = read_scheme(root);
    fluid.collision = root.choice("collision", "trt", {"trt", "bgk"}) == "bgk" ? Collision::bgk : Collision::trt;
    fluid.storage = root.choice("storage", "double", {"double", "single"}) == "single" ? Storage::single_precision
                                                                                       : Storage::double_precision;
    fluid.inertia = root.flag("inertia", true);
    fluid.lubrication = root.flag("lubrication", fluid.lubrication);
    fluid.lubrication_roughness = root.number("lubrication_roughness", fluid.lubrication_roughness);
    fluid.acceleration = root.vector("acceleration", {});
    fluid.gravity = root.vector("gravity", {});
    fluid.initial_velocity = root.vector("initial_velocity", {});
    fluid.max_mach = root.number("max_mach", fluid.max_mach);
    fluid.threads = static_cast<int>(std::min<std::int64_t>(root.count("threads", 0), std::numeric_limits<int>::max()));
    if (root.has("boundaries")) read_boundaries(root.section("boundaries"), fluid);

    if (root.has("solids")) {
        if (!root.at("solids").is_array()) throw ConfigError("solids: must be a list");
        std::int64_t id = 0;
        for (const Json& solid : root.at("solids")) {
            result.solids.push_back(read_solid({solid, "solids[" + std::to_string(id) + "]"}, id));
            ++id;
        }
        require_bodies_move_as_one(result.solids);
        require_different(result.solids);
    }
    const std::string lattice = root.choice("lattice", "auto", {"auto", "D3Q19", "D3Q27"});
    const bool isotropic = lattice == "auto" ? is_duct(fluid, result.solids) : lattice == "D3Q27";
    fluid.lattice = isotropic ? Lattice::d3q27 : Lattice::d3q19;
    if (root.has("stop")) {
        Section stop = root.section("stop");
        result.steady = stop.number("steady", 0);
        if (!(std::isfinite(result.steady) && result.steady >= 0))
            throw ConfigError("stop.steady: must be finite and >= 0");
        result.max_steps = stop.count("max_steps", result.max_steps);
        stop.close();
    }
    if (root.has("output")) {
        Section output = root.section("output");
        result.vtk = output.text("vtk", "");
        output.close();
    }
    root.close();
    return result;
}

}  // namespace lbm
