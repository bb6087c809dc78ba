#include "common/dataset/import.h"

#include <fmt/format.h>

#include <algorithm>

#include "common/base/partial_file.h"
#include "common/codec/codec.h"
#include "common/dataset/image_file.h"
#include "common/doubts/plausibility_check.h"

namespace isotherm {
namespace {

namespace fs = std::filesystem;

// Recordings of a dataset have one session; 0 would mean "none".
constexpr std::uint64_t kSession = 1;

/// Writes one dataset into an open recording.
class Importer {
 public:
  Importer(const ImportRequest& request, const Dataset& dataset, RecordingWriter& writer)
      : request_(request),
        dataset_(dataset),
        writer_(writer),
        nuc_(dataset.nuc),
        plausibility_(dataset.rig) {}

  Result<ImportSummary> Run() {
    Status status = WriteHeader();
    while (status.ok() && !Done()) {
      status =
          request_.stop.stop_requested() ? Unavailable("the import was interrupted") : WriteNext();
    }
    if (!status.ok()) return Err(std::move(status));
    summary_.doubts = plausibility_.Find();
    return summary_;
  }

 private:
  bool Done() const {
    return depth_ == dataset_.depth.size() && thermal_ == dataset_.thermal.size() &&
           pose_ == dataset_.groundtruth.size() && event_ == dataset_.nuc.size() &&
           next_odometry_ == dataset_.external_odometry.size();
  }

  Status WriteHeader() {
    ISOTHERM_RETURN_IF_ERROR(writer_.Write(dataset_.rig));
    return writer_.WriteMetadata(
        "origin",
        {{"format", "tum"},
         {"folder", fs::absolute(request_.dataset.folder).filename().string()},
         {"thermal_list",
          dataset_.thermal.empty() ? std::string() : dataset_.thermal_list.filename().string()},
         {"software", request_.software}});
  }

  // The earliest of the streams; events and poses before the frames of the same time.
  Status WriteNext() {
    constexpr CaptureTime kNever = CaptureTime::max();
    const CaptureTime event = event_ < dataset_.nuc.size() ? dataset_.nuc[event_].start : kNever;
    const CaptureTime pose =
        pose_ < dataset_.groundtruth.size() ? dataset_.groundtruth[pose_].time : kNever;
    const CaptureTime odometry = next_odometry_ < dataset_.external_odometry.size()
                                     ? dataset_.external_odometry[next_odometry_].time
                                     : kNever;
    const CaptureTime depth = depth_ < dataset_.depth.size() ? dataset_.depth[depth_].time : kNever;
    const CaptureTime thermal =
        thermal_ < dataset_.thermal.size() ? dataset_.thermal[thermal_].time : kNever;
    const CaptureTime first = std::min({event, pose, odometry, depth, thermal});
    if (event == first) return WriteEvent();
    if (pose == first) return WritePose();
    if (odometry == first) return WriteExternalOdometry();
    if (request_.progress) request_.progress(Fraction());
    return depth == first ? WriteDepth() : WriteThermal();
  }

  double Fraction() const {
    const std::size_t total = dataset_.depth.size() + dataset_.thermal.size();
    return static_cast<double>(depth_ + thermal_) / static_cast<double>(total);
  }

  Status WriteEvent() {
    const NucInterval& interval = dataset_.nuc[event_++];
    return writer_.Write(NucEvent{interval.start, interval.end, NucSource::kInBand});
  }

  Status WritePose() {
    const StampedPose& pose = dataset_.groundtruth[pose_++];
    ++summary_.groundtruth_poses;
    return writer_.WritePose("groundtruth", pose);
  }

  Status WriteExternalOdometry() {
    ++summary_.external_odometry;
    return writer_.Write(dataset_.external_odometry[next_odometry_++]);
  }

  FrameHeader Header(const ImageEntry& entry, std::size_t index) const {
    FrameHeader header;
    header.session = kSession;
    header.frame_number = index;
    header.device_ticks = DeviceTicks(
        std::chrono::duration_cast<std::chrono::microseconds>(entry.time.time_since_epoch()));
    header.capture_time = entry.time;
    return header;
  }

