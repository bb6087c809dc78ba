// Update of one block of voxels in SIMD lanes (algorithm 2). Compiled once per instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "ground/tsdf/integration_kernel.cc"
#include <hwy/foreach_target.h>  // Must come before highway.h.
//
#include <hwy/highway.h>

#include "ground/tsdf/integration_kernel.h"

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

void IntegrateBlock(const IntegrationKernelArgs& a, const float* first, std::uint32_t* voxels) {
  auto* words = reinterpret_cast<std::int32_t*>(voxels);
  const int lanes = static_cast<int>(hn::Lanes(d));
  const VF zero = hn::Zero(d);
  const VF one = hn::Set(d, 1.0F);
  const VI seven = hn::Set(di, 7);
  const VF truncation = hn::Set(d, a.truncation_m);
  const VF double_truncation = hn::Set(d, 2.0F * a.truncation_m);
  for (int i = 0; i < 512; i += lanes) {
    const VI index = hn::Iota(di, i);
    const VF x = hn::ConvertTo(d, hn::And(index, seven));
    const VF y = hn::ConvertTo(d, hn::And(hn::ShiftRight<3>(index), seven));
    const VF z = hn::ConvertTo(d, hn::ShiftRight<6>(index));
    const auto coordinate = [&](int row) {
      const float* axis = a.axes + 3 * row;
      return hn::MulAdd(hn::Set(d, axis[0]), x,
                        hn::MulAdd(hn::Set(d, axis[1]), y,
                                   hn::MulAdd(hn::Set(d, axis[2]), z, hn::Set(d, first[row]))));
    };
    const VF px = coordinate(0);
    const VF py = coordinate(1);
    const VF pz = coordinate(2);
    const VF inverse_z = hn::Div(one, pz);
    const VF u = hn::MulAdd(hn::Mul(px, inverse_z), hn::Set(d, a.fx), hn::Set(d, a.cx + 0.5F));
    const VF v = hn::MulAdd(hn::Mul(py, inverse_z), hn::Set(d, a.fy), hn::Set(d, a.cy + 0.5F));
    MF good = hn::Gt(pz, zero);
    good =
        hn::And(good, hn::And(hn::Ge(u, zero), hn::Lt(u, hn::Set(d, static_cast<float>(a.width)))));
    good = hn::And(good,
                   hn::And(hn::Ge(v, zero), hn::Lt(v, hn::Set(d, static_cast<float>(a.height)))));
    if (hn::AllFalse(d, good)) continue;
    const VI column = hn::ConvertTo(di, hn::IfThenElseZero(good, u));
    const VI row = hn::ConvertTo(di, hn::IfThenElseZero(good, v));
    const VI pixel = hn::Add(hn::Mul(row, hn::Set(di, a.width)), column);
    const VI sample = hn::Mul(pixel, hn::Set(di, kDepthSampleFloats));

    const VF weight = hn::GatherIndex(d, a.samples + 5, sample);
    const VF depth = hn::GatherIndex(d, a.samples + 4, sample);
    const VF along_ray = hn::Sub(depth, pz);
    good = hn::And(good, hn::Gt(weight, zero));
    good = hn::And(good, hn::Ge(along_ray, hn::Neg(double_truncation)));
    if (hn::AllFalse(d, good)) continue;
    const VF nx = hn::GatherIndex(d, a.samples, sample);
    const VF ny = hn::GatherIndex(d, a.samples + 1, sample);
    const VF nz = hn::GatherIndex(d, a.samples + 2, sample);
    const VF offset = hn::GatherIndex(d, a.samples + 3, sample);
    const VF distance = hn::MulAdd(nx, px, hn::MulAdd(ny, py, hn::MulSub(nz, pz, offset)));
    // Far in front along the ray counts as free whatever the plane's tilt; behind the band is
    // unknown.
    const MF is_free = hn::Gt(along_ray, double_truncation);
    good = hn::And(good, hn::Or(is_free, hn::Ge(distance, hn::Neg(truncation))));
    if (hn::AllFalse(d, good)) continue;
    const VF tsdf = hn::IfThenElse(
        is_free, one, hn::Min(one, hn::Mul(distance, hn::Set(d, 1.0F / a.truncation_m))));

    const VI word = hn::LoadU(di, words + i);
    const VF old_tsdf =
        hn::Mul(hn::ConvertTo(d, hn::ShiftRight<16>(word)), hn::Set(d, 1.0F / kTsdfScale));
    const VF old_weight = hn::Mul(hn::ConvertTo(d, hn::And(word, hn::Set(di, 0xFFFF))),
                                  hn::Set(d, 1.0F / kWeightScale));
    const VF total = hn::Add(old_weight, weight);
    const VF averaged = hn::Div(hn::MulAdd(old_tsdf, old_weight, hn::Mul(tsdf, weight)), total);
    const VI tsdf_code = hn::NearestInt(hn::Mul(averaged, hn::Set(d, kTsdfScale)));
    const VI weight_code =
        hn::NearestInt(hn::Mul(hn::Min(total, hn::Set(d, a.max_weight)), hn::Set(d, kWeightScale)));
    const VI updated = hn::Or(hn::ShiftLeft<16>(tsdf_code), weight_code);
    hn::StoreU(hn::IfThenElse(hn::RebindMask(di, good), updated, word), di, words + i);
  }
}

}  // namespace isotherm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace isotherm {

HWY_EXPORT(IntegrateBlock);

void IntegrateBlock(const IntegrationKernelArgs& args, const float* first, std::uint32_t* voxels) {
  HWY_DYNAMIC_DISPATCH(IntegrateBlock)(args, first, voxels);
}

}  // namespace isotherm
#endif  // HWY_ONCE
