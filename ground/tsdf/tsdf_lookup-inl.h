// What the ray caster reads of the sparse volume: in which block and at which element of it the
// voxel of a position is, what a voxel word says, and the distance interpolated between voxels.
// Included once per instruction set.
#include "common/simd/kernel_prelude-inl.h"

#if defined(ISOTHERM_TSDF_LOOKUP_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ISOTHERM_TSDF_LOOKUP_INL_H_
#undef ISOTHERM_TSDF_LOOKUP_INL_H_
#else
#define ISOTHERM_TSDF_LOOKUP_INL_H_
#endif

#include <cstdint>

#include "ground/surface/block_layout.h"
#include "ground/tsdf/raycast_kernel.h"
#include "ground/tsdf/voxel_layout.h"

HWY_BEFORE_NAMESPACE();
namespace isotherm::HWY_NAMESPACE {

/// tsdf in [-1, 1] from a voxel word.
HWY_INLINE VF DecodeTsdf(VI word) {
  return hn::Mul(hn::ConvertTo(d, hn::ShiftRight<TsdfLayout::kTsdfShift>(word)),
                 hn::Set(d, 1.0F / TsdfLayout::kTsdfScale));
}

HWY_INLINE VI WeightCode(VI word) { return hn::And(word, hn::Set(di, TsdfLayout::kWeightMask)); }

HWY_INLINE MI Observed(const RaycastKernelArgs& a, VI word) {
  return hn::Gt(WeightCode(word), hn::Set(di, a.min_weight_code - 1));
}

/// Whole voxels of a coordinate, kept within the table: lanes that are done, or whose ray misses
/// the volume, may be anywhere.
HWY_INLINE VI ToVoxel(VF coordinate, std::int32_t last) {
  return hn::Min(hn::Max(hn::ConvertTo(di, coordinate), hn::Zero(di)), hn::Set(di, last));
}

HWY_INLINE VI BlockOf(VI voxel) { return hn::ShiftRight<BlockLayout::kSideBits>(voxel); }

HWY_INLINE VI FirstElement(VI block) { return hn::ShiftLeft<BlockLayout::kBlockShift>(block); }

/// Returns what one coordinate of a voxel adds to its element in the block.
HWY_INLINE VI LocalPart(int axis, VI voxel) {
  const VI local = hn::And(voxel, hn::Set(di, BlockLayout::kSideMask));
  return axis == 0   ? local
         : axis == 1 ? hn::ShiftLeft<BlockLayout::kShiftY>(local)
                     : hn::ShiftLeft<BlockLayout::kShiftZ>(local);
}

/// The eight voxels around a point, x fastest.
struct Corners {
  VF tsdf[8];
  VF fraction[3];  ///< Fraction of the way from the lower to the upper ones, along each axis.
  VI min_weight;
};

HWY_INLINE Corners LoadCorners(const RaycastKernelArgs& a, const Vector3& p) {
  const VI one = hn::Set(di, 1);
  // Per axis, for the lower and the upper voxel: fraction of the table index and of the index in
  // the block. Positions on rays are positive, so truncation is the floor.
  VI table_part[3][2], local_part[3][2];
  Corners corners;
  bool crosses[3];
  const VF position[3] = {p.x, p.y, p.z};
  const VI stride[3] = {one, hn::Set(di, a.stride_y), hn::Set(di, a.stride_z)};
  for (int axis = 0; axis < 3; ++axis) {
    const VI lower = ToVoxel(position[axis], a.last[axis] - 1);
    corners.fraction[axis] = hn::Sub(position[axis], hn::ConvertTo(d, lower));
    const VI upper = hn::Add(lower, one);
    const VI lower_block = BlockOf(lower);
    const VI upper_block = BlockOf(upper);
    crosses[axis] = !hn::AllTrue(di, hn::Eq(lower_block, upper_block));
    table_part[axis][0] = axis == 0 ? lower_block : hn::Mul(lower_block, stride[axis]);
    table_part[axis][1] =
        crosses[axis] ? hn::IfThenElse(hn::Eq(lower_block, upper_block), table_part[axis][0],
                                       hn::Add(table_part[axis][0], stride[axis]))
                      : table_part[axis][0];
    local_part[axis][0] = LocalPart(axis, lower);
    local_part[axis][1] = LocalPart(axis, upper);
  }
  VI block[8];
  corners.min_weight = hn::Set(di, TsdfLayout::kWeightMask);
  for (int k = 0; k < 8; ++k) {
    // Where no lane crosses a border of blocks, both corners lie in the same block.
    if ((k & 1) != 0 && !crosses[0]) {
      block[k] = block[k ^ 1];
    } else if ((k & 2) != 0 && !crosses[1]) {
      block[k] = block[k ^ 2];
    } else if ((k & 4) != 0 && !crosses[2]) {
      block[k] = block[k ^ 4];
    } else {
      const VI entry = hn::Add(table_part[0][k & 1],
                               hn::Add(table_part[1][(k >> 1) & 1], table_part[2][k >> 2]));
      block[k] = FirstElement(hn::GatherIndex(di, a.table, entry));
    }
    const VI local =
        hn::Or(local_part[0][k & 1], hn::Or(local_part[1][(k >> 1) & 1], local_part[2][k >> 2]));
    const VI word = hn::GatherIndex(di, a.voxels, hn::Add(block[k], local));
    corners.min_weight = hn::Min(corners.min_weight, WeightCode(word));
    corners.tsdf[k] = DecodeTsdf(word);
  }
  return corners;
}

/// Holds the distance at one point per lane.
struct Interpolated {
  VF value;
  Vector3 gradient;  ///< Per voxel.
  MF valid;          ///< All eight voxels around were observed.
};

/// Trilinear interpolation of the distance and its gradient within the cell.
HWY_INLINE Interpolated Interpolate(const RaycastKernelArgs& a, const Vector3& p) {
  const Corners corners = LoadCorners(a, p);
  const VF* const corner = corners.tsdf;
  const VF* const fraction = corners.fraction;
  const auto lerp = [](VF from, VF to, VF f) { return hn::MulAdd(f, hn::Sub(to, from), from); };
  const VF x00 = lerp(corner[0], corner[1], fraction[0]);
  const VF x10 = lerp(corner[2], corner[3], fraction[0]);
  const VF x01 = lerp(corner[4], corner[5], fraction[0]);
  const VF x11 = lerp(corner[6], corner[7], fraction[0]);
  const VF near = lerp(x00, x10, fraction[1]);
  const VF far = lerp(x01, x11, fraction[1]);
  Interpolated result;
  result.value = lerp(near, far, fraction[2]);
  result.gradient.x = lerp(
      lerp(hn::Sub(corner[1], corner[0]), hn::Sub(corner[3], corner[2]), fraction[1]),
      lerp(hn::Sub(corner[5], corner[4]), hn::Sub(corner[7], corner[6]), fraction[1]), fraction[2]);
  result.gradient.y = lerp(hn::Sub(x10, x00), hn::Sub(x11, x01), fraction[2]);
  result.gradient.z = hn::Sub(far, near);
  result.valid = hn::RebindMask(d, hn::Gt(corners.min_weight, hn::Set(di, a.min_weight_code - 1)));
  return result;
}

}  // namespace isotherm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // ISOTHERM_TSDF_LOOKUP_INL_H_
