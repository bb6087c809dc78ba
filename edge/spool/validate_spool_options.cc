#include <fmt/format.h>

#include <filesystem>
#include <system_error>

#include "common/options/option_problems.h"
#include "edge/options/edge_options.pb.h"
#include "edge/spool/spool.h"

namespace isotherm {
namespace {

/// The least that can be kept: 0.2 s of full-size cameras.
constexpr double kMinKept_gb = 0.001;

void CheckKept(const SpoolOptions& options, OptionProblems& problems) {
  if (options.quota_gb() < kMinKept_gb) {
    problems.Add("quota_gb", fmt::format("is {:g}; with when_full=KEEP_NEWEST it says how much is "
                                         "kept, {:g} GB (1e9 bytes) or more",
                                         options.quota_gb(), kMinKept_gb));
  }
  const std::filesystem::path record = options.record();
  std::error_code ignored;
  if (record.has_filename() && !std::filesystem::is_directory(record, ignored)) {
    problems.Add("record", fmt::format("\"{}\" is no folder; with when_full=KEEP_NEWEST name one, "
                                       "ending in \"/\" (in memory: \"/run/isotherm-edge/\")",
                                       options.record()));
  }
}

}  // namespace

Status Validate(const SpoolOptions& options) {
  OptionProblems problems("spool");
  if (options.record().empty()) problems.Add("record", "is empty; name a file or say \"off\"");
  problems.CheckRange("expert.queue_frames", options.expert().queue_frames(), 1, 100'000);
  problems.CheckRange("expert.flush_interval_s", options.expert().flush_interval_s(), 0.05, 1.0);
  problems.CheckRange("resume_s", options.resume_s(), 0.0, 86'400.0);
  problems.CheckRange("quota_gb", options.quota_gb(), 0.0, 1'000'000.0);
  if (options.when_full() == KEEP_NEWEST) CheckKept(options, problems);
  problems.CheckRange("expert.reserve_s", options.expert().reserve_s(), 0.0, 86'400.0);
  problems.CheckRange("expert.reserve_mb", options.expert().reserve_mb(), 0, 1'000'000);
  problems.CheckRange("expert.warn_s", options.expert().warn_s(), 0.0, 86'400.0);
  return problems.ToStatus();
}

}  // namespace isotherm
