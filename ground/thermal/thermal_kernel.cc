// The rows of the ideal thermal image in SIMD lanes, from its temperatures to what FuseBlock needs
// of a pixel. Compiled once per instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "ground/thermal/thermal_kernel.cc"
#include "common/simd/kernel_prelude-inl.h"  // Before everything else.

#include <limits>

#include "ground/thermal/thermal_kernel.h"
#include "ground/thermal/voxel_layout.h"
#include "ground/tsdf/voxel_kernel-inl.h"

HWY_BEFORE_NAMESPACE();
namespace isotherm::HWY_NAMESPACE {

// The classes of distance and angle; a bad one is 0.
constexpr auto kGood = static_cast<std::int32_t>(ConditionClass::kGood);
constexpr auto kAcceptable = static_cast<std::int32_t>(ConditionClass::kAcceptable);
static_assert(ConditionClass::kBad == ConditionClass{0});

// The motion class counts the limits of smear that a pixel keeps, from bad on.
constexpr auto kSmeared = static_cast<std::int32_t>(ThermalLayout::Encode(ConditionClass::kBad));
static_assert(ThermalLayout::Encode(ConditionClass::kAcceptable) == kSmeared + 1 &&
              ThermalLayout::Encode(ConditionClass::kGood) == kSmeared + 2);

// Looks a row of an image up at other places, bilinearly between four pixels: lens distortion is
// removed this way. NaN outside, and next to a pixel without value.
// Rows: for each output pixel the index of the upper left of its four, and two fractions. Fast:
// indices and fractions are computed once per camera; the rest is four gathers that mostly meet the
// same cache lines.
void ResampleRow(const ResampleRowArgs& a, float* out) {
  const int lanes = static_cast<int>(hn::Lanes(d));
  const VF none = hn::Set(d, std::numeric_limits<float>::quiet_NaN());
  for (int x = 0; x < a.width; x += lanes) {
    const auto count = static_cast<std::size_t>(a.width - x);
    const VI source = hn::IfThenElseZero(hn::FirstN(di, count), hn::LoadU(di, a.source + x));
    const VF fx = LoadFirst(count, a.fraction_x + x);
    const VF fy = LoadFirst(count, a.fraction_y + x);
    const MI inside = hn::Gt(source, hn::Set(di, -1));
    const VI upper = hn::IfThenElseZero(inside, source);
    const VI lower = hn::Add(upper, hn::Set(di, a.stride));
    const VF p00 = hn::GatherIndex(d, a.image, upper);
    const VF p10 = hn::GatherIndex(d, a.image + 1, upper);
    const VF p01 = hn::GatherIndex(d, a.image, lower);
    const VF p11 = hn::GatherIndex(d, a.image + 1, lower);
    const VF above = hn::MulAdd(fx, hn::Sub(p10, p00), p00);
    const VF below = hn::MulAdd(fx, hn::Sub(p11, p01), p01);
    const VF value = hn::IfThenElse(hn::RebindMask(d, inside),
                                    hn::MulAdd(fy, hn::Sub(below, above), above), none);
    StoreFirst(value, count, out + x);
  }
}

// Distances |vertex - position|, so large where there is no vertex that it hides nothing.
// Rows: coordinates are planes, one pixel per lane. Fast: the square root of a vector costs little
// beside its loads.
void DistanceRow(const float* vx, const float* vy, const float* vz, const float* position,
                 std::int32_t width, float* distance_m) {
  const int lanes = static_cast<int>(hn::Lanes(d));
  const VF far = hn::Set(d, std::numeric_limits<float>::max());
  for (int x = 0; x < width; x += lanes) {
    const auto count = static_cast<std::size_t>(width - x);
    const auto offset = [&](const float* row, int axis) {
      return hn::Sub(LoadFirst(count, row + x), hn::Set(d, position[axis]));
    };
    const VF dx = offset(vx, 0);
    const VF dy = offset(vy, 1);
    const VF dz = offset(vz, 2);
    const VF squared = hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz)));
    const VF distance =
        hn::IfThenElse(hn::Ge(squared, hn::Zero(d)), hn::Sqrt(squared), far);  // NaN: far.
    StoreFirst(distance, count, distance_m + x);
  }
}

