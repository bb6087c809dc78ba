#include "ground/evaluation/rigid_alignment.h"

#include <Eigen/Dense>

#include "common/base/check.h"

namespace isotherm {

RigidTransform AlignRigid(std::span<const Eigen::Vector3d> from,
                          std::span<const Eigen::Vector3d> to) {
  CHECK(from.size() == to.size());
  RigidTransform result = RigidTransform::Identity();
  if (from.empty()) return result;
  const double weight = 1.0 / static_cast<double>(from.size());
  Eigen::Vector3d from_mean = Eigen::Vector3d::Zero();
  Eigen::Vector3d to_mean = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < from.size(); ++i) {
    from_mean += weight * from[i];
    to_mean += weight * to[i];
  }
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < from.size(); ++i) {
    covariance += weight * (to[i] - to_mean) * (from[i] - from_mean).transpose();
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance,
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d signs = Eigen::Vector3d::Ones();
  if ((svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0) signs.z() = -1.0;
  result.linear() = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  result.translation() = to_mean - result.linear() * from_mean;
  return result;
}

}  // namespace isotherm
