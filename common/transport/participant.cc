#include "common/transport/participant.h"

#include <dds/dds.h>
#include <fmt/format.h>

#include <string>

#include "common/base/check.h"
#include "common/transport/peer_guid.h"
#include "common/transport/qos.h"

namespace isotherm {

DdsHandle::DdsHandle(DdsHandle&& other) noexcept : value_(std::exchange(other.value_, 0)) {}

DdsHandle& DdsHandle::operator=(DdsHandle&& other) noexcept {
  std::swap(value_, other.value_);
  return *this;
}

DdsHandle::~DdsHandle() {
  if (value_ > 0) static_cast<void>(dds_delete(value_));
}

namespace {

std::string ReasonOf(const TransportEnvironment& environment, dds_return_t code) {
  std::string error = environment.last_error();
  while (error.ends_with('.')) error.pop_back();
  return error.empty() ? dds_strretcode(code) : error;
}

}  // namespace

Result<std::unique_ptr<Participant>> Participant::Create(
    const TransportEnvironment& environment, int domain_id,
    const std::optional<Announcement>& announcement) {
  if (domain_id < 0 || domain_id > kMaxDomainId) {
    return Err(
        InvalidArgument(fmt::format("DDS domain {} is outside 0..{}", domain_id, kMaxDomainId)));
  }
  const QosPtr qos(dds_create_qos());
  if (announcement) {
    const std::string text = ToText(*announcement);
    dds_qset_userdata(qos.get(), text.data(), text.size());
  }
  DdsHandle handle(
      dds_create_participant(static_cast<dds_domainid_t>(domain_id), qos.get(), nullptr));
  if (handle.value() < 0) {
    return Err(Unavailable(
        fmt::format("cannot join DDS domain {} ({}); check the profile in CYCLONEDDS_URI and that "
                    "its network interface is there and up (ip address)",
                    domain_id, ReasonOf(environment, handle.value()))));
  }
  return std::unique_ptr<Participant>(new Participant(std::move(handle)));
}

std::uint64_t Participant::peer() const {
  dds_guid_t guid{};
  CHECK(dds_get_guid(handle_.value(), &guid) == DDS_RETCODE_OK);
  return PeerOfGuid(guid);
}

}  // namespace isotherm
