#include "common/rig/depth_bias.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace isotherm {

double DepthBias::InLayer(int distance, double x, double y) const {
  const double column = std::clamp(x, 0.0, 1.0) * (columns - 1);
  const double row = std::clamp(y, 0.0, 1.0) * (rows - 1);
  const int left = std::min(static_cast<int>(column), columns - 2);
  const int top = std::min(static_cast<int>(row), rows - 2);
  const double right_share = column - left, lower_share = row - top;
  const auto across = [&](int r) {
    return (1.0 - right_share) * Node(distance, r, left) +
           right_share * Node(distance, r, left + 1);
  };
  return (1.0 - lower_share) * across(top) + lower_share * across(top + 1);
}

double DepthBias::At(double x, double y, double measured_m) const {
  if (empty()) return 1.0;
  double multiplier = InLayer(0, x, y);
  for (std::size_t k = 1; k < distances_m.size(); ++k) {
    const double share = std::clamp(
        (measured_m - distances_m[k - 1]) / (distances_m[k] - distances_m[k - 1]), 0.0, 1.0);
    const int layer = static_cast<int>(k);
    multiplier += share * (InLayer(layer, x, y) - InLayer(layer - 1, x, y));
  }
  return multiplier;
}

Status Validate(const DepthBias& bias) {
  if (bias.empty() && bias.distances_m.empty()) return OkStatus();
  const auto is_side = [](int nodes) {
    return nodes >= DepthBias::kMinSide && nodes <= DepthBias::kMaxSide;
  };
  if (!is_side(bias.columns) || !is_side(bias.rows)) {
    return InvalidArgument(
        fmt::format("depth_sensor.bias: columns and rows must be {}..{}, got {} "
                    "and {}",
                    DepthBias::kMinSide, DepthBias::kMaxSide, bias.columns, bias.rows));
  }
  const std::vector<float>& d = bias.distances_m;
  const bool ascends =
      std::adjacent_find(d.begin(), d.end(), [](float a, float b) { return !(a < b); }) == d.end();
  if (d.empty() || d.size() > DepthBias::kMaxDistances || !ascends || !(d.front() > 0.0F) ||
      !(d.back() <= 100.0F)) {
    return InvalidArgument(fmt::format(
        "depth_sensor.bias.distance_m: need 1..{} ascending distances above 0 and up to 100 m",
        DepthBias::kMaxDistances));
  }
  const std::size_t nodes = d.size() * static_cast<std::size_t>(bias.columns * bias.rows);
  if (bias.multipliers.size() != nodes) {
    return InvalidArgument(fmt::format(
        "depth_sensor.bias.multiplier: {} distances x {} rows x {} columns need {} values, got {}",
        d.size(), bias.rows, bias.columns, nodes, bias.multipliers.size()));
  }
  const auto is_multiplier = [](float m) {
    return m >= DepthBias::kMinMultiplier && m <= DepthBias::kMaxMultiplier;
  };
  if (!std::all_of(bias.multipliers.begin(), bias.multipliers.end(), is_multiplier)) {
    return InvalidArgument(fmt::format("depth_sensor.bias.multiplier: values must be {}..{}",
                                       DepthBias::kMinMultiplier, DepthBias::kMaxMultiplier));
  }
  return OkStatus();
}

}  // namespace isotherm
