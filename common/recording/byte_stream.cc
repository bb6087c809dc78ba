#include "common/recording/byte_stream.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

#include "common/base/file_descriptor.h"
#include "common/base/sync_folder.h"

namespace isotherm {
namespace {

Status FromErrno(int error, std::string_view action, const std::filesystem::path& path) {
  std::string message = fmt::format("cannot {} {}: {}", action, path.string(),
                                    std::generic_category().message(error));
  if (error == ENOSPC || error == EDQUOT || error == EFBIG) {
    return ResourceExhausted(message + "; free some space or record to another disk");
  }
  if (error == EROFS) {
    message += "; if it was writable before, its disk has failed: see dmesg, record to another";
  }
  if (error == ENOENT) return NotFound(std::move(message));
  return IoError(std::move(message));
}

class FileSink final : public ByteSink {
 public:
  FileSink(FileDescriptor fd, std::filesystem::path path)
      : fd_(std::move(fd)), path_(std::move(path)) {}

  Status Write(std::span<const std::uint8_t> bytes) override {
    while (!bytes.empty()) {
      const ssize_t written = ::write(fd_.get(), bytes.data(), bytes.size());
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) return FromErrno(errno, "write", path_);
      bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
    return OkStatus();
  }

  Status Sync() override {
    if (::fdatasync(fd_.get()) == 0) return OkStatus();
    // Devices and pipes have nothing to sync. EROFS is not among them: it is what a file system
    // says that has gone read-only because of an error.
    if (errno == EINVAL || errno == ENOTSUP) return OkStatus();
    return FromErrno(errno, "sync", path_);
  }

  Status Close() override {
    const int error = fd_.Close();
    return error == 0 ? OkStatus() : FromErrno(error, "close", path_);
  }

 private:
  FileDescriptor fd_;
  const std::filesystem::path path_;
};

class LockedFileEnd final : public FileEnd {
 public:
  LockedFileEnd(FileDescriptor fd, std::filesystem::path path)
      : fd_(std::move(fd)), path_(std::move(path)) {}

  Status Replace(std::uint64_t offset, std::span<const std::uint8_t> bytes) override {
    struct stat before {};
    if (::fstat(fd_.get(), &before) != 0) return FromErrno(errno, "look at", path_);
    // Cut last: on a disk that is full nothing is gone.
    if (const int error = fd_.WriteAt(offset, bytes); error != 0)
      return FromErrno(error, "write", path_);
    if (::ftruncate(fd_.get(), static_cast<off_t>(offset + bytes.size())) != 0)
      return FromErrno(errno, "cut", path_);
    // What is in the file is as old as before. Best effort.
    const std::array<timespec, 2> times = {before.st_atim, before.st_mtim};
    static_cast<void>(::futimens(fd_.get(), times.data()));
    return ::fsync(fd_.get()) == 0 ? OkStatus() : FromErrno(errno, "sync", path_);
  }

 private:
  FileDescriptor fd_;
  const std::filesystem::path path_;
};

class FileSource final : public ByteSource {
 public:
  FileSource(FileDescriptor fd, std::filesystem::path path, std::uint64_t size)
      : fd_(std::move(fd)), path_(std::move(path)), size_(size) {}

  std::uint64_t size() const override { return size_; }

  Status Read(std::uint64_t offset, std::span<std::uint8_t> bytes) const override {
    while (!bytes.empty()) {
      const ssize_t count =
          ::pread(fd_.get(), bytes.data(), bytes.size(), static_cast<off_t>(offset));
      if (count < 0 && errno == EINTR) continue;
      if (count < 0) return FromErrno(errno, "read", path_);
      if (count == 0)
        return DataLoss(fmt::format("{} became shorter while it was read", path_.string()));
      bytes = bytes.subspan(static_cast<std::size_t>(count));
      offset += static_cast<std::uint64_t>(count);
    }
    return OkStatus();
  }

 private:
  FileDescriptor fd_;
  const std::filesystem::path path_;
  const std::uint64_t size_;
};

/// Locks the file for its writer, which says as long as that lives that it is being written
/// (IsBeingWritten). Returns false if it has another writer. A file system without locks goes
/// without. Whoever asks holds a lock for an instant, too: tried again for a while. Not tuned.
bool LockForWriter(int file) {
  constexpr int kTries = 50;
  for (int i = 0; i < kTries; ++i) {
    if (::flock(file, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return false;
}

}  // namespace

Result<std::unique_ptr<ByteSink>> CreateFileSink(const std::filesystem::path& path) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  const bool device =
      std::filesystem::is_character_file(status) || std::filesystem::is_fifo(status);
  if (std::filesystem::exists(status) && !device) {
    return Err(InvalidArgument(
        fmt::format("{} exists already; choose another name or remove it", path.string())));
  }
  const std::filesystem::path directory = path.has_parent_path() ? path.parent_path() : ".";
  std::filesystem::create_directories(directory, error);
  if (error) return Err(FromErrno(error.value(), "create folder", directory));
  const int flags = O_WRONLY | O_CLOEXEC | (device ? 0 : O_CREAT | O_EXCL);
  FileDescriptor fd(::open(path.c_str(), flags, 0644));
  if (fd.get() < 0) return Err(FromErrno(errno, "create", path));
  if (!device) {
    static_cast<void>(LockForWriter(fd.get()));  // It is new.
    SyncFolder(directory);
  }
  return std::make_unique<FileSink>(std::move(fd), path);
}

Result<std::unique_ptr<FileEnd>> LockFileEnd(const std::filesystem::path& path) {
  FileDescriptor fd(::open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NONBLOCK));
  if (fd.get() < 0) return Err(FromErrno(errno, "open", path));
  if (!LockForWriter(fd.get())) {
    return Err(FailedPrecondition(
        fmt::format("{} is still being written by another program", path.string())));
  }
  return std::make_unique<LockedFileEnd>(std::move(fd), path);
}

Result<std::unique_ptr<ByteSource>> OpenFileSource(const std::filesystem::path& path) {
  // A pipe would be waited for until somebody writes to it.
  FileDescriptor fd(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (fd.get() < 0) return Err(FromErrno(errno, "open", path));
  struct stat info {};
  if (::fstat(fd.get(), &info) != 0) return Err(FromErrno(errno, "open", path));
  if (!S_ISREG(info.st_mode)) {
    return Err(InvalidArgument(fmt::format(
        "{} is a folder, a pipe or a device; a recording is a regular file", path.string())));
  }
  return std::make_unique<FileSource>(std::move(fd), path,
                                      static_cast<std::uint64_t>(info.st_size));
}

}  // namespace isotherm
