#include "ground/service/result_writer.h"

#include <fmt/format.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

#include "common/base/log.h"
#include "common/base/standard_error.h"
#include "common/doubts/doubts.h"
#include "ground/export/result_files.h"
#include "ground/results/scan_result.h"
#include "ground/service/conclusion.h"
#include "ground/service/link_counters.h"
#include "ground/service/scan_completion.h"

namespace isotherm {
namespace {

using namespace std::chrono_literals;

namespace fs = std::filesystem;

/// The recording's end is written at the same time. A disk that takes longer is slow or stuck.
constexpr Nanoseconds kClosingPatience = 1s;
constexpr Nanoseconds kLateClosingPatience = 10s;

Json DescribeEnd(LiveScan& scan, const GroundOptions& options, const SessionCounters& counters,
                 const RecordingProgress& recording, std::uint64_t unprocessed) {
  Json stats = DescribeScan(scan.model(), options);
  Json& link = stats["link"];
  link["session"] = counters.session;
  link["closed"] = counters.closed;
  link["final"] = counters.ended;
  link["not_processed_at_stop"] = unprocessed;
  link["waiting"] = DescribeStage(scan.waiting());
  if (Json load_shedding = scan.DescribeLoadShedding(); !load_shedding.is_null())
    link["load_shedding"] = std::move(load_shedding);
  if (Json rebuild = scan.DescribeRebuild(); !rebuild.is_null())
    link["rebuild"] = std::move(rebuild);
  if (Json ages = scan.arrival_ages().Describe(); !ages.is_null())
    link["capture_to_ground"] = std::move(ages);
  link["out_of_order_frames"] = scan.out_of_order();
  if (scan.odometry_poses_received() > 0) {
    link["external_odometry"]["received"] = scan.odometry_poses_received();
    link["external_odometry"]["missing"] = scan.odometry_poses_missing();
  }
  DescribeCounters(counters, recording, link);
  stats["feedback"] = scan.DescribeFeedback();
  if (Json console = scan.DescribeConsole(); !console.is_null())
    stats["console"] = std::move(console);
  stats["processor"] = DescribeProcessor(scan.processor_times(), scan.model().trajectory);
  return stats;
}

std::string WhereFramesAre(const RecordingProgress& recording) {
  if (!recording.earlier_files.empty()) {
    std::string files;
    for (const fs::path& file : recording.AllFiles())
      files += (files.empty() ? "" : " ") + file.string();
    return "its frames are in " + files + " (isotherm merge-recordings, then isotherm reconstruct)";
  }
  return fmt::format(
      "what came late is in {} (isotherm merge-recordings, then isotherm reconstruct)",
      (recording.late_files.empty() ? recording.path : recording.late_files.front()).string());
}

/// Returns where results go that cannot be written where they belong.
fs::path SecondFolder(const fs::path& folder) {
  std::error_code error;
  const fs::path base = fs::temp_directory_path(error);
  const fs::path name = fs::absolute(folder, error).lexically_normal();
  return base /
         ("isotherm-" + (name.has_filename() ? name : name.parent_path()).filename().string());
}

}  // namespace

void ResultWriter::Enqueue(EndedScan ended, const std::stop_token& stop) {
  ++board_.scans_being_written;
  const Nanoseconds patience = ended.start.rig.waits_for_ground ? kReplayPatience : Nanoseconds(0);
  MutexLock lock(mutex_);
  if (!WaitForRoom(lock, patience, stop)) {
    --board_.scans_being_written;
    lock.unlock();
    return GiveUp(ended);
  }
  waiting_ = std::move(ended);
  changed_.notify_all();
}

bool ResultWriter::WaitForRoom(MutexLock& lock, Nanoseconds patience, const std::stop_token& stop) {
  const auto has_room = [this]() REQUIRES(mutex_) { return !waiting_; };
  if (changed_.wait_for(lock, stop, patience, has_room)) return true;
  // At a stop there is time: the scan before is waited for, and this one's results are not lost.
  if (!stop.stop_requested()) return false;
  changed_.wait(lock, has_room);
  return true;
}

void ResultWriter::GiveUp(const EndedScan& ended) {
  if (!ended.scan) return;  // It had none.
  const RecordingProgress recording = ended.start.recording->Get();
  const std::string where =
      recording.is_in_parts() ? WhereFramesAre(recording)
      : recording.path.empty()
          ? "its frames were not recorded"
          : fmt::format("its frames are in the recording: isotherm reconstruct {} -o {}",
                        recording.path.string(), ended.start.folder.string());
  given_up_ = ResourceExhausted(fmt::format(
      "the results of a scan are lost, session={}: those of two scans before it are still being "
      "written, the disk is slow or stuck, output_dir={}; {}",
      ended.start.rig.session, options_.live().output_dir(), where));
  ++board_.scans_given_up;
  LOG(Ground, Error) << given_up_.message();
}

std::optional<EndedScan> ResultWriter::Take(const std::stop_token& stop) {
  MutexLock lock(mutex_);
  if (!changed_.wait(lock, stop, [this]() REQUIRES(mutex_) { return waiting_.has_value(); }))
    return std::nullopt;
  std::optional<EndedScan> ended = std::exchange(waiting_, std::nullopt);
  changed_.notify_all();
  return ended;
}

void ResultWriter::Run(const std::stop_token& stop) {
  while (std::optional<EndedScan> ended = Take(stop)) {
    progress_.Busy(clock_.SteadyNow());
    const Json stats = FinishScan(*ended, stop);
    handlers_.written(std::move(ended->scan));
    if (!stats.is_null()) {
      Complete(ended->start, stats, stop);
    } else if (const RecordingProgress recording = ended->start.recording->Get();
               recording.is_in_parts() && !ended->start.is_complete) {
      LOG(Ground, Warning) << WhereFramesAre(recording);
    }
    progress_.Idle();
    // The reserve on the disk was for these results; a scan under way says again what it needs.
    if (--board_.scans_being_written == 0) board_.result_bytes = 0;
    if (handlers_.completed) handlers_.completed();
  }
}

Json ResultWriter::FinishScan(EndedScan& ended, const std::stop_token& stop) {
  if (!ended.scan) return nullptr;  // Recorded only.
  LiveScan& scan = *ended.scan;
  const auto go_on = [this] { progress_.Busy(clock_.SteadyNow()); };
  scan.FinishFrames([&](double) { go_on(); });
  const CalibrationCheckReport calibration = scan.CheckCalibration([&] { go_on(); }, stop);
  // A scan that cannot tell does not take back what another one told.
  if (const CheckVerdict verdict = Overall(calibration);
      verdict == CheckVerdict::kMoved || verdict == CheckVerdict::kAgrees)
    board_.calibration.Set(WhatHasMoved(calibration));
  go_on();
  // The summary says how much the recording has; its last chunk is being written meanwhile.
  const RecordingProgress recording = ended.start.recording->WaitUntilClosed(kClosingPatience);
  const SessionCounters counters = counters_(scan.session());
  const Json stats = DescribeEnd(scan, options_, counters, recording, ended.unprocessed);
  // Results of an earlier process know more than a model of which only the beginning is there.
  const bool is_partial = !recording.earlier_files.empty() && !recording.is_earlier_in_model;
  std::error_code missing;
  if (is_partial && fs::exists(ended.start.folder / "stats.json", missing)) {
    WriteStandardOutput("results  as they were before, until the scan is completed\n" +
                        CountersText(counters, recording));
    return stats;
  }
  const Result<std::string> text = WriteWithFallback(scan, calibration, stats, ended.start.folder);
  if (!text) {
    status_ = text.error();
    LOG(Ground, Error) << status_.message();
    return nullptr;
  }
  WriteStandardOutput(*text + CountersText(counters, recording) + scan.arrival_ages().ToText() +
                      ConclusionText(scan.behind(), scan.areas(),
                                     options_.feedback().done_fraction(), recording.path));
  return stats;
}

void ResultWriter::Complete(const SessionStart& start, const Json& stats,
                            const std::stop_token& stop) {
  if (!start.recording->Get().is_in_parts()) return;
  // Two files are being closed; whoever waits for results has some by now.
  const RecordingProgress recording = start.recording->WaitUntilClosed(kLateClosingPatience);
  if (!NeedsCompletion(options_, recording)) {
    if (recording.AllFiles().size() > 1) {
      LOG(Ground, Warning) << "the scan is in parts: " << WhereFramesAre(recording);
    }
    return;
  }
  const std::string why =
      recording.late_frames > 0
          ? fmt::format("frames came late, frames={}", recording.late_frames)
          : fmt::format("frames were recorded before, files={}", recording.earlier_files.size());
  LOG(Ground, Info) << why << ": the recording and the results are completed";
  std::stop_source give_up;
  const std::stop_callback on_stop(stop, [&give_up] { give_up.request_stop(); });
  const auto go_on = [this, &give_up] {
    progress_.Busy(clock_.SteadyNow());
    MutexLock lock(mutex_);
    if (waiting_) give_up.request_stop();
  };
  const auto describe = [&stats, &recording](Json& json) {
    for (const char* part : {"link", "feedback", "console"}) {
      if (stats.contains(part)) json[part] = stats[part];
    }
    json["link"]["recording_files"] = {recording.AllFiles().front().filename().string()};
  };
  const Result<std::string> completed =
      CompleteScan({.options = options_,
                    .folder = start.folder,
                    .recording = recording,
                    .depth_frames = stats["link"]["depth"]["recorded"],
                    .thermal_frames = stats["link"]["thermal"]["recorded"],
                    .describe = describe,
                    .go_on = go_on,
                    .stop = give_up.get_token()});
  if (completed) return WriteStandardOutput(*completed);
  LOG(Ground, Warning) << "the scan is not completed: " << completed.error().message() << "; "
                       << WhereFramesAre(recording);
}

Result<std::string> ResultWriter::WriteWithFallback(LiveScan& scan,
                                                    const CalibrationCheckReport& calibration,
                                                    const Json& stats, const fs::path& folder) {
  const auto progress = [this](std::string_view, double) { progress_.Busy(clock_.SteadyNow()); };
  const auto write = [&](const fs::path& to) -> Result<std::string> {
    if (Status prepared = PrepareOutputDir(to); !prepared.ok()) return Err(prepared);
    Result<WrittenScan> written = WriteScan(
        scan.model(), options_, {calibration, DoubtsAbout(scan.rig()), stats}, to, progress);
    if (!written) return Err(written.error());
    for (const std::string& doubt : written->doubts) LOG(Ground, Warning) << doubt;
    return std::move(written->text);
  };
  const Result<std::string> first = write(folder);
  if (first) return first;
  status_ = first.error();
  // An hour's scan is worth a second try on another disk.
  const fs::path second_folder = SecondFolder(folder);
  LOG(Ground, Error) << "the results of this scan cannot be written: " << first.error().message()
                     << "; trying " << second_folder.string();
  Result<std::string> second = write(second_folder);
  if (!second) {
    return Err(first.error().WithContext("the results are lost: writing to " +
                                         second_folder.string() + " failed too, " +
                                         second.error().message()));
  }
  LOG(Ground, Warning) << "the results are in " << second_folder.string()
                       << ", because they could not be written to " << folder.string();
  return *second + fmt::format("         not in {}, which could not be written\n", folder.string());
}

}  // namespace isotherm
