#include "common/base/output_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "common/base/check.h"
#include "common/base/sync_folder.h"

namespace isotherm {
namespace {

std::filesystem::path PartialName(std::filesystem::path path) {
  path += ".partial";
  return path;
}

/// Returns what the user can do about a failure, as the end of its sentence.
std::string Advice(int error) {
  switch (error) {
    case ENOSPC:
    case EDQUOT:
      return "; free some space or choose another folder with -o";
    case EACCES:
    case EPERM:
    case EROFS:
    case ENOENT:
    case ENOTDIR:
      return "; choose a folder that can be written with -o";
    case EEXIST:
    case ELOOP:
      return "; something else has the name with .partial at its end, remove it";
    default:
      return "";
  }
}

}  // namespace

OutputFile::OutputFile(std::filesystem::path path)
    : path_(std::move(path)), partial_(PartialName(path_)) {
  // An interrupted run may have left it behind. Anything else of that name, a link above all, would
  // lead the content to where somebody else wants it.
  std::error_code ignored;
  if (std::filesystem::is_regular_file(std::filesystem::symlink_status(partial_, ignored)))
    std::filesystem::remove(partial_, ignored);
  constexpr int kFlags = O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC;
  const int descriptor = open(partial_.c_str(), kFlags, 0666);
  if (descriptor >= 0) file_ = fdopen(descriptor, "wb");
  if (file_ == nullptr) Fail("creating", errno);
}

OutputFile::~OutputFile() {
  if (file_ == nullptr) return;
  std::fclose(file_);
  std::error_code ignored;
  std::filesystem::remove(partial_, ignored);
}

void OutputFile::Fail(std::string_view action, int error) {
  if (!status_.ok()) return;
  const StatusCode code = error == ENOSPC || error == EDQUOT || error == EFBIG
                              ? StatusCode::kResourceExhausted
                              : StatusCode::kIoError;
  status_ = Status(code, std::string(action) + " " + path_.string() + ": " +
                             std::generic_category().message(error) + Advice(error));
}

void OutputFile::Write(std::span<const std::byte> bytes) {
  if (!status_.ok()) return;
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_) != bytes.size()) Fail("writing", errno);
}

Status OutputFile::Commit() {
  if (!status_.ok()) return status_;
  CHECK(file_ != nullptr);
  if (std::fflush(file_) != 0 || fsync(fileno(file_)) != 0) {
    Fail("writing", errno);
    return status_;
  }
  const int closed = std::fclose(std::exchange(file_, nullptr));
  if (closed != 0) Fail("closing", errno);
  if (status_.ok() && std::rename(partial_.c_str(), path_.c_str()) != 0) Fail("renaming to", errno);
  if (!status_.ok()) {
    std::error_code ignored;
    std::filesystem::remove(partial_, ignored);
    return status_;
  }
  SyncFolder(path_.parent_path());
  return OkStatus();
}

Status WriteFile(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  OutputFile file(path);
  file.Write(bytes);
  return file.Commit();
}

Status WriteFile(const std::filesystem::path& path, std::string_view text) {
  return WriteFile(path, std::as_bytes(std::span(text)));
}

}  // namespace isotherm
