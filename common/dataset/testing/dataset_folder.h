#pragma once

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "common/png/png.h"

namespace isotherm {

/// A small dataset folder that is complete and correct, for tests to break. Removed at the end.
class DatasetFolder {
 public:
  using Grey = Image<std::uint16_t>;
  static constexpr int kDepthWidth = 32, kDepthHeight = 24, kThermalWidth = 20, kThermalHeight = 15;
  static constexpr int kDepthFrames = 4, kThermalFrames = 6;

  explicit DatasetFolder(const std::string& name = "scan") {
    std::string pattern =
        (std::filesystem::temp_directory_path() / "isotherm-dataset-XXXXXX").string();
    if (::mkdtemp(pattern.data()) == nullptr) std::abort();
    root_ = pattern;
    folder_ = root_ / std::filesystem::path(name);
    std::filesystem::create_directories(folder_ / "depth");
    std::filesystem::create_directories(folder_ / "thermal");
    Write("rig.textproto",
          "depth { width: 32 height: 24 fx: 30 fy: 30 cx: 15.5 cy: 11.5 }\ndepth_scale: 1000\n"
          "thermal { width: 20 height: 15 fx: 20 fy: 20 cx: 9.5 cy: 7 }\n"
          "T_thermal_depth { tx: 0.05 ty: 0 tz: 0 qx: 0 qy: 0 qz: 0 qw: 1 }\nthermal_delay_s: "
          "-0.02\n");
    std::string depth = "# timestamp filename\n", thermal = depth;
    for (int i = 0; i < kDepthFrames; ++i) {
      depth += "100." + std::to_string(100 + 33 * i) + " depth/" + std::to_string(i) + ".png\n";
      WriteImage("depth/" + std::to_string(i) + ".png",
                 Grey(kDepthWidth, kDepthHeight, static_cast<std::uint16_t>(500 + i)));
    }
    for (int i = 0; i < kThermalFrames; ++i) {
      thermal += "100." + std::to_string(100 + 25 * i) + " thermal/" + std::to_string(i) + ".png\n";
      WriteImage("thermal/" + std::to_string(i) + ".png",
                 Grey(kThermalWidth, kThermalHeight, static_cast<std::uint16_t>(30000 + i)));
    }
    Write("depth.txt", depth);
    Write("thermal.txt", thermal);
    Write("nuc.txt", "# start end first last mode\n100.150 100.175 2 3 freeze\n");
    Write("groundtruth.txt", "100.100 0 0 0 0 0 0 1\n100.133 0.01 0 0 0 0 0.1 0.99498744\n");
  }
  ~DatasetFolder() {
    std::error_code error;
    std::filesystem::remove_all(root_, error);
  }
  DatasetFolder(const DatasetFolder&) = delete;
  DatasetFolder& operator=(const DatasetFolder&) = delete;

  const std::filesystem::path& root() const { return root_; }
  const std::filesystem::path& path() const { return folder_; }
  void Write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  void WriteImage(const std::string& name, const Grey& image) const {
    WriteBytes(name, *EncodeGrey16Png(image));
  }
  /// A PNG of a kind that data sets must not have; all bytes are 1.
  void WriteOtherPng(const std::string& name, int width, int height, int channels, int bits) const {
    const std::vector<std::uint8_t> bytes(
        static_cast<std::size_t>(width * height * channels * bits / 8), 1);
    WriteBytes(name, *EncodePng({.width = width,
                                 .height = height,
                                 .channels = channels,
                                 .bits = bits,
                                 .bytes = bytes}));
  }
  void WriteBytes(const std::string& name, const std::vector<std::uint8_t>& bytes) const {
    Write(name, std::string(bytes.begin(), bytes.end()));
  }
  void Remove(const std::string& name) const { std::filesystem::remove_all(folder_ / name); }
  void Rename(const std::string& from, const std::string& to) const {
    std::filesystem::rename(folder_ / from, folder_ / to);
  }

 private:
  std::filesystem::path root_;
  std::filesystem::path folder_;
};

/// Real data for tests; empty path if it is not there.
inline std::filesystem::path TestData(const std::string& name) {
  const char* set = std::getenv("ISOTHERM_DATA_DIR");
  const std::filesystem::path root = set != nullptr ? set : ISOTHERM_SOURCE_DIR "/../shared/data";
  std::error_code error;
  return std::filesystem::exists(root / name, error) ? root / name : std::filesystem::path();
}

}  // namespace isotherm
