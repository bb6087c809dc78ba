#include "common/pieces/frame_assembler.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "common/pieces/cut_frame.h"

namespace isotherm {
namespace {

Bytes RandomFrame(std::size_t size, std::mt19937* random) {
  Bytes frame(size);
  std::ranges::generate(frame, [&] { return static_cast<std::uint8_t>((*random)()); });
  return frame;
}

std::vector<FramePiece> Cut(const Bytes& frame, int parity, std::uint64_t number = 0) {
  std::vector<FramePiece> pieces = CutFrame(frame, [&](int) { return parity; });
  for (FramePiece& piece : pieces) piece.frame_number = number;
  return pieces;
}

std::optional<Bytes> AddAll(std::vector<FramePiece> pieces, FrameAssembler* assembler) {
  std::optional<Bytes> frame;
  for (FramePiece& piece : pieces) {
    auto whole = assembler->Add(std::move(piece));
    EXPECT_FALSE(whole && frame) << "twice";
    if (whole) frame = std::move(whole);
  }
  return frame;
}

TEST(FrameAssemblerTest, AnyFrameIsThereAgainWithoutLoss) {
  std::mt19937 random(1);
  for (const std::size_t size :
       {1UL, 255UL, 256UL, 1200UL, 1201UL, 80'000UL, 153'600UL, 153'601UL, 700'001UL}) {
    FrameAssembler assembler;
    const Bytes frame = RandomFrame(size, &random);
    std::vector<FramePiece> pieces = Cut(frame, 0);
    for (const FramePiece& piece : pieces) {
      EXPECT_LE(piece.bytes.size(), kMaxFramePieceBytes);
      EXPECT_GE(piece.bytes.size(), kMinFramePieceBytes);
    }
    EXPECT_EQ(AddAll(pieces, &assembler), frame) << size;
    std::ranges::shuffle(pieces, random);
    EXPECT_EQ(AddAll(pieces, &assembler), std::nullopt) << "late pieces are nothing new";
    EXPECT_EQ(assembler.frames(), 1U);
  }
}

TEST(FrameAssemblerTest, AsManyLossesAsThereIsParityInEachBlock) {
  std::mt19937 random(2);
  const Bytes frame = RandomFrame(400'000, &random);  // 334 pieces, three blocks.
  for (int attempt = 0; attempt < 20; ++attempt) {
    std::vector<FramePiece> pieces = Cut(frame, 9);
    // Neighbours are in different blocks: a burst of 27 costs each block nine.
    const auto begin =
        pieces.begin() + static_cast<std::ptrdiff_t>(random() % (pieces.size() - 27));
    pieces.erase(begin, begin + 27);
    FrameAssembler assembler;
    EXPECT_EQ(AddAll(pieces, &assembler), frame);
    pieces.erase(pieces.begin());
    FrameAssembler another;
    EXPECT_EQ(AddAll(pieces, &another), std::nullopt) << "one too many";
  }
}

TEST(FrameAssemblerTest, PiecesThatContradictOthersAreLeftOut) {
  std::mt19937 random(3);
  const Bytes frame = RandomFrame(5'000, &random);
  std::vector<FramePiece> pieces = Cut(frame, 2);
  FrameAssembler assembler;
  ASSERT_FALSE(assembler.Add(FramePiece(pieces[0])));
  FramePiece other = pieces[1];
  other.frame_crc ^= 1;
  EXPECT_FALSE(assembler.Add(FramePiece(other)));
  other = pieces[1];
  other.bytes.push_back(0);
  EXPECT_FALSE(assembler.Add(FramePiece(other)));
  other = pieces[1];
  other.frame_bytes += 1;
  EXPECT_FALSE(assembler.Add(FramePiece(other)));
  other = pieces[1];
  other.index = 1'000'000;
  EXPECT_FALSE(assembler.Add(FramePiece(other)));
  EXPECT_EQ(AddAll(pieces, &assembler), frame);
}

TEST(FrameAssemblerTest, AFrameThatIsAnotherThanItsChecksumSaysIsBroken) {
  std::mt19937 random(4);
  std::vector<FramePiece> pieces = Cut(RandomFrame(5'000, &random), 0);
  pieces[2].bytes[7] ^= 1;
  FrameAssembler assembler;
  EXPECT_EQ(AddAll(pieces, &assembler), std::nullopt);
  EXPECT_EQ(assembler.broken(), 1U);
}

TEST(FrameAssemblerTest, WhatIsNeverWholeIsGivenUpWhenNewerOnesHaveBegun) {
  std::mt19937 random(5);
  FrameAssembler assembler;
  const Bytes frame = RandomFrame(3'000, &random);
  constexpr std::uint64_t kFrames = 200;
  for (std::uint64_t number = 0; number < kFrames; ++number) {
    std::vector<FramePiece> pieces = Cut(frame, 0, number);
    pieces.pop_back();
    EXPECT_EQ(AddAll(pieces, &assembler), std::nullopt);
  }
  EXPECT_EQ(assembler.broken(), kFrames - FrameAssembler::kMaxOpen);
  EXPECT_EQ(AddAll(Cut(frame, 0, kFrames - 1), &assembler), frame) << "the newest is still open";
  EXPECT_EQ(AddAll(Cut(frame, 0, 0), &assembler), std::nullopt) << "this one was given up";
}

TEST(FrameAssemblerTest, LargeFramesThatAreNeverWholeDoNotFillTheMemory) {
  FrameAssembler assembler;
  const Bytes frame(kMaxPiecedFrameBytes);
  for (std::uint64_t number = 0; number < 8; ++number) {
    std::vector<FramePiece> pieces = Cut(frame, 0, number);
    pieces.pop_back();
    EXPECT_EQ(AddAll(std::move(pieces), &assembler), std::nullopt);
    EXPECT_LE(assembler.kept_bytes(), FrameAssembler::kMaxBytes);
  }
  EXPECT_GT(assembler.kept_bytes(), FrameAssembler::kMaxBytes / 2);
  EXPECT_GE(assembler.broken(), 4U);
}

TEST(FrameAssemblerTest, WhatAnybodyMaySendIsNoFrame) {
  std::mt19937 random(6);
  FrameAssembler assembler;
  for (int i = 0; i < 100'000; ++i) {
    FramePiece piece{.session = random() % 3,
                     .sensor = static_cast<Sensor>(random() % 2),
                     .frame_number = random() % 40,
                     .frame_bytes = static_cast<std::uint32_t>(random()),
                     .frame_crc = 0,
                     .index = static_cast<std::uint32_t>(random() >> random() % 32),
                     .bytes = Bytes(random() % 1'300)};
    if (i % 2 == 0) piece.frame_bytes >>= 8;
    EXPECT_EQ(assembler.Add(std::move(piece)), std::nullopt);
  }
}

}  // namespace
}  // namespace isotherm
