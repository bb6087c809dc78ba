#include "ground/calibration/calibration_verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace isotherm {
namespace {

// At three standard deviations one scan in 400 would be told wrongly that something has moved.
constexpr double kSigmas = 3.0;
// An estimate less certain than this may tell that something has moved by much, but agrees with
// nearly all.
constexpr double kMaxSigmaToAgree_s = 0.005;
constexpr double kMaxSigmaToAgree_px = 1.0;
constexpr double kMaxSigmaToAgree_k = 0.5;
constexpr double kMaxSigmaOfInfluence = 0.02;

CheckVerdict AssessSize(double size, double sigma, double limit, double max_sigma_to_agree) {
  if (std::abs(size) > std::max(limit, kSigmas * sigma)) return CheckVerdict::kMoved;
  // Nor is what is not a number told.
  return std::isfinite(size) && sigma <= max_sigma_to_agree ? CheckVerdict::kAgrees
                                                            : CheckVerdict::kNotAssessed;
}

std::string Sentence(CheckVerdict verdict, const std::string& figures) {
  switch (verdict) {
    case CheckVerdict::kMoved:
      return "moved by " + figures;
    case CheckVerdict::kAgrees:
      return "ok, within " + figures;
    case CheckVerdict::kRefuted:
      return "cannot tell here: " + figures + ", but images that were held out do not agree better";
    case CheckVerdict::kNotAssessed:
    case CheckVerdict::kOff:
      break;
  }
  return "cannot tell here: " + figures;
}

}  // namespace

FractionChange ChangeOfInfluence(const Refinement& refinement) {
  return {refinement.correction.segment<2>(kNearInfluence).sum(),
          std::sqrt(std::max(
              0.0, refinement.covariance.block<2, 2>(kNearInfluence, kNearInfluence).sum()))};
}

std::string_view ToString(CheckVerdict verdict) {
  switch (verdict) {
    case CheckVerdict::kOff:
      return "off";
    case CheckVerdict::kNotAssessed:
      return "could not be assessed";
    case CheckVerdict::kRefuted:
      return "refuted by images that were held out";
    case CheckVerdict::kAgrees:
      return "agrees";
    case CheckVerdict::kMoved:
      return "moved";
  }
  return "?";
}

bool CalibrationVerdict::Moved() const {
  return pose == CheckVerdict::kMoved || delay == CheckVerdict::kMoved ||
         influence == CheckVerdict::kMoved;
}

bool CalibrationVerdict::Agrees() const {
  return pose == CheckVerdict::kAgrees && delay == CheckVerdict::kAgrees &&
         influence != CheckVerdict::kMoved;
}

CheckVerdict Assess(const DelayEstimate& off_by, double max_shift_s) {
  return AssessSize(off_by.delay_s, off_by.sigma_s, max_shift_s, kMaxSigmaToAgree_s);
}

CalibrationVerdict Assess(const Refinement& refinement, const CheckLimits& limits) {
  CalibrationVerdict verdict;
  verdict.pose = AssessSize(refinement.shift.rms_px, refinement.shift.sigma_px, limits.shift_px,
                            kMaxSigmaToAgree_px);
  verdict.delay =
      Assess({.delay_s = refinement.correction[kDelay], .sigma_s = refinement.Sigma(kDelay)},
             limits.delay_s);
  const FractionChange influence = ChangeOfInfluence(refinement);
  verdict.influence =
      AssessSize(influence.sum, influence.sigma, limits.influence, kMaxSigmaOfInfluence);
  if (!refinement.held_out.improves) {
    for (CheckVerdict* part : {&verdict.pose, &verdict.delay, &verdict.influence}) {
      if (*part == CheckVerdict::kMoved) *part = CheckVerdict::kRefuted;
    }
  }
  if (const auto& offset = refinement.epoch_offset) {
    verdict.offset =
        AssessSize(offset->kelvin, offset->sigma_k, limits.epoch_offset_k, kMaxSigmaToAgree_k);
  }
  return verdict;
}

std::string DescribePose(const Refinement& refinement, CheckVerdict verdict) {
  return Sentence(verdict, fmt::format("{:.2f} px in the thermal image, uncertain by {:.2f} px",
                                       refinement.shift.rms_px, refinement.shift.sigma_px));
}

std::string DescribeDelay(const Refinement& refinement, CheckVerdict verdict) {
  return Sentence(verdict,
                  fmt::format("{:+.1f} ms, uncertain by {:.1f} ms",
                              1e3 * refinement.correction[kDelay], 1e3 * refinement.Sigma(kDelay)));
}

std::string DescribeInfluence(const Refinement& refinement, CheckVerdict verdict) {
  const FractionChange influence = ChangeOfInfluence(refinement);
  return Sentence(verdict, fmt::format("{:+.1f} % of what other pixels show, uncertain by {:.1f} %",
                                       100.0 * influence.sum, 100.0 * influence.sigma));
}

std::string DescribeOffset(const Refinement& refinement, CheckVerdict verdict) {
  if (!refinement.epoch_offset)
    return "cannot tell here: no place was seen often enough both before and after a NUC";
  const EpochOffset& offset = *refinement.epoch_offset;
  return Sentence(verdict, fmt::format("{:+.2f} K from one NUC to another, uncertain by {:.2f} K",
                                       offset.kelvin, offset.sigma_k));
}

}  // namespace isotherm
