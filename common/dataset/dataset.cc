#include "common/dataset/dataset.h"

#include <fmt/format.h>

#include <algorithm>

#include "common/dataset/text_lines.h"
#include "common/options/nearest_name.h"
#include "common/rig/rig_calibration.h"

namespace isotherm {
namespace {

namespace fs = std::filesystem;

constexpr char kRigFile[] = "rig.textproto";
constexpr char kLayout[] =
    "A dataset folder holds rig.textproto, depth.txt with depth/*.png and, optionally, thermal.txt "
    "with thermal/*.png, nuc.txt and groundtruth.txt.";

bool Exists(const fs::path& path) {
  std::error_code error;
  return fs::exists(path, error);
}

std::vector<std::string> NamesIn(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    names.push_back(entry->path().filename().string());
  }
  // Suggestions must not depend on the order of the file system.
  std::sort(names.begin(), names.end());
  return names;
}

Status CheckFolder(const fs::path& folder) {
  std::error_code error;
  const fs::file_status status = fs::status(folder, error);
  if (!fs::exists(status)) {
    const fs::path parent = folder.has_parent_path() ? folder.parent_path() : ".";
    return NotFound(fmt::format("{}: no such folder.{}", folder.string(),
                                DidYouMean(folder.filename().string(), NamesIn(parent))));
  }
  if (!fs::is_directory(status)) {
    return InvalidArgument(fmt::format("{}: is not a folder. {}", folder.string(), kLayout));
  }
  // Permissions show only when it is read.
  const fs::directory_iterator first(folder, error);
  if (error)
    return IoError(fmt::format("{}: cannot be read: {}", folder.string(), error.message()));
  if (first == fs::directory_iterator()) {
    return NotFound(fmt::format("{}: the folder is empty. {}", folder.string(), kLayout));
  }
  return OkStatus();
}

// A file named on the command line: as given, or else inside the folder.
fs::path Resolve(const fs::path& given, const fs::path& folder) {
  return Exists(given) ? given : folder / given;
}

Result<Rig> ReadRig(const DatasetOptions& options, const std::vector<std::string>& names) {
  const fs::path path =
      options.rig ? Resolve(*options.rig, options.folder) : options.folder / kRigFile;
  if (!Exists(path) && !options.rig) {
    return Err(NotFound(fmt::format(
        "{}: there is no rig calibration.{} It gives the intrinsics, e.g. 'depth {{ width: 640 "
        "height: 480 fx: 570 "
        "fy: 570 cx: 319.5 cy: 239.5 }} depth_scale: 1000'; --rig FILE takes one from elsewhere.",
        path.string(), DidYouMean(kRigFile, names))));
  }
  return LoadRigCalibration(path);
}

Status ReadExternalOdometry(const fs::path& path, std::vector<ExternalOdometry>& poses) {
  const Result<std::vector<StampedPose>> read = ReadTrajectory(path);
  if (!read) return read.error();
  // As many as the link carries (kMaxIdBytes).
  constexpr std::size_t kMaxSourceBytes = 32;
  for (const StampedPose& stamped : *read) {
    ExternalOdometry& pose = poses.emplace_back();
    pose.source = path.stem().string().substr(0, kMaxSourceBytes);
    pose.time = stamped.time;
    pose.translation_m = stamped.T_world_depth.translation();
    pose.rotation = Eigen::Quaterniond(stamped.T_world_depth.linear());
  }
  return OkStatus();
}

// An absent list is fine unless something says that there should be one: intrinsics, a folder of
// images or a name that looks like a typing error.
Status CheckAbsentList(const fs::path& folder, const std::string& sensor, bool has_intrinsics,
                       bool required, const std::vector<std::string>& names,
                       std::vector<std::string>& notes) {
  const std::string list = sensor + ".txt";
  std::vector<std::string> files;
  std::copy_if(names.begin(), names.end(), std::back_inserter(files),
               [&](const std::string& name) { return name != sensor; });
  const std::string suggestion = DidYouMean(list, files);
  const bool has_images = std::find(names.begin(), names.end(), sensor) != names.end();
  if (has_images || !suggestion.empty() || (required && has_intrinsics)) {
    return NotFound(
        fmt::format("{}: no such file, although {}.{} It lists 'timestamp_s filename' per line.",
                    (folder / list).string(),
                    has_images       ? fmt::format("there is a folder '{}'", sensor)
                    : has_intrinsics ? fmt::format("{} has {} intrinsics", kRigFile, sensor)
                                     : "there is one with a similar name",
                    suggestion));
  }
  if (has_intrinsics) {
    notes.push_back(fmt::format("no {}: the recording has no {} frames", list, sensor));
  }
  return OkStatus();
}

Status CheckImagesExist(const std::vector<ImageEntry>& entries, const fs::path& list) {
  for (const ImageEntry& entry : entries) {
    std::error_code error;
    if (fs::is_regular_file(entry.path, error)) continue;
    if (fs::exists(entry.path, error)) {
      return InvalidArgument(fmt::format("{}:{}: image '{}' is a folder, a pipe or a device",
                                         list.string(), entry.line, entry.path.string()));
    }
    const fs::path folder = entry.path.parent_path();
    const std::string suggestion = Exists(folder)
                                       ? DidYouMean(entry.path.filename().string(), NamesIn(folder))
                                       : fmt::format(" There is no folder '{}'.", folder.string());
    return NotFound(fmt::format("{}:{}: image '{}' does not exist.{}", list.string(), entry.line,
                                entry.path.string(), suggestion));
  }
  return OkStatus();
}

Result<std::vector<ImageEntry>> ReadImageList(const fs::path& list, const fs::path& folder,
                                              const std::string& sensor, bool has_intrinsics) {
  const Result<std::string> text = ReadTextFile(list);
  if (!text) return Err(text.error());
  Result<std::vector<ImageEntry>> entries = ParseImageList(*text, list.string(), folder);
  if (!entries) return entries;
  if (!has_intrinsics) {
    return Err(
        FailedPrecondition(fmt::format("{}: lists images, but the rig calibration has no '{}' "
                                       "intrinsics; add '{} {{ width: .. height: .. "
                                       "fx: .. fy: .. cx: .. cy: .. }}'",
                                       list.string(), sensor, sensor)));
  }
  // All are looked for before the first is read: an import of an hour should not end at the last
  // image.
  if (Status status = CheckImagesExist(*entries, list); !status.ok()) return Err(std::move(status));
  return entries;
}

// Reads an optional file with `parse`; a name that looks like a typing error becomes a note.
template <typename T, typename Parse>
Status ReadOptional(const fs::path& path, const std::vector<std::string>& names, const Parse& parse,
                    std::vector<T>& values, std::vector<std::string>& notes) {
  const std::string name = path.filename().string();
  if (!Exists(path)) {
    const std::string similar = NearestName(name, names);
    if (!similar.empty())
      notes.push_back(fmt::format("'{}' is not read; is it meant to be {}?", similar, name));
    return OkStatus();
  }
  const Result<std::string> text = ReadTextFile(path);
  if (!text) return text.error();
  Result<std::vector<T>> parsed = parse(*text, path.string());
  if (!parsed) return parsed.error();
  values = std::move(*parsed);
  return OkStatus();
}

Status ReadLists(const DatasetOptions& options, const std::vector<std::string>& names,
                 Dataset& dataset) {
  const fs::path& folder = options.folder;
  dataset.depth_list = folder / "depth.txt";
  dataset.thermal_list =
      options.thermal_list ? Resolve(*options.thermal_list, folder) : folder / "thermal.txt";
  const bool has_depth = Exists(dataset.depth_list);
  const bool has_thermal = options.thermal_list || Exists(dataset.thermal_list);
  if (has_depth) {
    auto entries =
        ReadImageList(dataset.depth_list, folder, "depth", dataset.rig.depth.has_value());
    if (!entries) return entries.error();
    dataset.depth = std::move(*entries);
  } else {
    ISOTHERM_RETURN_IF_ERROR(CheckAbsentList(folder, "depth", dataset.rig.depth.has_value(), true,
                                             names, dataset.notes));
  }
  if (has_thermal) {
    auto entries =
        ReadImageList(dataset.thermal_list, folder, "thermal", dataset.rig.thermal.has_value());
    if (!entries) return entries.error();
    dataset.thermal = std::move(*entries);
  } else {
    ISOTHERM_RETURN_IF_ERROR(CheckAbsentList(folder, "thermal", dataset.rig.thermal.has_value(),
                                             !has_depth, names, dataset.notes));
  }
  if (!has_depth && !has_thermal) {
    return NotFound(
        fmt::format("{}: has neither depth.txt nor thermal.txt. {}", folder.string(), kLayout));
  }
  return OkStatus();
}

}  // namespace

Result<Dataset> OpenDataset(const DatasetOptions& options) {
  if (Status status = CheckFolder(options.folder); !status.ok()) return Err(std::move(status));
  const std::vector<std::string> names = NamesIn(options.folder);
  Dataset dataset;
  Result<Rig> rig = ReadRig(options, names);
  if (!rig) return Err(rig.error());
  dataset.rig = std::move(*rig);
  if (Status status = ReadLists(options, names, dataset); !status.ok())
    return Err(std::move(status));
  Status status = ReadOptional(options.folder / "nuc.txt", names, ParseNucIntervals, dataset.nuc,
                               dataset.notes);
  if (status.ok()) {
    status = ReadOptional(options.folder / "groundtruth.txt", names, ParseTrajectory,
                          dataset.groundtruth, dataset.notes);
  }
  if (status.ok() && options.external_odometry) {
    status = ReadExternalOdometry(Resolve(*options.external_odometry, options.folder),
                                  dataset.external_odometry);
  }
  if (!status.ok()) return Err(std::move(status));
  if (dataset.depth.empty()) {
    dataset.notes.push_back(
        "thermal only: the recording can be inspected and rendered, but not reconstructed");
  }
  return dataset;
}

}  // namespace isotherm
