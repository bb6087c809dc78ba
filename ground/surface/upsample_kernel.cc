// A cast of the model at half size made a whole one. Compiled once per instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "ground/surface/upsample_kernel.cc"
#include "common/simd/kernel_prelude-inl.h"  // Before everything else.

#include <limits>

#include "ground/surface/upsample_kernel.h"

HWY_BEFORE_NAMESPACE();
namespace isotherm::HWY_NAMESPACE {

struct Vertices {
  VF p[3], n[3];

  HWY_INLINE Vertices(const SurfaceMaps& maps, int x, int y) {
    const Image<float>* const planes[6] = {&maps.vx, &maps.vy, &maps.vz,
                                           &maps.nx, &maps.ny, &maps.nz};
    for (int i = 0; i < 3; ++i) {
      p[i] = hn::LoadU(d, planes[i]->Row(y).data() + x);
      n[i] = hn::LoadU(d, planes[3 + i]->Row(y).data() + x);
    }
  }
};

/// False where either is no surface.
HWY_INLINE MF OnOneSurface(const Vertices& a, const Vertices& b, VF max_plane_distance) {
  VF from_a = hn::Zero(d);
  VF from_b = hn::Zero(d);
  for (int i = 0; i < 3; ++i) {
    const VF between = hn::Sub(b.p[i], a.p[i]);
    from_a = hn::MulAdd(a.n[i], between, from_a);
    from_b = hn::MulAdd(b.n[i], between, from_b);
  }
  return hn::And(hn::Le(hn::Abs(from_a), max_plane_distance),
                 hn::Le(hn::Abs(from_b), max_plane_distance));
}

/// The squared distance of a vertex, huge where there is none.
HWY_INLINE VF SquaredDistance(const VF* p, const float* position) {
  VF sum = hn::Zero(d);
  for (int i = 0; i < 3; ++i) {
    const VF offset = hn::Sub(p[i], hn::Set(d, position[i]));
    sum = hn::MulAdd(offset, offset, sum);
  }
  return hn::IfThenElse(hn::Eq(sum, sum), sum, hn::Set(d, std::numeric_limits<float>::max()));
}

HWY_INLINE void Normalize(VF* n) {
  const VF squared = hn::MulAdd(n[0], n[0], hn::MulAdd(n[1], n[1], hn::Mul(n[2], n[2])));
  const VF scale = hn::Div(hn::Set(d, 1.0F), hn::Sqrt(squared));
  for (int i = 0; i < 3; ++i) n[i] = hn::Mul(n[i], scale);
}

// Makes a row of surface maps of twice the resolution. Even pixels in even rows are coarse ones;
// the others are the mean of the two or four coarse ones around, if these lie on one surface (each
// within max_plane_distance_m of the other's plane), else NaN. A pixel without a vertex still gets
// the distance of the nearest around, so that it hides what is behind it.
// Rows: planes; a lane makes one even and one odd pixel. Fast: a quarter of the rays are cast, and
// the rest is four loads per plane; both halves of the row leave interleaved.
void UpsampleRow(const UpsampleRowArgs& args, int y, SurfaceMaps& fine, float* distance_m) {
  const int lanes = static_cast<int>(hn::Lanes(d));
  const int width = fine.width();
  const SurfaceMaps& coarse = *args.coarse;
  const VF max_distance = hn::Set(d, args.max_plane_distance_m);
  const VF none = hn::Set(d, std::numeric_limits<float>::quiet_NaN());
  const VF too_far = hn::Set(d, std::numeric_limits<float>::max());
  Image<float>* const targets[6] = {&fine.vx, &fine.vy, &fine.vz, &fine.nx, &fine.ny, &fine.nz};
  const int planes = distance_m == nullptr ? 6 : 7;
  HWY_ALIGN float pairs[2 * hn::MaxLanes(d)];
  for (int i = 0; 2 * i < width; i += lanes) {
    // Lanes beyond the row's end read the next row or the slack behind the last.
    const Vertices a(coarse, i, y / 2);
    const Vertices b(coarse, i + 1, y / 2);
    const Vertices c(coarse, i, (y + 1) / 2);
    const Vertices e(coarse, i + 1, (y + 1) / 2);
    const MF even_agrees = OnOneSurface(a, c, max_distance);
    const MF odd_agrees =
        hn::And(hn::And(even_agrees, OnOneSurface(a, b, max_distance)),
                hn::And(OnOneSurface(a, e, max_distance), OnOneSurface(b, c, max_distance)));
    VF even[7], odd[7];  // Vertex, normal, distance.
    for (int k = 0; k < 6; ++k) {
      const VF left = k < 3 ? hn::Add(a.p[k], c.p[k]) : hn::Add(a.n[k - 3], c.n[k - 3]);
      const VF right = k < 3 ? hn::Add(b.p[k], e.p[k]) : hn::Add(b.n[k - 3], e.n[k - 3]);
      even[k] = hn::IfThenElse(even_agrees, hn::Mul(hn::Set(d, 0.5F), left), none);
      odd[k] = hn::IfThenElse(odd_agrees, hn::Mul(hn::Set(d, 0.25F), hn::Add(left, right)), none);
    }
    Normalize(even + 3);
    Normalize(odd + 3);
    if (distance_m != nullptr) {
      const auto squared = [&](const VF* p) { return SquaredDistance(p, args.position); };
      const VF nearest_left = hn::Min(squared(a.p), squared(c.p));
      const VF nearest = hn::Min(nearest_left, hn::Min(squared(b.p), squared(e.p)));
      const auto distance = [&](VF square) {
        return hn::IfThenElse(hn::Lt(square, too_far), hn::Sqrt(square), too_far);
      };
      even[6] = distance(hn::IfThenElse(even_agrees, squared(even), nearest_left));
      odd[6] = distance(hn::IfThenElse(odd_agrees, squared(odd), nearest));
    }
    const int rest = width - 2 * i;
    for (int k = 0; k < planes; ++k) {
      float* target = 2 * i + (k < 6 ? targets[k]->Row(y).data() : distance_m);
      if (rest >= 2 * lanes) {
        hn::StoreInterleaved2(even[k], odd[k], d, target);
        continue;
      }
      hn::StoreInterleaved2(even[k], odd[k], d, pairs);
      for (int x = 0; x < rest; ++x) target[x] = pairs[x];
    }
  }
}

}  // namespace isotherm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace isotherm {

HWY_EXPORT(UpsampleRow);

void UpsampleRow(const UpsampleRowArgs& args, int y, SurfaceMaps& fine, float* distance_m) {
  HWY_DYNAMIC_DISPATCH(UpsampleRow)(args, y, fine, distance_m);
}

}  // namespace isotherm
#endif  // HWY_ONCE
