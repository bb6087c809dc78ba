// Depth samples, the search for missing blocks and the update of one block (algorithm 2) in SIMD
// lanes. Compiled once per instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "ground/tsdf/integration_kernel.cc"
#include <hwy/foreach_target.h>  // Must come before highway.h.
//
#include <hwy/highway.h>

#include <cmath>

#include "ground/tsdf/integration_kernel.h"
#include "ground/tsdf/voxel_kernel-inl.h"

HWY_BEFORE_NAMESPACE();
namespace isotherm::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::ScalableTag<float>;
using DI = hn::RebindToSigned<D>;
using VF = hn::Vec<D>;
using VI = hn::Vec<DI>;
using MF = hn::Mask<D>;

constexpr D d;
constexpr DI di;

// TsdfVoxel's scales.
constexpr float kTsdfScale = 32767.0F;
constexpr float kWeightScale = 64.0F;

/// Noise reaches this many standard deviations (a generous estimate) behind the surface.
constexpr float kNoiseReach = 1.0F;

/// Share of the weight that an observation keeps at the far end of the band, and of the band in
/// which weights fall, at least.
constexpr float kLeastCertainty = 0.02F;

/// Weight of an observation: the variance of triangulated depth grows with the fourth power of
/// depth, but far surfaces must still be learnt in a few frames.
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
  return {{depth, hn::BitCast(d, hn::Or(hn::ShiftLeft<16>(iy), hn::And(ix, hn::Set(di, 0xFFFF)))),
           hn::BitCast(d, hn::Or(hn::ShiftLeft<16>(iz), iw)), scaled_offset}};
}

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

