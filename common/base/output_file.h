#pragma once

#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "common/base/status.h"

namespace isotherm {

/// Writes a file that appears under its name only when it is complete: until Commit() it is
/// `NAME.partial` beside it. The first failure is kept and returned by Commit(); messages name the
/// file. Without Commit() the partial file is removed and an older file of that name stays.
/// Thread-compatible.
class OutputFile {
 public:
  explicit OutputFile(std::filesystem::path path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  void Write(std::span<const std::byte> bytes);
  void Write(std::string_view text) { Write(std::as_bytes(std::span(text))); }

  /// Flushes to the disk and renames.
  Status Commit();

 private:
  void Fail(std::string_view action, int error);

  const std::filesystem::path path_;
  const std::filesystem::path partial_;
  std::FILE* file_ = nullptr;
  Status status_;
};

/// The whole content at once.
Status WriteFile(const std::filesystem::path& path, std::span<const std::byte> bytes);
Status WriteFile(const std::filesystem::path& path, std::string_view text);

}  // namespace isotherm
