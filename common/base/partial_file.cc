#include "common/base/partial_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <utility>

#include "common/base/sync_folder.h"

namespace isotherm {

namespace fs = std::filesystem;

Result<PartialFile> PartialFile::Create(const fs::path& target, bool overwrite) {
  std::error_code error;
  if (target.empty() || !target.has_filename()) {
    return Err(InvalidArgument(
        fmt::format("-o '{}': names no file; name a new .mcap file", target.string())));
  }
  const fs::file_status found = fs::status(target, error);
  if (fs::exists(found) && !fs::is_regular_file(found)) {
    return Err(InvalidArgument(
        fmt::format("{}: is not a regular file; name a new .mcap file", target.string())));
  }
  if (fs::exists(found) && !overwrite) {
    return Err(
        InvalidArgument(fmt::format("{}: exists already; --force replaces it", target.string())));
  }
  fs::path partial = target;
  // In the same folder, so that renaming it is atomic; hidden, and with the process's number, so
  // that two runs do not share it.
  partial.replace_filename(fmt::format(".{}.{}.partial", target.filename().string(), ::getpid()));
  return PartialFile(target, std::move(partial));
}

PartialFile::PartialFile(fs::path target, fs::path path)
    : target_(std::move(target)), path_(std::move(path)) {}

PartialFile::PartialFile(PartialFile&& other) noexcept
    : target_(std::move(other.target_)), path_(std::exchange(other.path_, fs::path())) {}

PartialFile::~PartialFile() {
  std::error_code ignored;
  if (!path_.empty()) fs::remove(path_, ignored);
}

Status PartialFile::Commit() const {
  std::error_code error;
  fs::rename(path_, target_, error);
  if (!error) SyncFolder(target_.parent_path());
  if (!error) return OkStatus();
  return IoError(fmt::format("{}: cannot be created: {}", target_.string(), error.message()));
}

}  // namespace isotherm
