#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "common/time/clock.h"

namespace isotherm {

/// Samples and packets that the middleware dropped itself, before any reader of ours saw them.
struct MiddlewareRefusals {
  std::uint64_t oversize = 0;   ///< Larger than MaxSampleSize of the profile.
  std::uint64_t malformed = 0;  ///< Not what the type says, beyond a bound, or not a valid packet.
};

/// Process-wide preparation for DDS. Construct it first thing in main(), before any thread starts,
/// and keep it until the last Participant is gone. It
///   - keeps freed memory for large samples (mallopt), which makes writing and taking them ten
///   times faster,
///   - sets CYCLONEDDS_URI to the compiled-in loopback profile if the variable is unset, so that
///   nothing leaves
///     this computer unless somebody said so (deploy/cyclonedds-lan.xml),
///   - sends the middleware's messages to our log, of each kind one at once, then one in ten
///   seconds with the number left out between (TextLimiter).
/// One per process. Thread-safe.
class TransportEnvironment {
 public:
  /// `clock` must outlive this object.
  explicit TransportEnvironment(const Clock& clock);
  ~TransportEnvironment();
  TransportEnvironment(const TransportEnvironment&) = delete;
  TransportEnvironment& operator=(const TransportEnvironment&) = delete;

  /// Keeps the middleware's messages out of the log during its life, for what is tried again and
  /// again.
  class Quiet {
   public:
    explicit Quiet(const TransportEnvironment& environment);
    ~Quiet();
    Quiet(const Quiet&) = delete;
    Quiet& operator=(const Quiet&) = delete;

   private:
    const TransportEnvironment& environment_;
  };

  /// The newest error of the middleware, in its words; empty if there was none.
  std::string last_error() const;
  /// Messages of the middleware that were left out of the log because there were too many.
  std::uint64_t suppressed_log_lines() const;
  /// Known from the middleware's messages only: a lower bound.
  MiddlewareRefusals refused() const;

 private:
  struct LogSink;
  std::unique_ptr<LogSink> sink_;
};

/// The loopback profile that is used when CYCLONEDDS_URI is unset (text of
/// deploy/cyclonedds-loopback.xml).
const char* DefaultProfile();

}  // namespace isotherm
