#include "edge/spool/recorded_frames.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <utility>

namespace isotherm {
namespace {

constexpr std::uint64_t kLastNumber = std::numeric_limits<std::uint64_t>::max();

/// Returns what is in `runs` and in `wanted`; all ascending.
std::vector<FrameRange> Intersection(const std::vector<FrameRange>& runs,
                                     const std::vector<FrameRange>& wanted) {
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

}  // namespace

void RecordedFrames::BeginFile(const std::filesystem::path& file) {
  MutexLock lock(mutex_);
  files_.push_back(file);
}

void RecordedFrames::Add(Sensor sensor, const FrameRange& frames, CaptureTime time) {
  MutexLock lock(mutex_);
  if (files_.empty()) return;
  Stream& stream = streams_[static_cast<std::size_t>(sensor)];
  const std::vector<FrameRange>& before = stream.runs.empty() ? stream.deleted : stream.runs;
  if (!before.empty() && frames.first <= before.back().last) return;
  std::vector<FrameRange>& runs = stream.runs;
  if (!runs.empty() && frames.first == runs.back().last + 1) {
    runs.back().last = frames.last;
  } else {
    // The oldest are what the ground is least likely to wait for.
    if (runs.size() >= kMaxRuns) runs.erase(runs.begin(), runs.begin() + kMaxRuns / 2);
    runs.push_back(frames);
  }
  AddMark({frames.first, time, deleted_files_ + files_.size() - 1}, stream);
}

void RecordedFrames::AddTo(const FrameRange& frames, std::vector<FrameRange>& deleted) {
  if (!deleted.empty() && frames.first == deleted.back().last + 1) {
    deleted.back().last = frames.last;
    return;
  }
  if (deleted.size() >= kMaxRuns) {
    const auto end = deleted.begin() + kMaxRuns / 2;
    deleted.front().last = std::prev(end)->last;
    deleted.erase(std::next(deleted.begin()), end);
  }
  deleted.push_back(frames);
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
    return mark.number > number && FileOf(mark) != file;
  });
  Cut({number, next_file == stream.marks.end() ? kLastNumber : next_file->number - 1}, stream);
}

void RecordedFrames::ForgetAll(Sensor sensor, const std::filesystem::path& file) {
  MutexLock lock(mutex_);
  Stream& stream = streams_[static_cast<std::size_t>(sensor)];
  const auto is_in_file = [&](const Mark& mark) REQUIRES(mutex_) { return FileOf(mark) == file; };
  const auto first = std::ranges::find_if(stream.marks, is_in_file);
  const auto end = std::find_if_not(first, stream.marks.end(), is_in_file);
  if (first == end) return;
  const std::uint64_t last = end == stream.marks.end() ? kLastNumber : end->number - 1;
  Cut({first->number, last}, stream);
}

void RecordedFrames::AddDeleted(Sensor sensor, std::uint64_t number) {
  MutexLock lock(mutex_);
  if (number > 0) AddTo({0, number - 1}, streams_[static_cast<std::size_t>(sensor)].deleted);
}

void RecordedFrames::DeleteUpTo(const std::filesystem::path& file) {
  MutexLock lock(mutex_);
  const auto found = std::ranges::find(files_, file);
  if (found == files_.end()) return;
  const auto count = static_cast<std::size_t>(found - files_.begin()) + 1;
  const std::size_t first_kept = deleted_files_ + count;
  for (Stream& stream : streams_) {
    // Numbers rise from file to file, and of each file the first frame has a mark.
    const auto kept = std::ranges::find_if(
        stream.marks, [first_kept](const Mark& mark) { return mark.file >= first_kept; });
    const std::uint64_t end = kept == stream.marks.end() ? kLastNumber : kept->number;
    for (const FrameRange& run : stream.runs) {
      if (run.first >= end) break;
      AddTo({run.first, std::min(run.last, end - 1)}, stream.deleted);
    }
    if (end > 0) Cut({0, end - 1}, stream);
    stream.marks.erase(stream.marks.begin(), kept);
  }
  files_.erase(files_.begin(), files_.begin() + static_cast<std::ptrdiff_t>(count));
  deleted_files_ = first_kept;
}

bool RecordedFrames::HasFile(const std::filesystem::path& file) const {
  MutexLock lock(mutex_);
  return std::ranges::find(files_, file) != files_.end();
}

std::vector<FrameRange> RecordedFrames::Of(Sensor sensor,
                                           const std::vector<FrameRange>& wanted) const {
  MutexLock lock(mutex_);
  return Intersection(streams_[static_cast<std::size_t>(sensor)].runs, wanted);
}

std::vector<FrameRange> RecordedFrames::DeletedOf(Sensor sensor,
                                                  const std::vector<FrameRange>& wanted) const {
  MutexLock lock(mutex_);
  return Intersection(streams_[static_cast<std::size_t>(sensor)].deleted, wanted);
}

std::optional<RecordedFrames::Place> RecordedFrames::PlaceOf(Sensor sensor,
                                                             std::uint64_t number) const {
  MutexLock lock(mutex_);
  const std::vector<Mark>& marks = streams_[static_cast<std::size_t>(sensor)].marks;
  const auto behind = std::ranges::upper_bound(marks, number, {}, &Mark::number);
  if (behind == marks.begin()) return std::nullopt;
  const Mark& mark = *std::prev(behind);
  return Place{FileOf(mark), mark.time};
}

}  // namespace isotherm
