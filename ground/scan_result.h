#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "common/base/status.h"
#include "common/geometry/camera.h"
#include "ground/calibration/delay_check.h"
#include "ground/export/json.h"
#include "ground/ground_pipeline.h"

namespace isotherm {

/// How long a stage took, as it goes into stats.json.
Json DescribeStage(const StageStats& stats);

/// Frames, stages, volume and calibration of a scan as they go into stats.json.
Json DescribeScan(const GroundPipeline& pipeline, const GroundOptions& options, const Rig& rig);

/// Writes all result files of a scan into `dir` and returns one screen of text for the user.
/// `stats` is DescribeScan() plus whatever the driver adds; `delay` goes into both.
Result<std::string> WriteScan(
    GroundPipeline& pipeline, const GroundOptions& options, const DelayReport& delay, Json stats,
    const std::filesystem::path& dir,
    const std::function<void(std::string_view what, double share)>& progress);

}  // namespace isotherm
