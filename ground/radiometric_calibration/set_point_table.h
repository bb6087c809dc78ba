#pragma once

#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "common/base/status.h"

namespace isotherm {

/// One row of a table of set points.
struct SetPointRow {
  int line = 0;                             ///< In the file, from 1.
  double body_celsius = 0.0;                ///< The black body's temperature.
  std::optional<double> reading_celsius{};  ///< The camera showed this.
  std::filesystem::path images{};           ///< Else it is in these images.
  std::optional<double> sigma_k{};  ///< Standard uncertainty of the black body at this set point.
};

/// Reads rows "black body °C, reading °C or file[, uncertainty K]". `#` begins a comment line.
/// Files are relative to `folder`. The message of a failure names `source_name` and the line.
Result<std::vector<SetPointRow>> ParseSetPoints(std::string_view text, std::string_view source_name,
                                                const std::filesystem::path& folder);

}  // namespace isotherm