HWY_INLINE VI Classify(MF good, MF acceptable) {
  return hn::IfThenElse(
      hn::RebindMask(di, good), hn::Set(di, kGood),
      hn::IfThenElseZero(hn::RebindMask(di, acceptable), hn::Set(di, kAcceptable)));
}

/// A vector in the image for each lane.
struct ImageVector {
  VF u, v;
};

HWY_INLINE VF Dot(const ImageVector& a, const ImageVector& b) {
  return hn::MulAdd(a.u, b.u, hn::Mul(a.v, b.v));
}

/// How fast the surface goes through the image, pixels per second, with the other sign: the
/// derivative of the projection of a resting point (ImageVelocity).
HWY_INLINE ImageVector ImageSpeed(const PixelRowArgs& a, int first, VF depth) {
  const VF x = hn::Mul(hn::Sub(hn::ConvertTo(d, hn::Iota(di, first)), hn::Set(d, a.cx)),
                       hn::Set(d, 1.0F / a.fx));
  const VF y = hn::Set(d, a.y);
  const VF inverse_z = Reciprocal(depth);
  const auto rate = [&](int axis) { return hn::Set(d, a.rate_rad_s[axis]); };
  const auto speed = [&](int axis) { return hn::Mul(hn::Set(d, a.velocity_m_s[axis]), inverse_z); };
  // Minus the point's velocity over its depth.
  const VF vx = hn::Add(speed(0), hn::NegMulAdd(rate(2), y, rate(1)));
  const VF vy = hn::Add(speed(1), hn::MulSub(rate(2), x, rate(0)));
  const VF vz = hn::Add(speed(2), hn::MulSub(rate(0), y, hn::Mul(rate(1), x)));
  return {hn::Mul(hn::NegMulAdd(x, vz, vx), hn::Set(d, a.fx)),
          hn::Mul(hn::NegMulAdd(y, vz, vy), hn::Set(d, a.fy))};
}

/// Loads the vector of a row that begins at pixel `x`; the last one of the row has zeros behind it.
struct RowLoader {
  int x;
  std::size_t count;
  bool whole;

  HWY_INLINE RowLoader(int first, int width)
      : x(first),
        count(static_cast<std::size_t>(width - first)),
        whole(first + static_cast<int>(hn::Lanes(d)) <= width) {}
  HWY_INLINE VF operator()(const float* row) const {
    return whole ? hn::LoadU(d, row + x) : LoadFirst(count, row + x);
  }
};

/// Seen by the depth camera's pyramid of view: what no depth frame covers may be hidden by
/// something that was never measured.
HWY_INLINE MF SeenByDepthCamera(const PixelRowArgs& a, const Vector3& p, MF surface) {
  const VF zero = hn::Zero(d);
  const auto to_depth = [&](int row) {
    const float* R = a.R_depth + 3 * row;
    return hn::MulAdd(hn::Set(d, R[0]), p.x,
                      hn::MulAdd(hn::Set(d, R[1]), p.y,
                                 hn::MulAdd(hn::Set(d, R[2]), p.z, hn::Set(d, a.t_depth[row]))));
  };
  const VF z = to_depth(2);
  const VF inverse_z = hn::Div(hn::Set(d, 1.0F), z);
  const VF u = hn::MulAdd(hn::Mul(to_depth(0), inverse_z), hn::Set(d, a.depth_fx),
                          hn::Set(d, a.depth_cx + 0.5F));
  const VF v = hn::MulAdd(hn::Mul(to_depth(1), inverse_z), hn::Set(d, a.depth_fy),
                          hn::Set(d, a.depth_cy + 0.5F));
  MF seen = hn::And(surface, hn::Gt(z, zero));
  seen = hn::And(seen, hn::And(hn::Ge(u, zero), hn::Lt(u, hn::Set(d, a.depth_width))));
  return hn::And(seen, hn::And(hn::Ge(v, zero), hn::Lt(v, hn::Set(d, a.depth_height))));
}

