#pragma once

namespace isotherm {

/// Blocks have 8 x 8 x 8 voxels, x fastest: voxel (x, y, z) of a block is element x + 8 (y + 8 z).
inline constexpr int kBlockSide = 8;
inline constexpr int kBlockVoxels = kBlockSide * kBlockSide * kBlockSide;

/// A voxel takes 32 bits for distance and weight, and 32 for its temperature.
inline constexpr int kBytesPerVoxel = 8;

/// The same in bits, for volumes and kernels: a voxel coordinate is the block's coordinate above
/// kSideBits bits of the place in the block, and an element is z y x of such bits.
struct BlockLayout {
  static constexpr int kSideBits = 3;
  static constexpr int kSideMask = kBlockSide - 1;
  static constexpr int kShiftY = kSideBits;
  static constexpr int kShiftZ = 2 * kSideBits;
  static constexpr int kBlockShift = 3 * kSideBits;  ///< From block to its first element.
  static constexpr int kLayerVoxels = kBlockSide * kBlockSide;  ///< Voxels of the same z.

  /// The element of a voxel with these coordinates, whichever block it is in.
  static constexpr int Element(int x, int y, int z) {
    return (x & kSideMask) | (y & kSideMask) << kShiftY | (z & kSideMask) << kShiftZ;
  }
  static constexpr int X(int element) { return element & kSideMask; }
  static constexpr int Y(int element) { return element >> kShiftY & kSideMask; }
  static constexpr int Z(int element) { return element >> kShiftZ & kSideMask; }
};
static_assert(1 << BlockLayout::kSideBits == kBlockSide);
static_assert(1 << BlockLayout::kBlockShift == kBlockVoxels);
static_assert(BlockLayout::Element(1, 2, 3) == 1 + kBlockSide * (2 + kBlockSide * 3));
static_assert(BlockLayout::Element(-1, 8, 15) == BlockLayout::Element(7, 0, 7));
static_assert(BlockLayout::X(BlockLayout::Element(1, 2, 3)) == 1 &&
              BlockLayout::Y(BlockLayout::Element(1, 2, 3)) == 2 &&
              BlockLayout::Z(BlockLayout::Element(1, 2, 3)) == 3);

}  // namespace isotherm
