#pragma once

#include <filesystem>
#include <string>

#include "common/base/status.h"

namespace isotherm {

/// The place where a file grows until it is complete: beside its final name, which it gets in the
/// end. What is left unfinished is removed. Thread-compatible.
class PartialFile {
 public:
  /// Fails if `target` is something else than a file, or a file that is not to be replaced.
  static Result<PartialFile> Create(const std::filesystem::path& target, bool overwrite);
  ~PartialFile();
  PartialFile(PartialFile&& other) noexcept;
  PartialFile& operator=(PartialFile&&) = delete;

  /// Returns where to write; nothing is there yet.
  const std::filesystem::path& path() const { return path_; }
  /// Gives the file its name.
  Status Commit() const;

 private:
  PartialFile(std::filesystem::path target, std::filesystem::path path);

  std::filesystem::path target_;
  std::filesystem::path path_;
};

}  // namespace isotherm
