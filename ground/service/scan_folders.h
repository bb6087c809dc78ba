#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "common/time/time_types.h"
#include "ground/options/ground_options.pb.h"
#include "ground/service/folder_lock.h"

namespace isotherm {

/// Where a session's recording and results go, and what is there of it.
struct ScanFolder {
  std::filesystem::path path;
  /// Recordings that an earlier process has left there, in their order, what came late behind the
  /// rest. By their folder's name they are of the same session; nobody has looked into them.
  std::vector<std::filesystem::path> earlier_files{};
  /// The session has ended, and recording and results are complete: nothing is to be done but to
  /// tell the rig, which may still describe it.
  bool is_complete = false;
  std::shared_ptr<FolderLock> lock{};  ///< To be taken once a new folder is there.
};

/// Gives each session a folder: the newest that an earlier process has begun for it
/// (live.expert.resume) and no other one has, or else a new one. Thread-compatible.
class ScanFolders {
 public:
  ScanFolders(const GroundOptions& options, bool single_scan);

  /// Returns the folder of a session that begins at `now`. Earlier recordings are told once, and
  /// only what was there at the first call is an earlier process's.
  ScanFolder Begin(std::uint64_t session, CaptureTime now);

 private:
  /// Looks which folders there are.
  void Look();
  std::optional<ScanFolder> FindEarlier(std::uint64_t session);

  const std::filesystem::path base_;
  const bool single_scan_;
  const bool resumes_;
  bool has_looked_ = false;
  /// By the end of their names; the newest first.
  std::map<std::uint32_t, std::vector<std::filesystem::path>> earlier_;
};

}  // namespace isotherm
