#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "common/base/mutex.h"
#include "common/time/line_limiter.h"

namespace isotherm {

/// Says why a sample from the link is not used.
enum class RefusalCause : std::uint8_t {
  kIncomplete,       ///< It ends before what each version of our major has.
  kOversizePayload,  ///< More bytes than such an image can need.
  kEmptyPayload,
  kImpossibleSize,  ///< Width or height zero or absurd.
  kUnknownEncoding,
  kUnknownValue,  ///< An enumeration holds a value that this version does not know.
  kNotFinite,     ///< NaN or infinity where a number is needed.
  kOutOfRange,    ///< A number that cannot be (below absolute zero, a depth scale of 0, ...).
  kNegativeTime,
  kImpossibleNumber,  ///< Frame number that cannot be next in its session.
  kOtherSession,      ///< The sample is of a session that is over.
  kUndecodable,       ///< The payload does not decode.
  kOtherVersion,      ///< The peer speaks another major version.
  kOtherWriter,       ///< It calls itself the rig, but another process is.
  kUnannounced,       ///< The rig has not announced its session.
  kImplausibleTime,   ///< Capture time that cannot be next in its session.
  kNotTheGround,      ///< The sender has not said hello as a ground station of our version.
  kTooManyNames,      ///< One writer goes by more names than anybody has (InstanceLimit).
  kCount
};

/// One or two words, e.g. "oversize payload".
std::string_view ToString(RefusalCause cause);

/// Counts how many samples were refused, by cause.
using RefusalCounts = std::array<std::uint64_t, static_cast<std::size_t>(RefusalCause::kCount)>;

/// Counts what was refused, per cause, and logs it: of each cause the first, then one in ten
/// seconds with the number of those between. Thread-safe.
class RefusalCounter {
 public:
  RefusalCounter() = default;
  /// Everything is also added to `whole`, which writes the log; it must outlive this counter.
  explicit RefusalCounter(RefusalCounter* whole) : whole_(whole) {}

  /// `detail` says which sample: it goes into the log line.
  void Add(RefusalCause cause, std::string_view detail);
  std::uint64_t count(RefusalCause cause) const;
  std::uint64_t total() const;
  RefusalCounts counts() const;

 private:
  RefusalCounter* const whole_ = nullptr;
  mutable Mutex mutex_;
  RefusalCounts counts_ GUARDED_BY(mutex_){};
  std::array<LineLimiter, static_cast<std::size_t>(RefusalCause::kCount)> limiters_
      GUARDED_BY(mutex_){};
};

}  // namespace isotherm
