#include "tests/support/programs.h"

#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <limits>
#include <sstream>

#include "common/codec/codec.h"
#include "common/frame/sensor_name.h"
#include "common/transport/testing/test_domain.h"

namespace isotherm::system_test {
namespace {

std::filesystem::path Program(const char* name) {
  return std::filesystem::path(ISOTHERM_BINARY_DIR) / "bin" / name;
}

StoredFrame ToStored(Sensor sensor, const FrameHeader& header, const EncodedImage& image) {
  StoredFrame stored{sensor, header.frame_number, header.capture_time, {}};
  const Result<Image<std::uint16_t>> decoded = Decode(image);
  if (!decoded) {
    ADD_FAILURE() << "frame " << header.frame_number << ": " << decoded.error().message();
  } else {
    stored.pixels.assign(decoded->pixels().begin(), decoded->pixels().end());
  }
  return stored;
}

void SortByNumber(std::vector<StoredFrame>& frames) {
  std::sort(frames.begin(), frames.end(), [](const StoredFrame& a, const StoredFrame& b) {
    return a.frame_number < b.frame_number;
  });
}

}  // namespace

std::filesystem::path Tool() { return Program("isotherm"); }
std::filesystem::path EdgeDaemon() { return Program("isotherm-edge"); }
std::filesystem::path GroundService() { return Program("isotherm-ground"); }

int OwnDomain() {
  static const TestDomain domain;
  return domain.number();
}

std::vector<std::string> QuickModel() {
  return {"--set", "volume.voxel_size_m=0.006", "--set", "tsdf.expert.truncation_distance_m=0.024"};
}

std::vector<std::string> QuickScan() {
  std::vector<std::string> options = QuickModel();
  options.insert(options.end(), {"--set", "calibration_check.expert.enabled=false"});
  return options;
}

void SimulateScan(const std::filesystem::path& path, double duration_s) {
  const Finished simulated = RunToEnd({Tool(),
                                       {"simulate", "--scene", "corner-sphere", "--duration",
                                        std::to_string(duration_s), "-o", path.string()},
                                       {}},
                                      kPatience);
  ASSERT_EQ(simulated.status, 0) << simulated.output;
}

google::protobuf::Struct ReadStats(const std::filesystem::path& folder) {
  std::ostringstream text;
  text << std::ifstream(folder / "stats.json").rdbuf();
  google::protobuf::Struct json;
  const auto parsed = google::protobuf::util::JsonStringToMessage(text.str(), &json);
  EXPECT_TRUE(parsed.ok()) << folder << ": " << parsed.ToString();
  return json;
}

double NumberAt(const google::protobuf::Struct& json, const std::vector<std::string>& path) {
  const google::protobuf::Struct* node = &json;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const auto found = node->fields().find(path[i]);
    if (found == node->fields().end()) break;
    if (i + 1 == path.size() && found->second.has_number_value())
      return found->second.number_value();
    node = &found->second.struct_value();
  }
  ADD_FAILURE() << "no number " << path.back() << " in " << json.ShortDebugString().substr(0, 400);
  return std::numeric_limits<double>::quiet_NaN();
}

RecordingContent ReadRecording(const std::filesystem::path& path) {
  RecordingContent content;
  Result<std::unique_ptr<RecordingReader>> reader = RecordingReader::Open(path);
  if (!reader) {
    ADD_FAILURE() << reader.error().message();
    return content;
  }
  content.complete = (*reader)->info().complete;
  for (;;) {
    const Result<std::optional<RecordedItem>> item = (*reader)->Next();
    if (!item) {
      ADD_FAILURE() << item.error().message();
      continue;
    }
    if (!item->has_value()) break;
    if (const auto* depth = std::get_if<RecordedDepth>(&**item)) {
      content.depth.push_back(ToStored(Sensor::kDepth, depth->frame.header, depth->frame.image));
    } else if (const auto* thermal = std::get_if<RecordedThermal>(&**item)) {
      content.thermal.push_back(
          ToStored(Sensor::kThermal, thermal->frame.header, thermal->frame.image));
    }
  }
  SortByNumber(content.depth);
  SortByNumber(content.thermal);
  return content;
}

FrameCountersText CountersOf(const std::string& output, Sensor sensor, const std::string& done) {
  const std::string name(NameOf(sensor));
  // A blank in the format stands for any number of them in the text.
  const std::string format = name + " captured %ld = " + done +
                             " %ld + rejected %ld + queue full %ld + failed %ld"
                             " + no free slot in the camera's process %ld\n";
  std::istringstream lines(output);
  for (std::string line; std::getline(lines, line);) {
    FrameCountersText counters;
    const int numbers =
        std::sscanf(line.c_str(), format.c_str(), &counters.captured, &counters.done,
                    &counters.rejected, &counters.queue_full, &counters.failed, &counters.left_out);
    if (numbers >= 5 && line.find("unaccounted") == std::string::npos) return counters;
  }
  return {};
}

long LostInCamera(const std::string& output, Sensor sensor) {
  const std::string format = std::string(NameOf(sensor)) + " lost in the camera or its library %ld";
  std::istringstream lines(output);
  for (std::string line; std::getline(lines, line);) {
    long lost = 0;
    if (std::sscanf(line.c_str(), format.c_str(), &lost) == 1) return lost;
  }
  return 0;
}

}  // namespace isotherm::system_test
