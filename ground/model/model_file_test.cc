#include "ground/model/model_file.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "common/testing/temporary_directory.h"
#include "common/testing/volume_shapes.h"
#include "ground/model/model.pb.h"
#include "ground/model/record_part.h"
#include "ground/surface/voxel_grid.h"

namespace isotherm {
namespace {

constexpr std::uint64_t kSeed = 5;

class ModelFileTest : public ::testing::Test {
 protected:
  ModelFileTest() {
    options_.mutable_volume()->set_size_x_m(0.32);
    options_.mutable_volume()->set_size_y_m(0.32);
    options_.mutable_volume()->set_size_z_m(0.32);
    options_.mutable_volume()->mutable_expert()->set_min_z_m(-0.1);
    options_.mutable_volume()->set_voxel_size_m(0.004);
    options_.mutable_tsdf()->mutable_expert()->set_truncation_distance_m(0.016);
    rig_.depth = CameraModel{640, 480, 575.0, 576.0, 320.0, 240.0};
    rig_.thermal = CameraModel{382, 288, 550.0, 551.0, 190.0, 144.0, -0.2};
    rig_.T_thermal_depth = MakeTransform({0.07, 0.0, 0.0}, Eigen::Quaterniond::Identity());
    Make(options_, tsdf_, thermal_);
    testing::FillVolume(*tsdf_, [](const Eigen::Vector3d& p) {
      return (p - Eigen::Vector3d(0.16, 0.16, 0.06)).norm() - 0.1;
    });
    std::mt19937_64 random(kSeed);
    for (std::int32_t block = 0; block < tsdf_->block_count(); ++block) {
      for (ThermalVoxel& voxel : thermal_->voxels(block))
        voxel.bits = static_cast<std::uint32_t>(random() & 0xFFFF00FF);
    }
    for (int i = 0; i < 3; ++i) {
      poses_.push_back(
          MakeTransform({0.1 * i, 0.0, -0.5},
                        Eigen::Quaterniond(Eigen::AngleAxisd(0.1 * i, Eigen::Vector3d::UnitY()))));
    }
  }
  static void Make(const GroundOptions& options, std::unique_ptr<TsdfVolume>& tsdf,
                   std::unique_ptr<ThermalVolume>& thermal) {
    const VoxelGrid grid = MakeVoxelGrid(options.volume()).value();
    const std::int32_t max_blocks = MaxBlocks(options.volume(), grid);
    tsdf = std::make_unique<TsdfVolume>(grid, options.tsdf().expert().truncation_distance_m(),
                                        max_blocks);
    thermal = std::make_unique<ThermalVolume>(max_blocks);
  }
  std::filesystem::path Path() const { return folder_.path() / "model.iso"; }
  void Save() { ASSERT_TRUE(SaveModel(Path(), *tsdf_, *thermal_, rig_, poses_).ok()); }
  std::string Bytes() const {
    std::ifstream file(Path(), std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  void Write(const std::string& bytes) const {
    std::ofstream(Path(), std::ios::binary | std::ios::trunc) << bytes;
  }
  /// Opens and reads everything into new volumes.
  Status Read() {
    const auto model = ModelFile::Open(Path());
    if (!model) return model.error();
    GroundOptions options;
    if (Status status = (*model)->AdoptVolume(options); !status.ok()) return status;
    if (Status status = Validate(options.volume()); !status.ok()) return status;
    Make(options, read_tsdf_, read_thermal_);
    return (*model)->ReadBlocks(*read_tsdf_, *read_thermal_);
  }

  const testing::TemporaryDirectory folder_;
  GroundOptions options_;
  Rig rig_;
  std::unique_ptr<TsdfVolume> tsdf_, read_tsdf_;
  std::unique_ptr<ThermalVolume> thermal_, read_thermal_;
  std::vector<RigidTransform> poses_;
};

TEST_F(ModelFileTest, WhoSavesHearsAfterEachPartThatItGoesOn) {
  std::vector<double> fractions;
  ASSERT_TRUE(SaveModel(Path(), *tsdf_, *thermal_, rig_, poses_, [&](double fraction) {
                fractions.push_back(fraction);
              }).ok());
  constexpr int kBlocksPerPart = 256;
  const int parts = (tsdf_->block_count() + kBlocksPerPart - 1) / kBlocksPerPart;
  ASSERT_GT(parts, 1);
  ASSERT_EQ(fractions.size(), static_cast<std::size_t>(parts));
  EXPECT_TRUE(std::ranges::is_sorted(fractions));
  EXPECT_EQ(fractions.back(), 1.0);
}

TEST_F(ModelFileTest, GivesBackEveryVoxelAndPose) {
  Save();
  ASSERT_TRUE(Read().ok());
  ASSERT_GT(tsdf_->block_count(), 300);  // More than one part of the file.
  ASSERT_EQ(read_tsdf_->block_count(), tsdf_->block_count());
  EXPECT_EQ(read_tsdf_->grid().min_m, tsdf_->grid().min_m);
  for (std::int32_t block = 0; block < tsdf_->block_count(); ++block) {
    const std::int32_t other = read_tsdf_->Find(tsdf_->block_coordinates(block));
    ASSERT_NE(other, TsdfVolume::kNoBlock);
    for (std::size_t i = 0; i < kBlockVoxels; ++i) {
      ASSERT_EQ(read_tsdf_->voxels(other)[i].bits, tsdf_->voxels(block)[i].bits);
      ASSERT_EQ(read_thermal_->voxels(other)[i].bits, thermal_->voxels(block)[i].bits);
    }
  }
  const auto model = ModelFile::Open(Path());
  ASSERT_EQ((*model)->known_poses().size(), poses_.size());
  for (std::size_t i = 0; i < poses_.size(); ++i)
    EXPECT_TRUE((*model)->known_poses()[i].isApprox(poses_[i], 1e-12));
  EXPECT_TRUE((*model)->CheckRig(rig_).ok());
}

/// Rows that hold a bit of everything, in every second block.
void FillRecords(ThermalVolume& thermal, std::int32_t blocks) {
  for (std::int32_t block = 0; block < blocks; block += 2) {
    for (int row = block % 5; row < ThermalRecords::kRowsPerBlock; row += 7) {
      thermal.records()->Row(block, row).conditions[row % 8].direction =
          static_cast<std::uint16_t>(block + row);
      for (int x = 0; x < RecordRow::kVoxels; ++x) {
        thermal.records()->Sigmas(block, row)[x] =
            static_cast<std::uint8_t>(block + 3 * row + 11 * x);
      }
    }
  }
}

TEST_F(ModelFileTest, GivesBackEveryRecordAndUncertainty) {
  FillRecords(*thermal_, tsdf_->block_count());
  Save();
  ASSERT_TRUE(Read().ok());
  int rows = 0;
  for (std::int32_t block = 0; block < tsdf_->block_count(); ++block) {
    const std::int32_t other = read_tsdf_->Find(tsdf_->block_coordinates(block));
    for (int row = 0; row < ThermalRecords::kRowsPerBlock; ++row) {
      const RecordRow* read = std::as_const(*read_thermal_).records()->Find(other, row);
      ASSERT_EQ(read != nullptr, thermal_->records()->Find(block, row) != nullptr);
      if (read == nullptr) continue;
      ++rows;
      EXPECT_EQ(read->conditions[row % 8].direction, block + row);
      for (int x = 0; x < RecordRow::kVoxels; ++x) {
        ASSERT_EQ(read_thermal_->sigma_code(other, row * RecordRow::kVoxels + x),
                  static_cast<std::uint8_t>(block + 3 * row + 11 * x));
      }
    }
  }
  EXPECT_GT(rows, 1000);
}

TEST_F(ModelFileTest, RecordsOfVersion2AreReadAndTheirUncertaintiesAreNotKnown) {
  ThermalVolume written(1), read(1);
  ASSERT_TRUE(written.Commit(1) && read.Commit(1));
  FillRecords(written, 1);
  std::vector<std::uint8_t> bytes = PackRecords(written, 0, 1);
  constexpr std::size_t kMask = sizeof(std::uint64_t);
  const std::size_t rows =
      (bytes.size() - kMask) / (sizeof(RecordRow) + std::size_t{RecordRow::kVoxels});
  EXPECT_FALSE(UnpackRecords(bytes, 0, 1, /*with_sigmas=*/false, read)) << "too long for it";
  bytes.resize(kMask + rows * sizeof(RecordRow));
  EXPECT_FALSE(UnpackRecords(bytes, 0, 1, /*with_sigmas=*/true, read)) << "too short";
  ASSERT_TRUE(UnpackRecords(bytes, 0, 1, /*with_sigmas=*/false, read));
  EXPECT_EQ(read.records()->Find(0, 7)->conditions[7].direction, 7);
  EXPECT_EQ(read.sigma_code(0, 7 * RecordRow::kVoxels), 0);
  // A whole file of that version, as far as it has no records.
  Save();
  std::string file = Bytes();
  file[8] = 2;
  Write(file);
  EXPECT_TRUE(Read().ok());
}

TEST_F(ModelFileTest, AnotherRigOrVoxelSizeIsRefusedByName) {
  Save();
  const auto model = ModelFile::Open(Path());
  ASSERT_TRUE(model.has_value());
  Rig other = rig_;
  other.depth->fx += 1.0;
  const Status rig = (*model)->CheckRig(other);
  EXPECT_EQ(rig.code(), StatusCode::kFailedPrecondition);
  EXPECT_NE(rig.message().find("depth camera"), std::string::npos) << rig.message();
  GroundOptions options;
  options.mutable_volume()->set_voxel_size_m(0.002);
  const Status volume = (*model)->AdoptVolume(options);
  EXPECT_EQ(volume.code(), StatusCode::kFailedPrecondition);
  EXPECT_NE(volume.message().find("volume.voxel_size_m"), std::string::npos) << volume.message();
}

TEST_F(ModelFileTest, AFileCutOffAnywhereIsRefused) {
  Save();
  const std::string whole = Bytes();
  for (std::size_t length = 0; length < whole.size(); length += 1 + length / 7) {
    Write(whole.substr(0, length));
    EXPECT_FALSE(Read().ok()) << length << " of " << whole.size() << " bytes";
  }
  Write(whole.substr(0, whole.size() - 1));
  EXPECT_FALSE(Read().ok());
  Write(whole + "x");
  EXPECT_FALSE(Read().ok());
}

TEST_F(ModelFileTest, DamageAnywhereIsRefused) {
  Save();
  const std::string whole = Bytes();
  std::mt19937_64 random(kSeed);
  for (int i = 0; i < 300; ++i) {
    std::string damaged = whole;
    const std::size_t place = i < 100 ? static_cast<std::size_t>(i) : random() % whole.size();
    damaged[place] = static_cast<char>(damaged[place] ^ static_cast<char>(1U << (random() % 8)));
    Write(damaged);
    const Status status = Read();
    EXPECT_FALSE(status.ok()) << "byte " << place;
    EXPECT_NE(status.message().find("model.iso"), std::string::npos) << status.message();
  }
}

/// The saved file with another head, whose checksum is right.
class ModelHeadTest : public ModelFileTest {
 protected:
  Status ReadWith(const std::function<void(ModelHeader&)>& change) {
    Save();
    const std::string whole = Bytes();
    constexpr std::size_t kHead = 8 + 3 * sizeof(std::uint32_t);
    std::uint32_t bytes = 0;
    std::memcpy(&bytes, whole.data() + 12, sizeof(bytes));
    ModelHeader header;
    EXPECT_TRUE(header.ParseFromString(whole.substr(kHead, bytes)));
    change(header);
    const std::string head = header.SerializeAsString();
    const auto size = static_cast<std::uint32_t>(head.size());
    const auto crc = static_cast<std::uint32_t>(
        crc32(0, reinterpret_cast<const Bytef*>(head.data()), static_cast<uInt>(size)));
    std::string file = whole.substr(0, 12);
    file.append(reinterpret_cast<const char*>(&size), sizeof(size));
    file.append(reinterpret_cast<const char*>(&crc), sizeof(crc));
    Write(file + head + whole.substr(kHead + bytes));
    return Read();
  }
};

TEST_F(ModelHeadTest, F65NumbersThatNoVolumeCanHaveAreRefused) {
  ASSERT_TRUE(ReadWith([](ModelHeader&) {}).ok());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  using Change = std::function<void(ModelHeader&)>;
  std::vector<Change> changes;
  for (const double value : {0.0, -0.016, nan, 1e30, 1e-9, 0.004}) {
    changes.push_back([value](ModelHeader& h) { h.set_truncation_distance_m(value); });
  }
  for (const double value : {0.0, -0.004, nan, 1e30, 1e-9}) {
    changes.push_back([value](ModelHeader& h) { h.set_voxel_size_m(value); });
  }
  for (const double value : {nan, 1e30, -1e30}) {
    changes.push_back([value](ModelHeader& h) { h.set_min_x_m(value); });
    changes.push_back([value](ModelHeader& h) { h.set_min_z_m(value); });
  }
  for (const double value : {0.0, -500.0, nan, 1e-300, 1e300}) {
    changes.push_back([value](ModelHeader& h) { h.mutable_depth()->set_fx(value); });
    changes.push_back([value](ModelHeader& h) { h.mutable_thermal()->set_fy(value); });
  }
  for (const double value : {nan, 1e9}) {
    changes.push_back([value](ModelHeader& h) { h.mutable_depth()->set_cx(value); });
    changes.push_back([value](ModelHeader& h) { h.mutable_thermal()->set_distortion(0, value); });
    changes.push_back([value](ModelHeader& h) { h.set_t_thermal_depth(0, value); });
    changes.push_back([value](ModelHeader& h) { h.set_known_poses(1, value); });
  }
  changes.push_back([](ModelHeader& h) { h.set_blocks_x(0); });
  changes.push_back([](ModelHeader& h) { h.set_blocks_y(-1); });
  changes.push_back([](ModelHeader& h) { h.set_blocks_z(1 << 30); });
  changes.push_back([](ModelHeader& h) { h.set_block_count(-1); });
  changes.push_back([](ModelHeader& h) { h.set_block_count(1 << 30); });
  changes.push_back([](ModelHeader& h) { h.mutable_t_thermal_depth()->RemoveLast(); });
  for (std::size_t i = 0; i < changes.size(); ++i) {
    const Status status = ReadWith(changes[i]);
    EXPECT_EQ(status.code(), StatusCode::kDataLoss) << "change " << i << ": " << status.message();
    EXPECT_NE(status.message().find("model.iso"), std::string::npos) << status.message();
  }
}

TEST_F(ModelFileTest, NoModelIsSaidToBeNone) {
  Write("not a model at all");
  EXPECT_EQ(Read().code(), StatusCode::kInvalidArgument);
  EXPECT_EQ(ModelFile::Open(folder_.path() / "missing.iso").error().code(), StatusCode::kNotFound);
}

}  // namespace
}  // namespace isotherm
