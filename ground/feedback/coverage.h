#pragma once

#include <string>
#include <string_view>

#include "ground/renderer/view_maps.h"

namespace isotherm {

class ThermalOptions;

/// How well the surface in a view has been measured so far, and how well it could be measured from
/// where the view is taken now. Shares are of the pixels with a surface and 0 if there are none.
struct CoverageSummary {
  double surface = 0.0;  ///< Pixels with a surface, share of the picture.
  // What is stored. The four add up to 1 if there is a surface.
  double good = 0.0;        ///< Good in distance and angle.
  double acceptable = 0.0;  ///< Neither bad nor both good.
  double bad = 0.0;         ///< Bad in distance or angle.
  double never_measured = 0.0;
  // Of what is not yet acceptable, why another measurement from here would not help. May overlap.
  double too_near = 0.0;
  double too_far = 0.0;
  double too_oblique = 0.0;
};

CoverageSummary SummarizeCoverage(const ViewMaps& view, const ThermalOptions& limits);

enum class AdviceKind {
  kNone,  ///< Carry on.
  kDone,  ///< What is in view is measured well.
  kCloser,
  kFarther,
  kLessOblique,
  kSlower,
  kHoldForNuc,
  kGoBack,  ///< Tracking is lost: return to where it worked.
};
std::string_view ToString(AdviceKind advice);

/// What advice depends on besides the coverage.
struct ScanSituation {
  bool tracking_lost = false;
  bool nuc_running = false;  ///< Shutter closed or settling: no temperature is valid.
  double speed_m_s = 0.0;    ///< Of the depth camera.
  double turn_rate_deg_s = 0.0;
  double max_speed_m_s = 0.0;  ///< Beyond these the model is not updated; 0 = no limit.
  double max_turn_rate_deg_s = 0.0;
};

/// One thing to do, and the sentence that says why, with its numbers.
struct OperatorAdvice {
  AdviceKind advice = AdviceKind::kNone;
  std::string reason;
};

/// The most urgent advice: tracking, then NUC, then motion, then what hinders the largest share of
/// the surface that is not yet measured well.
OperatorAdvice AdviseOperator(const CoverageSummary& coverage, const ScanSituation& situation,
                              const ThermalOptions& limits);

}  // namespace isotherm
