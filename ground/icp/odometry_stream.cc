#include "ground/icp/odometry_stream.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/base/log.h"
#include "common/base/units.h"
#include "ground/options/option_geometry.h"

namespace isotherm {
namespace {

constexpr std::size_t kMaxSamples = 4096;  ///< Four seconds at 1 kHz.
/// Senders round; what is further off is not a rotation.
constexpr double kUnitTolerance = 0.01;
/// Jitter that two neighbouring poses may show on top of the greatest speed, in sigmas.
/// Smaller: sound poses are refused, one in 370 at 3; larger: a jump passes for jitter.
constexpr double kJitterSigmas = 4.0;
/// A rig in somebody's hands may accelerate so much while its motion is carried on from the newest
/// sample.
constexpr double kAcceleration = 2.0;         ///< m/s²
constexpr double kAngularAcceleration = 4.0;  ///< rad/s²

constexpr EnumArray<OdometryFault, std::string_view> kNames = {
    {OdometryFault::kJump, "jump"},
    {OdometryFault::kNotFinite, "not_finite"},
    {OdometryFault::kOtherSource, "other_source"},
    {OdometryFault::kQuaternion, "quaternion"},
    {OdometryFault::kSigma, "sigma"},
    {OdometryFault::kTime, "time"}};

bool IsSigma(double sigma) { return std::isnan(sigma) || sigma >= 0.0; }

}  // namespace

std::string_view ToString(OdometryFault fault) { return kNames[fault]; }

Status Validate(const ExternalOdometryOptions& o) {
  if (o.has_t_depth_body()) {
    if (const Result<RigidTransform> pose = ToTransform(o.t_depth_body()); !pose)
      return pose.error().WithContext("tracker.external_odometry.T_depth_body");
  }
  return Validate(o.expert());
}

Status Validate(const ExternalOdometryExpertOptions& o) {
  const auto check = [](const char* name, double value, double limit) {
    if (value > 0.0 && value <= limit) return OkStatus();
    return InvalidArgument(
        fmt::format("tracker.external_odometry.expert.{} must be above 0 and at most {}, got {}",
                    name, limit, value));
  };
  ISOTHERM_RETURN_IF_ERROR(check("max_gap_s", o.max_gap_s(), 10.0));
  ISOTHERM_RETURN_IF_ERROR(check("max_speed_m_s", o.max_speed_m_s(), 100.0));
  ISOTHERM_RETURN_IF_ERROR(check("max_rotation_deg_s", o.max_rotation_deg_s(), 10'000.0));
  ISOTHERM_RETURN_IF_ERROR(check("max_disagreement_m", o.max_disagreement_m(), 1.0));
  ISOTHERM_RETURN_IF_ERROR(check("position_sigma_m", o.position_sigma_m(), 1.0));
  ISOTHERM_RETURN_IF_ERROR(check("rotation_sigma_deg", o.rotation_sigma_deg(), 45.0));
  if (!(o.max_ahead_s() >= 0.0 && o.max_ahead_s() <= 1.0)) {
    return InvalidArgument(fmt::format(
        "tracker.external_odometry.expert.max_ahead_s must be 0 (wait for none) to 1 s, got {}",
        o.max_ahead_s()));
  }
  if (!(o.drift_ratio() >= 0.0 && o.drift_ratio() <= 1.0)) {
    return InvalidArgument(fmt::format(
        "tracker.external_odometry.expert.drift_ratio must be 0 to 1, got {}", o.drift_ratio()));
  }
  return OkStatus();
}

OdometryStream::OdometryStream(const ExternalOdometryOptions& options)
    : options_(options),
      T_body_depth_(RigidTransform::Identity()),
      source_(options.expert().source()) {
  if (!options.has_t_depth_body()) return;
  T_body_depth_ = ToTransform(options.t_depth_body())->inverse();
}

std::optional<OdometryFault> OdometryStream::FindFault(const ExternalOdometry& sample) const {
  if (sample.source != source_) return OdometryFault::kOtherSource;
  const bool finite = (!sample.has_position() || sample.translation_m.allFinite()) &&
                      sample.rotation.coeffs().allFinite();
  if (!finite) return OdometryFault::kNotFinite;
  if (!(std::abs(sample.rotation.norm() - 1.0) <= kUnitTolerance))
    return OdometryFault::kQuaternion;
  if (!IsSigma(sample.position_sigma_m) || !IsSigma(sample.rotation_sigma_rad) ||
      std::isinf(sample.rotation_sigma_rad) || sample.time_sigma < Nanoseconds(0)) {
    return OdometryFault::kSigma;
  }
  return std::nullopt;
}

OdometryStream::Sample OdometryStream::ToSample(const ExternalOdometry& pose) const {
  Sample sample;
  sample.time = pose.time;
  sample.time_sigma_s = ToSeconds(pose.time_sigma);
  Estimate& estimate = sample.estimate;
  estimate.has_position = pose.has_position();
  const RigidTransform T_reference_body = MakeTransform(
      pose.has_position() ? pose.translation_m : Eigen::Vector3d::Zero(), pose.rotation);
  estimate.T_reference_depth = T_reference_body * T_body_depth_;
  const auto known_or = [](double sigma, double usual) {
    return std::isnan(sigma) ? usual : sigma;
  };
  estimate.position_noise_m =
      pose.has_position() ? known_or(pose.position_sigma_m, options_.expert().position_sigma_m())
                          : 0.0;
  estimate.rotation_noise_rad =
      known_or(pose.rotation_sigma_rad, options_.expert().rotation_sigma_deg() * kRadPerDeg);
  return sample;
}

bool OdometryStream::IsTooFast(const Sample& before, const Sample& after) const {
  const double seconds = ToSeconds(after.time - before.time);
  const Estimate& a = before.estimate;
  const Estimate& b = after.estimate;
  const double rotation = RotationAngle(a.T_reference_depth, b.T_reference_depth);
  if (rotation > options_.expert().max_rotation_deg_s() * kRadPerDeg * seconds +
                     kJitterSigmas * std::hypot(a.rotation_noise_rad, b.rotation_noise_rad)) {
    return true;
  }
  if (!a.has_position || !b.has_position) return false;
  return TranslationDistance(a.T_reference_depth, b.T_reference_depth) >
         options_.expert().max_speed_m_s() * seconds +
             kJitterSigmas * std::hypot(a.position_noise_m, b.position_noise_m);
}

bool OdometryStream::Follows(const Sample& before, const Sample& after) const {
  return after.time > before.time &&
         ToSeconds(after.time - before.time) <= options_.expert().max_gap_s() &&
         !IsTooFast(before, after);
}

void OdometryStream::Refuse(OdometryFault fault) {
  if (counts_.refused[fault]++ == 0) {
    LOG(Tracker, Warning) << "a pose from \"" << source_
                          << "\" is refused, reason=" << ToString(fault)
                          << " (counted in stats.json; said once)";
  }
}

void OdometryStream::Append(const Sample& sample) {
  samples_.push_back(sample);
  if (samples_.size() > kMaxSamples) samples_.pop_front();
  ++counts_.accepted;
}

void OdometryStream::Add(const ExternalOdometry& pose) {
  ++counts_.in;
  if (source_.empty()) source_ = pose.source;
  if (const auto fault = FindFault(pose)) {
    Refuse(*fault);
    return;
  }
  const Sample sample = ToSample(pose);
  if (!samples_.empty()) {
    const Sample& newest = samples_.back();
    const bool is_late = sample.time <= newest.time;
    // Late by less than a gap, it comes out of order, or twice: nothing follows from that.
    const bool is_out_of_order =
        is_late && ToSeconds(newest.time - sample.time) <= options_.expert().max_gap_s();
    if (is_out_of_order) {
      Refuse(OdometryFault::kTime);
      return;
    }
    if (is_late || IsTooFast(newest, sample)) {
      // One such sample is an outlier. Two that follow each other are a source that has started
      // again, and refusing would never end.
      if (!suspect_ || !Follows(*suspect_, sample)) {
        Refuse(is_late ? OdometryFault::kTime : OdometryFault::kJump);
        suspect_ = sample;
        return;
      }
      // Between the old reference frame and the new one nothing can be interpolated.
      samples_.clear();
      ++counts_.restarts;
      LOG(Tracker, Warning) << "poses from \"" << source_ << "\" go on in another place or time";
    } else if (ToSeconds(sample.time - newest.time) > options_.expert().max_gap_s()) {
      ++counts_.gaps;
    }
  }
  suspect_.reset();
  Append(sample);
}

OdometryStream::Estimate OdometryStream::Between(const Sample& a, const Sample& b,
                                                 CaptureTime time) const {
  const double span_s = ToSeconds(b.time - a.time);
  const double fraction = ToSeconds(time - a.time) / span_s;
  Estimate result;
  result.T_reference_depth =
      Interpolate(a.estimate.T_reference_depth, b.estimate.T_reference_depth, fraction);
  result.has_position = a.estimate.has_position && b.estimate.has_position;
  // Beyond the newest sample, the jitter of both ends grows with the lever.
  const double lever = fraction > 1.0 ? std::hypot(fraction, fraction - 1.0) : 1.0;
  const double ahead_s = std::max(0.0, ToSeconds(time - b.time));
  const double time_sigma_s = std::max(a.time_sigma_s, b.time_sigma_s);
  const auto noise = [&](double jitter, double motion, double acceleration) {
    return std::hypot(lever * jitter, motion / span_s * time_sigma_s,
                      0.5 * acceleration * ahead_s * (ahead_s + span_s));
  };
  const RigidTransform& from = a.estimate.T_reference_depth;
  const RigidTransform& to = b.estimate.T_reference_depth;
  if (result.has_position) {
    result.position_noise_m =
        noise(std::max(a.estimate.position_noise_m, b.estimate.position_noise_m),
              TranslationDistance(from, to), kAcceleration);
  }
  result.rotation_noise_rad =
      noise(std::max(a.estimate.rotation_noise_rad, b.estimate.rotation_noise_rad),
            RotationAngle(from, to), kAngularAcceleration);
  return result;
}

std::optional<OdometryStream::Estimate> OdometryStream::Ahead(CaptureTime time) const {
  const Sample& newest = samples_.back();
  const Nanoseconds ahead = time - newest.time;
  if (ToSeconds(ahead) > options_.expert().max_ahead_s()) return std::nullopt;
  // The velocity over as long as it is carried on, so that jitter does not grow much.
  for (auto before = std::next(samples_.rbegin()); before != samples_.rend(); ++before) {
    if (ToSeconds(std::prev(before)->time - before->time) > options_.expert().max_gap_s()) break;
    if (newest.time - before->time >= ahead) return Between(*before, newest, time);
  }
  return std::nullopt;
}

std::optional<OdometryStream::Estimate> OdometryStream::At(CaptureTime time) const {
  if (samples_.empty() || time < samples_.front().time) return std::nullopt;
  if (time > samples_.back().time) return Ahead(time);
  const auto after = std::lower_bound(
      samples_.begin(), samples_.end(), time,
      [](const Sample& sample, CaptureTime wanted) { return sample.time < wanted; });
  const bool is_connected =
      after != samples_.begin() &&
      ToSeconds(after->time - std::prev(after)->time) <= options_.expert().max_gap_s();
  if (is_connected) return Between(*std::prev(after), *after, time);
  // The first sample behind a gap is known, but nothing between it and the one before.
  return after->time == time ? std::optional(after->estimate) : std::nullopt;
}

}  // namespace isotherm