/// The smallest distance within the margin around.
HWY_INLINE VF NearestAround(const PixelRowArgs& a, const RowLoader& load, VF distance) {
  VF nearest = distance;
  for (int row = -a.margin; row <= a.margin; ++row) {
    for (int column = -a.margin; column <= a.margin; ++column) {
      nearest = hn::Min(nearest, load(a.distance_m + row * a.distance_stride + column));
    }
  }
  return nearest;
}

/// Distance of the camera before the surface's plane: cosine of the emission angle times distance.
HWY_INLINE VF BeforePlane(const PixelRowArgs& a, const Vector3& n, const Vector3& p) {
  const VF to_camera_x = hn::Sub(hn::Set(d, a.position[0]), p.x);
  const VF to_camera_y = hn::Sub(hn::Set(d, a.position[1]), p.y);
  const VF to_camera_z = hn::Sub(hn::Set(d, a.position[2]), p.z);
  return hn::MulAdd(n.x, to_camera_x, hn::MulAdd(n.y, to_camera_y, hn::Mul(n.z, to_camera_z)));
}

/// The plane through a pixel's vertex (PixelPlane). With the plane's distance h = -n . p in camera
/// coordinates, a ray r of depth 1 meets it at depth z = -h / n . r, so 1 / z changes by
/// -n_x / (h fx) per pixel. None where the camera does not look at its front.
HWY_INLINE VI PackPlane(const PixelRowArgs& a, const Vector3& n, VF depth, VF before_plane) {
  const VF zero = hn::Zero(d);
  const auto along = [&](const float* axis) {
    return hn::MulAdd(n.x, hn::Set(d, axis[0]),
                      hn::MulAdd(n.y, hn::Set(d, axis[1]), hn::Mul(n.z, hn::Set(d, axis[2]))));
  };
  const MF front = hn::Gt(before_plane, zero);
  const VF scale = hn::IfThenElseZero(
      front, hn::Div(hn::Mul(depth, hn::Set(d, -PixelPlane::kScale)), before_plane));
  const auto code = [&](const float* axis, float focal_px) {
    const VF limit = hn::Set(d, static_cast<float>(PixelPlane::kMaxCode));
    const VF scaled = hn::Mul(hn::Mul(along(axis), hn::Set(d, 1.0F / focal_px)), scale);
    const VF finite = hn::IfThenElseZero(front, scaled);
    return hn::NearestInt(hn::Max(hn::Min(finite, limit), hn::Neg(limit)));
  };
  return hn::Or(hn::ShiftLeft<PixelPlane::kVShift>(code(a.y_axis, a.fy)),
                hn::And(code(a.x_axis, a.fx), hn::Set(di, PixelPlane::kUMask)));
}

/// Classes of distance (eq. 6.3a) and angle (eq. 6.3b), where ThermalLayout has them. A distance
/// whose pixel covers too much of the surface is bad.
HWY_INLINE VI DistanceAndAngle(const PixelRowArgs& a, VF distance, VF cosine) {
  const MF resolved = hn::Le(hn::Mul(distance, hn::Set(d, 1.0F / a.fx)),
                             hn::Mul(cosine, hn::Set(d, a.max_footprint_m)));
  const MF far_enough = hn::And(hn::Ge(distance, hn::Set(d, a.distance_min_m)), resolved);
  const VI distance_class =
      Classify(hn::And(far_enough, hn::Le(distance, hn::Set(d, a.distance_good_m))),
               hn::And(far_enough, hn::Le(distance, hn::Set(d, a.distance_max_m))));
  const MF not_frontal = hn::Le(cosine, hn::Set(d, a.cosine_min_angle));
  const VI angle_class =
      Classify(hn::And(not_frontal, hn::Ge(cosine, hn::Set(d, a.cosine_good_angle))),
               hn::And(not_frontal, hn::Ge(cosine, hn::Set(d, a.cosine_max_angle))));
  return hn::Or(hn::ShiftLeft<ThermalLayout::kDistanceShift>(distance_class),
                hn::ShiftLeft<ThermalLayout::kAngleShift>(angle_class));
}

