// Depth samples, the search for missing blocks and the update of one block (algorithm 2) in SIMD
// lanes. Compiled once per instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "ground/tsdf/integration_kernel.cc"
#include "common/simd/kernel_prelude-inl.h"  // Before everything else.

#include <cmath>

#include "ground/tsdf/integration_kernel.h"
#include "ground/tsdf/voxel_kernel-inl.h"
#include "ground/tsdf/voxel_layout.h"

HWY_BEFORE_NAMESPACE();
namespace isotherm::HWY_NAMESPACE {

/// Noise reaches this many standard deviations (a generous estimate) behind the surface.
constexpr float kNoiseReach = 1.0F;

/// Fraction of the weight that an observation keeps at the far end of the band, and of the band in
/// which weights fall, at least.
constexpr float kMinCertainty = 0.02F;

/// Weight of an observation: the variance of triangulated depth grows with the fourth power of
/// depth, but far surfaces must still be learnt in a few frames, so that it ends at a quarter (from
/// 0.71 m on).
constexpr float kReferenceDepth = 0.5F;
constexpr float kMinWeight = 0.25F;
/// Without a normal the point lies on an edge, where depth is least certain.
constexpr float kEdgeWeight = 0.125F;

HWY_INLINE RecordVectors PackSamples(VF depth, VF nx, VF ny, VF nz, VF px, VF py, VF weight) {
  const VF scale = hn::Set(d, DepthSample::kNormalScale);
  const VI ix = hn::NearestInt(hn::Mul(nx, scale));
  const VI iy = hn::NearestInt(hn::Mul(ny, scale));
  const VI iz = hn::NearestInt(hn::Mul(nz, scale));
  const VI iw = hn::NearestInt(hn::Mul(weight, hn::Set(d, DepthSample::kWeightScale)));
  const VF scaled_offset =
      hn::MulAdd(hn::ConvertTo(d, ix), px,
                 hn::MulAdd(hn::ConvertTo(d, iy), py, hn::Mul(hn::ConvertTo(d, iz), depth)));
  constexpr int kUpperShift = DepthSample::kUpperShift;
  const VI lower_x = hn::And(ix, hn::Set(di, DepthSample::kLowerMask));
  return {{depth, hn::BitCast(d, hn::Or(hn::ShiftLeft<kUpperShift>(iy), lower_x)),
           hn::BitCast(d, hn::Or(hn::ShiftLeft<kUpperShift>(iz), iw)), scaled_offset}};
}

// Makes the samples of one image row: the plane n . p = offset that each pixel sees, and how much
// it counts,
//   weight = min(1, (0.5 m / depth)^2) cos(angle between normal and ray),
// at least a quarter for the depth; 1/8 without a normal, where the ray stands in for it.
// Rows: depth and normals are planes, one pixel per lane; samples are records of 16 bytes. Fast: no
// branch per pixel, and what IntegrateBlock needs of a pixel lies in one quarter of a cache line.
void MakeSampleRow(const SampleRowArgs& a, DepthSample* samples) {
  const int lanes = static_cast<int>(hn::Lanes(d));
  const VF zero = hn::Zero(d);
  const VF one = hn::Set(d, 1.0F);
  const VF ray_y = hn::Set(d, a.ray_y);
  for (int x = 0; x < a.width; x += lanes) {
    const bool whole = x + lanes <= a.width;
    const auto count = static_cast<std::size_t>(a.width - x);
    const auto load = [&](const float* row) {
      return whole ? hn::LoadU(d, row + x) : LoadFirst(count, row + x);
    };
    const VF depth = load(a.depth_m);
    const MF seen = hn::Gt(depth, zero);
    const VF ray_x = hn::Mul(hn::Sub(hn::Iota(d, static_cast<float>(x)), hn::Set(d, a.cx)),
                             hn::Set(d, 1.0F / a.fx));
    const VF px = hn::Mul(ray_x, depth);
    const VF py = hn::Mul(ray_y, depth);
    // Unit vector from the point to the camera.
    const VF shortening = hn::Div(
        hn::Set(d, -1.0F), hn::Sqrt(hn::MulAdd(ray_x, ray_x, hn::MulAdd(ray_y, ray_y, one))));
    const VF to_camera_x = hn::Mul(ray_x, shortening);
    const VF to_camera_y = hn::Mul(ray_y, shortening);
    const VF nx = load(a.nx);
    const VF ny = load(a.ny);
    const VF nz = load(a.nz);
    const VF cosine =
        hn::MulAdd(nx, to_camera_x, hn::MulAdd(ny, to_camera_y, hn::Mul(nz, shortening)));
    const MF facing = hn::Gt(cosine, zero);  // False for NaN.
    const MF to_plane = a.along_ray ? hn::MaskFromVec(zero) : facing;
    const VF ratio = hn::Div(hn::Set(d, kReferenceDepth), hn::Max(depth, hn::Set(d, 1e-3F)));
    const VF depth_weight = hn::Min(hn::Max(hn::Mul(ratio, ratio), hn::Set(d, kMinWeight)), one);
    const VF weight = hn::Mul(
        depth_weight, hn::IfThenElse(facing, hn::Min(cosine, one), hn::Set(d, kEdgeWeight)));
    StoreRecords(PackSamples(depth, hn::IfThenElse(to_plane, nx, to_camera_x),
                             hn::IfThenElse(to_plane, ny, to_camera_y),
                             hn::IfThenElse(to_plane, nz, shortening), px, py,
                             hn::IfThenElseZero(seen, weight)),
                 count, samples + x);
  }
}

// Finds the blocks that the band of truncation around the surface enters and that do not exist yet:
// for every second pixel, points along the ray at depth - truncation .. depth + truncation, the
// block of each, and whether the table has it.
// Rows: every second pixel of an image row, one per lane; the table is x fastest, with a border of
// one block. Fast: rays are straight in blocks too, so a step is one multiply-add per axis; most
// look-ups find a block, and a vector of them ends there.
std::int32_t FindMissingBlocks(const BandRowArgs& a, std::int32_t* missing) {
  const int lanes = static_cast<int>(hn::Lanes(d));
  const VF zero = hn::Zero(d);
  const VF one = hn::Set(d, 1.0F);
  const VF ray_y = hn::Set(d, a.ray_y);
  const VI zero_i = hn::Zero(di);
  std::int32_t found = 0;
  HWY_ALIGN float depths[hn::MaxLanes(d)];
  for (int x = 0; x < a.width; x += 2 * lanes) {
    const VI column = hn::Add(hn::ShiftLeft<1>(hn::Iota(di, 0)), hn::Set(di, x));
    for (int i = 0; i < lanes; ++i) depths[i] = x + 2 * i < a.width ? a.depth_m[x + 2 * i] : 0.0F;
    const VF depth = hn::Load(d, depths);
    const MF seen = hn::Gt(depth, zero);
    if (hn::AllFalse(d, seen)) continue;
    const VF ray_x =
        hn::Mul(hn::Sub(hn::ConvertTo(d, column), hn::Set(d, a.cx)), hn::Set(d, 1.0F / a.fx));
    // The direction in blocks per metre of depth, and the depth along z of a metre along the ray.
    const auto rotate = [&](int row) {
      return hn::MulAdd(
          hn::Set(d, a.R[3 * row]), ray_x,
          hn::MulAdd(hn::Set(d, a.R[3 * row + 1]), ray_y, hn::Set(d, a.R[3 * row + 2])));
    };
    const VF dx = rotate(0);
    const VF dy = rotate(1);
    const VF dz = rotate(2);
    const VF depth_per_m =
        hn::Div(one, hn::Sqrt(hn::MulAdd(ray_x, ray_x, hn::MulAdd(ray_y, ray_y, one))));
    const VF step =
        hn::Mul(depth_per_m, hn::Set(d, a.truncation_m / static_cast<float>(a.half_steps)));
    for (int i = -a.half_steps; i <= a.half_steps; ++i) {
      const VF z = hn::MulAdd(step, hn::Set(d, static_cast<float>(i)), depth);
      // Truncation is the floor within the volume, whose first block is 1; before it, it is 0.
      const VI bx = hn::ConvertTo(di, hn::MulAdd(dx, z, hn::Set(d, a.t[0])));
      const VI by = hn::ConvertTo(di, hn::MulAdd(dy, z, hn::Set(d, a.t[1])));
      const VI bz = hn::ConvertTo(di, hn::MulAdd(dz, z, hn::Set(d, a.t[2])));
      const auto between = [&](VI b, std::int32_t blocks) {
        return hn::And(hn::Gt(b, zero_i), hn::Lt(b, hn::Set(di, blocks + 1)));
      };
      const auto inside =
          hn::And(hn::RebindMask(di, seen),
                  hn::And(between(bx, a.blocks[0]),
                          hn::And(between(by, a.blocks[1]), between(bz, a.blocks[2]))));
      const VI entry =
          hn::IfThenElseZero(inside, hn::Add(bx, hn::Add(hn::Mul(by, hn::Set(di, a.stride_y)),
                                                         hn::Mul(bz, hn::Set(di, a.stride_z)))));
      const VI block = hn::GatherIndex(di, a.table, entry);
      const auto lacking = hn::And(inside, hn::Lt(block, zero_i));
      if (hn::AllFalse(di, lacking)) continue;
      found += static_cast<std::int32_t>(hn::CompressStore(entry, lacking, di, missing + found));
    }
  }
  return found;
}

/// Holds what IntegrateBlock needs in all lanes.
struct UpdateConstants {
  VF width, height;
  VI row_stride, nowhere;
  VF double_truncation;
  VF to_tsdf;  ///< From a distance in metres times DepthSample::kNormalScale.
  VF noise_reach_at_1m;

