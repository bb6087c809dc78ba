#include "edge/publisher/parity_control.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace isotherm {
namespace {

constexpr Nanoseconds kWindow = std::chrono::seconds(1);
/// The fraction that was lost is not known of fewer pieces.
constexpr std::uint64_t kMinPieces = 50;
constexpr double kMaxBroken = 1e-3;  ///< Blocks, at independent losses.
/// Of all frames: more than independent losses break.
constexpr double kTooManyBroken = 0.01;
constexpr double kRaise = 1.5;
constexpr double kLower = 0.99;  ///< With each report without a broken frame.
constexpr double kMaxFactor = 3.0;
/// As many as there are data pieces: beyond, what is sent is mostly parity. Of small blocks this
/// many.
constexpr int kMaxOfSmall = 16;

/// Returns the fraction of pieces that was lost between two reports; nullopt: of too few.
std::optional<double> LossBetween(const PieceReport& before, const PieceReport& after) {
  const std::uint64_t sent = after.next_order - std::min(after.next_order, before.next_order);
  if (sent < kMinPieces) return std::nullopt;
  const std::uint64_t arrived = after.received - std::min(after.received, before.received);
  return std::clamp(1.0 - static_cast<double>(arrived) / static_cast<double>(sent), 0.0, 1.0);
}

}  // namespace

void ParityControl::OnReport(const PieceReport& report, bool is_full, SteadyTime now) {
  // It begins anew, or what was lost in an outage is between them.
  if (!heard_.empty() &&
      (report.received < heard_.back().report.received || now - heard_.back().time > kWindow)) {
    ForgetReports();
  }
  // Losses of the time before say nothing of those of the link as it is used now.
  if (is_full) heard_.clear();
  heard_.push_back({report, now});
  while (heard_.size() > 2 && now - heard_[1].time >= kWindow) heard_.pop_front();
  if (!is_full) Assess(report, now);
}

void ParityControl::Assess(const PieceReport& report, SteadyTime now) {
  const PieceReport& before = heard_.front().report;
  const std::optional<double> lost = LossBetween(before, report);
  if (!lost) return;
  loss_ = *lost;
  const auto broken = static_cast<double>(report.broken - std::min(report.broken, before.broken));
  const auto whole = static_cast<double>(report.frames - std::min(report.frames, before.frames));
  if (broken <= kTooManyBroken * (broken + whole)) {
    factor_ = std::max(1.0, factor_ * kLower);
  } else if (now - raised_at_ >= kWindow) {  // What was raised shows in a second.
    raised_at_ = now;
    factor_ = std::min(kMaxFactor, factor_ * kRaise);
  }
}

int ParityControl::PiecesFor(int data_pieces) const {
  const double p = std::clamp(loss_, kMinLoss, kMaxLoss);
  // The probability that more than m of k + m pieces are lost: a binomial distribution's tail,
  // summed from its terms.
  const int most = std::max(data_pieces, kMaxOfSmall);
  int parity = 0;
  for (; parity < most; ++parity) {
    const int n = data_pieces + parity;
    double term = std::pow(1.0 - p, n);
    double sum = term;
    for (int lost = 1; lost <= parity; ++lost) {
      term *= static_cast<double>(n - lost + 1) / lost * p / (1.0 - p);
      sum += term;
    }
    if (1.0 - sum <= kMaxBroken) break;
  }
  return std::min(static_cast<int>(std::ceil(factor_ * parity)), most);
}

}  // namespace isotherm
