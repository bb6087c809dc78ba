#include "edge/nuc/nuc_hold.h"

#include <fmt/format.h>

#include <algorithm>

#include "edge/options/edge_options.pb.h"

namespace isotherm {

NucHold::NucHold(const NucOptions& options, NucNotices& notices)
    : max_hold_s_(options.expert().max_hold_s()), notices_(notices) {}

Result<std::string> NucHold::Hold(CaptureTime now, double seconds) {
  if (!(seconds >= 0.0)) return Err(InvalidArgument("a hold lasts 0 s or longer"));
  if (seconds == 0.0) {
    until_.reset();
    started_.reset();
    notices_.Add(LogLevel::kInfo, "hold ended by the operator");
    return "corrections are not held";
  }
  if (is_used_up_) {
    return Err(FailedPrecondition(
        fmt::format("corrections were held for the {:.0f} s that are allowed; one must come first",
                    max_hold_s_)));
  }
  // Renewing a hold does not extend it beyond max_hold_s from its first beginning.
  if (!started_) started_ = now;
  const CaptureTime last = *started_ + FromSeconds(max_hold_s_);
  // What is longer than any scan must not overflow the clock.
  const double longest_s = ToSeconds(last - now);
  until_ = now + FromSeconds(std::min(seconds, longest_s));
  std::string text = fmt::format("corrections are held for {:.0f} s", ToSeconds(left(now)));
  if (seconds > longest_s) text += ", the most that nuc.expert.max_hold_s allows";
  notices_.Add(LogLevel::kInfo, text);
  return text;
}

void NucHold::Update(CaptureTime now, const std::string& due) {
  if (!until_ || now < *until_) return;
  until_.reset();
  started_.reset();
  // If nothing became due meanwhile, nothing was put off, and the next hold may be as long again.
  is_used_up_ = !due.empty();
  notices_.Add(LogLevel::kInfo, due.empty() ? "hold is over" : "hold is over; due: " + due);
}

}  // namespace isotherm