/// Half the difference of the neighbours, kelvin per pixel; 0 if either has no value.
HWY_INLINE VF Slope(const RowLoader& load, const float* before, const float* after) {
  const VF half = hn::Mul(hn::Sub(load(after), load(before)), hn::Set(d, 0.5F));
  return hn::IfThenElseZero(hn::Eq(half, half), half);
}

/// Second difference with the neighbours, kelvin per pixel squared; 0 if either has no value.
HWY_INLINE VF Curvature(const RowLoader& load, VF here, const float* before, const float* after) {
  const VF second = hn::NegMulAdd(hn::Set(d, 2.0F), here, hn::Add(load(after), load(before)));
  return hn::IfThenElseZero(hn::Eq(second, second), second);
}

HWY_INLINE VI PackSlopes(VF slope_u, VF slope_v) {
  const auto code = [](VF slope) {
    const VF limit = hn::Set(d, static_cast<float>(ThermalPixel::kMaxSlopeCode));
    const VF scaled = hn::Mul(slope, hn::Set(d, ThermalPixel::kSlopeScale));
    return hn::NearestInt(hn::Max(hn::Min(scaled, limit), hn::Neg(limit)));
  };
  return hn::Or(hn::ShiftLeft<ThermalPixel::kSlopeVShift>(code(slope_v)),
                hn::And(code(slope_u), hn::Set(di, ThermalPixel::kSlopeUMask)));
}

/// The square of the standard uncertainty, kelvin squared: the sum of those of BudgetOf's terms.
HWY_INLINE VF Variance(const PixelRowArgs& a, const RowLoader& load, VF celsius, VF depth,
                       const ImageVector& slope, const ImageVector& speed) {
  const SigmaArgs& s = a.sigma;
  const VF inverse_z = Reciprocal(depth);
  const VF place_px2 = hn::MulAdd(hn::Mul(inverse_z, inverse_z), hn::Set(d, s.voxel_px2_m2),
                                  hn::Set(d, s.place_px2));
  const VF rate = Dot(slope, speed);
  const VF time_s2 = hn::Set(d, s.time_s2 + a.smear_s * a.smear_s);
  const VF scene =
      hn::Mul(hn::Sub(celsius, hn::Set(d, s.scene_celsius)), hn::Set(d, s.scene_influence));
  VF sum = hn::MulAdd(load(a.noise_gain), hn::Set(d, s.noise_k2), hn::Set(d, s.even_k2));
  sum = hn::MulAdd(Dot(slope, slope), place_px2, sum);
  const ImageVector curvature{
      Curvature(load, celsius, a.celsius - 1, a.celsius + 1),
      Curvature(load, celsius, a.celsius - a.celsius_stride, a.celsius + a.celsius_stride)};
  const VF mean = hn::Mul(hn::Set(d, 0.5F), hn::Add(curvature.u, curvature.v));
  const VF curved = hn::MulAdd(hn::Set(d, 0.5F), Dot(curvature, curvature), hn::Mul(mean, mean));
  sum = hn::MulAdd(hn::Mul(place_px2, place_px2), curved, sum);
  sum = hn::MulAdd(hn::Mul(rate, rate), time_s2, sum);
  return hn::MulAdd(scene, scene, sum);
}

