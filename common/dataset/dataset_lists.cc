#include <fmt/format.h>

#include <algorithm>

#include "common/dataset/dataset.h"
#include "common/dataset/text_lines.h"

namespace isotherm {

Result<std::vector<ImageEntry>> ParseImageList(std::string_view text, std::string_view source_name,
                                               const std::filesystem::path& folder) {
  std::vector<ImageEntry> entries;
  for (const TextLine& line : ContentLines(text)) {
    std::string_view name = line.text;
    const Result<CaptureTime> time = ParseStamp(NextWord(name));
    if (!time) return Err(time.error().WithContext(At(source_name, line)));
    if (name.empty()) {
      return Err(DataLoss(
          fmt::format("{}: no file name behind the timestamp; expected 'timestamp_s filename'",
                      At(source_name, line))));
    }
    if (!entries.empty() && *time <= entries.back().time) {
      const bool duplicate = *time == entries.back().time;
      return Err(DataLoss(fmt::format(
          "{}: timestamp {} {} line {} ({}); sort the list by time and remove duplicates",
          At(source_name, line), FormatStamp(*time),
          duplicate ? "is a duplicate of" : "is earlier than", entries.back().line,
          FormatStamp(entries.back().time))));
    }
    const std::filesystem::path image(name);
    if (image.is_absolute() || std::find(image.begin(), image.end(), "..") != image.end()) {
      return Err(DataLoss(fmt::format(
          "{}: '{}' leads out of the data set's folder; copy the images into it, or list them in a "
          "folder of its own",
          At(source_name, line), name)));
    }
    entries.push_back({*time, folder / image, line.number});
  }
  if (entries.empty()) {
    return Err(DataLoss(
        fmt::format("{}: has no frames; expected 'timestamp_s filename' per line", source_name)));
  }
  return entries;
}

Result<std::vector<NucInterval>> ParseNucIntervals(std::string_view text,
                                                   std::string_view source_name) {
  std::vector<NucInterval> intervals;
  for (const TextLine& line : ContentLines(text)) {
    std::string_view rest = line.text;
    const Result<CaptureTime> start = ParseStamp(NextWord(rest));
    if (!start) return Err(start.error().WithContext(At(source_name, line)));
    if (rest.empty()) {
      return Err(DataLoss(fmt::format("{}: expected 'start_s end_s'", At(source_name, line))));
    }
    const Result<CaptureTime> end = ParseStamp(NextWord(rest));
    if (!end) return Err(end.error().WithContext(At(source_name, line)));
    if (*end < *start) {
      return Err(
          DataLoss(fmt::format("{}: the interval ends ({}) before it starts ({})",
                               At(source_name, line), FormatStamp(*end), FormatStamp(*start))));
    }
    if (!intervals.empty() && *start < intervals.back().end) {
      return Err(DataLoss(
          fmt::format("{}: the interval starts before the one above has ended; sort the lines by "
                      "time and join intervals that overlap",
                      At(source_name, line))));
    }
    intervals.push_back({*start, *end});
  }
  return intervals;
}

}  // namespace isotherm
