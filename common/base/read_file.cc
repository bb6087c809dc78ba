#include "common/base/read_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace isotherm {
namespace {

Status CannotOpen(const std::filesystem::path& path, int reason) {
  std::string text = fmt::format("{}: cannot be opened: {}", path.string(), std::strerror(reason));
  return reason == ENOENT ? NotFound(std::move(text)) : IoError(std::move(text));
}

Status CheckKind(const std::filesystem::path& path, const struct stat& info,
                 std::uint64_t max_bytes) {
  if (!S_ISREG(info.st_mode)) {
    return InvalidArgument(fmt::format("{}: is {}, expected a regular file", path.string(),
                                       S_ISDIR(info.st_mode) ? "a folder" : "a pipe or a device"));
  }
  const auto size = static_cast<std::uint64_t>(info.st_size);
  if (size > max_bytes) {
    return DataLoss(fmt::format("{}: has {} bytes, more than are read ({} at most)", path.string(),
                                size, max_bytes));
  }
  return OkStatus();
}

/// Reads up to `size` bytes; a file that was cut meanwhile has fewer.
Result<std::string> ReadBytes(int file, const std::filesystem::path& path, std::size_t size) {
  std::string bytes(size, '\0');
  std::size_t got = 0;
  while (got < size) {
    const ssize_t count = ::read(file, bytes.data() + got, size - got);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) {
      return Err(
          IoError(fmt::format("{}: cannot be read: {}", path.string(), std::strerror(errno))));
    }
    if (count == 0) break;
    got += static_cast<std::size_t>(count);
  }
  bytes.resize(got);
  return bytes;
}

}  // namespace

Result<std::string> ReadFile(const std::filesystem::path& path, std::uint64_t max_bytes) {
  // Without O_NONBLOCK a pipe is waited for when it is opened.
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (file < 0) return Err(CannotOpen(path, errno));
  struct stat info {};
  const Status usable =
      ::fstat(file, &info) != 0 ? CannotOpen(path, errno) : CheckKind(path, info, max_bytes);
  Result<std::string> bytes =
      // The size of the opened file, not of the name, which may point elsewhere by now.
      usable.ok() ? ReadBytes(file, path, static_cast<std::size_t>(info.st_size)) : Err(usable);
  ::close(file);
  return bytes;
}

}  // namespace isotherm