/// SigmaCode of a standard uncertainty; the largest one of NaN.
HWY_INLINE VI PackSigma(VF variance) {
  const VF largest = hn::Set(d, SigmaCode::kMax_k);
  const VF known = hn::IfThenElse(hn::IsNaN(variance), hn::Mul(largest, largest), variance);
  const VF sigma = hn::Min(hn::Max(hn::Sqrt(known), hn::Set(d, SigmaCode::kMin_k)), largest);
  constexpr std::int32_t kHalfStep = 1 << (SigmaCode::kShift - 1);
  const VI rounded = hn::Add(hn::BitCast(di, sigma), hn::Set(di, kHalfStep));
  return hn::Sub(hn::ShiftRight<SigmaCode::kShift>(rounded),
                 hn::Set(di, static_cast<std::int32_t>(SigmaCode::kBias)));
}

HWY_INLINE VI Flag(MF condition, std::int32_t bit) {
  return hn::IfThenElseZero(hn::RebindMask(di, condition), hn::Set(di, bit));
}

/// ThermalPixel's flags but for the classes: what is known of a pixel, cosine and uncertainty.
HWY_INLINE VI PackFlags(MF seen, MF assignable, VF cosine, VI sigma_code) {
  const VI cosine_code = hn::NearestInt(hn::IfThenElseZero(
      hn::Gt(cosine, hn::Zero(d)), hn::Mul(cosine, hn::Set(d, ThermalPixel::kCosineScale))));
  const VI codes = hn::Or(hn::ShiftLeft<ThermalPixel::kCosineShift>(cosine_code),
                          hn::ShiftLeft<ThermalPixel::kSigmaShift>(sigma_code));
  return hn::Or(
      hn::Or(Flag(seen, ThermalPixel::kSeen), Flag(assignable, ThermalPixel::kAssignable)), codes);
}

/// Depths of points in the camera's coordinates.
HWY_INLINE VF DepthOf(const float* z_axis, const Vector3& p) {
  return hn::MulAdd(hn::Set(d, z_axis[0]), p.x,
                    hn::MulAdd(hn::Set(d, z_axis[1]), p.y,
                               hn::MulAdd(hn::Set(d, z_axis[2]), p.z, hn::Set(d, z_axis[3]))));
}

