#include "edge/publisher/piece_pace.h"

#include <algorithm>

namespace isotherm {
namespace {

constexpr double kBitsPerByte = 8.0;
/// So much of the rate is planned for at most; less to take more frames than before, so that it
/// does not go to and fro.
constexpr double kUsed = 0.85;
constexpr double kUsedForMore = 0.75;
/// A lower rate shows when what was sent before has arrived and was reported.
constexpr Nanoseconds kSettled = std::chrono::milliseconds(250);
constexpr double kLowerRate = 0.9;
/// Part of a report's time may have passed without anything to send.
constexpr double kLowest = 0.4;
/// With each report (twenty in a second) without a queue. At first, and later.
constexpr double kRaiseRateFirst = 1.6;
constexpr double kRaiseRate = 1.01;
constexpr double kSmoothing = 0.1;
/// The cameras' rates are counted for so long.
constexpr Nanoseconds kCounted = std::chrono::milliseconds(500);
/// A frame that more newer ones wait behind is not new any more: some 40 ms of both cameras.
constexpr std::size_t kFewFrames = 3;

void Smooth(double value, double* mean) {
  *mean = *mean == 0.0 ? value : *mean + kSmoothing * (value - *mean);
}

}  // namespace

bool PiecePace::TakesNext(Sensor sensor, std::size_t newer, SteadyTime now) {
  Stream& stream = Of(sensor);
  Count(&stream, now);
  if (IsSilent(now)) {
    if (now - stream.sent_at < kProbeInterval) return false;
    stream.waiting = 0;
    return true;
  }
  ChooseStep(now);
  if (++stream.waiting < stride(sensor) || newer > kFewFrames) return false;
  stream.waiting = 0;
  return true;
}

void PiecePace::Count(Stream* stream, SteadyTime now) {
  const Nanoseconds interval = now - stream->counted_since;
  // A pause is no rate.
  if (interval > kCounted && interval < 4 * kCounted) {
    stream->rate_hz = stream->frames / ToSeconds(interval);
  }
  if (interval > kCounted) {
    stream->counted_since = now;
    stream->frames = 0;
  }
  ++stream->frames;
}

void PiecePace::OnSent(Sensor sensor, std::size_t pieces, std::size_t piece_bytes, SteadyTime now) {
  Stream& stream = Of(sensor);
  const double piece_bits = kBitsPerByte * static_cast<double>(piece_bytes);
  Smooth(piece_bits, &piece_bits_);
  Smooth(piece_bits * static_cast<double>(pieces), &stream.bits);
  stream.sent_at = now;
  if (!sent_since_) sent_since_ = now;
}

void PiecePace::OnReport(const PieceReport& report, SteadyTime now) {
  if (IsSilent(now)) {
    // The link may be another one.
    rate_bit_s_ = std::min(rate_bit_s_, kFirstRate_bit_s);
    was_full_ = false;
    had_.clear();
  }
  if (!had_.empty() && report.received < had_.back().received) had_.clear();
  report_at_ = now;
  had_.push_back({now, report.received, report.next_order});
  while (had_.size() > 2 && now - had_[1].time >= kSettled) had_.pop_front();
  sent_since_.reset();
  if (report.queued > kFullQueue) {
    was_full_ = true;
    if (now - lowered_at_ < kSettled) return;
    Lower(now);
  } else if (report.queued < kFullQueue / 2 && RateOf(&Had::sent) > rate_bit_s_ / 2.0) {
    // A rate that is not used says nothing of the link.
    rate_bit_s_ *= was_full_ ? kRaiseRate : kRaiseRateFirst;
  }
  rate_bit_s_ = std::clamp(rate_bit_s_, kMinRate_bit_s, kMaxRate_bit_s);
}

void PiecePace::Lower(SteadyTime now) {
  lowered_at_ = now;
  // What arrives while pieces wait is what the link carries.
  const double carried = RateOf(&Had::received);
  rate_bit_s_ = std::clamp(kLowerRate * carried, kLowest * rate_bit_s_, kLowerRate * rate_bit_s_);
}

double PiecePace::RateOf(std::uint64_t Had::*count) const {
  if (had_.empty() || had_.back().time <= had_.front().time) return 0.0;
  const std::uint64_t pieces =
      had_.back().*count - std::min(had_.back().*count, had_.front().*count);
  return static_cast<double>(pieces) * piece_bits_ /
         ToSeconds(had_.back().time - had_.front().time);
}

double PiecePace::LoadAt(std::size_t step, SteadyTime now) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < streams_.size(); ++i) {
    const Stream& stream = streams_.at(i);
    // A camera that is gone takes nothing.
    if (now - stream.counted_since > 4 * kCounted) continue;
    sum += stream.bits * stream.rate_hz / kSteps.at(step).at(i);
  }
  return sum;
}

void PiecePace::ChooseStep(SteadyTime now) {
  while (step_ + 1 < kSteps.size() && LoadAt(step_, now) > kUsed * rate_bit_s_) ++step_;
  while (step_ > 0 && LoadAt(step_ - 1, now) < kUsedForMore * rate_bit_s_) --step_;
}

bool PiecePace::IsSilent(SteadyTime now) const {
  return report_at_ && sent_since_ && now - *sent_since_ > kSilence;
}

}  // namespace isotherm
