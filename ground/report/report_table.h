#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ground/report/report.h"

namespace isotherm {

/// A measured object as a report shows it: numbers that are not there are empty texts.
struct ObjectRow {
  std::string name, kind, quality, remark;
  std::string max_celsius, mean_celsius, min_celsius, sigma_k, difference_k;
  std::string area_m2, length_mm, heat_flow_w;
  std::string emissivity, reflected_celsius, material;
  std::string alarm, severity, action;
  bool is_problem = false;  ///< It could not be measured, or an alarm is on.
};
std::vector<ObjectRow> ObjectRows(const ReportInputs& inputs);

}  // namespace isotherm
