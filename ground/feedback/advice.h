#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "common/base/status.h"
#include "common/time/time_types.h"
#include "ground/feedback/coverage.h"
#include "ground/options/ground_options.pb.h"

namespace isotherm {

/// Names what the operator can be told to do, most urgent first: an earlier one makes the later
/// ones useless.
enum class AdviceKind {
  kGoBack,      ///< Tracking is lost, or nothing of the model is in view.
  kHoldForNuc,  ///< No temperature is valid now.
  kDone,        ///< Enough of the surface that can be measured well is.
  kSlower,      ///< The model cannot follow, the thermal image is smeared, or the ground is behind.
  kCloser,
  kFarther,
  kLessOblique,
  kMoreOblique,  ///< The operator is reflected.
  kNone,         ///< Carry on.
};

/// Holds what advice depends on besides the coverage of the view.
struct ScanSituation {
  bool tracking_lost = false;
  bool slides = false;       ///< DepthReport::slides.
  bool nuc_running = false;  ///< Shutter about to close, closed or settling.
  double speed_m_s = 0.0;    ///< Speed of the depth camera.
  double rotation_rate_deg_s = 0.0;
  double max_speed_m_s = 0.0;  ///< Beyond these the model is not updated; 0 = no limit.
  double max_rotation_rate_deg_s = 0.0;
  /// The rig goes to the next view, and is not near it yet.
  bool is_on_the_way = false;
  bool ground_is_behind = false;  ///< Thermal frames are left out to keep up.
  /// The fraction of the whole surface that is measured well, of what is not out of reach; nullopt
  /// while it is not known.
  std::optional<double> model_good;
  double out_of_reach_m2 = 0.0;  ///< Surface that no view would measure well.
};

/// Holds one thing to do, and the sentence that says why, with its numbers.
struct OperatorAdvice {
  AdviceKind kind = AdviceKind::kNone;
  std::string reason;
};

Status Validate(const FeedbackOptions& options);

/// Chooses the one advice that the operator gets, and keeps it from flickering. A cause becomes due
/// above one threshold and stays due until a lower one. It must be due for a while before it is
/// said, and what is said stays for a while. A lost track and a closed shutter are said at once.
/// Thread-compatible.
class OperatorAdviser {
 public:
  /// `limits` come from CompleteLimits.
  OperatorAdviser(const FeedbackOptions& options, const ThermalOptions& limits);

  /// Returns the advice for this view and situation. `now` must not go back.
  OperatorAdvice Update(CaptureTime now, const CoverageSummary& view,
                        const ScanSituation& situation);
  /// Returns whether the stop criterion is met.
  bool done() const { return due_[static_cast<std::size_t>(AdviceKind::kDone)]; }

 private:
  static constexpr std::size_t kKinds = static_cast<std::size_t>(AdviceKind::kNone);

  bool& Due(AdviceKind kind) { return due_[static_cast<std::size_t>(kind)]; }
  /// Makes `kind` due once `value` reaches `on`, until it falls below `off`.
  void Trigger(AdviceKind kind, double value, double on, double off);
  std::string ReasonToSlowDown(const CoverageSummary& view, const ScanSituation& situation) const;
  void UpdateTriggers(const CoverageSummary& view, const ScanSituation& situation);
  /// Returns what would be said without regard to time.
  AdviceKind MostUrgent(const CoverageSummary& view) const;
  std::string Reason(AdviceKind kind, const CoverageSummary& view,
                     const ScanSituation& situation) const;

  const FeedbackOptions options_;
  const ThermalOptions limits_;
  std::array<bool, kKinds> due_{};
  bool hurries_ = false, smears_ = false;  ///< Why it should go slower.
  AdviceKind said_ = AdviceKind::kNone;
  std::string reason_;
  AdviceKind candidate_ = AdviceKind::kNone;
  std::optional<CaptureTime> said_since_, candidate_since_;
};

}  // namespace isotherm
