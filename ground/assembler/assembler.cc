#include "ground/assembler/assembler.h"

#include <algorithm>
#include <utility>

namespace isotherm {
namespace {

/// Keeps a queue sorted: frames arrive nearly in order, so the place is near the end.
template <typename Pointer>
void Insert(std::deque<Pointer>& queue, Pointer frame) {
  auto place = queue.end();
  while (place != queue.begin() &&
         (*std::prev(place))->header.capture_time > frame->header.capture_time) {
    --place;
  }
  queue.insert(place, std::move(frame));
}

}  // namespace

void Assembler::Add(DepthFramePtr frame) {
  const CaptureTime time = frame->header.capture_time;
  if (released_ && time < *released_) {
    ++refused_late_;
    return;
  }
  depth_stalled_ = false;
  newest_depth_ = std::max(newest_depth_.value_or(time), time);
  Insert(depth_, std::move(frame));
}

void Assembler::Add(ThermalFramePtr frame) {
  const CaptureTime time = frame->header.capture_time;
  if (released_ && time < *released_) {
    ++refused_late_;
    return;
  }
  thermal_stalled_ = false;
  newest_thermal_ = std::max(newest_thermal_.value_or(time), time);
  Insert(thermal_, std::move(frame));
}

std::optional<Assembler::Frame> Assembler::PopEarliest() {
  if (depth_.empty() && thermal_.empty()) return std::nullopt;
  const bool take_depth =
      thermal_.empty() || (!depth_.empty() && depth_.front()->header.capture_time <=
                                                  thermal_.front()->header.capture_time);
  if (take_depth) {
    Frame frame = std::move(depth_.front());
    depth_.pop_front();
    released_ = std::get<DepthFramePtr>(frame)->header.capture_time;
    return frame;
  }
  Frame frame = std::move(thermal_.front());
  thermal_.pop_front();
  released_ = std::get<ThermalFramePtr>(frame)->header.capture_time;
  return frame;
}

std::optional<Assembler::Frame> Assembler::Pop() {
  if (!depth_.empty() && !thermal_.empty()) return PopEarliest();
  if (depth_.empty() && thermal_.empty()) return std::nullopt;
  const CaptureTime earliest =
      depth_.empty() ? thermal_.front()->header.capture_time : depth_.front()->header.capture_time;
  // The other stream is in order: once it has been beyond this time, nothing earlier will come.
  const std::optional<CaptureTime>& other = depth_.empty() ? newest_depth_ : newest_thermal_;
  if (other && *other > earliest) return PopEarliest();
  bool& other_stalled = depth_.empty() ? depth_stalled_ : thermal_stalled_;
  if (waiting() > max_held_) other_stalled = true;
  return other_stalled ? PopEarliest() : std::nullopt;
}

std::optional<Assembler::Frame> Assembler::Flush() { return PopEarliest(); }

}  // namespace isotherm
