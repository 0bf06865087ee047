#include "lbm_engine.hpp"

#include "grains.hpp"
#include "planning.hpp"
#include "text.hpp"

#include "lbm/errors.hpp"

#include <core/Omega.hpp>
#include <core/Scene.hpp>

#include <omp.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <thread>
#include <utility>

namespace yadelbm {
namespace {

constexpr const char* kPartNames[] = {"states in", "map", "exchange", "collide-stream", "loads", "loads out", "films"};

/// Ratio of the planned to the present time step of the fluid from which on it is changed.
constexpr double kPoorFit = 1.25;

/// Holds Python's interpreter, from any thread.
class Interpreter {
public:
    Interpreter() = default;
    ~Interpreter() { PyGILState_Release(state_); }
    Interpreter(const Interpreter&) = delete;
    Interpreter& operator=(const Interpreter&) = delete;

private:
    PyGILState_STATE state_ = PyGILState_Ensure();
};

class Stopwatch {
public:
    double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

private:
    using Clock = std::chrono::steady_clock;
    Clock::time_point start_ = Clock::now();
};

}  // namespace

LbmEngine::LbmEngine()
{
    timingDeltas = yade::shared_ptr<yade::TimingDeltas>(new yade::TimingDeltas);  // or yade.timing shows no parts
}

LbmEngine::~LbmEngine() = default;

void LbmEngine::action()
{
    try {
        const bool begins = this->begins();
        if (begins) ask_python();
        try {
            advance();
        } catch (const lbm::RunError& error) {
            const std::lock_guard lock(mutex_);
            if (failure_.empty()) failure_ = error.what();
            throw;
        }
        if (!asked_.warnings.empty()) warn();
    } catch (...) {
        // O.run(n, True) starts the thread of this step and then waits for it; if the step has failed before the wait
        // begins, YADE overlooks the error and returns as if all were well
        std::this_thread::sleep_for(std::chrono::milliseconds(200));
        throw;
    }
}

/// In the first step, after O.reset, and in another scene, which may lie where the old one did. O.resetTime is not one.
bool LbmEngine::begins() const { return !fluid_ || started_in_ != scene || scene_is_there_.expired(); }

/// Before the lock is taken: queries hold the interpreter while they wait for the lock.
void LbmEngine::ask_python()
{
    asked_ = {};
    const Interpreter held;
    try {
        std::vector<lbm::Solid> solids;
        read_solids(*scene, {settings_.mask, settings_.ids}, solids);
        asked_.lubrication_law = lubrication_law(*scene);
        asked_.contact_frequency = contact_frequency(*scene, solids);
        asked_.warnings = scene_warnings(*scene, settings_, solids);
    } catch (const boost::python::error_already_set&) {
        PyErr_Clear();
    }
}

/// As Python's warnings, which users can filter.
void LbmEngine::warn()
{
    const Interpreter held;
    const std::vector<std::string> warnings = std::exchange(asked_.warnings, {});
    for (const std::string& warning : warnings) {
        const std::string said = "LbmEngine: " + warning;
        if (PyErr_WarnEx(PyExc_RuntimeWarning, said.c_str(), 1) == 0) continue;
        PyErr_Clear();  // a filter makes warnings errors
        throw lbm::RunError(said);
    }
}

void LbmEngine::advance()
{
    const std::lock_guard lock(mutex_);
    if (fluid_ && begins()) forget();
    if (!failure_.empty())
        throw lbm::RunError("LbmEngine: the fluid stopped earlier and is lost: " + failure_ +
                            "; put a new LbmEngine, which starts from rest, into O.engines");
    if (!fluid_) start();
    follow_grains();
    if (replan_ && schedule_.fluid_step_due()) follow_time_step();
    check_grain_step();
    while (schedule_.fluid_step_due()) step_fluid();

    const Stopwatch out;
    held_.hold_for(schedule_.grain_dt(), schedule_.lead(), schedule_.fluid_dt());
    held_.write(*scene);
    account(kLoadsOut, out.seconds(), 1);
    if (settings_.lubrication) add_films();
}

/// Last of all, when the forces of this grain step are known.
void LbmEngine::add_films()
{
    const Stopwatch time;
    read_solids(*scene, {settings_.mask, settings_.ids}, surfaces_);
    foretell(*scene, schedule_.grain_dt(), surfaces_);
    film_loads_ = fluid_->film_loads(surfaces_, schedule_.grain_dt());
    for (std::size_t i = 0; i < surfaces_.size(); ++i) {
        const auto id = static_cast<yade::Body::id_t>(surfaces_[i].id);
        const lbm::Vec3 &force = film_loads_[i].force, &torque = film_loads_[i].torque;
        scene->forces.addForce(id, yade::Vector3r(force[0], force[1], force[2]));
        scene->forces.addTorque(id, yade::Vector3r(torque[0], torque[1], torque[2]));
    }
    account(kFilms, time.seconds(), 1);
}

void LbmEngine::forget()
{
    fluid_.reset();
    held_ = HeldLoads();
    surfaces_.clear();
    film_loads_.clear();
    failure_.clear();
    last_iter_ = -1;
    replan_ = selection_changed_ = false;
    solids_before_.clear();
    times_moved_still_ = 0;
    moved_still_ = -1;
}

void LbmEngine::start()
{
    started_in_ = scene;
    scene_is_there_ = Singleton<yade::Omega>::instance().getScene();
    read_solids(*scene, {settings_.mask, settings_.ids}, solids_);
    check_scene(*scene, settings_, solids_);
    check_lubrication(settings_, asked_.lubrication_law);
    lbm::PlanRequest request = plan_request(*scene, settings_, solids_);
    request.contact_frequency = asked_.contact_frequency;
    const lbm::Plan plan = lbm::plan_time_step(request);
    asked_.warnings.insert(asked_.warnings.begin(), plan.warnings.begin(), plan.warnings.end());
    auto fluid = std::make_unique<lbm::Fluid>(fluid_config(settings_, plan.tau, threads_to_use()));
    for (std::string& warning : fluid_warnings(fluid->config(), solids_)) asked_.warnings.push_back(std::move(warning));
    if (loaded_ && scene->iter > 0)
        asked_.warnings.push_back("the scene goes on at step " + std::to_string(scene->iter) +
                                  " with a fluid at rest: files of scenes do not hold the fluid.");
    loaded_ = false;
    schedule_ = Schedule(scene->dt, fluid->dt());
    fluid_ = std::move(fluid);
}

/// Of the fluid: 0 leaves it to OpenMP. More than there are processors only get into each other's way.
int LbmEngine::threads_to_use()
{
    const int processors = omp_get_num_procs();
    if (ompThreads <= processors) return std::max(0, ompThreads);
    asked_.warnings.push_back("ompThreads = " + std::to_string(ompThreads) + ": there are " +
                              std::to_string(processors) + " processors, so " + std::to_string(processors) +
                              " are used");
    return processors;
}

/// Brings the schedule and the deliveries to the start of this grain step.
void LbmEngine::follow_grains()
{
    // the same step again happens after an error; steps without us (dead, or out of O.engines) are not the fluid's
    if (last_iter_ >= 0 && scene->iter != last_iter_) {
        const double elapsed = length_of_last_grain_step(*scene);
        held_.delivered(elapsed);
        if (elapsed == schedule_.grain_dt()) schedule_.grains_stepped();
        else schedule_.grains_stepped_by(elapsed);
    }
    last_iter_ = scene->iter;
    last_time_ = scene->time;
    if (scene->dt == schedule_.grain_dt()) return;
    if (!(std::isfinite(scene->dt) && scene->dt > 0))
        throw lbm::ConfigError("O.dt = " + text(scene->dt) + ": must be finite and > 0 [s]");
    schedule_.change_grain_dt(scene->dt);
    replan_ = true;
}

/// Gives the fluid the time step that fits the grains' new one, if the present one has become a poor fit. Small changes are
/// left to the schedule, which follows by time: time steppers make many.
void LbmEngine::follow_time_step()
{
    replan_ = false;
    if (!std::isnan(settings_.tau)) return;
    read_solids(*scene, {settings_.mask, settings_.ids}, solids_);
    try {
        const lbm::Plan plan = lbm::plan_time_step(plan_request(*scene, settings_, solids_));
        const double ratio = plan.fluid_dt / fluid_->dt();
        if (ratio < kPoorFit && ratio > 1 / kPoorFit) return;
        fluid_->change_tau(plan.tau);
        schedule_.change_fluid_dt(fluid_->dt());
    } catch (const lbm::ConfigError&) {
        // no better step than the present one, and that one still does: any ratio to the grains' step works
    }
}

/// The first one was checked with the plan.
void LbmEngine::check_grain_step() const
{
    const double most = lbm::kMaxFluidStepsPerGrainStep * fluid_->dt();
    if (schedule_.grain_dt() <= 1.001 * most) return;
    throw lbm::ConfigError("O.dt = " + text(schedule_.grain_dt()) + ": holds " +
                           text(schedule_.grain_dt() / fluid_->dt()) + " fluid steps of " + text(fluid_->dt()) +
                           " s, at most " + text(lbm::kMaxFluidStepsPerGrainStep) +
                           " are possible; use O.dt <= " + text(most));
}

/// A time stepper that stands behind the fluid changes O.dt after the loads were written: ask how far the scene's time
/// went. Time is a sum and carries round-off, so known lengths are preferred to the difference.
double LbmEngine::length_of_last_grain_step(const yade::Scene& now) const
{
    const double planned = schedule_.grain_dt();
    if (now.iter != last_iter_ + 1) return planned;
    const double elapsed = now.time - last_time_;
    const double round_off = 4e-16 * std::abs(now.time);
    for (double known : {planned, now.dt})
        if (std::abs(elapsed - known) <= 1e-6 * known + round_off) return known;
    return elapsed > 0 ? elapsed : planned;
}

/**
 * A fluid step that begins within a grain step meets the grains where they will be by then. They have taken up their loads of the fluid steps
 * before, and what films do to them: at the velocity of the grain step's beginning, light grains in a viscous liquid would get far more than it takes to stop them.
 */
void LbmEngine::step_fluid()
{
    check_place(*scene, settings_);
    const Stopwatch in;
    std::swap(solids_, solids_before_);
    read_solids(*scene, {settings_.mask, settings_.ids}, solids_);
    const double lead = schedule_.lead();
    if (lead > 0) {
        HeldLoads owed = held_;
        if (settings_.lubrication) {
            surfaces_ = solids_;
            foretell(*scene, lead, surfaces_, held_);
            owed.add(surfaces_, fluid_->film_loads(surfaces_, lead), lead);
        }
        foretell(*scene, lead, solids_, owed);
    }
    for (lbm::Solid& solid : solids_)
        for (int d = 0; d < 3; ++d) solid.position[d] += lead * solid.velocity[d];
    look_for_moves_without_velocity();
    check_cell(*scene, settings_, solids_);
    if (selection_changed_) check_selection(settings_, solids_);
    selection_changed_ = false;
    account(kStatesIn, in.seconds(), 1);

    const lbm::StepTimes before = fluid_->times();
    fluid_->place_solids(solids_);
    try {
        fluid_->step();
    } catch (const std::exception& error) {
        failure_ = error.what() + kept_state();
        throw lbm::RunError(failure_);
    }
    const lbm::StepTimes after = fluid_->times();
    account(kMap, after.map - before.map, 1);
    account(kExchange, after.exchange - before.exchange, 1);
    account(kCollideStream, after.collide_stream - before.collide_stream, 1);
    account(kLoads, after.loads - before.loads, 1);

    const Stopwatch out;
    held_.add(solids_, fluid_->loads(), fluid_->dt());
    schedule_.fluid_stepped();
    account(kLoadsOut, out.seconds(), 0);
}

/// Who sets state.pos in each step and not state.vel has a solid in another place whose surface does not drag the fluid. A body that is put elsewhere
/// once is all right.
void LbmEngine::look_for_moves_without_velocity()
{
    constexpr int kEnough = 3;
    if (times_moved_still_ >= kEnough) return;
    std::int64_t moved = -1;
    for (std::size_t i = 0; i < std::min(solids_.size(), solids_before_.size()) && moved < 0; ++i) {
        const lbm::Solid &now = solids_[i], &before = solids_before_[i];
        const bool still = now.velocity == lbm::Vec3{} && before.velocity == lbm::Vec3{};
        if (still && now.id == before.id && now.position != before.position) moved = now.id;
    }
    times_moved_still_ = moved >= 0 && moved == moved_still_ ? times_moved_still_ + 1 : moved >= 0;
    moved_still_ = moved;
    if (times_moved_still_ < kEnough) return;
    asked_.warnings.push_back("Body " + std::to_string(moved) +
                              " is moved from step to step and has no velocity: the fluid takes its surface to be at "
                              "rest; give it state.vel, or let TranslationEngine move it.");
}

void LbmEngine::account(Part part, double seconds, long executions)
{
    if (!yade::TimingInfo::enabled || !timingDeltas) return;
    if (timingDeltas->data.size() != kParts) {  // also after yade.timing.reset()
        timingDeltas->data.assign(kParts, yade::TimingInfo());
        timingDeltas->labels.assign(std::begin(kPartNames), std::end(kPartNames));
    }
    timingDeltas->data[part].nExec += executions;
    timingDeltas->data[part].nsec += static_cast<yade::TimingInfo::delta>(std::max(0.0, seconds) * 1e9);
}

/// Writes the fluid as it is for the user to look at; says where, or why not: the reason of the stop must get through.
std::string LbmEngine::kept_state() const
{
    if (settings_.stop_file.empty()) return "";
    try {
        fluid_->save_vtk(settings_.stop_file);
        return "; the state is in " + std::filesystem::absolute(settings_.stop_file).string();
    } catch (const std::exception& error) {
        return std::string("; the state is not kept: ") + error.what();
    }
}

}  // namespace yadelbm
