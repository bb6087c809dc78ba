#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "common/base/processor_time.h"
#include "common/base/status.h"
#include "common/doubts/doubts.h"
#include "ground/calibration/calibration_check.h"
#include "ground/json/json.h"
#include "ground/options/ground_options.pb.h"
#include "ground/scan/scan_model.h"

namespace isotherm {

/// Returns how long a stage took, as it goes into stats.json.
Json DescribeStage(const StageStats& stats);

/// Frames, stages, volume and calibration of a scan as they go into stats.json.
Json DescribeScan(const ScanModel& scan, const GroundOptions& options);

/// Describes what a scan cost: processor time by thread, and per second of its data, as it goes
/// into stats.json.
Json DescribeProcessor(const ProcessorTimes& used, const Trajectory& trajectory);

/// Holds what the user is told about a written scan.
struct WrittenScan {
  std::string text;  ///< One screen for the user.
  Doubts doubts;     ///< About what came in and what came out; stats.json has them as `warnings`.
};

/// Holds what a driver knows of a scan beside its model.
struct DriverReport {
  const CalibrationCheckReport& calibration;
  const Doubts& doubts;  ///< About the frames.
  const Json& stats;     ///< DescribeScan() and whatever the driver adds.
};

/// Writes all result files of a scan into `dir`. What an earlier scan left there and this one does
/// not write is removed.
Result<WrittenScan> WriteScan(
    const ScanModel& scan, const GroundOptions& options, const DriverReport& report,
    const std::filesystem::path& dir,
    const std::function<void(std::string_view what, double fraction)>& progress);

}  // namespace isotherm
