#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/status.h"
#include "common/dataset/trajectory.h"
#include "common/geometry/external_odometry.h"
#include "common/rig/rig.h"
#include "common/time/time_types.h"

namespace isotherm {

/// A line of depth.txt or thermal.txt.
struct ImageEntry {
  CaptureTime time;
  std::filesystem::path path;
  int line = 0;
};

/// A line of nuc.txt: the shutter was closed from `start` to `end`, both included, in thermal
/// timestamps.
struct NucInterval {
  CaptureTime start;
  CaptureTime end;
};

/// Says where a dataset lies and which of its files are replaced by others.
struct DatasetOptions {
  std::filesystem::path folder;
  /// Instead of thermal.txt; as given, or else inside the folder. Image names stay relative to the
  /// folder.
  std::optional<std::filesystem::path> thermal_list;
  /// Instead of rig.textproto.
  std::optional<std::filesystem::path> rig;
  /// A trajectory that external odometry measured on the clock of the lists, in TUM format: poses
  /// of a body in any reference frame. As given, or else inside the folder.
  std::optional<std::filesystem::path> external_odometry{};
};

/// A dataset folder in TUM style with everything checked but the pixels. Depth or thermal may be
/// empty, not both.
struct Dataset {
  Rig rig;
  std::filesystem::path depth_list;
  std::filesystem::path thermal_list;
  std::vector<ImageEntry> depth;
  std::vector<ImageEntry> thermal;
  std::vector<NucInterval> nuc;
  std::vector<StampedPose> groundtruth;
  std::vector<ExternalOdometry> external_odometry;  ///< Their source is the name of the file.
  std::vector<std::string>
      notes;  ///< Things that a user should know although they are no errors, a sentence each.
};

/// Reads lists and calibration of a dataset folder. Any inconsistency is an error with file, line
/// and what to do: missing or misspelt files, intrinsics that images need, unsorted or duplicate
/// stamps, non-finite numbers.
Result<Dataset> OpenDataset(const DatasetOptions& options);

/// `timestamp_s filename` per line; names are relative to `folder`. Stamps must increase.
Result<std::vector<ImageEntry>> ParseImageList(std::string_view text, std::string_view source_name,
                                               const std::filesystem::path& folder);

/// `start_s end_s ...` per line; further columns are ignored.
Result<std::vector<NucInterval>> ParseNucIntervals(std::string_view text,
                                                   std::string_view source_name);

}  // namespace isotherm
