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

With spool.when_full=DELETE_FETCHED the rig deletes the oldest recordings that were fetched whole when it needs the room; it
keeps all others.

A file of a recording that was interrupted (a power cut) has no index yet; `isotherm inspect --repair` adds it.

Exit status: 0 done, 69 no rig there or it does not answer any more, 64 several rigs and no --edge-id, or another file is in
the way, 66 no such recording, 65 it is being written or has changed meanwhile, 74 a disk fails or is full.

Examples:
  isotherm fetch                                       what there is
  isotherm fetch --newest -o flight                    the last one, with all its files
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

/// Returns the first file of the recording that `name` is a part of ("scan-2.mcap" of "scan.mcap").
std::string FirstFile(const std::string& name, const std::vector<RemoteRecording>& recordings) {
  const std::filesystem::path path = name;
  const std::string stem = path.stem().string();
  const std::size_t dash = stem.rfind('-');
  if (dash == std::string::npos) return name;
  const std::string first = stem.substr(0, dash) + path.extension().string();
  const bool is_there =
      std::ranges::find(recordings, first, &RemoteRecording::name) != recordings.end();
  // Where a rig keeps the newest only, the first file is deleted; the others have its name.
  constexpr std::string_view kNameOfFirst = "edge-00000000-000000-ffffffff";
  const bool is_part = stem.starts_with("edge-") && dash == kNameOfFirst.size();
  return is_there || is_part ? first : name;
}

/// Returns those that are meant, as the list has them.
Result<std::vector<RemoteRecording>> Chosen(const FetchArguments& arguments,
                                            const std::vector<RemoteRecording>& recordings) {
  for (const std::string& name : arguments.names) {
    if (std::ranges::find(recordings, name, &RemoteRecording::name) == recordings.end())
      return Err(
          NotFound(fmt::format("the rig has no {}; isotherm fetch lists what it has", name)));
  }
  const auto newest = std::ranges::find(recordings, false, &RemoteRecording::is_being_written);
  const std::string newest_first =
      newest == recordings.end() ? "" : FirstFile(newest->name, recordings);
  std::vector<RemoteRecording> chosen;
  for (const RemoteRecording& recording : recordings) {
    const bool is_named =
        std::ranges::find(arguments.names, recording.name) != arguments.names.end();
    const bool is_newest =
        arguments.newest && FirstFile(recording.name, recordings) == newest_first;
    if (is_named || is_newest || arguments.all) chosen.push_back(recording);
  }
  if (chosen.empty()) return Err(NotFound("the rig has no recording that is finished"));
  return chosen;
}

Status FetchOne(const RemoteRecording& recording, const std::string& folder,
                RecordingFetcher& fetcher) {
  ProgressBar bar(Printable(recording.name), recording.size / 1'000'000, "MB");
  const auto show = [&](std::uint64_t bytes) {
    bar.Update(static_cast<double>(bytes) / static_cast<double>(recording.size));
  };
  ISOTHERM_RETURN_IF_ERROR(fetcher.Fetch(recording, folder, show));
  bar.Finish();
  std::puts(Printable((std::filesystem::path(folder) / recording.name).string()).c_str());
  return OkStatus();
}

/// Tells the rig that a recording is here; one that does not know only keeps its own longer than it
/// must. Returns whether it listens.
bool Tell(const RemoteRecording& recording, RecordingFetcher& fetcher) {
  const Status told = fetcher.TellKept(recording);
  if (told.ok()) return true;
  std::fputs(fmt::format("the rig does not know that {} was fetched, and keeps it: {}\n",
                         Printable(recording.name), PrintableLines(told.message()))
                 .c_str(),
             stderr);
  return told.code() != StatusCode::kUnavailable;
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
  Status first_error;
  bool listens = true;
  for (const RemoteRecording& recording : *chosen) {
    const Status fetched = FetchOne(recording, arguments.folder, fetcher);
    if (fetched.ok() && listens) listens = Tell(recording, fetcher);
    if (fetched.ok()) continue;
    // What stands in the way of one file does not of the others.
    if (fetched.code() == StatusCode::kUnavailable || chosen->size() == 1) return fetched;
    std::fputs(fmt::format("{}\n", PrintableLines(fetched.message())).c_str(), stderr);
    if (first_error.ok()) first_error = fetched;
  }
  return first_error;
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
      std::fputs(fmt::format("{} is busy with a scan or a recording; it is waited for\n",
                             Printable(edge_id))
                     .c_str(),
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
  auto* const all = command->add_flag("--all", arguments->all, "All there are");
  command->add_flag("--newest", arguments->newest, "All files of the one that was finished last")
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
