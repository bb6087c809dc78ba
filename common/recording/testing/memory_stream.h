#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "common/recording/byte_stream.h"

namespace isotherm {

/// A disk in memory that is full after `capacity` bytes: the write that does not fit is cut, as on
/// a real disk.
class MemorySink final : public ByteSink {
 public:
  /// Plays the disk; it can be full, and it knows what a power cut would leave.
  struct Disk {
    std::vector<std::uint8_t> bytes;
    std::size_t capacity = std::numeric_limits<std::size_t>::max();
    std::size_t synced = 0;  ///< Bytes that would survive a power cut now.
    int refused_writes = 0;
  };

  explicit MemorySink(std::shared_ptr<Disk> disk) : disk_(std::move(disk)) {}

  Status Write(std::span<const std::uint8_t> bytes) override {
    const std::size_t fits = std::min(bytes.size(), disk_->capacity - disk_->bytes.size());
    disk_->bytes.insert(disk_->bytes.end(), bytes.begin(),
                        bytes.begin() + static_cast<std::ptrdiff_t>(fits));
    if (fits == bytes.size()) return OkStatus();
    ++disk_->refused_writes;
    return ResourceExhausted("no space left on the disk in memory");
  }
  Status Sync() override {
    disk_->synced = disk_->bytes.size();
    return OkStatus();
  }
  Status Close() override { return OkStatus(); }

 private:
  std::shared_ptr<Disk> disk_;
};

/// Reads a file that lies in memory.
class MemorySource final : public ByteSource {
 public:
  explicit MemorySource(std::vector<std::uint8_t> bytes) : bytes_(std::move(bytes)) {}

  std::uint64_t size() const override { return bytes_.size(); }
  Status Read(std::uint64_t offset, std::span<std::uint8_t> bytes) const override {
    if (offset > bytes_.size() || bytes.size() > bytes_.size() - offset) {
      return Internal(fmt::format("read of {} bytes at {} beyond the end", bytes.size(), offset));
    }
    std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(offset), bytes.size(), bytes.begin());
    return OkStatus();
  }

 private:
  const std::vector<std::uint8_t> bytes_;
};

}  // namespace isotherm
