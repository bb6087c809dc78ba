#include "ground/model/model_file.h"

#include <fmt/format.h>
#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <string>
#include <utility>

#include "common/base/output_file.h"
#include "common/recording/byte_stream.h"
#include "ground/model/model.pb.h"
#include "ground/model/record_part.h"
#include "ground/model/saved_rig.h"
#include "ground/tsdf/tsdf_integrator.h"

namespace isotherm {
namespace {

static_assert(std::endian::native == std::endian::little, "files are little-endian");

constexpr std::string_view kMagic = "ISOMODEL";
constexpr std::string_view kEnd = "LEDOMOSI";
/// There is no version 3: one wrong bit would make it a file of version 2.
constexpr std::uint32_t kVersion = 4;
constexpr std::uint32_t kOldestVersion = 1;
constexpr std::uint32_t kFirstWithRecords = 2;
constexpr std::uint32_t kFirstWithSigmas = 4;
// Known poses are 100 bytes each, so that even 100 000 of them stay below this; a damaged length
// does not.
constexpr std::uint32_t kMaxHeaderBytes = 1 << 24;
// 1 MB of voxels a part: damage costs the file, but memory for packing stays small, and progress
// can be told.
constexpr int kBlocksPerChunk = 256;
// zstd's fastest level. Higher ones: smaller files, and a scan that waits longer for them. Not
// tuned.
constexpr int kCompression = 1;

/// Coordinates, distances and temperatures of one block.
constexpr std::size_t kCoordinateBytes = 3 * sizeof(std::int32_t);
constexpr std::size_t kVoxelBytes = kBlockVoxels * sizeof(std::uint32_t);
constexpr std::size_t kBlockBytes = kCoordinateBytes + 2 * kVoxelBytes;

struct ChunkHead {
  std::uint32_t blocks;
  std::uint32_t bytes;  ///< Compressed.
  std::uint32_t crc;    ///< Checksum of the compressed bytes.
};

std::uint32_t Crc(std::span<const std::uint8_t> bytes) {
  return static_cast<std::uint32_t>(crc32_z(crc32_z(0, nullptr, 0), bytes.data(), bytes.size()));
}

std::string_view AsText(std::span<const std::uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

template <typename T>
std::string_view BytesOf(const T& value) {
  return {reinterpret_cast<const char*>(&value), sizeof(value)};
}

/// The block's bytes beside those of the others of its chunk.
void PackBlock(const TsdfVolume& tsdf, const ThermalVolume& thermal, std::int32_t block,
               std::uint8_t* out) {
  std::memcpy(out, tsdf.block_coordinates(block).data(), kCoordinateBytes);
  std::memcpy(out + kCoordinateBytes, tsdf.voxels(block).data(), kVoxelBytes);
  std::memcpy(out + kCoordinateBytes + kVoxelBytes, thermal.voxels(block).data(), kVoxelBytes);
}

}  // namespace

Status SaveModel(const std::filesystem::path& path, const TsdfVolume& tsdf,
                 const ThermalVolume& thermal, const Rig& rig,
                 std::span<const RigidTransform> known_poses,
                 const std::function<void(double fraction)>& progress) {
  const VoxelGrid& grid = tsdf.grid();
  ModelHeader header;
  header.set_software("Isotherm");
  header.set_min_x_m(grid.min_m.x());
  header.set_min_y_m(grid.min_m.y());
  header.set_min_z_m(grid.min_m.z());
  header.set_voxel_size_m(grid.voxel_size_m);
  header.set_blocks_x(grid.blocks.x());
  header.set_blocks_y(grid.blocks.y());
  header.set_blocks_z(grid.blocks.z());
  header.set_truncation_distance_m(tsdf.truncation_distance_m());
  header.set_block_count(tsdf.block_count());
  if (rig.depth) *header.mutable_depth() = ToSaved(*rig.depth);
  if (rig.thermal) *header.mutable_thermal() = ToSaved(*rig.thermal);
  if (rig.T_thermal_depth) AddPose(*rig.T_thermal_depth, header.mutable_t_thermal_depth());
  for (const RigidTransform& pose : known_poses) AddPose(pose, header.mutable_known_poses());
  const std::string head = header.SerializeAsString();

  OutputFile file(path);
  file.Write(kMagic);
  file.Write(BytesOf(kVersion));
  file.Write(BytesOf(static_cast<std::uint32_t>(head.size())));
  file.Write(BytesOf(Crc({reinterpret_cast<const std::uint8_t*>(head.data()), head.size()})));
  file.Write(head);
  std::vector<std::uint8_t> plain, packed;
  for (std::int32_t first = 0; first < tsdf.block_count(); first += kBlocksPerChunk) {
    const std::int32_t end = std::min(tsdf.block_count(), first + kBlocksPerChunk);
    plain.resize(static_cast<std::size_t>(end - first) * kBlockBytes);
    for (std::int32_t block = first; block < end; ++block) {
      PackBlock(tsdf, thermal, block,
                plain.data() + static_cast<std::size_t>(block - first) * kBlockBytes);
    }
    for (const bool records : {false, true}) {
      if (records) plain = PackRecords(thermal, first, end);
      packed.resize(ZSTD_compressBound(plain.size()));
      const std::size_t bytes =
          ZSTD_compress(packed.data(), packed.size(), plain.data(), plain.size(), kCompression);
      if (ZSTD_isError(bytes) != 0)
        return Internal(path.string() + ": compression failed: " + ZSTD_getErrorName(bytes));
      packed.resize(bytes);
      file.Write(BytesOf(ChunkHead{static_cast<std::uint32_t>(end - first),
                                   static_cast<std::uint32_t>(bytes), Crc(packed)}));
      file.Write(AsText(packed));
    }
    if (progress) progress(static_cast<double>(end) / tsdf.block_count());
  }
  file.Write(kEnd);
  return file.Commit();
}

struct ModelFile::Content {
  std::string name;
  std::unique_ptr<ByteSource> source;
  ModelHeader header;
  Rig rig;
  std::vector<RigidTransform> known_poses;
  std::uint64_t first_chunk = 0;
  std::uint32_t version = kVersion;

