#include "edge/daemon/replace_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace isotherm {
namespace {

bool WriteAll(int file, std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(file, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return true;
}

}  // namespace

Status ReplaceFile(const std::filesystem::path& path, std::span<const std::uint8_t> bytes) {
  std::filesystem::path partial = path;
  partial += ".partial";
  // An interrupted run may have left it behind. A link in its place would lead the image to where
  // somebody else wants it.
  std::error_code error;
  if (std::filesystem::is_regular_file(std::filesystem::symlink_status(partial, error)))
    std::filesystem::remove(partial, error);
  constexpr int kFlags = O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC;
  const int file = ::open(partial.c_str(), kFlags, 0644);
  if (file < 0) {
    return IoError(partial.string() + ": cannot be created: " + std::strerror(errno) +
                   "; is there such a folder, and nothing else of that name in it?");
  }
  const bool written = WriteAll(file, bytes);
  const int reason = errno;
  if (::close(file) != 0 || !written) {
    std::filesystem::remove(partial, error);
    return IoError(partial.string() + ": cannot be written: " + std::strerror(reason));
  }
  std::filesystem::rename(partial, path, error);
  if (error) return IoError(path.string() + ": cannot be replaced: " + error.message());
  return OkStatus();
}

}  // namespace isotherm
