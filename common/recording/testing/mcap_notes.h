#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "common/recording/mcap_file_index.h"
#include "common/recording/mcap_message_stream.h"
#include "common/recording/mcap_writer.h"
#include "common/recording/testing/memory_stream.h"

/// Small MCAP files of messages that can be recognised.
namespace isotherm::mcap {

/// Holds what a message is recognised by.
struct Note {
  std::uint64_t log_time = 0;
  std::uint32_t number = 0;
  bool operator==(const Note&) const = default;
};

inline Bytes ToBytes(std::uint32_t number) {
  Bytes bytes(20, static_cast<std::uint8_t>(number));
  std::memcpy(bytes.data(), &number, sizeof(number));
  return bytes;
}

/// Writes such files to a disk in memory, and reads them back.
class McapTest : public ::testing::Test {
 protected:
  std::unique_ptr<Writer> MakeWriter(std::uint64_t chunk_duration_ns = 100) {
    auto writer = Writer::Create(
        std::make_unique<MemorySink>(disk_),
        {.library = "test", .chunk_bytes = 1 << 20, .chunk_duration_ns = chunk_duration_ns});
    EXPECT_TRUE(writer);
    const SchemaId schema = (*writer)->AddSchema("Note", "protobuf", "not really");
    channel_ = (*writer)->AddChannel(schema, "/note", "protobuf");
    return std::move(*writer);
  }

  /// Returns the beginning of a file.
  static Bytes Beginning() {
    Bytes bytes(kMagic.begin(), kMagic.end());
    Append(Header{}, bytes);
    return bytes;
  }
  /// Returns what stands before `records` in a chunk that is not compressed.
  static ChunkHeader HeaderOf(const Bytes& records) {
    ChunkHeader header;
    header.uncompressed_size = header.compressed_size = records.size();
    return header;
  }

  /// One message per time; those that share a chunk are at most 100 ns apart.
  void WriteFile(const std::vector<std::uint64_t>& times, bool close = true) {
    auto writer = MakeWriter();
    for (std::uint32_t i = 0; i < times.size(); ++i) {
      ASSERT_TRUE(writer->WriteMessage(channel_, times[i], times[i], ToBytes(i)).ok());
    }
    ASSERT_TRUE(writer->WriteMetadata({.name = "extra", .values = {{"a", "b"}}}).ok());
    ASSERT_TRUE(writer->Flush().ok());
    if (!close) unfinished_ = disk_->bytes;
    ASSERT_TRUE(writer->Close().ok());
  }

  /// Holds everything that a reader finds in a file.
  struct Contents {
    FileIndex index;
    std::vector<Note> notes;
    std::vector<Status> errors;
  };

  /// nullopt if the file cannot be opened.
  static std::optional<Contents> Read(const Bytes& bytes, std::size_t cache_bytes = 1 << 20) {
    const MemorySource source(bytes);
    Result<FileIndex> index = ReadFileIndex(source);
    if (!index) return std::nullopt;
    Contents contents{.index = std::move(*index), .notes = {}, .errors = {}};
    MessageStream stream(source, contents.index, cache_bytes);
    while (true) {
      auto message = stream.Next();
      if (!message) {
        contents.errors.push_back(message.error());
        continue;
      }
      if (!*message) return contents;
      std::uint32_t number = 0;
      if ((*message)->data.size() >= sizeof(number)) {
        std::memcpy(&number, (*message)->data.data(), sizeof(number));
      }
      contents.notes.push_back({(*message)->log_time, number});
    }
  }

  std::shared_ptr<MemorySink::Disk> disk_ = std::make_shared<MemorySink::Disk>();
  Bytes unfinished_;
  ChannelId channel_ = 0;
};

}  // namespace isotherm::mcap
