#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "ground/conversion/convert_recording.h"

namespace isotherm {

/// `--encoding`; `help` names the values and the default.
void AddEncodingOption(CLI::App& command, ImageStorage& storage, const std::string& help);

/// Says where a conversion goes, and what its progress bar is called.
struct ConversionTarget {
  std::string output;
  bool force = false;  ///< Replaces an existing file.
  const char* verb = "converting";
};

/// Converts with a progress bar; the file gets its name when it is complete, so that a conversion
/// that fails or is interrupted leaves nothing. Fills in `request`'s output, progress and stop.
Result<ConvertSummary> ConvertInto(const ConversionTarget& target, ConvertRequest request);

}  // namespace isotherm
