#include "ground/experiment/hidden_surface_experiment.h"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <numeric>
#include <string>
#include <utility>

#include "common/base/check.h"
#include "ground/experiment/model_check.h"
#include "ground/experiment/stage_fusion.h"
#include "ground/experiment/thesis_fusion.h"
#include "ground/experiment/true_conditions.h"
#include "ground/renderer/renderer.h"
#include "ground/surface/depth_preprocessor.h"
#include "ground/thermal/thermal_options.h"

namespace isotherm {
namespace {

struct Method {
  std::string label;
  const ThermalVolume* thermal;
  std::string rendering = {};  ///< Empty: none.
};

RendererOptions ScaleOf(const Scene& scene) {
  double low = scene.surround_celsius(), high = low;
  for (const Primitive& primitive : scene.primitives()) {
    low = std::min(low, primitive.temperature.near_celsius);
    high = std::max(high, primitive.temperature.near_celsius);
  }
  return FixedScale(low, high);
}

/// The points of a sample that truly were seen under acceptable conditions: what a filter leaves
/// without a temperature there, it pays with. The same for all methods, which share the surface.
std::vector<std::size_t> TrulySeen(const SimulatedScan& scan,
                                   const std::vector<CheckedPoint>& points,
                                   const ThermalOptions& limits) {
  // Each takes rays for all frames. A sample is enough for a percentage.
  constexpr std::size_t kEvery = 20;
  std::vector<std::size_t> frames(scan.thermal_times().size());
  std::iota(frames.begin(), frames.end(), std::size_t{0});
  std::vector<std::size_t> seen;
  for (std::size_t i = 0; i < points.size(); i += kEvery) {
    const auto conditions = TrueConditions(scan, frames, points[i].truth);
    const bool acceptable = std::ranges::any_of(conditions, [&](const TrueCondition& c) {
      return c.surely_seen && c.distance_m >= limits.distance().min_m() &&
             c.distance_m <= limits.distance().max_m() && c.angle_deg >= limits.angle().min_deg() &&
             c.angle_deg <= limits.angle().max_deg();
    });
    if (acceptable) seen.push_back(i);
  }
  return seen;
}

double CoveragePercent(const std::vector<CheckedPoint>& points,
                       const std::vector<std::size_t>& truly_seen) {
  const auto measured = std::ranges::count_if(
      truly_seen, [&](std::size_t index) { return points[index].measured(); });
  return Percent(static_cast<std::size_t>(measured), truly_seen.size());
}

/// The ways to assign temperatures to one model, all fed with the same frames.
class Contest {
 public:
  Contest(const GroundOptions& options, const SimulatedScan& scan, GroundPipeline& pipeline)
      : pipeline_(pipeline),
        model_(pipeline.model()),
        preprocessor_(options.preprocessor(), *scan.rig().depth, scan.rig().depth_sensor),
        unfiltered_(options, scan.rig(), model_, ParallaxFilter::kNone),
        algorithm4_(options, scan.rig(), model_, ParallaxFilter::kAlgorithm4),
        algorithm4_and_rules_(options, scan.rig(), model_, ParallaxFilter::kAlgorithm4,
                              ThesisFusion::Rules::kAlsoOurOthers) {
    const auto min_weight = static_cast<float>(options.raycast().expert().min_weight());
    const ThermalSettings all{options.thermal(), scan.rig()};
    ThermalSettings without_any = all;
    // One rule less at a time: what a rule is worth shows in what goes wrong without it.
    for (const ThermalRule& rule : ThermalRules()) {
      ThermalSettings without = all;
      rule.switch_off(without);
      rule.switch_off(without_any);
      without_one_.emplace_back(without, min_weight, model_);
    }
    without_any_.emplace(without_any, min_weight, model_);
  }

  void AddDepth(const DepthFrame& frame, ThreadPool& pool) {
    pipeline_.ProcessDepth(frame);
    const Image<float>& depth_m = preprocessor_.Process(frame, pool).depth_m;
    for (ThesisFusion* fusion : {&unfiltered_, &algorithm4_, &algorithm4_and_rules_})
      fusion->AfterDepth(depth_m, pool);
    for (StageFusion& fusion : without_one_) fusion.AfterDepth(depth_m, pool);
    without_any_->AfterDepth(depth_m, pool);
  }

  void AddThermal(const ThermalFramePtr& frame) {
    pipeline_.ProcessThermal(frame);
    for (ThesisFusion* fusion : {&unfiltered_, &algorithm4_, &algorithm4_and_rules_})
      fusion->AddThermal(frame);
    for (StageFusion& fusion : without_one_) fusion.AddThermal(frame);
    without_any_->AddThermal(frame);
  }

  void Finish(ThreadPool& pool) {
    pipeline_.Finish();
    for (StageFusion& fusion : without_one_) fusion.Finish(pool);
    without_any_->Finish(pool);
  }

