#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "common/base/units.h"
#include "common/simulation/options.h"
#include "common/simulation/render_recording.h"
#include "common/simulation/simulation_options.pb.h"
#include "common/simulation/true_surface.h"
#include "ground/experiment/experiment.h"
#include "ground/experiment/link_scan.h"

namespace isotherm {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

constexpr double kScan_s = 12.0;
constexpr double kFrames_hz = 70.0;  // Of both cameras.
constexpr double kPercent = 100.0;
constexpr const char* kLossless = "LOSSLESS";
constexpr const char* kLive = "LIVE";
/// Each way: a radio over some kilometres, or one with a repeater in between.
constexpr Nanoseconds kDelay = 20ms;
/// The scan takes 43 Mbit/s; radios of these rates cannot keep up with it.
constexpr double kNarrow_mbit_s = 16.0;
constexpr double kVeryNarrow_mbit_s = 8.0;
/// So many of all packets are lost where a radio is far away.
constexpr double kFarLoss = 0.05;

/// One row of the table: a policy of the edge, and a link.
struct Link {
  std::string policy, label;
  PathProperties to_ground, to_edge;
  bool backfill = true;
  bool pieces = true;
};

/// Losses in both directions.
Link Lossy(const std::string& policy, double loss, Nanoseconds burst = {}) {
  const PathProperties path{.delay = kDelay, .loss = loss, .burst = burst};
  return {policy, fmt::format("{:.0f} % lost{}", kPercent * loss, burst > 0ns ? " in bursts" : ""),
          path, path};
}

Link Narrow(const std::string& policy, double mbit_s) {
  constexpr double kMega = 1e6;
  return {policy,
          fmt::format("{:.0f} Mbit/s", mbit_s),
          {.delay = kDelay, .rate_bit_s = kMega * mbit_s},
          {.delay = kDelay},
          true,
          true};
}

/// Returns the same link without a delay.
Link Near(Link link) {
  link.label += ", near";
  link.to_ground.delay = link.to_edge.delay = 0ns;
  return link;
}

/// Returns the same link for frames that go whole.
Link Whole(Link link) {
  link.label += ", whole frames";
  link.pieces = false;
  return link;
}

std::vector<Link> Links() {
  std::vector<Link> links;
  for (const std::string policy : {kLossless, kLive}) {
    links.push_back({policy, "no delay", {}, {}});
    for (const double loss : {0.01, kFarLoss, 0.10, 0.20})
      links.push_back(Near(Lossy(policy, loss)));
    for (const double loss : {0.0, 0.01, kFarLoss, 0.10, 0.20, 0.30})
      links.push_back(Lossy(policy, loss));
    links.push_back(Lossy(policy, kFarLoss, 200ms));
    for (const double mbit_s : {24.0, kNarrow_mbit_s, kVeryNarrow_mbit_s}) {
      links.push_back(Narrow(policy, mbit_s));
    }
  }
  // The controls.
  links.push_back(Whole(Lossy(kLossless, kFarLoss)));
  links.push_back(Whole(Narrow(kLossless, kNarrow_mbit_s)));
  links.push_back(Whole(Lossy(kLive, kFarLoss)));
  links.push_back(Whole(Narrow(kLive, kVeryNarrow_mbit_s)));
  Link without = Narrow(kLive, kNarrow_mbit_s);
  without.label += ", nothing sent again";
  without.backfill = false;
  links.push_back(without);
  return links;
}

std::string NameOf(const Link& link) { return fmt::format("{}, {}", link.policy, link.label); }

ExperimentTable::Row RowOf(const Link& link, const LinkScanOutcome& outcome) {
  const EvaluationReport& evaluation = outcome.evaluation;
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  double good_k = kNan, measured = kNan;
  if (evaluation.temperature) {
    good_k = evaluation.temperature->good.all.magnitude.median;
    measured = static_cast<double>(evaluation.temperature->any.all.magnitude.count) /
               static_cast<double>(evaluation.cloud_points);
  }
  return {NameOf(link),
          {outcome.missing, kPercent * outcome.late / outcome.captured,
           link.backfill ? outcome.most_lacking / kFrames_hz : kNan, outcome.scan_s,
           outcome.feedback_p50_ms, outcome.feedback_p99_ms, outcome.sent_mbit_s,
           kMmPerM * evaluation.trajectory.from_first_m.rms, good_k, kPercent * measured}};
}

/// Columns of the table that something is required of.
enum Column : std::uint8_t {
  kMissing = 0,
  kMostLacking = 2,
  kAdviceMedian = 4,
  kAdviceWorst = 5,
  kTrajectory = 7,
  kGoodError = 8
};

/// Returns what a row has; NaN, which meets nothing, if there is no such row.
double ValueOf(const ExperimentTable& table, const Link& link, Column column) {
  const auto row = std::ranges::find(table.rows, NameOf(link), &ExperimentTable::Row::label);
  return row == table.rows.end() ? std::numeric_limits<double>::quiet_NaN()
                                 : row->values.at(column);
}

/// Returns the largest value of all links on which what is lacking is sent; NaN if one is.
double WorstOf(const ExperimentTable& table, const std::vector<Link>& links, Column column) {
  double worst = 0.0;
  for (const Link& link : links) {
    if (!link.backfill) continue;
    const double value = ValueOf(table, link, column);
    worst = std::isnan(value) || std::isnan(worst) ? worst + value : std::max(worst, value);
  }
  return worst;
}

std::vector<Requirement> RequirementsOf(const ExperimentTable& table,
                                        const std::vector<Link>& links) {
  using enum Requirement::Sense;
  const Link& without = links.back();
  const Link far = Lossy(kLive, kFarLoss), far_lossless = Lossy(kLossless, kFarLoss);
  const Link very_narrow = Narrow(kLive, kVeryNarrow_mbit_s);
  const Requirement missing{"frames that the ground lacks in the end, all links",
                            WorstOf(table, links, kMissing), kAtMost, 0.0, ""};
  const Requirement advice{
      fmt::format("median age of advice on the rig, LIVE, {:.0f} Mbit/s", kNarrow_mbit_s),
      ValueOf(table, Narrow(kLive, kNarrow_mbit_s), kAdviceMedian), kAtMost, 500.0, "ms"};
  const Requirement lacking{"most that the ground lacks at once, " + NameOf(far),
                            ValueOf(table, far, kMostLacking), kAtMost, 2.0, "s"};
  const Requirement lacking_lossless{"most that the ground lacks at once, " + NameOf(far_lossless),
                                     ValueOf(table, far_lossless, kMostLacking), kAtMost, 2.0, "s"};
  const Requirement oldest{"99 % of advice is younger than, " + NameOf(very_narrow),
                           ValueOf(table, very_narrow, kAdviceWorst), kAtMost, 1'000.0, "ms"};
  const double whole_ms = ValueOf(table, Whole(Narrow(kLossless, kNarrow_mbit_s)), kAdviceMedian);
  return {
      missing,
      NegativeControl(missing, "the same where nothing is sent again",
                      ValueOf(table, without, kMissing)),
      advice,
      NegativeControl(advice, "the same, LOSSLESS, whole frames", whole_ms),
      lacking,
      NegativeControl(lacking, "the same, whole frames", ValueOf(table, Whole(far), kMostLacking)),
      lacking_lossless,
      NegativeControl(lacking_lossless, "the same, whole frames",
                      ValueOf(table, Whole(far_lossless), kMostLacking)),
      oldest,
      NegativeControl(oldest, "the same, whole frames",
                      ValueOf(table, Whole(very_narrow), kAdviceWorst)),
      {"trajectory, worst link", WorstOf(table, links, kTrajectory), kAtMost, 1.0, "mm"},
      {"error of class good, median, worst link", WorstOf(table, links, kGoodError), kAtMost, 0.2,
       "K"}};
}

}  // namespace

Result<ExperimentReport> RunLinkExperiment(ThreadPool& pool) {
  SimulationOptions options;
  options.set_duration_s(kScan_s);
  if (Status status = Validate(options); !status.ok()) return Err(std::move(status));
  options = Resolved(options);
  const auto recording = CachedRecording(options, DefaultCacheDir(), pool, {});
  if (!recording) return Err(recording.error());
  const fs::path folder = fs::temp_directory_path() / fmt::format("isotherm-link-{}", ::getpid());
  std::error_code ignored;
  fs::create_directories(folder, ignored);
  const fs::path surface = folder / "surface.ply";
  if (Status status = WriteTrueSurface(options, surface); !status.ok())
    return Err(std::move(status));
  ExperimentReport report;
  report.table.rows_are = "policy, link";
  report.table.columns = {"missing",       "came late %",       "most lacking s", "scan s",
                          "advice p50 ms", "advice p99 ms",     "sent Mbit/s",    "trajectory mm",
                          "good error K",  "with temperature %"};
  const std::vector<Link> links = Links();
  for (const Link& link : links) {
    const auto outcome = RunLinkScan({.recording = *recording,
                                      .surface = surface,
                                      .folder = folder / "scan",
                                      .policy = link.policy,
                                      .to_ground = link.to_ground,
                                      .to_edge = link.to_edge,
                                      .backfill = link.backfill,
                                      .pieces = link.pieces});
    if (!outcome) {
      return Err(outcome.error().WithContext(
          fmt::format("{}, {} (logs in {})", link.policy, link.label, folder.string())));
    }
    report.table.rows.push_back(RowOf(link, *outcome));
    // Each takes most of a minute.
    fmt::print(stderr,
               "  {} of {}: {}: {:.0f} missing, {:.0f} % came late, advice {:.0f} ms ({:.0f})\n",
               report.table.rows.size(), links.size(), NameOf(link), outcome->missing,
               kPercent * outcome->late / outcome->captured, outcome->feedback_p50_ms,
               outcome->feedback_p99_ms);
  }
  report.requirements = RequirementsOf(report.table, links);
  fs::remove_all(folder, ignored);
  return report;
}

}  // namespace isotherm
