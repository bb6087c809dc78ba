#include "common/transport/join_domain.h"

#include <algorithm>
#include <utility>

#include "common/base/log.h"
#include "common/base/pause.h"
#include "common/time/back_off.h"

namespace isotherm {
namespace {

// `waiting` is called this often: callers feed the service manager's watchdog in it.
constexpr Nanoseconds kReportInterval = std::chrono::milliseconds(250);

}  // namespace

Result<std::unique_ptr<Participant>> JoinDomain(const TransportEnvironment& environment,
                                                int domain_id, const Clock& clock,
                                                const std::stop_token& stop,
                                                const WaitingForNetwork& waiting,
                                                const Announcement& announcement) {
  const auto join = [&] { return Participant::Create(environment, domain_id, announcement); };
  Result<std::unique_ptr<Participant>> joined = join();
  const bool waits = !joined && joined.error().code() == StatusCode::kUnavailable;
  if (!waits) return joined;
  LOG(Transport, Warning) << joined.error().message() << "; trying again until it works";
  // The middleware would repeat its reason each time.
  const TransportEnvironment::Quiet quiet(environment);
  BackOff back_off;
  while (!joined && !stop.stop_requested()) {
    const SteadyTime due = clock.SteadyNow() + back_off.Next();
    for (SteadyTime now = clock.SteadyNow(); now < due && !stop.stop_requested();
         now = clock.SteadyNow()) {
      waiting(joined.error());
      Pause(stop, std::min<Nanoseconds>(due - now, kReportInterval));
    }
    if (!stop.stop_requested()) joined = join();
  }
  if (joined) {
    LOG(Transport, Info) << "joined DDS domain " << domain_id;
  }
  return joined;
}

}  // namespace isotherm
