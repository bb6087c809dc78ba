#pragma once

#include <cstdint>

#include "common/transport/endpoints.h"

namespace isotherm {

/// Makes the handle of a peer from its participant's GUID (FNV-1a): when an outage lets the
/// middleware forget a participant, it comes back with another instance handle, but with the same
/// GUID. Never 0, which means that nobody is known.
template <typename Guid>
PeerHandle PeerOfGuid(const Guid& guid) {
  PeerHandle peer = 0xCBF29CE484222325ULL;
  for (const std::uint8_t byte : guid.v) peer = (peer ^ byte) * 0x100000001B3ULL;
  return peer == 0 ? 1 : peer;
}

}  // namespace isotherm
