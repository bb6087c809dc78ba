#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>

#include "common/base/status.h"
#include "common/transport/announcement.h"
#include "common/transport/transport_environment.h"

namespace isotherm {

/// Handle of a DDS entity, deleted at the end of its life. Move-only. Thread-compatible.
class DdsHandle {
 public:
  DdsHandle() = default;
  explicit DdsHandle(std::int32_t value) : value_(value) {}
  DdsHandle(DdsHandle&& other) noexcept;
  DdsHandle& operator=(DdsHandle&& other) noexcept;
  ~DdsHandle();
  std::int32_t value() const { return value_; }

 private:
  std::int32_t value_ = 0;
};

/// Largest domain whose ports fit below 65536.
inline constexpr int kMaxDomainId = 230;

/// Membership in one DDS domain. Its destruction tells the peers at once that this side has left.
/// Thread-safe.
class Participant {
 public:
  /// kInvalidArgument for a domain outside 0..kMaxDomainId; kUnavailable if the middleware cannot
  /// start, e.g. because of a wrong profile in CYCLONEDDS_URI (the middleware's reason is in the
  /// log). It says to the domain what `announcement` says, if there is one.
  static Result<std::unique_ptr<Participant>> Create(
      const TransportEnvironment& environment, int domain_id,
      const std::optional<Announcement>& announcement = std::nullopt);
  std::int32_t handle() const { return handle_.value(); }
  /// Returns how the others of the domain know this process (a PeerHandle).
  std::uint64_t peer() const;

 private:
  explicit Participant(DdsHandle handle) : handle_(std::move(handle)) {}
  DdsHandle handle_;
};

}  // namespace isotherm
