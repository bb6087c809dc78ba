#pragma once

#include <filesystem>

namespace isotherm {

/// Keeps other processes of the ground out of a scan's folder, from taking it up until what was
/// recorded is put together. Ends with the process, whatever ends that. Thread-compatible.
class FolderLock {
 public:
  FolderLock() = default;
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

  /// Takes a folder that is there. Returns false if another process has it; true also where the
  /// file system has no locks.
  bool Take(const std::filesystem::path& folder);

 private:
  int descriptor_ = -1;
};

}  // namespace isotherm
