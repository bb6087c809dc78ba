// One strip of ICP in SIMD lanes along x. Compiled once per instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "ground/tracker/icp_kernel.cc"
#include <hwy/foreach_target.h>  // Must come before highway.h.
//
#include <hwy/highway.h>

#include "ground/tracker/icp_kernel.h"

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

struct Vector3 {
  VF x, y, z;
};

HWY_INLINE VF Dot(const Vector3& a, const Vector3& b) {
  return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z)));
}

HWY_INLINE Vector3 Rotate(const float* R, const Vector3& p) {
  const auto row = [&](int i) {
    return hn::MulAdd(hn::Set(d, R[i]), p.x,
                      hn::MulAdd(hn::Set(d, R[i + 1]), p.y, hn::Mul(hn::Set(d, R[i + 2]), p.z)));
  };
  return {row(0), row(3), row(6)};
}

HWY_INLINE Vector3 Add(const Vector3& p, const float* t) {
  return {hn::Add(p.x, hn::Set(d, t[0])), hn::Add(p.y, hn::Set(d, t[1])),
          hn::Add(p.z, hn::Set(d, t[2]))};
}

/// NaN compares false, so a pixel without a vertex is outside.
HWY_INLINE MF Inside(const IcpKernelArgs& a, const Vector3& p) {
  const auto between = [&](VF v, int axis) {
    return hn::And(hn::Ge(v, hn::Set(d, a.volume_min[axis])),
                   hn::Le(v, hn::Set(d, a.volume_max[axis])));
  };
  return hn::And(between(p.x, 0), hn::And(between(p.y, 1), between(p.z, 2)));
}

