#include "edge/daemon/validate_options.h"

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <utility>

#include "common/options/option_problems.h"
#include "edge/daemon/make_source.h"
#include "edge/nuc/nuc_supervisor.h"
#include "edge/options/edge_options.pb.h"
#include "edge/source/frame_check.h"
#include "edge/spool/spool.h"
#include "edge/timestamper/timestamper.h"

namespace isotherm {
namespace {

bool IsPlainName(const std::string& name) {
  constexpr std::string_view kAllowed =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-.";
  return !name.empty() && name.size() <= 32 &&
         name.find_first_not_of(kAllowed) == std::string::npos;
}

}  // namespace

Status Validate(const LinkOptions& options) {
  OptionProblems problems("link");
  if (!options.edge_id().empty() && !IsPlainName(options.edge_id())) {
    problems.Add("edge_id",
                 fmt::format("is \"{}\", must be 1 to 32 letters, digits, '_', '-' or '.'",
                             options.edge_id()));
  }
  problems.CheckRange("domain", options.domain(), 0, 230);
  problems.CheckRange("expert.queue_frames", options.expert().queue_frames(), 1, 100'000);
  problems.CheckRange("expert.backfill_hz", options.expert().backfill_hz(), 0.0, 10'000.0);
  problems.CheckRange("expert.fetch_mb_per_s", options.expert().fetch_mb_per_s(), 0.0, 10'000.0);
  constexpr double kMinFetch_mb_per_s = 0.05;  // A checksum must not take longer than patience.
  const double fetch_mb_per_s = options.expert().fetch_mb_per_s();
  if (fetch_mb_per_s > 0.0 && fetch_mb_per_s < kMinFetch_mb_per_s)
    problems.Add("expert.fetch_mb_per_s", "must be 0 (never) or at least 0.05");
  problems.CheckRange("expert.linger_s", options.expert().linger_s(), 0.0, 3600.0);
  return problems.ToStatus();
}

Status Validate(const DisplayOptions& options) {
  OptionProblems problems("display");
  const std::string& image = options.image_file();
  if (!image.empty() && image.back() == '/')
    problems.Add("image_file", fmt::format("is \"{}\", must name a file", image));
  return problems.ToStatus();
}

std::vector<Status> ValidateAll(const EdgeOptions& options) {
  std::vector<Status> problems;
  for (Status status :
       {Validate(options.source()), Validate(options.frame_check()),
        Validate(options.timestamper()), Validate(options.nuc()), Validate(options.spool()),
        Validate(options.link()), Validate(options.display())}) {
    if (!status.ok()) problems.push_back(std::move(status));
  }
  return problems;
}

}  // namespace isotherm
