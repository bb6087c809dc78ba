#pragma once

#include <functional>
#include <memory>
#include <stop_token>

#include "common/base/status.h"
#include "common/time/clock.h"
#include "common/transport/participant.h"

namespace isotherm {

/// Called a few times per second while the network is not there, with the reason and what to do.
using WaitingForNetwork = std::function<void(const Status& reason)>;

/// Participant::Create, tried again while it fails because the network interface is not there yet
/// (a computer that boots, a cable, a radio): after half a second, doubling up to five. The log has
/// the first failure and the success. Fails at once for a wrong domain, and when stop is requested.
Result<std::unique_ptr<Participant>> JoinDomain(const TransportEnvironment& environment,
                                                int domain_id, const Clock& clock,
                                                const std::stop_token& stop,
                                                const WaitingForNetwork& waiting,
                                                const Announcement& announcement);

}  // namespace isotherm
