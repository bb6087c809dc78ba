#include "common/transport/participant.h"

#include <dds/dds.h>
#include <fmt/format.h>

namespace isotherm {

DdsHandle::DdsHandle(DdsHandle&& other) noexcept : value_(std::exchange(other.value_, 0)) {}

DdsHandle& DdsHandle::operator=(DdsHandle&& other) noexcept {
  std::swap(value_, other.value_);
  return *this;
}

DdsHandle::~DdsHandle() {
  if (value_ > 0) static_cast<void>(dds_delete(value_));
}

Result<std::unique_ptr<Participant>> Participant::Create(const TransportEnvironment& environment,
                                                         int domain_id) {
  static_cast<void>(environment);  // Its existence is what counts.
  if (domain_id < 0 || domain_id > kMaxDomainId) {
    return Err(
        InvalidArgument(fmt::format("DDS domain {} is outside 0..{}", domain_id, kMaxDomainId)));
  }
  DdsHandle handle(
      dds_create_participant(static_cast<dds_domainid_t>(domain_id), nullptr, nullptr));
  if (handle.value() < 0) {
    return Err(Unavailable(
        fmt::format("cannot join DDS domain {} ({}): see the middleware's message above; check the "
                    "profile in CYCLONEDDS_URI and its network interface",
                    domain_id, dds_strretcode(handle.value()))));
  }
  return std::unique_ptr<Participant>(new Participant(std::move(handle)));
}

}  // namespace isotherm