bool IntegrateBlock(const IntegrationKernelArgs& a, const float* first, std::uint32_t* voxels) {
  auto* words = reinterpret_cast<std::int32_t*>(voxels);
  const int lanes = static_cast<int>(hn::Lanes(d));
  constexpr int kLayer = 64;
  HWY_ALIGN float along_x[kLayer];  // Of the layer's voxels from the layer's first, camera x.
  HWY_ALIGN float along_y[kLayer];
  HWY_ALIGN float along_z[kLayer];
  HWY_ALIGN std::int32_t pixels[kLayer];
  const VF zero = hn::Zero(d);
  const VF one = hn::Set(d, 1.0F);
  const VF double_truncation = hn::Set(d, 2.0F * a.truncation_m);
  const VF to_tsdf = hn::Set(d, 1.0F / (DepthSample::kNormalScale * a.truncation_m));
  const VF noise_reach_at_1m = hn::Set(d, kNoiseReach * a.noise_at_1m / a.truncation_m);
  const VF width = hn::Set(d, static_cast<float>(a.width));
  const VF height = hn::Set(d, static_cast<float>(a.height));
  const VI row_stride = hn::Set(di, a.width);
  const VI nowhere = hn::Set(di, a.width * a.height);
  const VI seven = hn::Set(di, 7);
  for (int i = 0; i < kLayer; i += lanes) {
    const VI index = hn::Iota(di, i);
    const VF x = hn::ConvertTo(d, hn::And(index, seven));
    const VF y = hn::ConvertTo(d, hn::ShiftRight<3>(index));
    const auto offset = [&](int row) {
      return hn::MulAdd(hn::Set(d, a.axes[3 * row]), x,
                        hn::Mul(hn::Set(d, a.axes[3 * row + 1]), y));
    };
    hn::Store(offset(0), d, along_x + i);
    hn::Store(offset(1), d, along_y + i);
    hn::Store(offset(2), d, along_z + i);
  }
  VI behind = hn::Zero(di);  // Not zero in lanes where an observed voxel has distance <= 0.
  const VI first_positive = hn::Set(di, 0x10000);
  for (int layer = 0; layer < 8; ++layer, words += kLayer) {
    const auto step = static_cast<float>(layer);
    const VF origin_x = hn::Set(d, first[0] + step * a.axes[2]);
    const VF origin_y = hn::Set(d, first[1] + step * a.axes[5]);
    const VF origin_z = hn::Set(d, first[2] + step * a.axes[8]);
    for (int i = 0; i < kLayer; i += lanes) {
      const VF px = hn::Add(origin_x, hn::Load(d, along_x + i));
      const VF py = hn::Add(origin_y, hn::Load(d, along_y + i));
      const VF pz = hn::Add(origin_z, hn::Load(d, along_z + i));
      const VF inverse_z = Reciprocal(pz);
      const VF u = hn::MulAdd(hn::Mul(px, inverse_z), hn::Set(d, a.fx), hn::Set(d, a.cx + 0.5F));
      const VF v = hn::MulAdd(hn::Mul(py, inverse_z), hn::Set(d, a.fy), hn::Set(d, a.cy + 0.5F));
      const MF inside =
          hn::And(hn::And(hn::Gt(pz, zero), hn::And(hn::Ge(u, zero), hn::Lt(u, width))),
                  hn::And(hn::Ge(v, zero), hn::Lt(v, height)));
      const VI pixel = hn::Add(hn::Mul(hn::ConvertTo(di, v), row_stride), hn::ConvertTo(di, u));
      hn::Store(hn::IfThenElse(hn::RebindMask(di, inside), pixel, nowhere), di, pixels + i);
    }
    for (int i = 0; i < kLayer; i += lanes) {
      const RecordVectors sample = GatherRecords(a.samples, pixels + i);
      const VF depth = sample.word[0];
      const VI normal_xy = hn::BitCast(di, sample.word[1]);
      const VI normal_z_weight = hn::BitCast(di, sample.word[2]);
      const VF scaled_offset = sample.word[3];
      const VI word = hn::LoadU(di, words + i);
      const VF px = hn::Add(origin_x, hn::Load(d, along_x + i));
      const VF py = hn::Add(origin_y, hn::Load(d, along_y + i));
      const VF pz = hn::Add(origin_z, hn::Load(d, along_z + i));
      const VF weight = hn::Mul(hn::ConvertTo(d, hn::And(normal_z_weight, hn::Set(di, 0xFFFF))),
                                hn::Set(d, 1.0F / DepthSample::kWeightScale));
      const VF along_ray = hn::Sub(depth, pz);
      const VF nx = hn::ConvertTo(d, hn::ShiftRight<16>(hn::ShiftLeft<16>(normal_xy)));
      const VF ny = hn::ConvertTo(d, hn::ShiftRight<16>(normal_xy));
      const VF nz = hn::ConvertTo(d, hn::ShiftRight<16>(normal_z_weight));
      const VF distance = hn::Mul(
          hn::MulAdd(nx, px, hn::MulAdd(ny, py, hn::MulSub(nz, pz, scaled_offset))), to_tsdf);
      // Far in front along the ray counts as free whatever the plane's tilt; behind the band is
      // unknown.
      const MF is_free = hn::Gt(along_ray, double_truncation);
      const MF in_band = hn::And(hn::Ge(along_ray, hn::Neg(double_truncation)),
                                 hn::Ge(distance, hn::Set(d, -1.0F)));
      const MF good = hn::And(hn::Gt(weight, zero), hn::Or(is_free, in_band));
      VI result = word;
      if (!hn::AllFalse(d, good)) {
        const VF tsdf = hn::IfThenElse(is_free, one, hn::Min(one, distance));
        // Full weight as far behind the surface as noise reaches; from there to the end of the band
        // less and less, so that what only stood in the shadow of an edge yields to free space seen
        // from elsewhere (Bylow et al., Real-time camera tracking and 3D reconstruction using
        // signed distance functions, 2013).
        const VF noise_reach = hn::Min(hn::Mul(hn::Mul(depth, depth), noise_reach_at_1m), one);
        const VF room = hn::Max(hn::Sub(one, noise_reach), hn::Set(d, kLeastCertainty));
        const VF certainty = hn::Max(hn::Set(d, kLeastCertainty),
                                     hn::Min(one, hn::Mul(hn::Add(one, tsdf), Reciprocal(room))));
        const VF new_weight = hn::Mul(weight, certainty);
        const VF old_tsdf = hn::ConvertTo(d, hn::ShiftRight<16>(word));
        const VF old_weight = hn::Mul(hn::ConvertTo(d, hn::And(word, hn::Set(di, 0xFFFF))),
                                      hn::Set(d, 1.0F / kWeightScale));
        const VF total = hn::Add(old_weight, new_weight);
        const VF averaged =
            hn::Mul(hn::MulAdd(old_tsdf, old_weight,
                               hn::Mul(hn::Mul(tsdf, hn::Set(d, kTsdfScale)), new_weight)),
                    Reciprocal(total));
        const VI tsdf_code = hn::NearestInt(averaged);
        const VI weight_code = hn::NearestInt(
            hn::Mul(hn::Min(total, hn::Set(d, a.max_weight)), hn::Set(d, kWeightScale)));
        // An observation too light to count leaves the voxel as it was.
        const auto counts = hn::And(hn::RebindMask(di, good), hn::Gt(weight_code, hn::Zero(di)));
        result = hn::IfThenElse(counts, hn::Or(hn::ShiftLeft<16>(tsdf_code), weight_code), word);
        hn::StoreU(result, di, words + i);
      }
      // Words of observed voxels are not 0; the distance is the upper half.
      behind = hn::Or(behind, hn::IfThenElseZero(hn::Lt(result, first_positive), result));
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
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(value) << 16);
  };
  DepthSample sample;
  sample.depth_m = p[2];
  sample.normal_xy = high(y) | (x & 0xFFFF);
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
