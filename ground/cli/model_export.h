#pragma once

#include <filesystem>

#include "ground/export/result_files.h"
#include "ground/interpretation/interpretation.h"
#include "ground/options/ground_options.pb.h"

namespace isotherm {

/// Writes the results of a saved model into `dir`, with temperatures as `interpretation` has them.
/// The renderings show the model as the depth camera saw it from the last pose that the model
/// knows; without one there are none. The volume in `options` becomes the model's.
Result<ResultSummary> ExportModel(const std::filesystem::path& model, GroundOptions options,
                                  const Interpretation& interpretation,
                                  const std::filesystem::path& dir,
                                  const ResultProgress& progress = {});

}  // namespace isotherm
