#include "lbm_engine.hpp"

// after the archives it must serve, which the engine's header brings with YADE's
#include <boost/serialization/array.hpp>
#include <boost/serialization/export.hpp>
#include <boost/serialization/string.hpp>
#include <boost/serialization/vector.hpp>

BOOST_CLASS_EXPORT_KEY2(yadelbm::LbmEngine, "yadelbm::LbmEngine")

namespace yadelbm {

/// The attributes. The fluid itself is not saved: a loaded one starts from rest.
template <class Archive>
void LbmEngine::serialize(Archive& archive, unsigned int)
{
    using boost::serialization::make_nvp;
    if constexpr (Archive::is_loading::value) loaded_ = true;
    archive& make_nvp("GlobalEngine", boost::serialization::base_object<yade::GlobalEngine>(*this));
    archive& make_nvp("lower", settings_.lower);
    archive& make_nvp("upper", settings_.upper);
    archive& make_nvp("dx", settings_.dx);
    archive& make_nvp("density", settings_.density);
    archive& make_nvp("viscosity", settings_.viscosity);
    archive& make_nvp("gravity", settings_.gravity);
    archive& make_nvp("acceleration", settings_.acceleration);
    archive& make_nvp("initialVelocity", settings_.initial_velocity);
    archive& make_nvp("boundary", settings_.boundary);
    archive& make_nvp("boundaryVelocity", settings_.boundary_velocity);
    archive& make_nvp("boundaryPressure", settings_.boundary_pressure);
    archive& make_nvp("tau", settings_.tau);
    archive& make_nvp("magicParameter", settings_.magic_parameter);
    archive& make_nvp("inertia", settings_.inertia);
    archive& make_nvp("scheme", settings_.scheme);
    archive& make_nvp("collision", settings_.collision);
    archive& make_nvp("lattice", settings_.lattice);
    archive& make_nvp("storage", settings_.storage);
    archive& make_nvp("mask", settings_.mask);
    archive& make_nvp("ids", settings_.ids);
    archive& make_nvp("lubrication", settings_.lubrication);
    archive& make_nvp("lubricationRoughness", settings_.lubrication_roughness);
    archive& make_nvp("maxMach", settings_.max_mach);
    archive& make_nvp("accuracy", settings_.accuracy);
    archive& make_nvp("stopFile", settings_.stop_file);
    archive& make_nvp("ranks", settings_.ranks);
}

}  // namespace yadelbm

BOOST_CLASS_EXPORT_IMPLEMENT(yadelbm::LbmEngine)
