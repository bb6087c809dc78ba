#include "ground/cli/recording_damage.h"

#include <fmt/format.h>

#include <algorithm>

#include "common/base/printable.h"

namespace isotherm {
namespace {

/// Messages of a topic that the file's index counts and that could not be read.
std::uint64_t UnreadOf(const RecordingReport& report, const char* topic, std::uint64_t read) {
  const auto indexed = report.info.messages_by_topic.find(topic);
  return indexed == report.info.messages_by_topic.end() || indexed->second <= read
             ? 0
             : indexed->second - read;
}

/// Frames that are known to have been in the parts that were left out.
std::uint64_t LostOf(const RecordingReport& report, const char* topic) {
  std::uint64_t lost = 0;
  for (const RecordingGap& gap : report.info.gaps) {
    const auto found = gap.messages_by_topic.find(topic);
    if (found != gap.messages_by_topic.end()) lost += found->second;
  }
  return lost;
}

}  // namespace

std::uint64_t UnreadDepth(const RecordingReport& report) {
  return UnreadOf(report, "/depth", report.summary.depth.frames) + LostOf(report, "/depth");
}

std::uint64_t UnreadThermal(const RecordingReport& report) {
  return UnreadOf(report, "/thermal", report.summary.thermal.frames) + LostOf(report, "/thermal");
}

bool IsDamaged(const RecordingReport& report) {
  if (report.summary.unreadable > 0 || UnreadDepth(report) + UnreadThermal(report) > 0) return true;
  return std::any_of(report.info.gaps.begin(), report.info.gaps.end(),
                     [&](const auto& gap) { return gap.offset + gap.bytes < report.file_bytes; });
}

std::string StateText(const RecordingReport& report) {
  const char* const state =
      report.info.complete ? "complete" : "not complete (the recorder was interrupted)";
  return IsDamaged(report) ? fmt::format("DAMAGED; {}", state) : state;
}

std::string DamageText(const RecordingReport& report) {
  std::string text;
  if (const std::uint64_t depth = UnreadDepth(report), thermal = UnreadThermal(report);
      depth + thermal > 0) {
    text += fmt::format("{:<14}{} depth and {} thermal frames that were recorded cannot be read\n",
                        "lost", depth, thermal);
  }
  if (report.info.bytes_ignored > 0) {
    text += fmt::format("{:<14}{} bytes are damaged or unfinished and were left out\n", "",
                        report.info.bytes_ignored);
  }
  constexpr std::size_t kMaxListed = 20;
  for (std::size_t i = 0; i < std::min(kMaxListed, report.info.gaps.size()); ++i) {
    const RecordingGap& gap = report.info.gaps[i];
    text += fmt::format("{:<14}{} bytes from byte {}", "", gap.bytes, gap.offset);
    for (const auto& [topic, count] : gap.messages_by_topic)
      text += fmt::format(", {} of {}", count, Printable(topic));
    text += "\n";
  }
  if (report.info.gaps.size() > kMaxListed)
    text += fmt::format("{:<14}and {} places more\n", "", report.info.gaps.size() - kMaxListed);
  if (!report.info.complete || IsDamaged(report)) {
    text += fmt::format(
        "{:<14}isotherm merge-recordings {} -o WHOLE.mcap makes it whole; with another recording "
        "of "
        "the same scan (of the rig, of the ground) with its frames\n",
        "", Printable(report.file));
  }
  return text;
}

}  // namespace isotherm
