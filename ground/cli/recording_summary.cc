#include "ground/cli/recording_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <string_view>

#include "common/base/quantile.h"
#include "common/codec/codec.h"
#include "common/messages/messages.h"

namespace isotherm {
namespace {

void CountNumbers(std::vector<std::pair<std::uint64_t, std::uint64_t>>& numbers,
                  StreamSummary& stream) {
  // Frames may be recorded out of order. Numbers begin anew in each session.
  std::sort(numbers.begin(), numbers.end());
  for (std::size_t i = 1; i < numbers.size(); ++i) {
    if (numbers[i].first != numbers[i - 1].first) continue;
    const std::uint64_t step = numbers[i].second - numbers[i - 1].second;
    if (step == 0) ++stream.duplicates;
    if (step < 2) continue;
    ++stream.holes;
    stream.missing += step - 1;
  }
}

void MeasurePeriods(std::vector<CaptureTime>& times, StreamSummary& stream) {
  // A frame is missing when the next one is late by more than half a period: jitter is far less.
  constexpr double kGapPeriods = 1.5;
  std::sort(times.begin(), times.end());
  stream.first = times.front();
  stream.last = times.back();
  std::vector<double> periods_s;
  for (std::size_t i = 1; i < times.size(); ++i)
    periods_s.push_back(ToSeconds(times[i] - times[i - 1]));
  if (periods_s.empty()) return;
  std::vector<double> ordered_s = periods_s;
  // The median, since gaps would spoil a mean.
  stream.period_s = TakeMedian(ordered_s);
  for (std::size_t i = 0; i < periods_s.size(); ++i) {
    if (periods_s[i] <= kGapPeriods * stream.period_s) continue;
    ++stream.gaps;
    if (periods_s[i] <= stream.longest_gap_s) continue;
    stream.longest_gap_s = periods_s[i];
    stream.longest_gap_at = times[i];
  }
}

}  // namespace

std::string EncodingName(Encoding encoding) {
  switch (encoding) {
    case Encoding::kRaw16:
      return "raw";
    case Encoding::kPng16:
      return "png";
    case Encoding::kDepthRans:
      return "depth-rans";
    case Encoding::kThermalRans:
      return "thermal-rans";
    case Encoding::kCounts16:
      return "counts (no temperatures)";
    case Encoding::kScaledThermalRans:
      return "scaled thermal-rans";
    case Encoding::kScaledRaw16:
      return "scaled raw";
    case Encoding::kDepthStrips:
      return "depth-strips";
    case Encoding::kThermalStrips:
      return "thermal-strips";
    case Encoding::kScaledThermalStrips:
      return "scaled thermal-strips";
  }
  return fmt::format("unknown ({})", static_cast<int>(encoding));
}

void RecordingSummarizer::AddFrame(const FrameHeader& header, const EncodedImage& image,
                                   StreamSummary& stream, Stamps& stamps) {
  ++stream.frames;
  constexpr std::size_t kMaxKinds = RecordingSummary::kMaxKinds;
  // A damaged file may hold any number of values: what grows is bounded.
  if (stream.sessions.size() < kMaxKinds) stream.sessions.insert(header.session);
  if (stream.sizes.size() < kMaxKinds) stream.sizes.insert({image.width, image.height});
  ++stream.encodings[EncodingName(image.encoding)];
  stream.raw_bytes +=
      2 * static_cast<std::uint64_t>(image.width) * static_cast<std::uint64_t>(image.height);
  stream.payload_bytes += image.payload.size();
  // Our codes are deterministic: equal images have equal codes.
  const std::size_t hash = std::hash<std::string_view>()(
      {reinterpret_cast<const char*>(image.payload.data()), image.payload.size()});
  if (stamps.last_encoding == image.encoding && stamps.last_hash == hash) ++stream.repeats;
  stamps.last_encoding = image.encoding;
  stamps.last_hash = hash;
  if (stamps.times.size() == kMaxFrames) return;
  if (!stamps.times.empty() && header.capture_time < stamps.times.back()) ++stream.out_of_order;
  stamps.numbers.emplace_back(header.session, header.frame_number);
  stamps.times.push_back(header.capture_time);
  stamps.sigmas_ns.push_back(header.capture_sigma.count());
}

void RecordingSummarizer::AddNuc(const EncodedThermalFrame& frame) {
  if (frame.valid) ++summary_.valid_thermal;
  ++summary_.nuc_states[std::string(ToString(frame.nuc_state))];
  const bool in_nuc =
      frame.nuc_state == NucState::kInProgress || frame.nuc_state == NucState::kError;
  const CaptureTime now = frame.header.capture_time;
  const bool begins = in_nuc && !in_nuc_;
  if (begins && summary_.nuc_runs.size() < RecordingSummary::kMaxKinds)
    summary_.nuc_runs.push_back({now, now, 0});
  if (in_nuc) {
    summary_.nuc_runs.back().end = now;
    ++summary_.nuc_runs.back().frames;
  }
  in_nuc_ = in_nuc;
}

void RecordingSummarizer::Add(const RecordedItem& item) {
  if (const auto* depth = std::get_if<RecordedDepth>(&item)) {
    AddFrame(depth->frame.header, depth->frame.image, summary_.depth, depth_);
  } else if (const auto* thermal = std::get_if<RecordedThermal>(&item)) {
    AddFrame(thermal->frame.header, thermal->frame.image, summary_.thermal, thermal_);
    AddNuc(thermal->frame);
  } else if (const auto* event = std::get_if<NucEvent>(&item)) {
    if (summary_.nuc_events.size() < RecordingSummary::kMaxKinds)
      summary_.nuc_events.push_back(*event);
  } else if (const auto* step = std::get_if<ClockStep>(&item)) {
    if (summary_.clock_steps.size() < RecordingSummary::kMaxLog)
      summary_.clock_steps.push_back(*step);
  } else if (const auto* pose = std::get_if<RecordedPose>(&item)) {
    ++summary_.poses[pose->stream];
  } else if (const auto* odometry = std::get_if<ExternalOdometry>(&item)) {
    if (summary_.external_odometry.size() < RecordingSummary::kMaxKinds)
      ++summary_.external_odometry[odometry->source.substr(0, RecordingSummary::kMaxLogBytes)];
  } else if (const auto* log = std::get_if<RecordedLog>(&item)) {
    if (summary_.log.size() < RecordingSummary::kMaxLog) {
      summary_.log.push_back(*log);
      summary_.log.back().text.resize(std::min(log->text.size(), RecordingSummary::kMaxLogBytes));
    } else {
      ++summary_.log_left_out;
    }
  }
}

void RecordingSummarizer::FinishStream(Stamps& stamps, StreamSummary& stream) {
  if (stamps.times.empty()) return;
  CountNumbers(stamps.numbers, stream);
  MeasurePeriods(stamps.times, stream);
  stream.sigma_s = 1e-9 * static_cast<double>(TakeMedian(stamps.sigmas_ns));
}

RecordingSummary RecordingSummarizer::Finish() {
  FinishStream(depth_, summary_.depth);
  FinishStream(thermal_, summary_.thermal);
  return std::move(summary_);
}

namespace {

void Show(const RecordedItem& item, PlausibilityCheck& plausibility) {
  if (const auto* depth = std::get_if<RecordedDepth>(&item)) {
    // Only some frames are looked at: decoding all would take as long as a reconstruction reads.
    if (!plausibility.AddDepth(depth->frame.header.capture_time)) return;
    if (const auto pixels = Decode(depth->frame.image))
      plausibility.LookAtDepth(*pixels, depth->frame.depth_scale);
  } else if (const auto* thermal = std::get_if<RecordedThermal>(&item)) {
    if (!plausibility.AddThermal(thermal->frame.header.capture_time)) return;
    if (thermal->frame.image.encoding == Encoding::kCounts16) return;  // No temperatures.
    if (const auto pixels = Decode(thermal->frame.image))
      plausibility.LookAtThermal(*pixels, thermal->frame.scale);
  }
}

}  // namespace

RecordingSummary Summarize(RecordingReader& reader, PlausibilityCheck& plausibility) {
  RecordingSummarizer summarizer;
  for (;;) {
    const Result<std::optional<RecordedItem>> item = reader.Next();
    if (!item) {
      summarizer.AddUnreadable();
    } else if (!*item) {
      return summarizer.Finish();
    } else {
      summarizer.Add(**item);
      Show(**item, plausibility);
    }
  }
}

}  // namespace isotherm
