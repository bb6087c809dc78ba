#include "edge/source/testing/fake_source.h"

#include <cstdlib>
#include <sstream>

#include "common/base/check.h"

namespace isotherm {
namespace {

constexpr std::chrono::microseconds kPeriod[] = {std::chrono::microseconds(33'333),
                                                 std::chrono::microseconds(25'000)};

constexpr std::uint64_t kMissing = 3;

}  // namespace

FakeSource::FakeSource(std::string_view script) {
  std::istringstream words{std::string(script)};
  for (std::string word; words >> word;) {
    int count = 1;
    if (const std::size_t star = word.find('*'); star != std::string::npos) {
      count = std::atoi(word.c_str());
      word = word.substr(star + 1);
    }
    CHECK(word.size() == 1 || (word.size() > 2 && word[1] == ':'));
    const Step step{word[0], word.size() > 2 ? word.substr(2) : ""};
    steps_.insert(steps_.end(), static_cast<std::size_t>(count), step);
  }
}

Status FakeSource::Open() {
  ++opened_;
  if (failures_to_open_ > 0) {
    --failures_to_open_;
    return Unavailable("the camera is not there");
  }
  open_ = true;
  return OkStatus();
}

Result<SourceItem> FakeSource::Read(std::stop_token) {
  CHECK(open_);
  ++reads_;
  if (next_ == steps_.size()) return EndOfStream{};
  const Step& step = steps_[next_++];
  if (step.what == '-') return NothingYet{};
  if (step.what == 'p') return MakePose();
  if (step.what == '%') {
    hangs_ = true;
    released_.wait(false);
    return NothingYet{};
  }
  if (step.what == '!') return Err(Unavailable("the cable came off"));
  return MakeFrame(step);
}

std::optional<Status> FakeSource::Control(const CameraControl& control) {
  controls.push_back(control);
  if (answers_after_reads == 0) return control_answer;
  open_orders_.push_back({control, reads_ + static_cast<std::size_t>(answers_after_reads)});
  return std::nullopt;
}

std::vector<ControlAnswer> FakeSource::TakeControlAnswers() {
  std::vector<ControlAnswer> answers;
  while (!open_orders_.empty() && open_orders_.front().answered_at <= reads_) {
    answers.push_back({open_orders_.front().control, control_answer});
    open_orders_.pop_front();
  }
  return answers;
}

ExternalOdometry FakeSource::MakePose() const {
  ExternalOdometry pose;
  pose.source = "fake";
  pose.time = kFakeEpoch + static_cast<int>(frames_[0]) * kPeriod[0];
  return pose;
}

RawFrame FakeSource::MakeFrame(const Step& step) {
  CHECK(step.what == 'd' || step.what == 't');
  RawFrame frame;
  frame.sensor = step.what == 'd' ? Sensor::kDepth : Sensor::kThermal;
  const bool depth = frame.sensor == Sensor::kDepth;
  const auto index = static_cast<std::size_t>(frame.sensor);
  if (step.fault == "lost" || step.fault == "left") frames_[index] += kMissing;
  if (step.fault == "left") left_out_[index] += kMissing;
  frame.frame_number = frames_[index]++;
  const auto time = static_cast<int>(frame.frame_number) * kPeriod[index];
  if (step.fault == "reset") device_zero_[index] = time;
  frame.device_ticks = DeviceTicks(time - device_zero_[index]);
  frame.arrival_wall = kFakeEpoch + time;
  frame.shutter_closed = step.fault == "shut";

  frame.thermal_scale = thermal_scale;
  frame.pixels =
      depth ? Image<std::uint16_t>(8, 6, kDepthRaw) : Image<std::uint16_t>(6, 4, kCentikelvin);
  // No thermal camera is free of noise; the first image has none, for comparison.
  if (!depth && step.fault != "same") noise_ = static_cast<std::uint16_t>(frame.frame_number % 97);
  if (!depth) frame.pixels.At(0, 1) = static_cast<std::uint16_t>(kCentikelvin + noise_);
  if (step.fault == "empty") frame.pixels = {};
  if (step.fault == "size") frame.pixels = Image<std::uint16_t>(7, 6, kDepthRaw);
  for (std::size_t i = 0; i < frame.pixels.size(); i += 2) {
    if (step.fault == "holes") frame.pixels.data()[i] = i % 4 == 0 ? kNoDepth : kNoDepthSaturated;
    if (step.fault == "hot") frame.pixels.data()[i] = i % 4 == 0 ? 65'535 : 100;
  }
  return frame;
}

}  // namespace isotherm