  HWY_INLINE explicit UpdateConstants(const IntegrationKernelArgs& a)
      : width(hn::Set(d, static_cast<float>(a.width))),
        height(hn::Set(d, static_cast<float>(a.height))),
        row_stride(hn::Set(di, a.width)),
        nowhere(hn::Set(di, a.width * a.height)),
        double_truncation(hn::Set(d, 2.0F * a.truncation_m)),
        to_tsdf(hn::Set(d, 1.0F / (DepthSample::kNormalScale * a.truncation_m))),
        noise_reach_at_1m(hn::Set(d, kNoiseReach * a.noise_at_1m / a.truncation_m)) {}
};

/// The samples that voxels are seen in; the one behind the last, of weight 0, outside the image.
HWY_INLINE VI SampleOf(const IntegrationKernelArgs& a, const UpdateConstants& c, const Vector3& p) {
  const VF zero = hn::Zero(d);
  const VF inverse_z = Reciprocal(p.z);
  const VF u = hn::MulAdd(hn::Mul(p.x, inverse_z), hn::Set(d, a.fx), hn::Set(d, a.cx + 0.5F));
  const VF v = hn::MulAdd(hn::Mul(p.y, inverse_z), hn::Set(d, a.fy), hn::Set(d, a.cy + 0.5F));
  const MF inside =
      hn::And(hn::And(hn::Gt(p.z, zero), hn::And(hn::Ge(u, zero), hn::Lt(u, c.width))),
              hn::And(hn::Ge(v, zero), hn::Lt(v, c.height)));
  const VI pixel = hn::Add(hn::Mul(hn::ConvertTo(di, v), c.row_stride), hn::ConvertTo(di, u));
  return hn::IfThenElse(hn::RebindMask(di, inside), pixel, c.nowhere);
}

/// Holds what samples say about the voxels that are seen in them.
struct Observation {
  VF depth, weight;
  VF distance;  ///< To the plane over the truncation distance, not truncated.
  MF is_free;   ///< The distance is 1 whatever it says.
  MF good;      ///< Counts at all.
};

HWY_INLINE Observation Observe(const UpdateConstants& c, const RecordVectors& sample,
                               const Vector3& p) {
  constexpr int kUpperShift = DepthSample::kUpperShift;
  Observation o;
  o.depth = sample.word[0];
  const VI normal_xy = hn::BitCast(di, sample.word[1]);
  const VI normal_z_weight = hn::BitCast(di, sample.word[2]);
  const VF scaled_offset = sample.word[3];
  const VI scaled_weight = hn::And(normal_z_weight, hn::Set(di, DepthSample::kLowerMask));
  o.weight = hn::Mul(hn::ConvertTo(d, scaled_weight), hn::Set(d, 1.0F / DepthSample::kWeightScale));
  const VF along_ray = hn::Sub(o.depth, p.z);
  const VF nx =
      hn::ConvertTo(d, hn::ShiftRight<kUpperShift>(hn::ShiftLeft<kUpperShift>(normal_xy)));
  const VF ny = hn::ConvertTo(d, hn::ShiftRight<kUpperShift>(normal_xy));
  const VF nz = hn::ConvertTo(d, hn::ShiftRight<kUpperShift>(normal_z_weight));
  o.distance = hn::Mul(hn::MulAdd(nx, p.x, hn::MulAdd(ny, p.y, hn::MulSub(nz, p.z, scaled_offset))),
                       c.to_tsdf);
  // Far in front along the ray counts as free whatever the plane's tilt; behind the band is
  // unknown.
  o.is_free = hn::Gt(along_ray, c.double_truncation);
  const MF in_band = hn::And(hn::Ge(along_ray, hn::Neg(c.double_truncation)),
                             hn::Ge(o.distance, hn::Set(d, -1.0F)));
  o.good = hn::And(hn::Gt(o.weight, hn::Zero(d)), hn::Or(o.is_free, in_band));
  return o;
}

/// The words after the observation: the running weighted average where it is good.
HWY_INLINE VI Average(const UpdateConstants& c, const Observation& o, float max_weight, VI word) {
  const VF one = hn::Set(d, 1.0F);
  const VF tsdf = hn::IfThenElse(o.is_free, one, hn::Min(one, o.distance));
  // Full weight as far behind the surface as noise reaches; from there to the end of the band
  // less and less, so that what only stood in the shadow of an edge yields to free space seen
  // from elsewhere (Bylow et al., Real-time camera tracking and 3D reconstruction using
  // signed distance functions, 2013).
  const VF noise_reach = hn::Min(hn::Mul(hn::Mul(o.depth, o.depth), c.noise_reach_at_1m), one);
  const VF room = hn::Max(hn::Sub(one, noise_reach), hn::Set(d, kMinCertainty));
  const VF certainty = hn::Max(hn::Set(d, kMinCertainty),
                               hn::Min(one, hn::Mul(hn::Add(one, tsdf), Reciprocal(room))));
  const VF new_weight = hn::Mul(o.weight, certainty);
  const VF old_tsdf = hn::ConvertTo(d, hn::ShiftRight<TsdfLayout::kTsdfShift>(word));
  const VI old_weight_code = hn::And(word, hn::Set(di, TsdfLayout::kWeightMask));
  const VF old_weight =
      hn::Mul(hn::ConvertTo(d, old_weight_code), hn::Set(d, 1.0F / TsdfLayout::kWeightScale));
  const VF total = hn::Add(old_weight, new_weight);
  const VF scaled_tsdf = hn::Mul(tsdf, hn::Set(d, TsdfLayout::kTsdfScale));
  const VF averaged = hn::Mul(hn::MulAdd(old_tsdf, old_weight, hn::Mul(scaled_tsdf, new_weight)),
                              Reciprocal(total));
  const VI tsdf_code = hn::NearestInt(averaged);
  const VI weight_code = hn::NearestInt(
      hn::Mul(hn::Min(total, hn::Set(d, max_weight)), hn::Set(d, TsdfLayout::kWeightScale)));
  // An observation too light to count leaves the voxel as it was.
  const MI counts = hn::And(hn::RebindMask(di, o.good), hn::Gt(weight_code, hn::Zero(di)));
  const VI packed = hn::Or(hn::ShiftLeft<TsdfLayout::kTsdfShift>(tsdf_code), weight_code);
  return hn::IfThenElse(counts, packed, word);
}

// Takes the depth frame into the voxels of a block (algorithm 2). A voxel is seen in the pixel it
// is projected to; its distance is that to the pixel's plane, n . p - offset over the truncation
// distance, cut off at 1 in front, and passed over behind the band. It enters a running average:
//   tsdf <- (W tsdf + w new) / (W + w),   W <- min(W + w, max_weight).
// Rows: lanes are neighbours along x, then y, of one layer of 64 voxels; words are TsdfLayout's,
// samples DepthSample's. Fast: a layer is projected first, so that its look-ups wait for memory
// together; a sample is one 16-byte load; lanes without observation cost no average.
bool IntegrateBlock(const IntegrationKernelArgs& a, const float* first, std::uint32_t* voxels) {
  auto* words = reinterpret_cast<std::int32_t*>(voxels);
  const int lanes = static_cast<int>(hn::Lanes(d));
  constexpr int kLayer = BlockLayout::kLayerVoxels;
  HWY_ALIGN std::int32_t pixels[kLayer];
  const UpdateConstants c(a);
  const BlockPoints points(a.axes, first);
  VI behind = hn::Zero(di);  // Not zero in lanes where an observed voxel has distance <= 0.
  const VI first_positive = hn::Set(di, TsdfLayout::kFirstPositive);
  for (int layer = 0; layer < kBlockSide; ++layer, words += kLayer) {
    const Vector3 origin = points.Origin(layer);
    for (int i = 0; i < kLayer; i += lanes)
      hn::Store(SampleOf(a, c, points.At(origin, i)), di, pixels + i);
    for (int i = 0; i < kLayer; i += lanes) {
      const RecordVectors sample = GatherRecords(a.samples, pixels + i);
      const Observation o = Observe(c, sample, points.At(origin, i));
      VI word = hn::LoadU(di, words + i);
      if (!hn::AllFalse(d, o.good)) {
        word = Average(c, o, a.max_weight, word);
        hn::StoreU(word, di, words + i);
      }
      // Words of observed voxels are not 0; the distance is the upper half.
      behind = hn::Or(behind, hn::IfThenElseZero(hn::Lt(word, first_positive), word));
    }
  }
  return !hn::AllTrue(di, hn::Eq(behind, hn::Zero(di)));
}

}  // namespace isotherm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace isotherm {

