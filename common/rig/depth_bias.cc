#include "common/rig/depth_bias.h"

#include <fmt/format.h>

#include <algorithm>

#include "common/rig/depth_bias_nodes.h"

namespace isotherm {

NodeShares SharesAt(const DepthBias& table, double x, double y, double measured_m) {
  const double column = std::clamp(x, 0.0, 1.0) * (table.columns - 1);
  const double row = std::clamp(y, 0.0, 1.0) * (table.rows - 1);
  const int left = std::min(static_cast<int>(column), table.columns - 2);
  const int top = std::min(static_cast<int>(row), table.rows - 2);
  const double right = column - left, lower = row - top;
  const std::vector<float>& d = table.distances_m;
  const auto beyond = std::upper_bound(d.begin(), d.end(), measured_m) - d.begin();
  const auto last = static_cast<std::ptrdiff_t>(d.size()) - 1;
  const auto far = static_cast<std::size_t>(std::min(beyond, last));
  const auto near = static_cast<std::size_t>(std::max<std::ptrdiff_t>(beyond - 1, 0));
  const double farther = far == near ? 0.0 : (measured_m - d[near]) / (d[far] - d[near]);
  NodeShares at{};
  for (std::size_t i = 0; i < at.nodes.size(); ++i) {
    const bool is_far = (i & 4U) != 0, is_lower = (i & 2U) != 0, is_right = (i & 1U) != 0;
    const int layer = static_cast<int>(is_far ? far : near);
    at.nodes[i] =
        static_cast<std::size_t>((layer * table.rows + top + (is_lower ? 1 : 0)) * table.columns +
                                 left + (is_right ? 1 : 0));
    at.shares[i] = (is_far ? farther : 1.0 - farther) * (is_lower ? lower : 1.0 - lower) *
                   (is_right ? right : 1.0 - right);
  }
  return at;
}

double DepthBias::InLayer(int distance, double x, double y) const {
  return At(x, y, distances_m[static_cast<std::size_t>(distance)]);
}

double DepthBias::At(double x, double y, double measured_m) const {
  if (empty()) return 1.0;
  const NodeShares at = SharesAt(*this, x, y, measured_m);
  double multiplier = 0.0;
  for (std::size_t i = 0; i < at.nodes.size(); ++i)
    multiplier += at.shares[i] * multipliers[at.nodes[i]];
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
