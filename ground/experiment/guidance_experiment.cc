#include "ground/experiment/guidance_experiment.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <string>

#include "common/base/mutex.h"
#include "common/base/progress.h"
#include "common/base/quantile.h"
#include "common/simulation/options.h"
#include "ground/experiment/closed_loop_scan.h"
#include "ground/experiment/raster_path.h"
#include "ground/thermal/thermal_options.h"

namespace isotherm {
namespace {

/// The guided operator may take this much of the fixed raster's time.
constexpr double kMaxTimePercent = 60.0;
/// The guided operator must measure this much well then, of what the raster has measured well at
/// its end.
constexpr double kMinCoveragePercent = 90.0;

struct Method {
  const char* label;
  Obedience obedience;
  enum class Path { kNone, kRaster, kFastRaster } path;
};
constexpr Method kMethods[] = {
    {"guided", {.next_view = true, .slower = true}, Method::Path::kNone},
    {"raster, told slower", {.next_view = false, .slower = true}, Method::Path::kFastRaster},
    {"raster", {.next_view = false, .slower = false}, Method::Path::kRaster},
    {"raster, 0.3 m/s", {.next_view = false, .slower = false}, Method::Path::kFastRaster},
};
enum MethodIndex : std::size_t { kGuided, kToldSlower, kRaster, kThesisSpeed };

/// A scene with what all scans of it share.
struct ScannedScene {
  ScannedScene(SimulatedScene which, const Rig& rig, const ThermalOptions& limits)
      : staged(Staged(which)),
        surface(staged.scene, limits),
        raster(RasterPath(staged.scene, rig, limits, RasterSpeed(rig, limits))),
        fast_raster(RasterPath(staged.scene, rig, limits, OperatorTraits().speed_m_s)) {}

  static StagedScene Staged(SimulatedScene which) {
    SceneOptions options;
    options.set_scene(which);
    return MakeScene(options);
  }
  std::vector<Waypoint> Path(Method::Path path) const {
    switch (path) {
      case Method::Path::kNone:
        return {};
      case Method::Path::kRaster:
        return raster;
      case Method::Path::kFastRaster:
        return fast_raster;
    }
    return {};
  }

