#include "ground/status_teller.h"

#include <fmt/format.h>

#include "common/base/log.h"
#include "common/base/service.h"
#include "ground/subscriber/clock_watch.h"

namespace isotherm {
namespace {

/// "300 of 301 depth".
std::string ArrivedText(const char* name, const StreamAccount& account) {
  return fmt::format("{} of {} {}", account.received, account.published, name);
}

void TellAboutCamera(const char* name, const StreamMode& camera) {
  if (camera.model.empty()) return;
  LOG(Ground, Info) << name << " camera: " << camera.model << ", serial=" << camera.serial
                    << " mode=" << ModeText(camera);
}

}  // namespace

void TellAboutCameras(const RigDescription& rig) {
  TellAboutCamera("depth", rig.depth);
  TellAboutCamera("thermal", rig.thermal);
}

std::string StatusText(const SubscriberStats& stats) {
  const std::string problem = stats.rig_problem.empty() ? "" : stats.rig_problem + " | ";
  if (stats.account.session == 0)
    return problem + (stats.edge_present ? "rig found, no scan yet" : "waiting for a rig");
  std::string text = problem + fmt::format("{} | received {}, {} | rig's clock: ",
                                           stats.edge_present ? "scanning" : "RIG LOST",
                                           ArrivedText("depth", stats.account.depth),
                                           ArrivedText("thermal", stats.account.thermal));
  return text + (stats.account.clock ? ClockText(*stats.account.clock) : "unknown");
}

void StatusTeller::Tell(const SubscriberStats& stats) {
  if (clock_.SteadyNow() < next_) return;
  next_ += kInterval;
  const std::string line = StatusText(stats);
  NotifyStatus(line);
  if (stats.account.session == 0 || stats.account.closed) return;
  LOG(Ground, Info) << line;
}

}  // namespace isotherm
