#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "common/base/noise.h"
#include "common/base/units.h"
#include "common/simulation/scenes.h"
#include "ground/calibration/calibration_check.h"
#include "ground/experiment/experiment.h"
#include "ground/experiment/experiment_scan.h"

namespace isotherm {
namespace {

constexpr int kScans = 10;
constexpr double kDuration_s = 30.0;
// A NUC in the middle of the scan.
constexpr double kNuc_s = 15.0;
// As a depth camera behind a bad cable: 0.4 s of each second are missing.
constexpr double kGap_s = 0.4;

/// Says what is wrong with a rig's calibration.
struct Disturbance {
  double rotation_deg = 0.0;
  double delay_s = 0.0;
};
constexpr Disturbance kRight{}, kMoved{0.2, 0.005}, kHardlyMoved{0.02, 0.0005};

/// Draws from [low, high], another number for each `what`.
class Draws {
 public:
  explicit Draws(int scan) : stream_(NoiseStream(811, static_cast<std::uint64_t>(scan), 0)) {}
  double operator()(double low, double high) {
    // A normal distribution's values are spread evenly by its distribution function.
    const double normal = NormalNoise(stream_, next_++);
    return low + (high - low) * 0.5 * std::erfc(-normal / std::numbers::sqrt2);
  }

 private:
  std::uint64_t stream_;
  std::uint64_t next_ = 0;
};

/// The furnace door, each scan along a path of its own: as slow as the scene's, every other one
/// with a hand that goes to and fro.
StagedScene StageOf(int scan) {
  StagedScene staged = MakeFurnaceDoorScene({});
  Draws draw(scan);
  ScanPath& path = staged.path;
  for (Swing* swing : {&path.target_x_m, &path.target_y_m, &path.azimuth_rad, &path.elevation_rad,
                       &path.distance_m, &path.roll_rad}) {
    swing->period_s *= draw(0.75, 1.3);
    swing->phase_rad = draw(-std::numbers::pi, std::numbers::pi);
  }
  if (scan % 2 == 0) {
    for (Swing* swing : {&path.target_x_m, &path.target_y_m}) {
      swing->second_amplitude = 0.03;
      swing->second_period_s = draw(1.8, 2.6);
    }
  }
  return staged;
}

SimulationOptions CamerasOf(int scan) {
  SimulationOptions options = ExperimentCameras(kDuration_s, 0.6);
  options.set_seed(static_cast<std::uint64_t>(scan));
  options.mutable_shutter()->set_first_s(kNuc_s);
  options.mutable_shutter()->set_interval_s(kDuration_s);
  return options;
}

Rig Disturbed(const Rig& rig, const Disturbance& by, int scan) {
  Draws draw(1000 + scan);
  Eigen::Vector3d axis;
  for (double& along : axis) along = draw(-1.0, 1.0);
  axis.normalize();
  Rig disturbed = rig;
  disturbed.T_thermal_depth->linear() =
      Eigen::AngleAxisd(by.rotation_deg * kRadPerDeg, axis).toRotationMatrix() *
      rig.T_thermal_depth->linear();
  return disturbed;
}

bool IsInGap(int scan, double scanned_s) {
  return scan % 3 == 0 && scanned_s > 1.0 && scanned_s - std::floor(scanned_s) > 1.0 - kGap_s;
}

/// Holds what the checks of one scan said.
struct Checked {
  CalibrationCheckReport right, moved, hardly_moved;
};

Result<Checked> Check(int scan, ThreadPool& pool) {
  Result<std::unique_ptr<SimulatedScan>> simulated =
      SimulatedScan::Create(CamerasOf(scan), StageOf(scan));
  if (!simulated) return Err(simulated.error());
  const Rig& rig = (*simulated)->rig();
  const auto pipeline = StartPipeline(GroundOptions(), **simulated, pool);
  if (!pipeline) return Err(pipeline.error());
  struct Case {
    Disturbance by;
    CalibrationCheck check;
  };
  std::vector<std::unique_ptr<Case>> cases;
  for (const Disturbance& by : {kRight, kMoved, kHardlyMoved}) {
    cases.push_back(std::make_unique<Case>(
        Case{by, CalibrationCheck({}, Disturbed(rig, by, scan), by.delay_s)}));
  }
  const CaptureTime start = (*simulated)->depth_times().front().exposure;
  const auto take_depth = [&](const DepthFrame& frame) {
    if (!IsInGap(scan, ToSeconds(frame.header.capture_time - start)))
      (*pipeline)->ProcessDepth(frame);
  };
  const auto take_thermal = [&](const ThermalFramePtr& frame) {
    for (const std::unique_ptr<Case>& each : cases) {
      auto late = std::make_shared<ThermalFrame>(*frame);
      late->header.capture_time += FromSeconds(each->by.delay_s);
      each->check.Add(late, (*pipeline)->model());
    }
  };
  PlayScan(**simulated, pool, {take_depth, take_thermal});
  (*pipeline)->Finish();
  const ScanModel model = (*pipeline)->model();
  return Checked{cases[0]->check.Finish(model, {}), cases[1]->check.Finish(model, {}),
                 cases[2]->check.Finish(model, {})};
}

/// Shift, its sigma, delay and its sigma; NaN where the scan did not tell.
void AddFigures(const CalibrationCheckReport& report, std::vector<double>& row) {
  if (!report.refinement) {
    row.insert(row.end(), 4, NAN);
    return;
  }
  const Refinement& r = *report.refinement;
  row.insert(row.end(), {r.shift.rms_px, r.shift.sigma_px, kMsPerS * r.correction[kDelay],
                         kMsPerS * r.Sigma(kDelay)});
}

/// Counts what ten scans said.
struct Tally {
  int right_told = 0, false_alarms = 0, found = 0, pose_found = 0, found_hardly_moved = 0;
  double delay_squares = 0.0;  ///< Sums the right scans' errors over their uncertainties.

