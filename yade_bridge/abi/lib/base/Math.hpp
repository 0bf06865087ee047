#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <boost/shared_ptr.hpp>

#if !defined(EIGEN_MAX_STATIC_ALIGN_BYTES) || EIGEN_MAX_STATIC_ALIGN_BYTES != 0
#error "YADE's objects are laid out with unaligned Eigen types: compile with EIGEN_MAX_STATIC_ALIGN_BYTES=0"
#endif

namespace yade {

using boost::shared_ptr;
using Real = double;
using Vector3r = Eigen::Matrix<Real, 3, 1>;
using Matrix3r = Eigen::Matrix<Real, 3, 3>;
using Quaternionr = Eigen::Quaternion<Real>;

template <typename Scalar>
class Se3 {
public:
    Eigen::Matrix<Scalar, 3, 1> position;
    Eigen::Quaternion<Scalar> orientation;
};
using Se3r = Se3<Real>;

}  // namespace yade
