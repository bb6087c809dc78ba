#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

#include "common/base/status.h"

namespace isotherm {

/// Takes the bytes of a recording that is written. Thread-compatible.
class ByteSink {
 public:
  virtual ~ByteSink() = default;
  /// Appends all of `bytes` or fails; after a failure any part of them may have been written.
  virtual Status Write(std::span<const std::uint8_t> bytes) = 0;
  /// Returns when everything written so far survives a power cut.
  virtual Status Sync() = 0;
  virtual Status Close() = 0;
};

/// Gives the bytes of a recording that is read. Thread-compatible.
class ByteSource {
 public:
  virtual ~ByteSource() = default;
  virtual std::uint64_t size() const = 0;
  /// Fills `bytes` from `offset` or fails; the caller has checked that they lie within size().
  virtual Status Read(std::uint64_t offset, std::span<std::uint8_t> bytes) const = 0;
};

/// A new file (parent directories are created, an existing file is refused) or an existing device
/// or pipe.
Result<std::unique_ptr<ByteSink>> CreateFileSink(const std::filesystem::path& path);

/// The end of a file that is there, for who replaces it. Locked against writers as long as it
/// lives. Thread-compatible.
class FileEnd {
 public:
  virtual ~FileEnd() = default;
  /// Makes `bytes` the last ones of the file, behind its first `offset`, and returns when that
  /// survives a power cut. When it was written last stays as it was. A disk that is full cuts
  /// nothing off.
  virtual Status Replace(std::uint64_t offset, std::span<const std::uint8_t> bytes) = 0;
};

/// Fails with kFailedPrecondition while another program writes the file.
Result<std::unique_ptr<FileEnd>> LockFileEnd(const std::filesystem::path& path);

/// A regular file, read in pieces. Its size is taken when it is opened.
Result<std::unique_ptr<ByteSource>> OpenFileSource(const std::filesystem::path& path);

}  // namespace isotherm