  Status Damaged(std::string_view what) const {
    return DataLoss(fmt::format("{}: the model file is damaged: {}", name, what));
  }
  /// The next bytes, or that the file ends before them.
  Status Read(std::uint64_t& offset, std::span<std::uint8_t> bytes) const {
    if (bytes.size() > source->size() - offset) return Damaged("it ends too early");
    if (Status status = source->Read(offset, bytes); !status.ok()) return status;
    offset += bytes.size();
    return OkStatus();
  }
  template <typename T>
  Status ReadValue(std::uint64_t& offset, T& value) const {
    return Read(offset, {reinterpret_cast<std::uint8_t*>(&value), sizeof(value)});
  }

  /// Reads and unpacks one part of at most `max_blocks` blocks and `max_bytes` bytes.
  Status ReadPart(std::uint64_t& offset, std::uint32_t max_blocks, std::size_t max_bytes,
                  std::uint32_t& blocks, std::vector<std::uint8_t>& plain) const;
  Status ReadHead();
  Status CheckHead();
  Status CheckVolume() const;
};

Status ModelFile::Content::ReadPart(std::uint64_t& offset, std::uint32_t max_blocks,
                                    std::size_t max_bytes, std::uint32_t& blocks,
                                    std::vector<std::uint8_t>& plain) const {
  ChunkHead head{};
  if (Status status = ReadValue(offset, head); !status.ok()) return status;
  if (head.blocks == 0 || head.blocks > kBlocksPerChunk || head.blocks > max_blocks ||
      head.bytes > ZSTD_compressBound(max_bytes)) {
    return Damaged("a part has an impossible size");
  }
  std::vector<std::uint8_t> packed(head.bytes);
  if (Status status = Read(offset, packed); !status.ok()) return status;
  // Before it is unpacked: zstd detects damage less surely.
  if (Crc(packed) != head.crc) return Damaged("a part has a wrong checksum");
  const unsigned long long bytes = ZSTD_getFrameContentSize(packed.data(), packed.size());
  if (bytes > max_bytes) return Damaged("a part has an impossible size");
  plain.resize(bytes);
  if (ZSTD_decompress(plain.data(), plain.size(), packed.data(), packed.size()) != plain.size())
    return Damaged("a part cannot be unpacked");
  blocks = head.blocks;
  return OkStatus();
}

Status ModelFile::Content::ReadHead() {
  std::uint64_t offset = 0;
  std::array<std::uint8_t, kMagic.size()> magic{};
  if (Status status = Read(offset, magic); !status.ok() || AsText(magic) != kMagic)
    return InvalidArgument(name + ": not an Isotherm model (model.iso)");
  std::uint32_t bytes = 0, crc = 0;
  for (std::uint32_t* value : {&version, &bytes, &crc}) {
    if (Status status = ReadValue(offset, *value); !status.ok()) return status;
  }
  if (version < kOldestVersion || version > kVersion) {
    return InvalidArgument(fmt::format("{}: model format {}, this program reads {} to {}", name,
                                       version, kOldestVersion, kVersion));
  }
  if (bytes > kMaxHeaderBytes) return Damaged("its head has an impossible size");
  std::vector<std::uint8_t> head(bytes);
  if (Status status = Read(offset, head); !status.ok()) return status;
  if (Crc(head) != crc || !header.ParseFromArray(head.data(), static_cast<int>(head.size())))
    return Damaged("its head has a wrong checksum");
  first_chunk = offset;
  return CheckHead();
}

/// As the options of a volume are checked, which these numbers become.
Status ModelFile::Content::CheckVolume() const {
  // Three of these multiply to 2^60, so the product below cannot overflow.
  constexpr std::int64_t kMaxBlocksAlongAxis = 1 << 20;
  std::int64_t blocks = 1;
  for (const std::int32_t along : {header.blocks_x(), header.blocks_y(), header.blocks_z()}) {
    if (along < 1 || along > kMaxBlocksAlongAxis)
      return Damaged(fmt::format("it has {} blocks along an axis", along));
    blocks *= along;
  }
  if (header.block_count() < 0 || header.block_count() > blocks)
    return Damaged(fmt::format("it has {} blocks in a volume of {}", header.block_count(), blocks));
  VolumeOptions volume;
  volume.set_voxel_size_m(header.voxel_size_m());
  volume.set_size_x_m(
      header.voxel_size_m());  // Whether all of it fits into memory is not asked here.
  volume.set_size_y_m(header.voxel_size_m());
  volume.set_size_z_m(header.voxel_size_m());
  TsdfOptions tsdf;
  tsdf.mutable_expert()->set_truncation_distance_m(header.truncation_distance_m());
  if (header.truncation_distance_m() == 0.0) return Damaged("its truncation distance is 0 m");
  for (const Status& status : {Validate(volume), Validate(tsdf, volume)}) {
    if (!status.ok()) return Damaged("its volume makes no sense: " + status.message());
  }
  for (const double corner : {header.min_x_m(), header.min_y_m(), header.min_z_m()}) {
    if (!(std::abs(corner) <= kMaxCoordinate_m))
      return Damaged(fmt::format("a corner of its volume lies at {} m", corner));
  }
  return OkStatus();
}

Status ModelFile::Content::CheckHead() {
  if (Status status = CheckVolume(); !status.ok()) return status;
  if (header.known_poses_size() % kPoseNumbers != 0) return Damaged("its head makes no sense");
  rig.depth = FromSaved(header.depth());
  rig.thermal = FromSaved(header.thermal());
  if (header.t_thermal_depth_size() > 0) {
    if (header.t_thermal_depth_size() == kPoseNumbers)
      rig.T_thermal_depth = PoseAt(header.t_thermal_depth(), 0);
    if (!rig.T_thermal_depth) return Damaged("its T_thermal_depth is no pose");
  }
  if (Status status = Validate(rig); !status.ok())
    return Damaged("its calibration makes no sense: " + status.message());
  for (int i = 0; i < header.known_poses_size(); i += kPoseNumbers) {
    const auto pose = PoseAt(header.known_poses(), i);
    if (!pose) return Damaged("a pose in it is none");
    known_poses.push_back(*pose);
  }
  return OkStatus();
}

ModelFile::ModelFile(std::unique_ptr<Content> content) : content_(std::move(content)) {}
ModelFile::~ModelFile() = default;

Result<std::unique_ptr<ModelFile>> ModelFile::Open(const std::filesystem::path& path) {
  Result<std::unique_ptr<ByteSource>> source = OpenFileSource(path);
  if (!source) return Err(source.error());
  auto content = std::make_unique<Content>();
  content->name = path.string();
  content->source = std::move(*source);
  if (Status status = content->ReadHead(); !status.ok()) return Err(status);
  return std::unique_ptr<ModelFile>(new ModelFile(std::move(content)));
}

Rig ModelFile::rig() const { return content_->rig; }

const std::vector<RigidTransform>& ModelFile::known_poses() const { return content_->known_poses; }

std::int32_t ModelFile::block_count() const { return content_->header.block_count(); }

Status ModelFile::AdoptVolume(GroundOptions& options) const {
  const ModelHeader& header = content_->header;
  VolumeOptions& volume = *options.mutable_volume();
  TsdfOptions& tsdf = *options.mutable_tsdf();
  const auto differs = [](double a, double b) { return std::abs(a - b) > 1e-9; };
  const auto refuse = [&](const char* option, double set, double has) {
    return FailedPrecondition(fmt::format(
        "{}: the model was made with {} = {} m, and {} m was asked for: leave the option "
        "out to go on with the model",
        content_->name, option, has, set));
  };
  if (volume.has_voxel_size_m() && differs(volume.voxel_size_m(), header.voxel_size_m()))
    return refuse("volume.voxel_size_m", volume.voxel_size_m(), header.voxel_size_m());
  const double truncation_m = tsdf.expert().truncation_distance_m();
  if (truncation_m != 0.0 && differs(truncation_m, header.truncation_distance_m())) {
    return refuse("tsdf.expert.truncation_distance_m", truncation_m,
                  header.truncation_distance_m());
  }
  const double block_m = header.voxel_size_m() * kBlockSide;
  volume.set_voxel_size_m(header.voxel_size_m());
  volume.set_size_x_m(header.blocks_x() * block_m);
  volume.set_size_y_m(header.blocks_y() * block_m);
  volume.set_size_z_m(header.blocks_z() * block_m);
  volume.mutable_expert()->set_min_x_m(header.min_x_m());
  volume.mutable_expert()->set_min_y_m(header.min_y_m());
  volume.mutable_expert()->set_min_z_m(header.min_z_m());
  tsdf.mutable_expert()->set_truncation_distance_m(header.truncation_distance_m());
  return OkStatus();
}

Status ModelFile::CheckRig(const Rig& rig) const {
  for (const std::string& difference :
       {Difference("depth", content_->header.depth(), rig.depth),
        Difference("thermal", content_->header.thermal(), rig.thermal)}) {
    if (!difference.empty()) {
      return FailedPrecondition(
          fmt::format("{}: the model was made with another rig: the recording's: {}",
                      content_->name, difference));
    }
  }
  return OkStatus();
}

Status ModelFile::ReadBlocks(TsdfVolume& tsdf, ThermalVolume& thermal) const {
  const Content& content = *content_;
  std::uint64_t offset = content.first_chunk;
  std::vector<std::uint8_t> plain;
  while (tsdf.block_count() < content.header.block_count()) {
    const auto missing =
        static_cast<std::uint32_t>(content.header.block_count() - tsdf.block_count());
    std::uint32_t blocks = 0;
    if (Status status =
            content.ReadPart(offset, missing, kBlocksPerChunk * kBlockBytes, blocks, plain);
        !status.ok())
      return status;
    if (plain.size() != blocks * kBlockBytes) return content.Damaged("a part has a wrong size");
    const std::int32_t first = tsdf.block_count();
    for (std::uint32_t i = 0; i < blocks; ++i) {
      const std::uint8_t* in = plain.data() + i * kBlockBytes;
      GridIndex coordinates;
      std::memcpy(coordinates.data(), in, kCoordinateBytes);
      // A file is data from elsewhere: its coordinates must not write outside the volume, nor twice
      // to one block.
      if (!tsdf.InGrid(coordinates) || tsdf.Find(coordinates) != TsdfVolume::kNoBlock)
        return content.Damaged("a block lies outside the volume, or twice in it");
      const std::int32_t block = tsdf.FindOrAllocate(coordinates);
      if (block == TsdfVolume::kNoBlock) {
        return ResourceExhausted(content.name +
                                 ": the model needs more than volume.expert.max_memory_bytes");
      }
      std::memcpy(tsdf.voxels(block).data(), in + kCoordinateBytes, kVoxelBytes);
      std::memcpy(thermal.voxels(block).data(), in + kCoordinateBytes + kVoxelBytes, kVoxelBytes);
      const auto voxels = tsdf.voxels(block);
      // Not stored: it follows from the voxels.
      tsdf.set_may_end_rays(block, std::any_of(voxels.begin(), voxels.end(), [](TsdfVoxel v) {
                              return v.observed() && v.tsdf() <= 0.0F;
                            }));
    }
    if (content.version < kFirstWithRecords) continue;
    std::uint32_t with_records = 0;
    if (Status status = content.ReadPart(offset, blocks, kBlocksPerChunk * kMaxRecordBytes,
                                         with_records, plain);
        !status.ok())
      return status;
    if (with_records != blocks ||
        !UnpackRecords(plain, first, first + static_cast<std::int32_t>(blocks),
                       content.version >= kFirstWithSigmas, thermal))
      return content.Damaged("the records of a part make no sense");
  }
  std::array<std::uint8_t, kEnd.size()> end{};
  if (Status status = content.Read(offset, end); !status.ok()) return status;
  if (AsText(end) != kEnd || offset != content.source->size())
    return content.Damaged("it does not end where it should");
  return OkStatus();
}

}  // namespace isotherm
