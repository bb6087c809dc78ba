#include "edge/spool/recorded_frames.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <utility>

namespace isotherm {
namespace {

constexpr std::uint64_t kLastNumber = std::numeric_limits<std::uint64_t>::max();

}  // namespace

void RecordedFrames::BeginFile(const std::filesystem::path& file) {
  MutexLock lock(mutex_);
  files_.push_back(file);
}

void RecordedFrames::Add(Sensor sensor, const FrameRange& frames, CaptureTime time) {
  MutexLock lock(mutex_);
  if (files_.empty()) return;
  Stream& stream = streams_[static_cast<std::size_t>(sensor)];
  std::vector<FrameRange>& runs = stream.runs;
  if (!runs.empty() && frames.first <= runs.back().last) return;
  if (!runs.empty() && frames.first == runs.back().last + 1) {
    runs.back().last = frames.last;
  } else {
    // The oldest are what the ground is least likely to wait for.
    if (runs.size() >= kMaxRuns) runs.erase(runs.begin(), runs.begin() + kMaxRuns / 2);
    runs.push_back(frames);
  }
  AddMark({frames.first, time, files_.size() - 1}, stream);
}

void RecordedFrames::AddMark(const Mark& mark, Stream& stream) {
  std::vector<Mark>& marks = stream.marks;
  // Of each file the first frame is known, so that a place is always in the frame's own file.
  const bool is_due = marks.empty() || mark.file != marks.back().file ||
                      mark.number >= marks.back().number + stream.stride;
  if (!is_due) return;
  if (marks.size() == kMaxPlaces) {
    stream.stride *= 2;
    std::vector<Mark> kept;
    for (const Mark& known : marks) {
      const bool keep = kept.empty() || known.file != kept.back().file ||
                        known.number >= kept.back().number + stream.stride;
      if (keep) kept.push_back(known);
    }
    // A disk that begins a file with every frame: the oldest are forgotten.
    if (kept.size() == kMaxPlaces) kept.erase(kept.begin(), kept.begin() + kMaxPlaces / 2);
    marks = std::move(kept);
  }
  marks.push_back(mark);
}

void RecordedFrames::Cut(const FrameRange& frames, Stream& stream) {
  std::vector<FrameRange> left;
  for (const FrameRange& run : stream.runs) {
    if (run.last < frames.first || run.first > frames.last) {
      left.push_back(run);
      continue;
    }
    if (run.first < frames.first) left.push_back({run.first, frames.first - 1});
    if (run.last > frames.last) left.push_back({frames.last + 1, run.last});
  }
  stream.runs = std::move(left);
}

void RecordedFrames::Forget(Sensor sensor, const FrameRange& frames) {
  MutexLock lock(mutex_);
  Cut(frames, streams_[static_cast<std::size_t>(sensor)]);
}

void RecordedFrames::ForgetRest(Sensor sensor, std::uint64_t number,
                                const std::filesystem::path& file) {
  MutexLock lock(mutex_);
  if (files_.empty() || files_.back() == file) return;
  Stream& stream = streams_[static_cast<std::size_t>(sensor)];
  const auto next_file = std::ranges::find_if(stream.marks, [&](const Mark& mark) REQUIRES(mutex_) {
    return mark.number > number && files_[mark.file] != file;
  });
  Cut({number, next_file == stream.marks.end() ? kLastNumber : next_file->number - 1}, stream);
}

void RecordedFrames::ForgetAll(Sensor sensor, const std::filesystem::path& file) {
  MutexLock lock(mutex_);
  Stream& stream = streams_[static_cast<std::size_t>(sensor)];
  const auto is_in_file = [&](const Mark& mark)
                              REQUIRES(mutex_) { return files_[mark.file] == file; };
  const auto first = std::ranges::find_if(stream.marks, is_in_file);
  const auto end = std::find_if_not(first, stream.marks.end(), is_in_file);
  if (first == end) return;
  const std::uint64_t last = end == stream.marks.end() ? kLastNumber : end->number - 1;
  Cut({first->number, last}, stream);
}

std::vector<FrameRange> RecordedFrames::Of(Sensor sensor,
                                           const std::vector<FrameRange>& wanted) const {
  MutexLock lock(mutex_);
  const std::vector<FrameRange>& runs = streams_[static_cast<std::size_t>(sensor)].runs;
  std::vector<FrameRange> both;
  auto run = runs.begin();
  for (const FrameRange& range : wanted) {
    run = std::lower_bound(run, runs.end(), range.first, [](const FrameRange& known, auto number) {
      return known.last < number;
    });
    // A run may reach into the next range as well.
    for (auto at = run; at != runs.end() && at->first <= range.last; ++at) {
      both.push_back({std::max(at->first, range.first), std::min(at->last, range.last)});
    }
  }
  return both;
}

std::optional<RecordedFrames::Place> RecordedFrames::PlaceOf(Sensor sensor,
                                                             std::uint64_t number) const {
  MutexLock lock(mutex_);
  const std::vector<Mark>& marks = streams_[static_cast<std::size_t>(sensor)].marks;
  const auto behind = std::ranges::upper_bound(marks, number, {}, &Mark::number);
  if (behind == marks.begin()) return std::nullopt;
  const Mark& mark = *std::prev(behind);
  return Place{files_[mark.file], mark.time};
}

}  // namespace isotherm