  // nullopt: the image is bad and shall be left out.
  Result<std::optional<Image<std::uint16_t>>> ReadImage(const ImageEntry& entry,
                                                        const fs::path& list,
                                                        const CameraModel& camera) {
    Result<Image<std::uint16_t>> image = ReadGrey16(entry.path, camera.width, camera.height);
    if (image) {
      summary_.image_bytes += 2 * image->size();
      return std::optional(std::move(*image));
    }
    const std::string place = fmt::format("{}:{}", list.string(), entry.line);
    if (!request_.skip_bad) {
      Status status = image.error().WithContext(place);
      return Err(Status(status.code(), status.message() + " (--skip-bad leaves such images out)"));
    }
    // A frame number stays unused for each: gaps show where images were left out.
    ++summary_.skipped_images;
    if (summary_.skipped_images <= kMaxSkipNotes) {
      summary_.notes.push_back("left out: " + image.error().WithContext(place).message());
    }
    return std::optional<Image<std::uint16_t>>();
  }

  Status WriteDepth() {
    const std::size_t index = depth_++;
    const ImageEntry& entry = dataset_.depth[index];
    auto image = ReadImage(entry, dataset_.depth_list, *dataset_.rig.depth);
    if (!image) return image.error();
    if (!*image) return OkStatus();
    if (plausibility_.AddDepth(entry.time))
      plausibility_.LookAtDepth(**image, dataset_.rig.depth_scale);
    EncodedDepthFrame frame;
    frame.header = Header(entry, index);
    frame.depth_scale = dataset_.rig.depth_scale;
    frame.image = depth_encoder_.Encode(**image);
    ++summary_.depth_frames;
    return writer_.Write(frame, std::nullopt);
  }

  Status WriteThermal() {
    const std::size_t index = thermal_++;
    const ImageEntry& entry = dataset_.thermal[index];
    auto image = ReadImage(entry, dataset_.thermal_list, *dataset_.rig.thermal);
    if (!image) return image.error();
    if (!*image) return OkStatus();
    if (plausibility_.AddThermal(entry.time))
      plausibility_.LookAtThermal(**image, dataset_.rig.thermal_scale);
    ThermalFrame marked;
    marked.header = Header(entry, index);
    marked.temperature_raw = std::move(**image);
    // Before the image is encoded: `valid` is part of the message.
    nuc_.Mark(marked);
    EncodedThermalFrame frame;
    frame.header = marked.header;
    frame.nuc_state = marked.nuc_state;
    frame.nuc_source = marked.nuc_source;
    frame.seconds_since_nuc = marked.seconds_since_nuc;
    frame.valid = marked.valid;
    frame.scale = dataset_.rig.thermal_scale;
    frame.image = thermal_encoder_.Encode(marked.temperature_raw, frame.scale);
    ++summary_.thermal_frames;
    if (!marked.valid) ++summary_.thermal_frames_in_nuc;
    return writer_.Write(frame, std::nullopt);
  }

  // Files that are skipped are named up to here, then only counted.
  static constexpr std::uint64_t kMaxSkipNotes = 10;

  const ImportRequest& request_;
  const Dataset& dataset_;
  RecordingWriter& writer_;
  NucMarker nuc_;
  DepthEncoder depth_encoder_;
  ThermalEncoder thermal_encoder_;
  PlausibilityCheck plausibility_;
  ImportSummary summary_;
  std::size_t depth_ = 0, thermal_ = 0, pose_ = 0, event_ = 0,
              next_odometry_ = 0;  // Next of each stream.
};

Result<ImportSummary> WriteRecording(const ImportRequest& request, const Dataset& dataset,
                                     const fs::path& path) {
  RecordingOptions options;
  options.image_storage = request.storage;
  options.sync = false;  // Importing again costs nothing.
  auto writer = RecordingWriter::Create(path, options);
  if (!writer) return Err(writer.error());
  Result<ImportSummary> summary = Importer(request, dataset, **writer).Run();
  if (!summary) return summary;
  if (Status status = (*writer)->Close(); !status.ok()) return Err(std::move(status));
  summary->recording_bytes = (*writer)->stats().bytes;
  return summary;
}

}  // namespace

Result<ImportSummary> ImportDataset(const ImportRequest& request) {
  const Result<PartialFile> target = PartialFile::Create(request.recording, request.overwrite);
  if (!target) return Err(target.error());
  Result<Dataset> dataset = OpenDataset(request.dataset);
  if (!dataset) return Err(dataset.error());
  Result<ImportSummary> summary = WriteRecording(request, *dataset, target->path());
  if (!summary) return summary;
  // The recording gets its name when it is complete.
  if (Status status = target->Commit(); !status.ok()) return Err(std::move(status));
  summary->notes.insert(summary->notes.begin(), dataset->notes.begin(), dataset->notes.end());
  return summary;
}

}  // namespace isotherm