  StagedScene staged;
  MeasurableSurface surface;
  std::vector<Waypoint> raster, fast_raster;
};

/// All scans of one scene in one way, one per person.
using Logs = std::vector<ClosedLoopLog>;

template <typename Value>
double Median(const Logs& logs, const Value& value) {
  std::vector<double> values;
  for (const ClosedLoopLog& log : logs) values.push_back(value(log));
  return TakeMedian(values);
}

/// Never is later than all times.
double DoneAfter(const ClosedLoopLog& log) {
  return log.done_s.value_or(std::numeric_limits<double>::infinity());
}

double AdvicePercent(const ClosedLoopLog& log, Advice advice) {
  return 100.0 * log.advice[static_cast<std::size_t>(advice)] / std::max(1, log.messages);
}

std::vector<std::string> Columns(int samples) {
  std::vector<std::string> columns = {"done", "done [s]", "end [s]"};
  for (int i = 1; i <= samples; ++i)
    columns.push_back(fmt::format("{:.0f} s [%]", i * ClosedLoopLog::kSampleInterval_s));
  for (const char* column : {"at end [%]", "way [m]", "lost [%]", "slower [%]", "closer [%]",
                             "farther [%]", "less oblique [%]", "go back [%]"})
    columns.emplace_back(column);
  return columns;
}

std::vector<double> Describe(const Logs& logs, int samples) {
  std::vector<double> row = {
      static_cast<double>(std::ranges::count_if(
          logs, [](const ClosedLoopLog& log) { return log.done_s.has_value(); })),
      Median(logs, DoneAfter), Median(logs, [](const ClosedLoopLog& log) { return log.end_s; })};
  for (int i = 1; i <= samples; ++i) {
    row.push_back(Median(logs, [i](const ClosedLoopLog& log) {
      return 100.0 * log.At(static_cast<std::size_t>(i));
    }));
  }
  row.push_back(
      Median(logs, [](const ClosedLoopLog& log) { return 100.0 * log.measured_well_at_end; }));
  row.push_back(Median(logs, [](const ClosedLoopLog& log) { return log.way_m; }));
  row.push_back(Median(logs, [](const ClosedLoopLog& log) {
    return 100.0 * log.lost_frames / std::max(1, log.depth_frames);
  }));
  for (const Advice advice : {Advice::kSlower, Advice::kMoveCloser, Advice::kMoveFarther,
                              Advice::kLessOblique, Advice::kGoBackToRelocalise}) {
    row.push_back(
        Median(logs, [advice](const ClosedLoopLog& log) { return AdvicePercent(log, advice); }));
  }
  return row;
}

void Require(const std::string& scene, const std::array<Logs, std::size(kMethods)>& logs,
             std::vector<Requirement>& requirements) {
  // A raster that is complete without being done would have to go on.
  const double raster_s = Median(logs[kRaster], [](const auto& log) { return log.end_s; });
  const auto percent = [&](std::size_t method) {
    return 100.0 * Median(logs[method], DoneAfter) / raster_s;
  };
  const auto well = [](const ClosedLoopLog& log) { return log.measured_well_at_end; };
  const Requirement time = {
      scene + ": time until done, of the raster's until done or complete, guided", percent(kGuided),
      Requirement::Sense::kAtMost, kMaxTimePercent, "%"};
  requirements.push_back(time);
  requirements.push_back(NegativeControl(
      time, scene + ": the same by who is told slower, but no next view", percent(kToldSlower)));
  requirements.push_back(NegativeControl(time, scene + ": the same at 0.3 m/s, whatever is advised",
                                         percent(kThesisSpeed)));
  requirements.push_back({scene + ": measured well then, of what the raster measures well, guided",
                          100.0 * Median(logs[kGuided], well) / Median(logs[kRaster], well),
                          Requirement::Sense::kAtLeast, kMinCoveragePercent, "%"});
}

}  // namespace

Result<ExperimentReport> CompareGuidance(const GuidanceTrial& trial, ThreadPool& pool) {
  const Rig rig = RigForClosedLoop();
  const ThermalOptions limits =
      CompleteLimits(OptionsForClosedLoop().thermal(), rig.thermal_sensor);
  std::vector<ScannedScene> scenes;
  for (const SimulatedScene which : trial.scenes) scenes.emplace_back(which, rig, limits);
  // Scans are independent of each other, so each goes on a thread of its own.
  const std::size_t persons = trial.persons.size(), methods = std::size(kMethods);
  std::vector<Result<ClosedLoopLog>> results(scenes.size() * methods * persons, ClosedLoopLog{});
  ProgressBar progress("scanning", results.size(), "scans");
  Mutex mutex;
  std::size_t complete = 0;
  pool.ParallelFor(static_cast<int>(results.size()), [&](int i) {
    const auto index = static_cast<std::size_t>(i);
    const ScannedScene& scene = scenes[index / (methods * persons)];
    const Method& method = kMethods[index / persons % methods];
    const std::uint64_t seed = trial.persons[index % persons];
    results[index] = RunClosedLoop({.staged = scene.staged,
                                    .surface = scene.surface,
                                    .traits = TraitsOfPerson(seed),
                                    .obedience = method.obedience,
                                    .path = scene.Path(method.path),
                                    .seed = seed,
                                    .max_duration_s = trial.max_duration_s});
    const MutexLock lock(mutex);
    progress.Update(static_cast<double>(++complete) / static_cast<double>(results.size()));
  });
  progress.Finish();
  ExperimentReport report;
  const int samples = static_cast<int>(trial.max_duration_s / ClosedLoopLog::kSampleInterval_s);
  report.table.rows_are = "scene, scanned";
  report.table.columns = Columns(samples);
  std::size_t next = 0;
  for (const ScannedScene& scene : scenes) {
    std::array<Logs, std::size(kMethods)> logs;
    for (std::size_t method = 0; method < methods; ++method) {
      for (std::size_t person = 0; person < persons; ++person, ++next) {
        if (!results[next]) return Err(results[next].error());
        logs[method].push_back(*results[next]);
      }
      report.table.rows.push_back(
          {fmt::format("{}, {}", scene.staged.scene.name(), kMethods[method].label),
           Describe(logs[method], samples)});
    }
    Require(scene.staged.scene.name(), logs, report.requirements);
  }
  return report;
}

Result<ExperimentReport> RunGuidanceExperiment(ThreadPool& pool) {
  // The raster takes longer; that it counts as complete by then is to the disadvantage of who is
  // guided.
  constexpr double kMaxDuration_s = 240.0;
  return CompareGuidance(
      {.scenes = {FURNACE_DOOR}, .persons = {1, 2, 3}, .max_duration_s = kMaxDuration_s}, pool);
}

}  // namespace isotherm