  enum Row : std::size_t { kNoFilter, kAlgorithm4, kAlgorithm4AndRules, kVisibilityOnly, kAll };
  std::vector<Method> methods() const {
    std::vector<Method> methods = {
        {"no filter", &unfiltered_.thermal(), "no_filter"},
        {"algorithm 4", &algorithm4_.thermal(), "algorithm4"},
        {"algorithm 4 and our other rules", &algorithm4_and_rules_.thermal()},
        {"visibility, no other rule", &without_any_->thermal()},
        {"visibility and all other rules", &model_.thermal(), "visibility"}};
    for (std::size_t i = 0; i < ThermalRules().size(); ++i) {
      methods.push_back(
          {fmt::format("  without: {}", ThermalRules()[i].name), &without_one_[i].thermal()});
    }
    return methods;
  }
  const ScanModel& model() const { return model_; }

 private:
  GroundPipeline& pipeline_;
  const ScanModel model_;
  DepthPreprocessor preprocessor_;
  ThesisFusion unfiltered_, algorithm4_, algorithm4_and_rules_;
  std::deque<StageFusion> without_one_;  ///< In the order of ThermalRules.
  std::optional<StageFusion> without_any_;
};

std::vector<Requirement> Require(const HiddenSurfaceSetup& setup, const ExperimentTable& table) {
  const auto wrong_percent = [&](std::size_t row) { return table.rows[row].values[4]; };
  const double coverage_percent = table.rows[Contest::kAll].values[5];
  const Requirement wrong = {"wrongly assigned with visibility", wrong_percent(Contest::kAll),
                             Requirement::Sense::kAtMost, setup.max_wrong_percent, "%"};
  std::vector<Requirement> requirements = {
      wrong,
      NegativeControl(wrong, "wrongly assigned without a filter",
                      wrong_percent(Contest::kNoFilter)),
      {"assigned of what was truly seen under acceptable conditions", coverage_percent,
       Requirement::Sense::kAtLeast, 90.0, "%"},
  };
  if (setup.defeats_algorithm4) {
    requirements.push_back(NegativeControl(wrong,
                                           "wrongly assigned with algorithm 4 and our other rules",
                                           wrong_percent(Contest::kAlgorithm4AndRules)));
  }
  return requirements;
}

ExperimentReport Compare(const HiddenSurfaceSetup& setup, const SimulatedScan& scan,
                         const Contest& contest, ThreadPool& pool) {
  ExperimentReport report;
  report.table.rows_are = "method";
  report.table.columns = {"points",
                          "assigned",
                          "background too warm",
                          "foreground too cold",
                          "wrong [% of assigned]",
                          "coverage [% of truly seen]",
                          "within sigma [%]",
                          "within 1.96 sigma [%]"};
  const Renderer renderer(ScaleOf(scan.scene()), ThermalOptions());
  const RigidTransform T_world_depth = scan.PoseAt(scan.depth_times().front().exposure);
  const ThermalOptions limits = CompleteLimits(ThermalOptions(), scan.rig().thermal_sensor);
  std::optional<std::vector<std::size_t>> truly_seen;
  for (const Method& method : contest.methods()) {
    const std::vector<CheckedPoint> points =
        CheckModel(scan.scene(), scan.band(), contest.model().tsdf(), *method.thermal, pool);
    if (!truly_seen) truly_seen = TrulySeen(scan, points, limits);
    const AssignmentCheck check = CheckAssignment(points);
    const ErrorSummary errors = SummarizeErrors(points);
    report.table.rows.push_back(
        {method.label,
         {static_cast<double>(check.points), static_cast<double>(check.assigned),
          static_cast<double>(check.too_warm), static_cast<double>(check.too_cold),
          check.WrongPercent(), CoveragePercent(points, *truly_seen), errors.within_sigma_percent,
          errors.within_1_96_sigma_percent}});
    if (method.rendering.empty()) continue;
    report.renderings.push_back(
        {method.rendering, renderer.Thermal(LookAtModel(contest.model().tsdf(), *method.thermal,
                                                        *scan.rig().depth, T_world_depth, pool))});
  }
  report.requirements = Require(setup, report.table);
  return report;
}

}  // namespace

Result<ExperimentReport> CompareParallaxFilters(const HiddenSurfaceSetup& setup, ThreadPool& pool) {
  const auto scan =
      SimulatedScan::Create(ExperimentCameras(setup.duration_s, setup.focus_m), setup.staged);
  if (!scan) return Err(scan.error());
  const GroundOptions options;
  auto pipeline = StartPipeline(options, **scan, pool);
  if (!pipeline) return Err(pipeline.error());
  Contest contest(options, **scan, **pipeline);
  PlayScan(**scan, pool,
           {[&](const DepthFrame& frame) { contest.AddDepth(frame, pool); },
            [&](const ThermalFramePtr& frame) { contest.AddThermal(frame); }});
  contest.Finish(pool);
  if (Status status = CheckTracked(contest.model()); !status.ok()) return Err(status);
  return Compare(setup, **scan, contest, pool);
}

}  // namespace isotherm
