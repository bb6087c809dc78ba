#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "common/base/status.h"
#include "common/rig/rig.h"
#include "common/time/time_types.h"
#include "edge/spool/spool.h"

namespace isotherm {

/// Holds what stands at the beginning of each file of a recording, and where they go.
struct RecordingDescription {
  using Metadata = std::map<std::string, std::map<std::string, std::string>>;

  std::filesystem::path path;  ///< The first file's.
  Nanoseconds flush_interval{};
  std::optional<Rig> rig;
  Metadata metadata;
  int parts = 0;                 ///< Files that the recording has already.
  bool sync = true;              ///< RecordingOptions::sync.
  const Clock* clock = nullptr;  ///< RecordingOptions::clock.
};

/// Begins one file after the other. A name that is taken is left alone: the next number is. A
/// device or pipe is opened again. Thread-compatible.
class RecordingFiles {
 public:
  explicit RecordingFiles(RecordingDescription description)
      : description_(std::move(description)), part_(description_.parts) {}

  Result<RecordingFile> Next();
  /// Writes a change of the rig; the files that follow begin with it.
  void Update(const RigUpdate& update);

 private:
  Status WriteBeginning(RecordingWriter& writer) const;

  RecordingDescription description_;
  int part_ = 0;
};

}  // namespace isotherm
