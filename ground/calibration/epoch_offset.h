#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

namespace isotherm {

/// Says by how much a place of the surface was warmer after a NUC than before it.
struct PlaceDifference {
  std::uint8_t before = 0, after = 0;                 ///< NUC epochs.
  Eigen::Vector3d p_world = Eigen::Vector3d::Zero();  ///< Metres.
  double kelvin = 0.0;
};

/// Says by how much all that the thermal camera sees seems warmer after a NUC than before it.
struct EpochOffset {
  double kelvin = 0.0, sigma_k = 0.0;  ///< One standard deviation.
};

/// The median over the surface, for the pair of epochs where it is largest. Its uncertainty is the
/// scatter of parts of the surface of 0.1 m, for places nearby are off alike; nullopt if too few
/// were seen in two epochs.
std::optional<EpochOffset> LargestEpochOffset(const std::vector<PlaceDifference>& differences);

}  // namespace isotherm
