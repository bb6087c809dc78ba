#include "ground/calibration/epoch_offset.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace isotherm {
namespace {

constexpr double kPart_m = 0.1;
// The median of fewer places is mostly noise; that of fewer parts has no scatter to speak of.
constexpr std::size_t kMinPlaces = 10, kMinParts = 5;
// From the median deviation to a standard deviation, and from a mean's uncertainty to a median's,
// of normal distributions.
constexpr double kSigmaOfMad = 1.4826, kMedianOverMean = 1.2533;

/// `values` are not empty; their order changes.
double Median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::optional<EpochOffset> OffsetOf(std::vector<double> part_medians) {
  if (part_medians.size() < kMinParts) return std::nullopt;
  EpochOffset offset;
  offset.kelvin = Median(part_medians);
  const auto parts = static_cast<double>(part_medians.size());
  for (double& value : part_medians) value = std::abs(value - offset.kelvin);
  offset.sigma_k = kMedianOverMean * kSigmaOfMad * Median(part_medians) / std::sqrt(parts);
  return offset;
}

}  // namespace

std::optional<EpochOffset> LargestEpochOffset(const std::vector<PlaceDifference>& differences) {
  using Pair = std::pair<std::uint8_t, std::uint8_t>;
  std::map<std::pair<Pair, std::array<int, 3>>, std::vector<double>> parts;
  for (const PlaceDifference& place : differences) {
    const Eigen::Vector3i cell = (place.p_world / kPart_m).array().floor().cast<int>();
    parts[{{place.before, place.after}, {cell.x(), cell.y(), cell.z()}}].push_back(place.kelvin);
  }
  std::map<Pair, std::vector<double>> medians;
  for (auto& [key, kelvin] : parts) {
    if (kelvin.size() >= kMinPlaces) medians[key.first].push_back(Median(kelvin));
  }
  std::optional<EpochOffset> largest;
  for (auto& [pair, part_medians] : medians) {
    const std::optional<EpochOffset> offset = OffsetOf(std::move(part_medians));
    if (offset && (!largest || std::abs(offset->kelvin) > std::abs(largest->kelvin)))
      largest = offset;
  }
  return largest;
}

}  // namespace isotherm
