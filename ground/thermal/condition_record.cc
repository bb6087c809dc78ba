#include "ground/thermal/condition_record.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "common/base/units.h"
#include "ground/thermal/thermal_volume.h"

namespace isotherm {
namespace {

/// Mean and squares forget what is older than this: sums stay precise in 16 bits.
constexpr int kMemory = static_cast<int>(ConditionRecord::kMaxGoodCount);

float ToFloat(std::uint16_t upper) {
  return std::bit_cast<float>(static_cast<std::uint32_t>(upper) << 16);
}

/// Rounded to the nearest value with 8 bits of precision.
std::uint16_t UpperHalf(float value) {
  return static_cast<std::uint16_t>((std::bit_cast<std::uint32_t>(value) + 0x8000U) >> 16);
}

}  // namespace

float ConditionRecord::age_s() const {
  return age == kNoAge ? std::numeric_limits<float>::quiet_NaN()
                       : kAgeStep_s * static_cast<float>(age);
}

void DisagreementRecord::Add(std::uint16_t code, int count) {
  if (count == 0) {
    lowest = highest = mean = code;
    squares = 0;
    return;
  }
  lowest = std::min(lowest, code);
  highest = std::max(highest, code);
  const float n = static_cast<float>(std::min(count, kMemory));
  const float off = static_cast<float>(code) - static_cast<float>(mean);
  const float fraction = 1.0F / (n + 1.0F);
  // Welford's update; once the memory is full, each new square replaces an average old one.
  const float kept = count < kMemory ? ToFloat(squares) : ToFloat(squares) * (1.0F - 1.0F / n);
  squares = UpperHalf(kept + off * off * n * fraction);
  // Between the old mean and the code, so never outside 16 bits.
  mean = static_cast<std::uint16_t>(static_cast<float>(mean) + off * fraction + 0.5F);
}

float DisagreementRecord::range_k() const {
  return ThermalVoxel::kStep_k * static_cast<float>(highest - lowest);
}

float DisagreementRecord::spread_k(int count) const {
  if (count < 2) return 0.0F;
  const float n = static_cast<float>(std::min(count, kMemory));
  return ThermalVoxel::kStep_k * std::sqrt(ToFloat(squares) / (n - 1.0F));
}

namespace {

float SignOf(float v) { return v < 0.0F ? -1.0F : 1.0F; }

}  // namespace

std::uint16_t EncodeDirection(const Eigen::Vector3f& unit) {
  const float sum = unit.cwiseAbs().sum();
  float u = unit.x() / sum;
  float v = unit.y() / sum;
  if (unit.z() < 0.0F) {
    const float folded = (1.0F - std::abs(v)) * SignOf(u);
    v = (1.0F - std::abs(u)) * SignOf(v);
    u = folded;
  }
  const auto byte = [](float c) {
    return static_cast<std::uint32_t>(std::clamp(std::lround(127.5F * (c + 1.0F)), 0L, 255L));
  };
  return static_cast<std::uint16_t>(byte(u) | byte(v) << 8);
}

Eigen::Vector3f DecodeDirection(std::uint16_t code) {
  const float u = static_cast<float>(code & 0xFFU) / 127.5F - 1.0F;
  const float v = static_cast<float>(code >> 8) / 127.5F - 1.0F;
  Eigen::Vector3f p(u, v, 1.0F - std::abs(u) - std::abs(v));
  if (p.z() < 0.0F) {
    p.x() = (1.0F - std::abs(v)) * SignOf(u);
    p.y() = (1.0F - std::abs(u)) * SignOf(v);
  }
  return p.normalized();
}

float AngleToNormalDeg(std::uint16_t direction, const Eigen::Vector3f& normal) {
  const float cosine = normal.dot(DecodeDirection(direction));
  return static_cast<float>(1.0 / kRadPerDeg) * std::acos(std::clamp(cosine, -1.0F, 1.0F));
}

}  // namespace isotherm