void AccumulateIcpRows(const IcpKernelArgs& a, int first_row, int last_row, IcpKernelSums& out) {
  const SurfaceMaps& current = *a.current;
  const SurfaceMaps& model = *a.model;
  const int width = current.width();
  const int lanes = static_cast<int>(hn::Lanes(d));
  const VF zero = hn::Zero(d);
  const VF one = hn::Set(d, 1.0F);
  VF sums[28];
  for (VF& sum : sums) sum = zero;
  for (int y = first_row; y < last_row; ++y) {
    for (int x = 0; x < width; x += lanes) {
      const std::size_t i = static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                            static_cast<std::size_t>(x);
      const MF in_row = hn::FirstN(d, static_cast<std::size_t>(width - x));
      const bool whole = x + lanes <= width;
      // A whole vector can be read (Image has slack); without AVX2, a masked load takes aligned
      // addresses only.
      const auto load = [&](const Image<float>& plane) {
        const VF v = hn::LoadU(d, plane.data() + i);
        return whole ? v : hn::IfThenElseZero(in_row, v);
      };
      const Vector3 p_depth{load(current.vx), load(current.vy), load(current.vz)};
      const Vector3 arm =
          Rotate(a.R_map_depth, p_depth);  // From the camera's position to the point, in `map`.
      const Vector3 p = Add(arm, a.t_map_depth);
      const MF seen = hn::And(in_row, hn::Gt(p_depth.z, zero));
      const MF candidate = hn::And(seen, Inside(a, p));
      if (hn::AllFalse(d, candidate)) continue;
      out.candidates += static_cast<std::int64_t>(hn::CountTrue(d, candidate));

      const Vector3 p_model = Add(Rotate(a.R_model_depth, p_depth), a.t_model_depth);
      const VF inverse_z = hn::Div(one, p_model.z);
      const VF u =
          hn::MulAdd(hn::Mul(p_model.x, inverse_z), hn::Set(d, a.fx), hn::Set(d, a.cx + 0.5F));
      const VF v =
          hn::MulAdd(hn::Mul(p_model.y, inverse_z), hn::Set(d, a.fy), hn::Set(d, a.cy + 0.5F));
      MF good = hn::And(candidate, hn::Gt(p_model.z, zero));
      good = hn::And(
          good, hn::And(hn::Ge(u, zero), hn::Lt(u, hn::Set(d, static_cast<float>(model.width())))));
      good = hn::And(good, hn::And(hn::Ge(v, zero),
                                   hn::Lt(v, hn::Set(d, static_cast<float>(model.height())))));
      if (hn::AllFalse(d, good)) continue;  // There may be no model to look at.
      const VI column = hn::ConvertTo(di, hn::IfThenElseZero(good, u));
      const VI row = hn::ConvertTo(di, hn::IfThenElseZero(good, v));
      const VI j = hn::Add(hn::Mul(row, hn::Set(di, model.width())), column);

      const Vector3 q{hn::GatherIndex(d, model.vx.data(), j),
                      hn::GatherIndex(d, model.vy.data(), j),
                      hn::GatherIndex(d, model.vz.data(), j)};
      const Vector3 difference{hn::Sub(p.x, q.x), hn::Sub(p.y, q.y), hn::Sub(p.z, q.z)};
      // The model has a surface where the pixel looks, near or not.
      out.overlap += static_cast<std::int64_t>(hn::CountTrue(d, hn::And(good, hn::Eq(q.x, q.x))));
      good =
          hn::And(good, hn::Lt(Dot(difference, difference), hn::Set(d, a.max_squared_distance_m2)));
      if (hn::AllFalse(d, good)) continue;
      Vector3 n{hn::GatherIndex(d, model.nx.data(), j), hn::GatherIndex(d, model.ny.data(), j),
                hn::GatherIndex(d, model.nz.data(), j)};
      const Vector3 n_current =
          Rotate(a.R_map_depth, {load(current.nx), load(current.ny), load(current.nz)});
      good = hn::And(good, hn::Gt(Dot(n, n_current), hn::Set(d, a.min_normal_cosine)));
      out.inliers += static_cast<std::int64_t>(hn::CountTrue(d, good));

      // Lanes that are no inliers contribute zeros, whatever NaN they hold.
      n = {hn::IfThenElseZero(good, n.x), hn::IfThenElseZero(good, n.y),
           hn::IfThenElseZero(good, n.z)};
      const VF residual = hn::IfThenElseZero(good, Dot(n, difference));
      const VF ratio =
          hn::IfThenElseZero(good, hn::Div(hn::Set(d, a.reference_depth_m), p_depth.z));
      const VF squared_ratio = hn::Mul(ratio, ratio);
      const VF weight = hn::Mul(squared_ratio, squared_ratio);
      const Vector3 r{hn::IfThenElseZero(good, arm.x), hn::IfThenElseZero(good, arm.y),
                      hn::IfThenElseZero(good, arm.z)};
      const VF J[6] = {n.x,
                       n.y,
                       n.z,
                       hn::NegMulAdd(r.z, n.y, hn::Mul(r.y, n.z)),
                       hn::NegMulAdd(r.x, n.z, hn::Mul(r.z, n.x)),
                       hn::NegMulAdd(r.y, n.x, hn::Mul(r.x, n.y))};
      int k = 0;
      for (int row_index = 0; row_index < 6; ++row_index) {
        const VF weighted = hn::Mul(weight, J[row_index]);
        for (int col = row_index; col < 6; ++col) {
          sums[k] = hn::MulAdd(weighted, J[col], sums[k]);
          ++k;
        }
        sums[21 + row_index] = hn::MulAdd(weighted, residual, sums[21 + row_index]);
      }
      sums[27] = hn::MulAdd(residual, residual, sums[27]);
    }
  }
  for (std::size_t k = 0; k < out.sums.size(); ++k)
    out.sums[k] += hn::GetLane(hn::SumOfLanes(d, sums[k]));
}

}  // namespace isotherm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace isotherm {

HWY_EXPORT(AccumulateIcpRows);

void AccumulateIcpRows(const IcpKernelArgs& args, int first_row, int last_row,
                       IcpKernelSums& sums) {
  HWY_DYNAMIC_DISPATCH(AccumulateIcpRows)(args, first_row, last_row, sums);
}

}  // namespace isotherm
#endif  // HWY_ONCE
