#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>

#include "common/base/enum_array.h"
#include "common/base/status.h"
#include "common/geometry/external_odometry.h"
#include "common/geometry/rigid_transform.h"
#include "ground/options/ground_options.pb.h"

namespace isotherm {

Status Validate(const ExternalOdometryOptions& options);
Status Validate(const ExternalOdometryExpertOptions& options);

/// Says why a sample is refused, in the order of the names, as in stats.json.
enum class OdometryFault : std::uint8_t {
  kJump,  ///< Farther from the one before than the rig can go.
  kNotFinite,
  kOtherSource,
  kQuaternion,  ///< Not a rotation.
  kSigma,       ///< An uncertainty that cannot be.
  kTime,        ///< Not later than the one before.
  kCount
};
/// "jump", as in stats.json.
std::string_view ToString(OdometryFault fault);

/// Holds what became of the samples: in = accepted + all refused.
struct OdometryStreamCounts {
  std::uint64_t in = 0;
  std::uint64_t accepted = 0;
  EnumArray<OdometryFault, std::uint64_t> refused;
  std::uint64_t gaps = 0;      ///< Between accepted samples, longer than max_gap_s.
  std::uint64_t restarts = 0;  ///< The source went on in another reference frame or time.
};

/// The newest poses of an odometry source: refuses what cannot be, and says where the depth camera
/// was at a time. Bounded. Thread-compatible.
class OdometryStream {
 public:
  explicit OdometryStream(const ExternalOdometryOptions& options);

  /// In order of capture time. A sample that cannot follow the one before (time, jump) is refused;
  /// if the next one follows it, the source has started again, and all before is forgotten.
  void Add(const ExternalOdometry& sample);

  /// Holds the depth camera's pose in the source's reference frame.
  struct Estimate {
    RigidTransform T_reference_depth;
    bool has_position = true;
    double position_noise_m = 0.0;  ///< One sigma of this pose alone.
    double rotation_noise_rad = 0.0;
  };
  /// Linear and SLERP between the samples around `time` (eq. 6.1), or carried on from the newest by
  /// at most max_ahead_s. nullopt: not known.
  std::optional<Estimate> At(CaptureTime time) const;

  const std::string& source() const { return source_; }
  const OdometryStreamCounts& counts() const { return counts_; }

 private:
  /// Holds a pose that was found to be of use.
  struct Sample {
    CaptureTime time;
    Estimate estimate;
    double time_sigma_s = 0.0;
  };
  /// Says why the sample is of no use by itself; nullopt if it is of use.
  std::optional<OdometryFault> FindFault(const ExternalOdometry& sample) const;
  Sample ToSample(const ExternalOdometry& pose) const;
  bool IsTooFast(const Sample& before, const Sample& after) const;
  bool Follows(const Sample& before, const Sample& after) const;
  void Refuse(OdometryFault fault);
  void Append(const Sample& sample);
  Estimate Between(const Sample& a, const Sample& b, CaptureTime time) const;
  std::optional<Estimate> Ahead(CaptureTime time) const;

  const ExternalOdometryOptions options_;
  RigidTransform T_body_depth_;
  std::string source_;
  std::deque<Sample> samples_;
  std::optional<Sample> suspect_;  ///< The last one refused, if only for what was before it.
  OdometryStreamCounts counts_;
};

}  // namespace isotherm
