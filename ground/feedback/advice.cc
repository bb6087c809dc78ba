#include "ground/feedback/advice.h"

#include <fmt/format.h>

#include <algorithm>

namespace isotherm {
namespace {

// A view with less surface than the first, as a fraction of the image, shows too little to assess;
// it does again from the second on. Two thresholds keep the advice from flickering, here and below.
// None of these was tuned with people.
constexpr double kTooLittleSurface = 0.02;
constexpr double kEnoughSurface = 0.04;
// "Slower" ends at this fraction of the fastest motion that the model follows.
constexpr double kSlowEnough = 0.8;
// The stop criterion is given up when the fraction falls this far below it: new surface came into
// view, not a block that was counted anew.
constexpr double kDoneSlack = 0.03;
/// Less surface out of reach is not worth a word, square metres.
constexpr double kWorthSaying_m2 = 0.005;
// A hindrance takes the place of another one that is still due when it is this much larger.
constexpr double kClearlyLarger = 1.3;

double Percent(double fraction) { return 100.0 * fraction; }

double Fraction(AdviceKind kind, const CoverageSummary& view) {
  switch (kind) {
    case AdviceKind::kCloser:
      return view.too_far;
    case AdviceKind::kFarther:
      return view.too_near;
    case AdviceKind::kLessOblique:
      return view.too_oblique;
    case AdviceKind::kMoreOblique:
      return view.too_frontal;
    default:
      return 0.0;
  }
}

/// Fraction of the fastest motion that the model follows, 0 without a limit.
double Hurry(const ScanSituation& s) {
  const auto ratio = [](double value, double limit) { return limit > 0.0 ? value / limit : 0.0; };
  return std::max(ratio(s.speed_m_s, s.max_speed_m_s),
                  ratio(s.rotation_rate_deg_s, s.max_rotation_rate_deg_s));
}

constexpr AdviceKind kHindrances[] = {AdviceKind::kCloser, AdviceKind::kFarther,
                                      AdviceKind::kLessOblique, AdviceKind::kMoreOblique};

bool IsHindrance(AdviceKind kind) {
  return std::ranges::find(kHindrances, kind) != std::end(kHindrances);
}

/// Not to be waited for.
bool IsAlarm(AdviceKind kind) {
  return kind == AdviceKind::kGoBack || kind == AdviceKind::kHoldForNuc;
}

}  // namespace

Status Validate(const FeedbackOptions& o) {
  if (!(o.done_fraction() > 0.0 && o.done_fraction() <= 1.0)) {
    return InvalidArgument(
        fmt::format("feedback.done_fraction must be above 0 and at most 1 (a fraction), got {}",
                    o.done_fraction()));
  }
  if (!(o.expert().withdraw_fraction() >= 0.0 &&
        o.expert().withdraw_fraction() <= o.expert().advise_fraction() &&
        o.expert().advise_fraction() <= 1.0)) {
    return InvalidArgument(fmt::format(
        "feedback.expert: need 0 <= withdraw_fraction <= advise_fraction <= 1, got {} and {}",
        o.expert().withdraw_fraction(), o.expert().advise_fraction()));
  }
  if (!(o.expert().settle_s() >= 0.0 && o.expert().settle_s() <= 10.0 &&
        o.expert().show_s() >= 0.0 && o.expert().show_s() <= 10.0)) {
    return InvalidArgument(fmt::format(
        "feedback.expert.settle_s and feedback.expert.show_s must be 0..10 s, got {} and {}",
        o.expert().settle_s(), o.expert().show_s()));
  }
  if (o.expert().blocks_per_message() < 1 || o.expert().blocks_per_message() > 1'000'000) {
    return InvalidArgument(
        fmt::format("feedback.expert.blocks_per_message must be 1..1000000, got {}",
                    o.expert().blocks_per_message()));
  }
  if (o.expert().views_per_message() < 0 || o.expert().views_per_message() > 100) {
    return InvalidArgument(
        fmt::format("feedback.expert.views_per_message must be 0 (no next view) to 100, got {}",
                    o.expert().views_per_message()));
  }
  if (!(o.expert().min_gain_m2() > 0.0)) {
    return InvalidArgument(fmt::format("feedback.expert.min_gain_m2 must be positive, got {} m2",
                                       o.expert().min_gain_m2()));
  }
  if (o.expert().image_width_px() != 0 &&
      (o.expert().image_width_px() < 40 || o.expert().image_width_px() > 640)) {
    return InvalidArgument(
        fmt::format("feedback.expert.image_width_px must be 0 (no image) or 40..640 pixels, got {}",
                    o.expert().image_width_px()));
  }
  return OkStatus();
}

OperatorAdviser::OperatorAdviser(const FeedbackOptions& options, const ThermalOptions& limits)
    : options_(options), limits_(limits) {}

void OperatorAdviser::Trigger(AdviceKind kind, double value, double on, double off) {
  bool& due = Due(kind);
  due = due ? value >= off : value >= on;
}

void OperatorAdviser::UpdateTriggers(const CoverageSummary& view, const ScanSituation& s) {
  if (s.tracking_lost || (s.slides && !s.nuc_running)) {
    Due(AdviceKind::kGoBack) = true;
  } else {
    // Negative, since here less is worse and Trigger fires upwards.
    Trigger(AdviceKind::kGoBack, -view.surface, -kTooLittleSurface, -kEnoughSurface);
  }
  Due(AdviceKind::kHoldForNuc) = s.nuc_running;
  if (s.model_good) {
    Trigger(AdviceKind::kDone, *s.model_good, options_.done_fraction(),
            options_.done_fraction() - kDoneSlack);
  }
  if (!s.tracking_lost) {
    const auto stays = [](bool due, double value, double on, double off) {
      return value >= (due ? off : on);
    };
    hurries_ = stays(hurries_, Hurry(s), 1.0, kSlowEnough);
    // What is smeared on the way to a view is measured later: to creep takes several times as long
    // as to go there and hold still.
    smears_ = !s.is_on_the_way && stays(smears_, view.too_fast, options_.expert().advise_fraction(),
                                        options_.expert().withdraw_fraction());
    Due(AdviceKind::kSlower) = hurries_ || smears_ || s.ground_is_behind;
  }
  for (const AdviceKind kind : kHindrances) {
    Trigger(kind, Fraction(kind, view), options_.expert().advise_fraction(),
            options_.expert().withdraw_fraction());
  }
}

AdviceKind OperatorAdviser::MostUrgent(const CoverageSummary& view) const {
  const auto is_due = [this](AdviceKind kind) { return due_[static_cast<std::size_t>(kind)]; };
  for (const AdviceKind kind :
       {AdviceKind::kGoBack, AdviceKind::kHoldForNuc, AdviceKind::kDone, AdviceKind::kSlower}) {
    if (is_due(kind)) return kind;
  }
  AdviceKind most = AdviceKind::kNone;
  double max_fraction = 0.0;
  for (const AdviceKind kind : kHindrances) {
    // Whoever was said last has a head start, so that two hindrances of the same size do not
    // alternate.
    const double fraction = Fraction(kind, view) * (kind == said_ ? kClearlyLarger : 1.0);
    if (!is_due(kind) || fraction <= max_fraction) continue;
    most = kind;
    max_fraction = fraction;
  }
  return most;
}

OperatorAdvice OperatorAdviser::Update(CaptureTime now, const CoverageSummary& view,
                                       const ScanSituation& situation) {
  UpdateTriggers(view, situation);
  const AdviceKind candidate = MostUrgent(view);
  if (!candidate_since_ || candidate != candidate_) {
    candidate_ = candidate;
    candidate_since_ = now;
  }
  const bool settled = now - *candidate_since_ >= FromSeconds(options_.expert().settle_s());
  const bool shown = !said_since_ || said_ == AdviceKind::kNone ||
                     now - *said_since_ >= FromSeconds(options_.expert().show_s());
  // Hindrances come and go as the rig moves; what makes them pointless need not wait for them.
  const bool overrides = !IsHindrance(candidate) && candidate < said_;
  if (candidate != said_ && (IsAlarm(candidate) || (settled && (shown || overrides)))) {
    said_ = candidate;
    said_since_ = now;
  }
  // What is only shown a little longer keeps the numbers that it was said for.
  if (said_ == AdviceKind::kNone || due_[static_cast<std::size_t>(said_)])
    reason_ = Reason(said_, view, situation);
  return {said_, reason_};
}

std::string OperatorAdviser::ReasonToSlowDown(const CoverageSummary& view,
                                              const ScanSituation& s) const {
  if (s.ground_is_behind && Hurry(s) < 1.0)
    return "the ground is behind and leaves thermal frames out: hold still";
  if (Hurry(s) < 1.0 && view.too_fast > 0.0) {
    const double good_px = limits_.expert().motion().smear_good_px();
    const double slow_enough = std::min(1.0, good_px / view.smear_px);
    // Turning by this many degrees moves the image as far as a metre does, half a metre away.
    constexpr double kDegPerMetre = 115.0;
    if (s.rotation_rate_deg_s > kDegPerMetre * s.speed_m_s) {
      return fmt::format(
          "turning at {:.0f} deg/s smears {:.1f} px, {:.1f} px are good: {:.0f} deg/s",
          s.rotation_rate_deg_s, view.smear_px, good_px, slow_enough * s.rotation_rate_deg_s);
    }
    return fmt::format("{:.2f} m/s smears {:.1f} px, {:.1f} px are good: {:.2f} m/s", s.speed_m_s,
                       view.smear_px, good_px, slow_enough * s.speed_m_s);
  }
  if (s.max_speed_m_s > 0.0 && s.speed_m_s / s.max_speed_m_s >= Hurry(s)) {
    return fmt::format("{:.2f} m/s, the model follows up to {:.2f} m/s", s.speed_m_s,
                       s.max_speed_m_s);
  }
  return fmt::format("turning at {:.0f} deg/s, the model follows up to {:.0f} deg/s",
                     s.rotation_rate_deg_s, s.max_rotation_rate_deg_s);
}

std::string OperatorAdviser::Reason(AdviceKind kind, const CoverageSummary& view,
                                    const ScanSituation& s) const {
  switch (kind) {
    case AdviceKind::kGoBack:
      if (s.tracking_lost) return "tracking is lost: return to where it worked";
      if (s.slides) {
        return "the view slides on itself, nothing is added to the model: show the cameras edges "
               "and corners that it has";
      }
      return "no surface of the model in view: point at the object";
    case AdviceKind::kHoldForNuc:
      return "the thermal camera is correcting itself: hold still";
    case AdviceKind::kDone:
      return fmt::format(
          "{:.0f} % of the surface is measured well, {:.0f} % were asked for{}",
          Percent(s.model_good.value_or(0.0)), Percent(options_.done_fraction()),
          s.out_of_reach_m2 < kWorthSaying_m2
              ? ""
              : fmt::format(" ({:.2f} m2 out of reach do not count)", s.out_of_reach_m2));
    case AdviceKind::kSlower:
      return ReasonToSlowDown(view, s);
    case AdviceKind::kCloser:
      return fmt::format("{:.0f} % of the surface is farther than {:.2f} m", Percent(view.too_far),
                         limits_.distance().good_m());
    case AdviceKind::kFarther:
      return fmt::format("{:.0f} % of the surface is nearer than {:.2f} m", Percent(view.too_near),
                         limits_.distance().min_m());
    case AdviceKind::kLessOblique:
      return fmt::format("{:.0f} % of the surface is seen at more than {:g} deg",
                         Percent(view.too_oblique), limits_.angle().good_deg());
    case AdviceKind::kMoreOblique:
      return fmt::format("{:.0f} % of the surface is seen at less than {:g} deg and reflects you",
                         Percent(view.too_frontal), limits_.angle().min_deg());
    case AdviceKind::kNone:
      break;
  }
  if (view.good < options_.done_fraction()) return "";
  return fmt::format("{:.0f} % in view is measured well: go on", Percent(view.good));
}

}  // namespace isotherm
