// One strip of ICP in SIMD lanes along x. Compiled once per instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "ground/icp/icp_kernel.cc"
#include "common/simd/kernel_prelude-inl.h"  // Before everything else.

#include "ground/icp/icp_kernel.h"

HWY_BEFORE_NAMESPACE();
namespace isotherm::HWY_NAMESPACE {

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

/// Pixels of the model's maps.
struct ModelPixels {
  VI index;
  MF inside;  ///< Elsewhere the index is 0.
};

HWY_INLINE ModelPixels ProjectToModel(const IcpKernelArgs& a, const Vector3& p_model,
                                      MF candidate) {
  const SurfaceMaps& model = *a.model;
  const VF zero = hn::Zero(d);
  const VF inverse_z = hn::Div(hn::Set(d, 1.0F), p_model.z);
  const VF u = hn::MulAdd(hn::Mul(p_model.x, inverse_z), hn::Set(d, a.fx), hn::Set(d, a.cx + 0.5F));
  const VF v = hn::MulAdd(hn::Mul(p_model.y, inverse_z), hn::Set(d, a.fy), hn::Set(d, a.cy + 0.5F));
  MF inside = hn::And(candidate, hn::Gt(p_model.z, zero));
  inside = hn::And(
      inside, hn::And(hn::Ge(u, zero), hn::Lt(u, hn::Set(d, static_cast<float>(model.width())))));
  inside = hn::And(
      inside, hn::And(hn::Ge(v, zero), hn::Lt(v, hn::Set(d, static_cast<float>(model.height())))));
  const VI column = hn::ConvertTo(di, hn::IfThenElseZero(inside, u));
  const VI row = hn::ConvertTo(di, hn::IfThenElseZero(inside, v));
  return {hn::Add(hn::Mul(row, hn::Set(di, model.width())), column), inside};
}

/// The sums of IcpKernelSums, in each lane.
struct NormalEquations {
  VF sums[28];

  HWY_INLINE NormalEquations() {
    for (VF& sum : sums) sum = hn::Zero(d);
  }
  /// Adds weight J J^T and weight J residual with J = (n, arm x n); `residual` and all vectors are
  /// 0 in lanes that do not count.
  HWY_INLINE void Add(const Vector3& n, const Vector3& arm, VF residual, VF weight) {
    const VF J[6] = {n.x,
                     n.y,
                     n.z,
                     hn::NegMulAdd(arm.z, n.y, hn::Mul(arm.y, n.z)),
                     hn::NegMulAdd(arm.x, n.z, hn::Mul(arm.z, n.x)),
                     hn::NegMulAdd(arm.y, n.x, hn::Mul(arm.x, n.y))};
    int k = 0;
    for (int row = 0; row < 6; ++row) {
      const VF weighted = hn::Mul(weight, J[row]);
      for (int col = row; col < 6; ++col) {
        sums[k] = hn::MulAdd(weighted, J[col], sums[k]);
        ++k;
      }
      sums[21 + row] = hn::MulAdd(weighted, residual, sums[21 + row]);
    }
    sums[27] = hn::MulAdd(residual, residual, sums[27]);
  }
};

/// Zeros where `mask` is false, whatever NaN is there.
HWY_INLINE Vector3 OnlyWhere(MF mask, const Vector3& v) {
  return {hn::IfThenElseZero(mask, v.x), hn::IfThenElseZero(mask, v.y),
          hn::IfThenElseZero(mask, v.z)};
}

/// Adds the pixels where `good`; lanes that are no inliers contribute zeros.
HWY_INLINE void AddInliers(const IcpKernelArgs& a, MF good, const Vector3& n,
                           const Vector3& difference, const Vector3& arm, VF depth,
                           NormalEquations& equations) {
  const Vector3 n_good = OnlyWhere(good, n);
  const VF residual = hn::IfThenElseZero(good, Dot(n_good, difference));
  const VF ratio = hn::IfThenElseZero(good, hn::Div(hn::Set(d, a.reference_depth_m), depth));
  const VF squared_ratio = hn::Mul(ratio, ratio);
  const VF weight = hn::Mul(squared_ratio, squared_ratio);
  equations.Add(n_good, OnlyWhere(good, arm), residual, weight);
}

// One pass of point-to-plane ICP with projective association (algorithm 1): a vertex p of the
// current frame meets the model's vertex q in the pixel that p is projected to; if they are near
// and their normals agree, it adds to the normal equations of the twist
//   sum of w (n . (p - q) + J . twist)^2,  J = (n, (p - camera) x n),  w = (reference / depth)^4,
// the weight being the inverse variance of triangulated depth.
// Rows: planes of both maps, one pixel of the current ones per lane; 28 sums per lane, added up at
// the end. Fast: the sums stay in registers, each test ends the vector if no lane is left, and
// neighbours look up neighbours.
void AccumulateIcpRows(const IcpKernelArgs& a, int first_row, int last_row, IcpKernelSums& out) {
  const SurfaceMaps& current = *a.current;
  const SurfaceMaps& model = *a.model;
  const int width = current.width();
  const int lanes = static_cast<int>(hn::Lanes(d));
  const VF zero = hn::Zero(d);
  NormalEquations equations;
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
      const ModelPixels pixels = ProjectToModel(a, p_model, candidate);
      if (hn::AllFalse(d, pixels.inside)) continue;  // There may be no model to look at.
      const auto look_up = [&pixels](const Image<float>& plane) {
        return hn::GatherIndex(d, plane.data(), pixels.index);
      };
      const Vector3 q{look_up(model.vx), look_up(model.vy), look_up(model.vz)};
      const Vector3 difference{hn::Sub(p.x, q.x), hn::Sub(p.y, q.y), hn::Sub(p.z, q.z)};
      // The model has a surface where the pixel looks, near or not.
      out.overlap +=
          static_cast<std::int64_t>(hn::CountTrue(d, hn::And(pixels.inside, hn::Eq(q.x, q.x))));
      MF good = hn::And(pixels.inside,
                        hn::Lt(Dot(difference, difference), hn::Set(d, a.max_squared_distance_m2)));
      if (hn::AllFalse(d, good)) continue;
      const Vector3 n{look_up(model.nx), look_up(model.ny), look_up(model.nz)};
      const Vector3 n_current =
          Rotate(a.R_map_depth, {load(current.nx), load(current.ny), load(current.nz)});
      good = hn::And(good, hn::Gt(Dot(n, n_current), hn::Set(d, a.min_normal_cosine)));
      out.inliers += static_cast<std::int64_t>(hn::CountTrue(d, good));
      AddInliers(a, good, n, difference, arm, p_depth.z, equations);
    }
  }
  for (std::size_t k = 0; k < out.sums.size(); ++k)
    out.sums[k] += hn::GetLane(hn::SumOfLanes(d, equations.sums[k]));
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