HWY_EXPORT(MakeSampleRow);
HWY_EXPORT(FindMissingBlocks);
HWY_EXPORT(IntegrateBlock);

DepthSample DepthSample::Make(const float* n, const float* p, float weight) {
  const auto code = [](float value) {
    return static_cast<std::int32_t>(std::lrint(value * kNormalScale));
  };
  const std::int32_t x = code(n[0]);
  const std::int32_t y = code(n[1]);
  const std::int32_t z = code(n[2]);
  const auto high = [](std::int32_t value) {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(value) << kUpperShift);
  };
  DepthSample sample;
  sample.depth_m = p[2];
  sample.normal_xy = high(y) | (x & kLowerMask);
  sample.normal_z_weight = high(z) | static_cast<std::int32_t>(std::lrint(weight * kWeightScale));
  sample.scaled_offset =
      static_cast<float>(x) * p[0] + static_cast<float>(y) * p[1] + static_cast<float>(z) * p[2];
  return sample;
}

void MakeSampleRow(const SampleRowArgs& args, DepthSample* samples) {
  HWY_DYNAMIC_DISPATCH(MakeSampleRow)(args, samples);
}

std::int32_t FindMissingBlocks(const BandRowArgs& args, std::int32_t* missing) {
  return HWY_DYNAMIC_DISPATCH(FindMissingBlocks)(args, missing);
}

bool IntegrateBlock(const IntegrationKernelArgs& args, const float* first, std::uint32_t* voxels) {
  return HWY_DYNAMIC_DISPATCH(IntegrateBlock)(args, first, voxels);
}

}  // namespace isotherm
#endif  // HWY_ONCE
