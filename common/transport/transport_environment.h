#pragma once

#include <cstdint>
#include <memory>

#include "common/time/clock.h"

namespace isotherm {

/// Process-wide preparation for DDS. Construct it first thing in main(), before any thread starts,
/// and keep it until the last Participant is gone. It
///   - keeps freed memory for large samples (mallopt), which makes writing and taking them ten
///   times faster,
///   - sets CYCLONEDDS_URI to the compiled-in loopback profile if the variable is unset, so that
///   nothing leaves
///     this computer unless somebody said so (deploy/cyclonedds-lan.xml),
///   - sends the middleware's messages to our log, at most ten lines per second.
/// One per process. Thread-safe.
class TransportEnvironment {
 public:
  /// `clock` must outlive this object.
  explicit TransportEnvironment(const Clock& clock);
  ~TransportEnvironment();
  TransportEnvironment(const TransportEnvironment&) = delete;
  TransportEnvironment& operator=(const TransportEnvironment&) = delete;

  /// Messages of the middleware that were left out of the log because there were too many.
  std::uint64_t suppressed_log_lines() const;

 private:
  struct LogSink;
  std::unique_ptr<LogSink> sink_;
};

/// The loopback profile that is used when CYCLONEDDS_URI is unset (text of
/// deploy/cyclonedds-loopback.xml).
const char* DefaultProfile();

}  // namespace isotherm
