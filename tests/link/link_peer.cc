// An edge in a process of its own, for link_test: link_peer DOMAIN SESSION DEPTH THERMAL DEPTH_HZ
// live|lossless WAIT_S. Prints "begun" when frames start to flow and "drained" or "not drained" at
// the end.
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "tests/link/edge_side.h"

int main(int argc, char** argv) {
  using namespace isotherm;
  if (argc != 8) return kExitUsage;
  EdgePlan plan;
  plan.domain = std::atoi(argv[1]);
  plan.session = std::strtoull(argv[2], nullptr, 10);
  plan.depth_frames = std::strtoull(argv[3], nullptr, 10);
  plan.thermal_frames = std::strtoull(argv[4], nullptr, 10);
  plan.depth_hz = std::atof(argv[5]);
  plan.policy =
      std::string_view(argv[6]) == "live" ? PublishPolicy::kLive : PublishPolicy::kLossless;
  plan.wait_for_ground = std::chrono::seconds(std::atoi(argv[7]));

  const SystemClock clock{};
  const TransportEnvironment environment(clock);
  EdgeSide edge(environment, clock, plan);
  std::puts("started");
  std::fflush(stdout);
  const bool drained = edge.SendAll();
  std::puts(drained ? "drained" : "not drained");
  return 0;
}
