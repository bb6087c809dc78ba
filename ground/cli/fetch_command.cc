#include <fmt/chrono.h>
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <random>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/base/printable.h"
#include "common/base/progress.h"
#include "ground/cli/command.h"
#include "ground/cli/rig_order.h"
#include "ground/fetch/recording_fetcher.h"

namespace isotherm {
namespace {

constexpr const char* kFetchFooter =
    R"(Without a name it lists what the rig has, the recording that was written last first.
What is fetched comes in pieces with checksums. An attempt that was ended or cut off leaves NAME.part, and the next one goes
on there, after comparing it with the rig's. While the rig scans, it waits: the scan has the link for itself. The rig gives no
more than link.expert.fetch_mb_per_s (8 MB/s).

A file of a recording that was interrupted (a power cut) has no index yet; `isotherm inspect --repair` adds it.

Exit status: 0 done, 69 no rig there or it does not answer any more, 64 several rigs and no --edge-id, or another file is in
the way, 66 no such recording, 65 it is being written.

Examples:
  isotherm fetch                                       what there is
  isotherm fetch --newest -o flight                    the last one
  isotherm fetch --all -o flight --edge-id drone-2
  isotherm fetch edge-20261127-101500-0123abcd.mcap

Then: isotherm merge-recordings, isotherm reconstruct)";

struct FetchArguments {
  std::vector<std::string> names;
  bool all = false;
  bool newest = false;
  std::string folder = ".";
  RigAddress rig;
};

std::string_view StateText(const RemoteRecording& recording, LocalState state) {
  if (recording.is_being_written) return "being written";
  switch (state) {
    case LocalState::kSameSize:
      return "here";
    case LocalState::kPartial:
      return "partly here";
    case LocalState::kOtherSize:
      return "another one is here";
    case LocalState::kMissing:
      break;
  }
  return "";
}

void PrintList(const std::vector<RemoteRecording>& recordings, const std::string& folder) {
  if (recordings.empty()) std::puts("the rig has no recordings");
  for (const RemoteRecording& recording : recordings) {
    const auto written = std::chrono::floor<std::chrono::seconds>(
        std::chrono::sys_time<Nanoseconds>(recording.written.time_since_epoch()));
    const std::string line = fmt::format("{}  {:8.1f} MB  {:%Y-%m-%d %H:%M:%S} UTC  {}",
                                         recording.name, static_cast<double>(recording.size) / 1e6,
                                         written, StateText(recording, StateOf(recording, folder)));
    std::puts(Printable(line).c_str());
  }
}

/// Returns those that are meant, as the list has them.
Result<std::vector<RemoteRecording>> Chosen(const FetchArguments& arguments,
                                            const std::vector<RemoteRecording>& recordings) {
  std::vector<RemoteRecording> chosen;
  for (const RemoteRecording& recording : recordings) {
    const bool is_named =
        std::ranges::find(arguments.names, recording.name) != arguments.names.end();
    const bool is_newest = arguments.newest && chosen.empty() && !recording.is_being_written;
    const bool is_one_of_all = arguments.all && !recording.is_being_written;
    if (is_named || is_newest || is_one_of_all) chosen.push_back(recording);
  }
  for (const std::string& name : arguments.names) {
    if (std::ranges::find(recordings, name, &RemoteRecording::name) == recordings.end())
      return Err(
          NotFound(fmt::format("the rig has no {}; isotherm fetch lists what it has", name)));
  }
  if (chosen.empty()) return Err(NotFound("the rig has no recording that is finished"));
  return chosen;
}

Status Fetch(const FetchArguments& arguments, RecordingFetcher& fetcher) {
  const Result<std::vector<RemoteRecording>> recordings = fetcher.List();
  if (!recordings) return recordings.error();
  if (arguments.names.empty() && !arguments.all && !arguments.newest) {
    PrintList(*recordings, arguments.folder);
    return OkStatus();
  }
  const Result<std::vector<RemoteRecording>> chosen = Chosen(arguments, *recordings);
  if (!chosen) return chosen.error();
  for (const RemoteRecording& recording : *chosen) {
    ProgressBar bar(recording.name, recording.size / 1'000'000, "MB");
    const auto show = [&](std::uint64_t bytes) {
      bar.Update(static_cast<double>(bytes) / static_cast<double>(recording.size));
    };
    ISOTHERM_RETURN_IF_ERROR(fetcher.Fetch(recording, arguments.folder, show));
    bar.Finish();
    fmt::print("{}\n", (std::filesystem::path(arguments.folder) / recording.name).string());
  }
  return OkStatus();
}

Status Run(const FetchArguments& arguments) {
  return WithLink(arguments.rig, [&](const Participant& link, const std::string& edge_id) {
    const Result<std::unique_ptr<RecordingWay>> way = OpenRecordingWay(link, edge_id);
    if (!way) return way.error();
    std::random_device random;
    const std::uint64_t asker = std::uint64_t{random()} << 32U | random();
    const SystemClock clock;
    RecordingFetcher::Options options;
    options.on_busy = [said = false, &edge_id]() mutable {
      if (std::exchange(said, true)) return;
      std::fputs(
          fmt::format("{} scans; its recordings come when the scan is over\n", edge_id).c_str(),
          stderr);
    };
    RecordingFetcher fetcher(**way, clock, asker, options);
    return Fetch(arguments, fetcher);
  });
}

}  // namespace

void AddFetchCommand(CLI::App& app, CommandBody& body) {
  CLI::App* command = app.add_subcommand("fetch", "Brings recordings of a running rig here");
  auto arguments = std::make_shared<FetchArguments>();
  auto* const names =
      command->add_option("recordings", arguments->names, "Names as the list has them");
  auto* const all = command->add_flag("--all", arguments->all, "All that are finished");
  command->add_flag("--newest", arguments->newest, "The one that was finished last")
      ->excludes(all)
      ->excludes(names);
  all->excludes(names);
  command->add_option("-o,--output", arguments->folder, "Folder to write to")
      ->capture_default_str();
  AddRigAddress(*command, arguments->rig);
  command->footer(kFetchFooter);
  command->callback([arguments, &body] {
    body = [arguments] {
      const Status done = Run(*arguments);
      return done.ok() ? 0 : Fail(done);
    };
  });
}

}  // namespace isotherm
