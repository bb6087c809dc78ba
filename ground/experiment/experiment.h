#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/status.h"
#include "common/concurrency/thread_pool.h"
#include "ground/renderer/rgb.h"

namespace isotherm {

/// A number that an experiment must reach.
struct Requirement {
  /// Says on which side of its limit a number must be.
  enum class Sense { kAtMost, kAtLeast };
  /// Says what a requirement is for.
  enum class Role {
    kLimit,
    /// The same number without what the experiment shows. It must miss the limit: otherwise the
    /// scene is too easy, and meeting the limit says nothing.
    kNegativeControl,
  };

  std::string what;
  double measured;
  Sense sense;
  double limit;
  std::string unit;  ///< Empty for counts and ratios.
  Role role = Role::kLimit;

  /// False for NaN.
  bool IsMet() const {
    if (role == Role::kNegativeControl)
      return sense == Sense::kAtMost ? measured > limit : measured < limit;
    return sense == Sense::kAtMost ? measured <= limit : measured >= limit;
  }
};
/// `measured` without what the experiment shows, held against the limit of `requirement`.
Requirement NegativeControl(const Requirement& requirement, std::string what, double measured);

/// Numbers by what was compared: one row per method or condition.
struct ExperimentTable {
  /// Holds the numbers of one method or condition.
  struct Row {
    std::string label;
    std::vector<double> values;  ///< As many as there are columns; NaN = does not apply.
  };
  std::string rows_are;              ///< Kind of the labels, for example "method".
  std::vector<std::string> columns;  ///< With their units.
  std::vector<Row> rows;
};

/// Holds an image for the report.
struct ExperimentRendering {
  std::string name;  ///< Part of the file's name.
  RgbImage rendering;
};

/// Holds what an experiment showed.
struct ExperimentReport {
  ExperimentTable table;
  std::vector<Requirement> requirements;
  std::vector<ExperimentRendering> renderings;

  bool HasNegativeControl() const;
  /// Without a negative control that misses its limit, nothing is met.
  bool AllMet() const;
};

/// Shows on an analytic scene, whose truth is known, what the method does: the real pipeline with
/// simulated cameras. The same each time.
struct Experiment {
  std::string_view name;    ///< On the command line and in file names.
  std::string_view figure;  ///< The figure of the thesis that it repeats.
  std::string_view claim;   ///< The experiment's claim, one sentence.
  /// Fails only if something is wrong with the experiment itself, for example tracking was lost.
  Result<ExperimentReport> (*run)(ThreadPool& pool);
};

/// In the order of the thesis's figures.
std::span<const Experiment> AllExperiments();
/// nullptr if there is none of this name.
const Experiment* FindExperiment(std::string_view name);

// One per file of the same name.
Result<ExperimentReport> RunFocusExperiment(ThreadPool& pool);
Result<ExperimentReport> RunSpotSizeExperiment(ThreadPool& pool);
Result<ExperimentReport> RunBackgroundExperiment(ThreadPool& pool);
Result<ExperimentReport> RunVoxelSizeExperiment(ThreadPool& pool);
Result<ExperimentReport> RunConditionalIntegrationExperiment(ThreadPool& pool);
Result<ExperimentReport> RunTimingExperiment(ThreadPool& pool);
Result<ExperimentReport> RunCalibrationExperiment(ThreadPool& pool);
Result<ExperimentReport> RunCalibrationCheckExperiment(ThreadPool& pool);
Result<ExperimentReport> RunSceneInfluenceExperiment(ThreadPool& pool);
Result<ExperimentReport> RunParallaxExperiment(ThreadPool& pool);
Result<ExperimentReport> RunForegroundExperiment(ThreadPool& pool);
Result<ExperimentReport> RunDistanceExperiment(ThreadPool& pool);
Result<ExperimentReport> RunAngleExperiment(ThreadPool& pool);
Result<ExperimentReport> RunShadingExperiment(ThreadPool& pool);
Result<ExperimentReport> RunConfidenceExperiment(ThreadPool& pool);
Result<ExperimentReport> RunMotionExperiment(ThreadPool& pool);
Result<ExperimentReport> RunMergingExperiment(ThreadPool& pool);
Result<ExperimentReport> RunReflectionExperiment(ThreadPool& pool);
Result<ExperimentReport> RunNucExperiment(ThreadPool& pool);
Result<ExperimentReport> RunNucDriftExperiment(ThreadPool& pool);
Result<ExperimentReport> RunGuidanceExperiment(ThreadPool& pool);
Result<ExperimentReport> RunLinkExperiment(ThreadPool& pool);

}  // namespace isotherm