  void Add(const Checked& checked) {
    const auto is_moved = [](const CalibrationCheckReport& report) {
      return report.verdict.pose == CheckVerdict::kMoved ||
             report.verdict.delay == CheckVerdict::kMoved;
    };
    false_alarms += checked.right.verdict.Moved() ? 1 : 0;
    found += is_moved(checked.moved) ? 1 : 0;
    pose_found += checked.moved.verdict.pose == CheckVerdict::kMoved ? 1 : 0;
    found_hardly_moved += is_moved(checked.hardly_moved) ? 1 : 0;
    const auto& right = checked.right.refinement;
    if (!right) return;
    ++right_told;
    delay_squares += std::pow(right->correction[kDelay] / right->Sigma(kDelay), 2);
  }
};

}  // namespace

Result<ExperimentReport> RunCalibrationCheckExperiment(ThreadPool& pool) {
  ExperimentReport report;
  report.table.rows_are = "scan";
  report.table.columns = {"right: shift [px]", "sigma [px]", "delay [ms]", "sigma [ms]",
                          "moved: shift [px]", "sigma [px]", "delay [ms]", "sigma [ms]"};
  Tally tally;
  for (int scan = 1; scan <= kScans; ++scan) {
    const Result<Checked> checked = Check(scan, pool);
    if (!checked) return Err(checked.error());
    tally.Add(*checked);
    std::vector<double> row;
    AddFigures(checked->right, row);
    AddFigures(checked->moved, row);
    report.table.rows.push_back({fmt::format("{}{}{}", scan, scan % 2 == 0 ? ", to and fro" : "",
                                             scan % 3 == 0 ? ", gaps in depth" : ""),
                                 row});
  }
  using Sense = Requirement::Sense;
  const Requirement finds = {"scans of ten that find that 0.2 degrees and 5 ms are wrong",
                             static_cast<double>(tally.found), Sense::kAtLeast, 9.0, ""};
  report.requirements = {
      finds,
      NegativeControl(finds, "scans of ten that find 0.02 degrees and 0.5 ms",
                      static_cast<double>(tally.found_hardly_moved)),
      {"right scans of ten that tell", static_cast<double>(tally.right_told), Sense::kAtLeast, 9.0,
       ""},
      {"false alarms in ten right scans", static_cast<double>(tally.false_alarms), Sense::kAtMost,
       0.0, ""},
      {"delay's error over its uncertainty, root mean square",
       std::sqrt(tally.delay_squares / tally.right_told), Sense::kAtMost, 1.3, ""}};
  report.table.rows.push_back({fmt::format("pose found in {} of {}", tally.pose_found, kScans),
                               std::vector<double>(report.table.columns.size(), NAN)});
  return report;
}

}  // namespace isotherm
