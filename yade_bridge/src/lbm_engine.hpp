#pragma once

#include "held_loads.hpp"
#include "schedule.hpp"
#include "settings.hpp"

#include "lbm/fluid.hpp"
#include "lbm/planner.hpp"

#include <core/GlobalEngine.hpp>

#include <boost/weak_ptr.hpp>

#include <array>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace yadelbm {

/// A plan as the user sees it.
struct FluidPlan : lbm::Plan {
    std::array<int, 3> cells{};
};

/**
 * A resolved fluid as an engine of YADE.
 *
 * The fluid comes into being in the first step that YADE runs and then covers, in every step, the time that the grains are
 * about to be integrated over. Loads of a fluid step are held while the grains sub-cycle; films between surfaces are evaluated in every grain step.
 */
class LbmEngine : public yade::GlobalEngine {
public:
    LbmEngine();
    ~LbmEngine() override;

    /// One step of the grains is about to be made. @throws std::exception  with a message that stands alone
    void action() override;

    std::string getClassName() const override { return "LbmEngine"; }
    std::string getBaseClassName(unsigned int i = 0) const override { return i == 0 ? "GlobalEngine" : ""; }
    int getBaseClassNumber() const override { return 1; }
    void pySetAttr(const std::string& key, const boost::python::object& value) override;
    boost::python::dict pyDict() const override;
    void callPostLoad() override;
    void pyRegisterClass(boost::python::object scope) override;

    const Settings& settings() const { return settings_; }
    /**
     * Changes the attribute `name`; nothing changes if `change` throws.
     * @param live  whether it may change while the fluid exists
     * @throws std::runtime_error  if the fluid exists and it may not
     */
    void change_settings(const char* name, bool live, const std::function<void(Settings&)>& change);

    FluidPlan plan() const;
    /// @param solid_fraction  NaN: of the spheres in the box; the others as lbm::Budget. @throws lbm::ConfigError
    double suggest_dx(double solid_fraction, double memory, double seconds) const;
    /// @param largest  NaN: 0.3 utils.PWaveTimeStep(). @throws lbm::ConfigError
    double suggest_dt(double largest, double seconds) const;

    // what the fluid says; each @throws std::runtime_error before the fluid exists
    lbm::SolidLoad load_on(int id) const;
    lbm::Vec3 velocity_at(const lbm::Vec3& position) const;
    double pressure_at(const lbm::Vec3& position) const;
    lbm::Vec3 average_velocity() const;
    double permeability() const;
    double boundary_flux(int face) const;
    lbm::Vec3 boundary_force(int face) const;
    double total_mass() const;
    lbm::Vec3 total_momentum() const;
    lbm::StressParts stress() const;
    double kinetic_energy() const;
    std::vector<double> velocity_field() const;
    std::vector<double> pressure_field() const;
    std::vector<double> solid_fraction_field() const;
    void save_vtk(const std::string& path) const;

    double fluid_dt() const;              ///< NaN before the fluid exists
    double steps_per_fluid_step() const;  ///< at the scene's present time step; NaN before the fluid exists
    std::int64_t fluid_steps() const;
    double fluid_time() const;
    std::array<int, 3> fluid_cells() const { return cells(settings_); }

private:
    enum Part { kStatesIn, kMap, kExchange, kCollideStream, kLoads, kLoadsOut, kFilms, kParts };

    bool begins() const;
    void ask_python();
    void warn();
    void advance();
    void start();
    int threads_to_use();
    void forget();
    void follow_grains();
    void follow_time_step();
    void check_grain_step() const;
    double length_of_last_grain_step(const yade::Scene& now) const;
    void step_fluid();
    void look_for_moves_without_velocity();
    void add_films();
    void account(Part part, double seconds, long executions);
    const lbm::Fluid& fluid(const char* asked) const;
    double throughput() const;
    std::string kept_state() const;

    friend class boost::serialization::access;
    template <class Archive>
    void serialize(Archive& archive, unsigned int version);

    Settings settings_;

    std::unique_ptr<lbm::Fluid> fluid_;  // none before the first step
    Schedule schedule_;
    HeldLoads held_;
    std::vector<lbm::Solid> solids_;          // of the last fluid step
    std::vector<lbm::Solid> solids_before_;   // of the one before it
    std::vector<lbm::Solid> surfaces_;        // of the films in the last grain step
    std::vector<lbm::SolidLoad> film_loads_;  // on them
    bool selection_changed_ = false;          // mask or ids, while the fluid exists
    bool replan_ = false;                     // O.dt has changed since the fluid's step was chosen
    std::int64_t moved_still_ = -1;           // body that was elsewhere, without a velocity
    int times_moved_still_ = 0;               // in so many fluid steps in turn
    bool loaded_ = false;                     // from a file, and not begun since
    const yade::Scene* started_in_ = nullptr;
    boost::weak_ptr<yade::Scene> scene_is_there_;
    long last_iter_ = -1;  // of the scene, at the last action
    double last_time_ = 0;
    struct Asked {
        std::string lubrication_law;
        double contact_frequency = 0;
        std::vector<std::string> warnings;
    };
    Asked asked_;               // of the scene, when the fluid began
    std::string failure_;       // why the fluid cannot go on; empty: it can
    mutable std::mutex mutex_;  // YADE runs steps in a thread of their own while Python may ask
};

}  // namespace yadelbm
