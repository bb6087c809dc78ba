#pragma once

#include <cstddef>
#include <filesystem>

#include "common/base/status.h"

namespace isotherm {

/// Memory that grows without moving: address space is reserved once, pages are taken as they are
/// used. With a folder to spill to, the pages belong to a nameless file there, and can be given
/// back without losing what is in them.
class GrowingArena {
 public:
  /// Throws std::bad_alloc if there is no address space, or no file can be made in `spill_dir`.
  explicit GrowingArena(std::size_t reserve_bytes, const std::filesystem::path& spill_dir = {});
  ~GrowingArena();
  GrowingArena(const GrowingArena&) = delete;
  GrowingArena& operator=(const GrowingArena&) = delete;
  std::byte* data() const { return data_; }
  /// Makes sure that the first `bytes` can be written. Returns false if they cannot: a file on a
  /// full disk does not grow.
  bool Commit(std::size_t bytes);
  /// Gives the memory of whole pages within a part back; touching it brings it back from the file.
  /// Does nothing without a file.
  void Decommit(std::size_t offset, std::size_t bytes) const;
  /// Has the file's pages read in the background, so that touching them soon does not wait for the
  /// disk. Does nothing without a file.
  void Fetch(std::size_t offset, std::size_t bytes) const;

 private:
  std::byte* data_ = nullptr;
  std::size_t bytes_ = 0;
  std::size_t committed_bytes_ = 0;
  int file_ = -1;
};

/// Says whether arenas can spill to the folder `volume.spill_dir`; without a folder they need none.
Status CheckSpillDir(const std::filesystem::path& spill_dir);

}  // namespace isotherm
