#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace isotherm {

/// The conditions under which the temperature of a voxel was measured, in 8 bytes.
struct ConditionRecord {
  /// Distance, age and count share 32 bits: 14 bits of half millimetres reach 8.2 m, 12 bits of
  /// quarter seconds 17 minutes, 6 bits 63 measurements. A distance or count beyond is entered as
  /// the largest, an age as not known.
  static constexpr float kDistanceStep_m = 5e-4F;
  static constexpr float kAgeStep_s = 0.25F;
  static constexpr std::uint32_t kMaxDistance = (1U << 14) - 1;
  static constexpr std::uint32_t kNoAge = (1U << 12) - 1;
  static constexpr std::uint32_t kMaxGoodCount = (1U << 6) - 1;

  std::uint16_t direction = 0;  ///< From the surface to the camera (EncodeDirection).
  std::uint8_t epoch = 0;       ///< NUCs so far in the session, modulo 256.
  std::uint8_t cosine = 0;  ///< Cosine of the angle to the surface that was seen then, in 1/255.
  std::uint32_t distance : 14 = 0;  ///< Steps of 0.5 mm; 0 = no record.
  std::uint32_t age : 12 = 0;  ///< Since the NUC, steps of 0.25 s; kNoAge = not known or longer.
  /// Measurements in the voxel's DisagreementRecord; stops at kMaxGoodCount.
  std::uint32_t good_count : 6 = 0;

  bool empty() const { return distance == 0; }
  float distance_m() const { return kDistanceStep_m * static_cast<float>(distance); }
  float cosine_seen() const { return static_cast<float>(cosine) / 255.0F; }
  /// Seconds since the NUC; NaN = not known.
  float age_s() const;
};
static_assert(sizeof(ConditionRecord) == 8);

/// Holds what measurements of a voxel under good conditions had in common, in 8 bytes; how many
/// they were stands in the ConditionRecord. Temperatures as ThermalVoxel's codes.
struct DisagreementRecord {
  std::uint16_t lowest = 0, highest = 0;
  std::uint16_t mean = 0;     ///< For the spread only.
  std::uint16_t squares = 0;  ///< Sum of squared deviations, upper half of a float, codes squared.

  /// Takes in one more code; `count` before it.
  void Add(std::uint16_t code, int count);
  float range_k() const;
  /// Standard deviation of `count` measurements, kelvin; 0 for fewer than two.
  float spread_k(int count) const;
};
static_assert(sizeof(DisagreementRecord) == 8);

/// Both for the 8 voxels of a row along x, 128 bytes.
struct RecordRow {
  static constexpr int kVoxels = 8;
  ConditionRecord conditions[kVoxels];
  DisagreementRecord disagreement[kVoxels];
};

/// A unit vector in 16 bits, to less than a degree: on the octahedron |x| + |y| + |z| = 1 folded
/// flat (Meyer et al., On floating-point normal vectors, 2010), 8 bits along each axis.
std::uint16_t EncodeDirection(const Eigen::Vector3f& unit);
Eigen::Vector3f DecodeDirection(std::uint16_t code);
/// Between a coded direction and a unit normal, degrees.
float AngleToNormalDeg(std::uint16_t direction, const Eigen::Vector3f& normal);

}  // namespace isotherm
