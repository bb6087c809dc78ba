// Small files that ask for much: what the tool takes to refuse or read them, measured from outside.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zstd.h>

#include <fstream>
#include <functional>

#include "common/recording/mcap_records.h"
#include "common/testing/temporary_directory.h"
#include "tests/system/measured_run.h"

namespace isotherm::system_test {
namespace {

using mcap::Bytes;

Bytes StartOfFile() {
  Bytes file(mcap::kMagic.begin(), mcap::kMagic.end());
  mcap::Append(mcap::Header{.profile = "", .library = ""}, file);
  return file;
}

void AppendChunk(const Bytes& records, std::uint64_t start, std::uint64_t end, Bytes& file) {
  Bytes packed(ZSTD_compressBound(records.size()));
  packed.resize(ZSTD_compress(packed.data(), packed.size(), records.data(), records.size(), 1));
  mcap::Append(mcap::ChunkHeader{.start = start,
                                 .end = end,
                                 .uncompressed_size = records.size(),
                                 .uncompressed_crc = mcap::Crc32(records),
                                 .compression = "zstd",
                                 .compressed_size = packed.size()},
               packed, file);
}

void AppendDepthChannel(Bytes& records) {
  mcap::Append(
      mcap::Schema{.id = 1, .name = "foxglove.CompressedImage", .encoding = "protobuf", .data = ""},
      records);
  mcap::Append(mcap::Channel{.id = 1,
                             .schema_id = 1,
                             .topic = "/depth",
                             .message_encoding = "protobuf",
                             .metadata = {}},
               records);
}

/// Messages at start, start + step, ...: 1 x 1 pixels in a field of the length of `text` (outside).
Bytes Messages(std::size_t count, std::uint64_t start, std::uint64_t step, std::size_t bytes) {
  Bytes records;
  AppendDepthChannel(records);
  const Bytes data(bytes);
  for (std::size_t i = 0; i < count; ++i) {
    mcap::Append(mcap::Message{.channel_id = 1,
                               .sequence = static_cast<std::uint32_t>(i),
                               .log_time = start + step * i,
                               .publish_time = 0,
                               .data = data},
                 records);
  }
  return records;
}

/// The metadata record and an index that lists it `times`.
Bytes MetadataListedOften(std::size_t bytes, int times) {
  Bytes file = StartOfFile();
  const std::uint64_t offset = file.size();
  mcap::Append(mcap::Metadata{.name = "m", .values = {{"k", std::string(bytes, 'x')}}}, file);
  const std::uint64_t length = file.size() - offset;
  mcap::Append(mcap::DataEnd{}, file);
  const std::uint64_t summary = file.size();
  mcap::Statistics statistics;
  statistics.metadata_count = static_cast<std::uint32_t>(times);
  mcap::Append(statistics, file);
  for (int i = 0; i < times; ++i)
    mcap::Append(mcap::MetadataIndex{.offset = offset, .length = length, .name = "m"}, file);
  mcap::Append(mcap::Footer{.summary_start = summary}, file);
  file.insert(file.end(), mcap::kMagic.begin(), mcap::kMagic.end());
  return file;
}

struct Bomb {
  const char* name;
  std::function<Bytes()> make;
};

Bytes OneLargeChunk() {
  Bytes file = StartOfFile();
  AppendChunk(Messages(4, 1, 1, 31U << 20), 1, 4, file);
  return file;
}

Bytes SchemaChunks() {
  Bytes file = StartOfFile();
  for (mcap::SchemaId id = 1; id <= 12; ++id) {
    Bytes records;
    mcap::Append(
        mcap::Schema{.id = id, .name = "s", .encoding = "", .data = std::string(36U << 20, 'x')},
        records);
    AppendChunk(records, id, id, file);
  }
  return file;
}

Bytes OverlappingChunks() {
  Bytes file = StartOfFile();
  for (std::uint64_t i = 0; i < 6; ++i)
    AppendChunk(Messages(1'200'000, i, 1000, 0), i, 1'200'000'000, file);
  return file;
}

Bytes AlternatingChunks() {
  Bytes file = StartOfFile();
  for (std::uint64_t i = 0; i < 2; ++i) AppendChunk(Messages(1000, i, 2, 36'000), i, 2000, file);
  return file;
}

Bytes ManyAlternatingChunks() {
  Bytes file = StartOfFile();
  for (std::uint64_t i = 0; i < 40; ++i) AppendChunk(Messages(1000, i, 40, 2000), i, 40'000, file);
  return file;
}

Bytes ManyFrames() {
  Bytes file = StartOfFile();
  for (std::uint64_t i = 0; i < 100; ++i)
    AppendChunk(Messages(100'000, 100'000 * i, 1, 0), 100'000 * i, 100'000 * (i + 1) - 1, file);
  return file;
}

class BombTest : public ::testing::TestWithParam<Bomb> {
 protected:
  testing::TemporaryDirectory folder_;
};

TEST_P(BombTest, F65TakesNoMoreThanItsSizeJustifies) {
  const std::filesystem::path recording = folder_.path() / "bomb.mcap";
  const Bytes file = GetParam().make();
  std::ofstream(recording, std::ios::binary)
      .write(reinterpret_cast<const char*>(file.data()), static_cast<std::streamsize>(file.size()));
  for (const std::string command : {"inspect", "reconstruct"}) {
    std::vector<std::string> arguments = {command, recording};
    if (command == "reconstruct") {
      arguments.insert(arguments.end(), {"-o", folder_.path() / "results"});
      for (const std::string& option : QuickModel()) arguments.push_back(option);
    }
    const Measured run = RunMeasured(arguments, folder_.path() / "output");
    std::printf("%s: ", GetParam().name);
    ExpectModest(run, command, file.size());
  }
}

INSTANTIATE_TEST_SUITE_P(
    Bombs, BombTest,
    ::testing::Values(
        Bomb{"OneLargeChunk", OneLargeChunk}, Bomb{"SchemaChunks", SchemaChunks},
        Bomb{"OverlappingChunks", OverlappingChunks}, Bomb{"AlternatingChunks", AlternatingChunks},
        Bomb{"ManyAlternatingChunks", ManyAlternatingChunks}, Bomb{"ManyFrames", ManyFrames},
        Bomb{"MetadataListedOften", [] { return MetadataListedOften(1'000'000, 1500); }}),
    [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace isotherm::system_test
