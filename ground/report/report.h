#pragma once

#include <string>
#include <utility>
#include <vector>

#include "common/base/status.h"
#include "common/rig/rig.h"
#include "ground/json/json.h"
#include "ground/measuring/measuring.pb.h"
#include "ground/mesh/surface.h"
#include "ground/options/ground_options.pb.h"
#include "ground/report/severity.h"

namespace isotherm {

/// A rendering for a report.
struct ReportImage {
  std::string title;
  std::string png;
};

/// Surface by how it was measured, square metres; what was not measured well by its reasons, of
/// which more than one may hold.
struct CoverageByReason {
  double total_m2 = 0.0;
  double good_m2 = 0.0, acceptable_m2 = 0.0, bad_m2 = 0.0, never_m2 = 0.0;
  double distance_m2 = 0.0, angle_m2 = 0.0, motion_m2 = 0.0, disagreement_m2 = 0.0;
};
CoverageByReason CoverageOf(const Surface& mesh);

/// Holds what goes into a report.
struct ReportInputs {
  std::string title;
  std::string place, inspector, load, remarks;  ///< As people say; empty: a blank to fill in.
  std::string when;                             ///< Time of the scan as text.
  std::string software;
  Rig rig;
  ThermalOptions limits;  ///< CompleteLimits.
  InterpretationOptions interpretation;
  CoverageByReason coverage;
  measuring::Measurements measurements;
  SeverityTables severity;  ///< Empty: nothing is assessed.
  std::vector<ReportImage> images;
  /// File name and SHA-256.
  std::vector<std::pair<std::string, std::string>> hashes;
};

/// The same content three times: a page for printing that needs nothing else, a table of the
/// measured objects, and all numbers.
struct ReportFiles {
  std::string html, csv, json;
};
ReportFiles MakeReport(const ReportInputs& inputs);

/// Returns the text as a field of CSV.
std::string EscapeCsv(std::string_view text);

}  // namespace isotherm
