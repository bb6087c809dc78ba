#pragma once

#include <google/protobuf/timestamp.pb.h>

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>

#include "common/base/units.h"
#include "common/recording/foxglove.pb.h"
#include "common/recording/recording_topics.h"
#include "common/time/time_types.h"

/// Converts the parts that several messages of a recording have in common.
namespace isotherm::recording {

inline constexpr char kDepthFrame[] = "depth";
inline constexpr char kThermalFrame[] = "thermal";

inline void SetTime(CaptureTime time, google::protobuf::Timestamp& message) {
  const std::int64_t ns = ToNanoseconds(time);
  message.set_seconds(ns / kNanosecondsPerSecond);
  message.set_nanos(static_cast<std::int32_t>(ns % kNanosecondsPerSecond));
}

/// nullopt if the time is none that a scan can have. Sums of two times that are left do not
/// overflow.
inline std::optional<CaptureTime> ToTime(const google::protobuf::Timestamp& message) {
  constexpr std::int64_t kMaxSeconds = kMaxRecordedNanoseconds / kNanosecondsPerSecond;
  if (message.seconds() < 0 || message.seconds() >= kMaxSeconds || message.nanos() < 0 ||
      message.nanos() >= kNanosecondsPerSecond) {
    return std::nullopt;
  }
  return CaptureTimeFromNanoseconds(message.seconds() * kNanosecondsPerSecond + message.nanos());
}

inline void SetVector(const Eigen::Vector3d& from, foxglove::Vector3& to) {
  to.set_x(from.x());
  to.set_y(from.y());
  to.set_z(from.z());
}

inline void SetQuaternion(const Eigen::Quaterniond& from, foxglove::Quaternion& to) {
  to.set_x(from.x());
  to.set_y(from.y());
  to.set_z(from.z());
  to.set_w(from.w());
}

/// The number as the enumerator, or `kUnknown` for one that this program does not know.
template <typename Enum>
Enum KnownOr(std::uint32_t value, Enum last, Enum unknown) {
  return value <= static_cast<std::uint32_t>(last) ? static_cast<Enum>(value) : unknown;
}

}  // namespace isotherm::recording
