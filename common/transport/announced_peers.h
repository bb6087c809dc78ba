#pragma once

#include <map>

#include "common/base/status.h"
#include "common/transport/announcement.h"
#include "common/transport/endpoints.h"
#include "common/transport/participant.h"

namespace isotherm {

/// Tells which processes of this system announce themselves in the domain; to hear that takes
/// packets in one direction only. A process that was killed stays for the middleware's lease of ten
/// seconds. Thread-compatible.
class AnnouncedPeers {
 public:
  /// `participant` must outlive it.
  Status Open(const Participant& participant);
  /// Returns those of `role` that are there now, no more than some hundred.
  std::map<PeerHandle, Announcement> Of(Role role) const;

 private:
  DdsHandle reader_;
};

}  // namespace isotherm