// Assesses a row of the ideal thermal image against the model as the thermal camera sees it: what
// each pixel shows of the surface, and whether its temperature may be assigned. Not if the depth
// camera does not see the surface (kSeen), if something nearer lies within the margin around
// (algorithm 5: occluded), if motion smears it, or if the temperature is too steep for how well the
// place is known; distance, angle and motion get their classes (eq. 6.3a-b), and an assignable
// temperature its standard uncertainty (BudgetOf).
// Rows: vertices, normals, distances and temperatures are planes, one pixel per lane, the last two
// with an apron; the result is records of 16 bytes (ThermalPixel) and a plane of words
// (PixelPlane). Fast: every question is a mask, none a branch, so a pixel costs the same whatever
// it shows; FuseBlock then finds all of it in one load.
PixelRowCounts MakePixelRow(const PixelRowArgs& a, ThermalPixel* pixels, std::int32_t* planes) {
  const int lanes = static_cast<int>(hn::Lanes(d));
  const VF zero = hn::Zero(d);
  const auto number = [](MF mask) { return static_cast<std::int64_t>(hn::CountTrue(d, mask)); };
  PixelRowCounts counts;
  for (int x = 0; x < a.width; x += lanes) {
    const RowLoader load(x, a.width);
    const MF in_row = hn::FirstN(d, load.count);
    const Vector3 p{load(a.vx), load(a.vy), load(a.vz)};
    const VF depth = DepthOf(a.z_axis, p);
    const MF surface = hn::And(in_row, hn::Gt(depth, zero));  // False for NaN.
    const MF seen = SeenByDepthCamera(a, p, surface);
    const VF distance = load(a.distance_m);
    // A slanted surface covers a range of distances within the margin.
    const MF occluded = hn::Gt(hn::Sub(distance, NearestAround(a, load, distance)),
                               hn::Set(d, a.occlusion_tolerance_m));
    counts.occluded += number(hn::And(seen, occluded));
    MF usable = hn::AndNot(occluded, seen);

    const Vector3 n{load(a.nx), load(a.ny), load(a.nz)};
    const VF before_plane = BeforePlane(a, n, p);
    const VF cosine = hn::Min(hn::Div(before_plane, distance), hn::Set(d, 1.0F));
    const VF celsius = load(a.celsius);
    const MF has_value = hn::Eq(celsius, celsius);
    const ImageVector slope{
        Slope(load, a.celsius - 1, a.celsius + 1),
        Slope(load, a.celsius - a.celsius_stride, a.celsius + a.celsius_stride)};

    const ImageVector speed = ImageSpeed(a, x, depth);
    const VF smear = hn::Mul(Dot(speed, speed), hn::Set(d, a.smear_s * a.smear_s));
    const MF sharp = hn::Le(smear, hn::Set(d, a.smear_max_px * a.smear_max_px));
    const MF still = hn::Le(smear, hn::Set(d, a.smear_good_px * a.smear_good_px));
    counts.smeared += number(hn::AndNot(sharp, usable));
    usable = hn::And(usable, sharp);
    // Inertia shows slope x smear too little or too much, and makes steep edges look even.
    const VF uncertainty = hn::Max(smear, hn::Set(d, a.uncertainty_px * a.uncertainty_px));
    const MF even =
        hn::Le(hn::Mul(uncertainty, Dot(slope, slope)), hn::Set(d, a.max_error_k * a.max_error_k));
    counts.steep += number(hn::AndNot(even, usable));
    usable = hn::And(usable, even);

    const MF assignable = hn::And(usable, hn::And(has_value, hn::Gt(cosine, zero)));
    const VI motion_class = hn::Add(hn::Add(hn::Set(di, kSmeared), Flag(sharp, 1)), Flag(still, 1));
    const VI classes = hn::Or(hn::ShiftLeft<ThermalLayout::kMotionShift>(motion_class),
                              DistanceAndAngle(a, distance, cosine));
    const VI sigma_code = hn::IfThenElseZero(
        hn::RebindMask(di, assignable), PackSigma(Variance(a, load, celsius, depth, slope, speed)));
    const VI flags = hn::Or(PackFlags(seen, assignable, cosine, sigma_code), classes);
    StoreRecords({{hn::IfThenElseZero(surface, depth), hn::IfThenElseZero(has_value, celsius),
                   hn::BitCast(d, PackSlopes(slope.u, slope.v)), hn::BitCast(d, flags)}},
                 load.count, pixels + x);
    const VI plane =
        hn::IfThenElseZero(hn::RebindMask(di, surface), PackPlane(a, n, depth, before_plane));
    StoreFirst(hn::BitCast(d, plane), load.count, reinterpret_cast<float*>(planes + x));
  }
  return counts;
}

}  // namespace isotherm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace isotherm {

HWY_EXPORT(ResampleRow);
HWY_EXPORT(DistanceRow);
HWY_EXPORT(MakePixelRow);

void ResampleRow(const ResampleRowArgs& args, float* out) {
  HWY_DYNAMIC_DISPATCH(ResampleRow)(args, out);
}

void DistanceRow(const float* vx, const float* vy, const float* vz, const float* position,
                 std::int32_t width, float* distance_m) {
  HWY_DYNAMIC_DISPATCH(DistanceRow)(vx, vy, vz, position, width, distance_m);
}

PixelRowCounts MakePixelRow(const PixelRowArgs& args, ThermalPixel* pixels, std::int32_t* planes) {
  return HWY_DYNAMIC_DISPATCH(MakePixelRow)(args, pixels, planes);
}

}  // namespace isotherm
#endif  // HWY_ONCE
