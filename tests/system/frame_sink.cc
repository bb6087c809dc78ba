// A ground station that takes frames and throws them away: frame_sink DOMAIN. Prints what came at
// SIGTERM.

#include <cstdio>
#include <cstdlib>

#include "common/base/service.h"
#include "common/time/clock.h"
#include "common/transport/participant.h"
#include "ground/subscriber/subscriber.h"

int main(int argc, char** argv) {
  using namespace isotherm;
  if (argc != 2) return kExitUsage;
  const StopSignal signal;
  const SystemClock clock{};
  const TransportEnvironment environment(clock);
  const auto participant = Participant::Create(environment, std::atoi(argv[1]));
  if (!participant) return ExitCode(participant.error());
  std::uint64_t depth = 0;
  std::uint64_t thermal = 0;
  SubscriberHandlers handlers;
  handlers.depth = [&depth](const ReceivedDepth&) { ++depth; };
  handlers.thermal = [&thermal](const ReceivedThermal&) { ++thermal; };
  const auto subscriber = Subscriber::Create(**participant, clock, {}, std::move(handlers));
  if (!subscriber) return ExitCode(subscriber.error());
  std::puts("listening");
  std::fflush(stdout);
  (*subscriber)->Run(signal.token());
  std::printf("received depth=%lu thermal=%lu\n", depth, thermal);
  return 0;
}
