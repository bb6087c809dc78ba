// Writes small good inputs for each fuzzer, made by our own writers: fuzz_seeds FOLDER. Each fuzzer
// gets a folder of its name. Without them a fuzzer would have to guess magic numbers and checksums.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/check.h"
#include "common/codec/codec.h"
#include "common/png/png.h"
#include "common/recording/testing/recording_data.h"
#include "common/rig/rig_calibration.h"
#include "common/testing/volume_shapes.h"
#include "ground/export/ply.h"
#include "ground/export/trajectory_text.h"
#include "ground/model/model_file.h"
#include "ground/options/ground_options.pb.h"
#include "ground/renderer/palette.h"
#include "ground/surface/voxel_grid.h"

namespace isotherm {
namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<std::uint8_t>;

class SeedFolder {
 public:
  SeedFolder(const fs::path& root, std::string_view fuzzer) : folder_(root / fuzzer) {
    fs::create_directories(folder_);
  }
  fs::path Path(std::string_view name) const { return folder_ / name; }
  void Write(std::string_view name, std::span<const std::uint8_t> bytes) const {
    std::ofstream file(Path(name), std::ios::binary | std::ios::trunc);
    file.write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
    CHECK(file.good());
  }
  void Write(std::string_view name, std::string_view text) const {
    Write(name, std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
  }

 private:
  const fs::path folder_;
};

/// A slope with a step and a hole, in which every code finds something to predict.
Image<std::uint16_t> TestImage(int width, int height) {
  Image<std::uint16_t> image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x)
      image.At(x, y) = static_cast<std::uint16_t>(x == 2 ? 0 : 30'000 + 7 * x + (y > 3 ? 900 : y));
  }
  return image;
}

void WriteCodecSeeds(const fs::path& root) {
  const SeedFolder folder(root, "codec_fuzz");
  const Image<std::uint16_t> image = TestImage(11, 7);
  const auto write = [&](std::string_view name, const EncodedImage& encoded) {
    // As codec_fuzz.cc takes it apart.
    Bytes bytes = {static_cast<std::uint8_t>(encoded.encoding),
                   static_cast<std::uint8_t>(encoded.width),
                   static_cast<std::uint8_t>(encoded.height)};
    bytes.insert(bytes.end(), encoded.payload.begin(), encoded.payload.end());
    folder.Write(name, bytes);
  };
  write("depth", DepthEncoder().Encode(image));
  write("thermal", ThermalEncoder().Encode(image, kCentikelvin));
  constexpr RadiometricScale kHot{.kelvin_per_count = 0.02};
  const EncodedImage scaled = ThermalEncoder().Encode(image, kHot);
  CHECK(scaled.encoding == Encoding::kScaledThermalStrips);
  write("thermal-scaled", scaled);
  EncodedImage scaled_raw = PackCounts(image);  // The same bytes under another name.
  scaled_raw.encoding = Encoding::kScaledRaw16;
  write("thermal-scaled-raw", scaled_raw);
  write("counts", PackCounts(image));
  write("png", {.encoding = Encoding::kPng16,
                .width = image.width(),
                .height = image.height(),
                .payload = EncodeGrey16Png(image).value()});
}

void WritePngSeeds(const fs::path& root) {
  const SeedFolder folder(root, "png_fuzz");
  folder.Write("grey16", EncodeGrey16Png(TestImage(11, 7)).value());
  const Bytes colours(11 * 7 * 3, 90);
  folder.Write("colour8", EncodePng({.width = 11, .height = 7, .bytes = colours}).value());
}

void WriteRecordingSeeds(const fs::path& root) {
  const SeedFolder folder(root, "recording_fuzz");
  const auto write = [&](std::string_view name, const RecordingOptions& options) {
    const auto disk = std::make_shared<MemorySink::Disk>();
    const auto writer = testing::WriterTo(disk, options);
    CHECK(writer->Write(testing::MakeRig()).ok());
    CHECK(writer->WriteMetadata("origin", {{"program", "fuzz_seeds"}}).ok());
    CHECK(testing::WriteScan(testing::MakeScan(70, 4, 3), *writer) == 0);
    CHECK(writer->Write(NucEvent{testing::kScanStart, testing::kScanStart}).ok());
    CHECK(writer->WriteLog(testing::kScanStart, "info", "a sentence").ok());
    CHECK(writer->Close().ok());
    folder.Write(name, disk->bytes);
    // Without its summary it is read by a scan.
    folder.Write(std::string(name) + "-cut",
                 std::span<const std::uint8_t>(disk->bytes).first(disk->bytes.size() * 2 / 3));
  };
  write("compact", {.image_storage = ImageStorage::kCompact});
  write("viewable", {.image_storage = ImageStorage::kViewable});
}

void WriteTextSeeds(const fs::path& root) {
  SeedFolder(root, "text_proto_fuzz").Write("rig", ToText(testing::MakeRig()));
  const SeedFolder dataset(root, "dataset_fuzz");
  dataset.Write("list", "# timestamp filename\n1.25 depth/1.png\n1.5 depth/2.png\n");
  dataset.Write("nuc", "# start end\n1.25 1.75\n4 4.5 in_band\n");
  std::string trajectory;
  for (int i = 0; i < 3; ++i) {
    const StampedPose pose{
        testing::kScanStart + i * std::chrono::milliseconds(33),
        MakeTransform({0.1 * i, 0.2, 0.3}, Eigen::Quaterniond(0.9, 0.1, -0.2, 0.3).normalized())};
    trajectory += TumLine(pose) + "\n";
  }
  dataset.Write("trajectory", trajectory);
}

void WriteModelSeed(const fs::path& root) {
  GroundOptions options;
  VolumeOptions& volume = *options.mutable_volume();
  volume.set_size_x_m(0.064);
  volume.set_size_y_m(0.064);
  volume.set_size_z_m(0.064);
  volume.mutable_expert()->set_min_z_m(0.0);
  volume.set_voxel_size_m(0.004);
  constexpr double kTruncation_m = 0.008;
  const VoxelGrid grid = MakeVoxelGrid(volume).value();
  const std::int32_t max_blocks = MaxBlocks(volume, grid);
  TsdfVolume tsdf(grid, kTruncation_m, max_blocks);
  ThermalVolume thermal(max_blocks);
  testing::FillVolume(tsdf, [](const Eigen::Vector3d& p) {
    return (p - Eigen::Vector3d(0.02, 0.02, 0.02)).norm() - 0.008;
  });
  const RigidTransform pose = MakeTransform({0.0, 0.0, -0.5}, Eigen::Quaterniond::Identity());
  const SeedFolder folder(root, "model_fuzz");
  fs::remove(folder.Path("ball"));
  CHECK(SaveModel(folder.Path("ball"), tsdf, thermal, testing::MakeRig(), std::vector{pose}).ok());
}

void WritePlySeeds(const fs::path& root) {
  Surface surface;
  for (int i = 0; i < 4; ++i) {
    CloudPoint point;
    point.position_m = Eigen::Vector3f(static_cast<float>(i % 2), static_cast<float>(i / 2), 0.5F);
    point.normal = Eigen::Vector3f::UnitZ();
    point.celsius = i == 3 ? NAN : 20.0F + static_cast<float>(i);
    surface.points.push_back(point);
  }
  surface.triangles = {{0, 1, 2}, {1, 3, 2}};
  const ColourTable colours{RendererOptions()};
  const PlyStyle style{.colours = colours,
                       .scale = TemperatureScale{.min_celsius = 20.0, .max_celsius = 22.0},
                       .palette_name = "iron",
                       .software = "fuzz_seeds"};
  const SeedFolder folder(root, "ply_fuzz");
  CHECK(WriteCloudPly(surface, style, folder.Path("cloud")).ok());
  CHECK(WriteMeshPly(surface, style, folder.Path("mesh")).ok());
  folder.Write("ascii",
               "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
               "property float z\nend_header\n0 0 0\n1 2 3\n");
}

}  // namespace
}  // namespace isotherm

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: fuzz_seeds FOLDER\n", stderr);
    return 64;
  }
  const std::filesystem::path root = argv[1];
  isotherm::WriteCodecSeeds(root);
  isotherm::WritePngSeeds(root);
  isotherm::WriteRecordingSeeds(root);
  isotherm::WriteTextSeeds(root);
  isotherm::WriteModelSeed(root);
  isotherm::WritePlySeeds(root);
}
