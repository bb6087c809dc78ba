#include "ground/health.h"

#include <fmt/format.h>

namespace isotherm {

std::optional<std::string> Health::Problem(SteadyTime now) const {
  struct Judged {
    const char* what;
    const ThreadProgress& thread;
    Nanoseconds limit;
  };
  for (const auto& [what, thread, limit] :
       {Judged{"reception", receive, kFrameLimit},
        Judged{"the reconstruction", reconstruction, kFrameLimit},
        Judged{"the recording (is the disk stuck?)", recording, disk_limit_},
        Judged{"writing results (is the disk stuck?)", results, disk_limit_}}) {
    const Nanoseconds at_it = thread.AtItFor(now);
    if (at_it > limit)
      return fmt::format("{} has not gone on for {:.0f} s", what, ToSeconds(at_it));
  }
  return std::nullopt;
}

}  // namespace isotherm
