// The inner loops of thermal fusion in SIMD lanes. Compiled once per instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "ground/thermal/thermal_kernel.cc"
#include <hwy/foreach_target.h>  // Must come before highway.h.
//
#include <hwy/highway.h>

#include <limits>

#include "ground/thermal/thermal_kernel.h"
#include "ground/tsdf/voxel_kernel-inl.h"

HWY_BEFORE_NAMESPACE();
namespace isotherm::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::ScalableTag<float>;
using DI = hn::RebindToSigned<D>;
using VF = hn::Vec<D>;
using VI = hn::Vec<DI>;
using MF = hn::Mask<D>;
using MI = hn::Mask<DI>;

constexpr D d;
constexpr DI di;

// ThermalVoxel's layout.
constexpr float kMinCelsius = -100.0F;
constexpr float kStepsPerKelvin = 40.0F;
constexpr float kMaxCode = 65535.0F;

// ConditionClass.
constexpr std::int32_t kGood = 1;
constexpr std::int32_t kAcceptable = 2;

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
    const VF p00 = hn::GatherIndex(d, a.picture, upper);
    const VF p10 = hn::GatherIndex(d, a.picture + 1, upper);
    const VF p01 = hn::GatherIndex(d, a.picture, lower);
    const VF p11 = hn::GatherIndex(d, a.picture + 1, lower);
    const VF above = hn::MulAdd(fx, hn::Sub(p10, p00), p00);
    const VF below = hn::MulAdd(fx, hn::Sub(p11, p01), p01);
    const VF value = hn::IfThenElse(hn::RebindMask(d, inside),
                                    hn::MulAdd(fy, hn::Sub(below, above), above), none);
    StoreFirst(value, count, out + x);
  }
}

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

/// Square of the way that the surface goes in the picture while a row is smeared, pixels: the
/// derivative of the projection of a resting point (camera_motion.h).
HWY_INLINE VF SmearSquared(const PixelRowArgs& a, int first, VF depth) {
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
  const VF du = hn::Mul(hn::NegMulAdd(x, vz, vx), hn::Set(d, a.fx * a.smear_s));
  const VF dv = hn::Mul(hn::NegMulAdd(y, vz, vy), hn::Set(d, a.fy * a.smear_s));
  return hn::MulAdd(du, du, hn::Mul(dv, dv));
}

PixelRowCounts MakePixelRow(const PixelRowArgs& a, ThermalPixel* pixels) {
  const int lanes = static_cast<int>(hn::Lanes(d));
  const VF zero = hn::Zero(d);
  const VF one = hn::Set(d, 1.0F);
  const auto number = [](MF mask) { return static_cast<std::int64_t>(hn::CountTrue(d, mask)); };
  PixelRowCounts counts;
  for (int x = 0; x < a.width; x += lanes) {
    const auto count = static_cast<std::size_t>(a.width - x);
    const MF in_row = hn::FirstN(d, count);
    const bool whole = x + lanes <= a.width;
    const auto load = [&](const float* row) {
      return whole ? hn::LoadU(d, row + x) : LoadFirst(count, row + x);
    };
    const VF px = load(a.vx);
    const VF py = load(a.vy);
    const VF pz = load(a.vz);
    const VF depth =
        hn::MulAdd(hn::Set(d, a.z_axis[0]), px,
                   hn::MulAdd(hn::Set(d, a.z_axis[1]), py,
                              hn::MulAdd(hn::Set(d, a.z_axis[2]), pz, hn::Set(d, a.z_axis[3]))));
    const MF surface = hn::And(in_row, hn::Gt(depth, zero));  // False for NaN.

    // Seen by the depth camera's pyramid of view: what no depth frame covers may be hidden by
    // something that was never measured.
    const auto to_depth = [&](int row) {
      const float* R = a.R_depth + 3 * row;
      return hn::MulAdd(hn::Set(d, R[0]), px,
                        hn::MulAdd(hn::Set(d, R[1]), py,
                                   hn::MulAdd(hn::Set(d, R[2]), pz, hn::Set(d, a.t_depth[row]))));
    };
    const VF z = to_depth(2);
    const VF inverse_z = hn::Div(one, z);
    const VF u = hn::MulAdd(hn::Mul(to_depth(0), inverse_z), hn::Set(d, a.depth_fx),
                            hn::Set(d, a.depth_cx + 0.5F));
    const VF v = hn::MulAdd(hn::Mul(to_depth(1), inverse_z), hn::Set(d, a.depth_fy),
                            hn::Set(d, a.depth_cy + 0.5F));
    MF seen = hn::And(surface, hn::Gt(z, zero));
    seen = hn::And(seen, hn::And(hn::Ge(u, zero), hn::Lt(u, hn::Set(d, a.depth_width))));
    seen = hn::And(seen, hn::And(hn::Ge(v, zero), hn::Lt(v, hn::Set(d, a.depth_height))));

    const VF distance = load(a.distance_m);
    VF nearest = distance;
    for (int row = -a.margin; row <= a.margin; ++row) {
      for (int column = -a.margin; column <= a.margin; ++column) {
        nearest = hn::Min(nearest, load(a.distance_m + row * a.distance_stride + column));
      }
    }
    // A slanted surface covers a range of distances within the margin.
    const MF occluded = hn::Gt(hn::Sub(distance, nearest), hn::Set(d, a.occlusion_tolerance_m));
    counts.occluded += number(hn::And(seen, occluded));
    MF usable = hn::AndNot(occluded, seen);

    const VF to_camera_x = hn::Sub(hn::Set(d, a.position[0]), px);
    const VF to_camera_y = hn::Sub(hn::Set(d, a.position[1]), py);
    const VF to_camera_z = hn::Sub(hn::Set(d, a.position[2]), pz);
    const VF along =
        hn::MulAdd(load(a.nx), to_camera_x,
                   hn::MulAdd(load(a.ny), to_camera_y, hn::Mul(load(a.nz), to_camera_z)));
    const VF cosine = hn::Min(hn::Div(along, distance), one);
    const MF resolved = hn::Le(hn::Mul(distance, hn::Set(d, 1.0F / a.fx)),
                               hn::Mul(cosine, hn::Set(d, a.max_footprint_m)));
    const MF far_enough = hn::And(hn::Ge(distance, hn::Set(d, a.distance_min_m)), resolved);
    const VI distance_class =
        Classify(hn::And(far_enough, hn::Le(distance, hn::Set(d, a.distance_good_m))),
                 hn::And(far_enough, hn::Le(distance, hn::Set(d, a.distance_max_m))));
    const VI angle_class = Classify(hn::And(hn::Le(cosine, hn::Set(d, a.cosine_min_angle)),
                                            hn::Ge(cosine, hn::Set(d, a.cosine_good_angle))),
                                    hn::And(hn::Le(cosine, hn::Set(d, a.cosine_min_angle)),
                                            hn::Ge(cosine, hn::Set(d, a.cosine_max_angle))));

    const VF celsius = load(a.celsius);
    const MF has_value = hn::Eq(celsius, celsius);
    const auto slope = [&](const float* before, const float* after) {
      const VF half = hn::Mul(hn::Sub(load(after), load(before)), hn::Set(d, 0.5F));
      return hn::IfThenElseZero(hn::Eq(half, half), half);
    };
    const auto slope_code = [&](VF kelvin) {
      const VF limit = hn::Set(d, 32767.0F);
      const VF code = hn::Mul(kelvin, hn::Set(d, ThermalPixel::kSlopeScale));
      return hn::NearestInt(hn::Max(hn::Min(code, limit), hn::Neg(limit)));
    };
    const VF slope_u = slope(a.celsius - 1, a.celsius + 1);
    const VF slope_v = slope(a.celsius - a.celsius_stride, a.celsius + a.celsius_stride);

    const VF smear = SmearSquared(a, x, depth);
    const MF sharp = hn::Le(smear, hn::Set(d, a.smear_max_px * a.smear_max_px));
    const MF still = hn::Le(smear, hn::Set(d, a.smear_good_px * a.smear_good_px));
    counts.smeared += number(hn::AndNot(sharp, usable));
    usable = hn::And(usable, sharp);
    // Inertia shows slope x smear too little or too much, and makes steep edges look even.
    const VF uncertainty = hn::Max(smear, hn::Set(d, a.uncertainty_px * a.uncertainty_px));
    const MF even =
        hn::Le(hn::Mul(uncertainty, hn::MulAdd(slope_u, slope_u, hn::Mul(slope_v, slope_v))),
               hn::Set(d, a.max_error_k * a.max_error_k));
    counts.steep += number(hn::AndNot(even, usable));
    usable = hn::And(usable, even);

    const MF assignable = hn::And(usable, hn::And(has_value, hn::Gt(cosine, zero)));
    const auto flag = [&](MF condition, std::int32_t bit) {
      return hn::IfThenElseZero(hn::RebindMask(di, condition), hn::Set(di, bit));
    };
    const VI motion_class = hn::Add(hn::Add(hn::Set(di, 1), flag(sharp, 1)), flag(still, 1));
    const VI cosine_code = hn::NearestInt(
        hn::IfThenElseZero(hn::Gt(cosine, zero), hn::Mul(cosine, hn::Set(d, 255.0F))));
    const VI classes = hn::Or(hn::ShiftLeft<12>(motion_class),
                              hn::Or(hn::ShiftLeft<4>(distance_class), angle_class));
    const VI flags =
        hn::Or(hn::Or(flag(seen, ThermalPixel::kSeen), flag(assignable, ThermalPixel::kAssignable)),
               hn::Or(hn::ShiftLeft<ThermalPixel::kCosineShift>(cosine_code), classes));
    const VI slopes = hn::Or(hn::ShiftLeft<16>(slope_code(slope_v)),
                             hn::And(slope_code(slope_u), hn::Set(di, 0xFFFF)));
    StoreRecords({{hn::IfThenElseZero(surface, depth), hn::IfThenElseZero(has_value, celsius),
                   hn::BitCast(d, slopes), hn::BitCast(d, flags)}},
                 count, pixels + x);
  }
  return counts;
}

// ThermalVoxel's classes of one measurement: motion, distance and angle.
constexpr std::int32_t kConditionBits = 0xF0FF;

/// Neither distance nor angle is bad.
HWY_INLINE MI BothValid(VI classes) {
  return hn::And(hn::Ne(hn::And(classes, hn::Set(di, 0x0F)), hn::Zero(di)),
                 hn::Ne(hn::And(classes, hn::Set(di, 0xF0)), hn::Zero(di)));
}

/// Where a voxel's new temperature is no better than the one it has (algorithm 6).
HWY_INLINE MI KeepsOld(VI old_word, VI word) {
  // Smaller is better: distance, then angle, then motion (whose code grows the better it is).
  const auto order = [&](VI classes) {
    return hn::Sub(hn::ShiftLeft<4>(hn::And(classes, hn::Set(di, 0xFF))),
                   hn::And(hn::ShiftRight<12>(classes), hn::Set(di, 0xF)));
  };
  // A voxel never measured has no valid classes either.
  return hn::And(BothValid(old_word),
                 hn::Or(hn::Not(BothValid(word)), hn::Gt(order(word), order(old_word))));
}

/// Good in motion, distance and angle.
constexpr std::int32_t kAllGood = 0x3011;

void FuseBlock(const FusionKernelArgs& a, const float* first, const std::uint32_t* tsdf,
               std::uint32_t* thermal, FusionKernelCounts& counts, BlockMeasurements* measured) {
  const int lanes = static_cast<int>(hn::Lanes(d));
  const auto* distances = reinterpret_cast<const std::int32_t*>(tsdf);
  auto* temperatures = reinterpret_cast<std::int32_t*>(thermal);
  constexpr int kLayer = 64;
  HWY_ALIGN float along[3][kLayer];  // Of the layer's voxels from the layer's first.
  HWY_ALIGN std::int32_t pixels[hn::MaxLanes(d)];
  const VF zero = hn::Zero(d);
  const VF one = hn::Set(d, 1.0F);
  const VF half = hn::Set(d, 0.5F);
  const VI low_half = hn::Set(di, 0xFFFF);
  const VI max_code = hn::Set(di, a.max_tsdf_code + 1);
  const VF width = hn::Set(d, static_cast<float>(a.width));
  const VF height = hn::Set(d, static_cast<float>(a.height));
  const VI nowhere = hn::Set(di, a.width * a.height);
  const VF max_squared = hn::Set(d, a.max_distance_m * a.max_distance_m);
  for (int i = 0; i < kLayer; i += lanes) {
    const VI index = hn::Iota(di, i);
    const VF x = hn::ConvertTo(d, hn::And(index, hn::Set(di, 7)));
    const VF y = hn::ConvertTo(d, hn::ShiftRight<3>(index));
    for (int row = 0; row < 3; ++row) {
      const float* axis = a.axes + 3 * row;
      hn::Store(hn::MulAdd(hn::Set(d, axis[0]), x, hn::Mul(hn::Set(d, axis[1]), y)), d,
                along[row] + i);
    }
  }
  for (int i = 0; i < 512; i += lanes) {
    const VI word = hn::LoadU(di, distances + i);
    const MI near = hn::And(hn::Gt(hn::And(word, low_half), hn::Zero(di)),
                            hn::Lt(hn::Abs(hn::ShiftRight<16>(word)), max_code));
    if (hn::AllFalse(di, near)) continue;
    const auto layer = static_cast<float>(i / kLayer);
    const auto coordinate = [&](int row) {
      return hn::Add(hn::Load(d, along[row] + i % kLayer),
                     hn::Set(d, first[row] + layer * a.axes[3 * row + 2]));
    };
    const VF px = coordinate(0);
    const VF py = coordinate(1);
    const VF pz = coordinate(2);
    const VF inverse_z = Reciprocal(pz);
    const VF u = hn::MulAdd(hn::Mul(px, inverse_z), hn::Set(d, a.fx), hn::Set(d, a.cx));
    const VF v = hn::MulAdd(hn::Mul(py, inverse_z), hn::Set(d, a.fy), hn::Set(d, a.cy));
    const VF column = hn::Floor(hn::Add(u, half));
    const VF row = hn::Floor(hn::Add(v, half));
    const MF inside = hn::And(hn::And(hn::RebindMask(d, near), hn::Gt(pz, zero)),
                              hn::And(hn::And(hn::Ge(column, zero), hn::Lt(column, width)),
                                      hn::And(hn::Ge(row, zero), hn::Lt(row, height))));
    // Exact in single precision: pictures have far less than 2^24 pixels.
    const VI pixel = hn::ConvertTo(di, hn::MulAdd(row, width, column));
    hn::Store(hn::IfThenElse(hn::RebindMask(di, inside), pixel, nowhere), di, pixels);
    const RecordVectors record = GatherRecords(a.pixels, pixels);
    const VF depth = record.word[0];
    const VI flags = hn::BitCast(di, record.word[3]);

    // Distance between the voxel and the vertex that the pixel shows (algorithm 5).
    const VF ray_x = hn::Mul(hn::Sub(column, hn::Set(d, a.cx)), hn::Set(d, 1.0F / a.fx));
    const VF ray_y = hn::Mul(hn::Sub(row, hn::Set(d, a.cy)), hn::Set(d, 1.0F / a.fy));
    const VF dx = hn::NegMulAdd(ray_x, depth, px);
    const VF dy = hn::NegMulAdd(ray_y, depth, py);
    const VF dz = hn::Sub(pz, depth);
    const VF squared = hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz)));
    const auto has = [&](std::int32_t bit) {
      return hn::Ne(hn::And(flags, hn::Set(di, bit)), hn::Zero(di));
    };
    const MI on_surface = hn::And(hn::RebindMask(di, hn::And(inside, hn::Lt(squared, max_squared))),
                                  has(ThermalPixel::kSeen));
    const VI old = hn::LoadU(di, temperatures + i);
    const VI classes = hn::And(flags, hn::Set(di, kConditionBits));
    const MI assignable = hn::And(on_surface, has(ThermalPixel::kAssignable));
    MI assign = assignable;
    if (a.validate) assign = hn::AndNot(KeepsOld(old, classes), assign);
    counts.considered += static_cast<std::int64_t>(hn::CountTrue(di, on_surface));
    const MI good = hn::And(assignable, hn::Eq(classes, hn::Set(di, kAllGood)));
    if (hn::AllFalse(di, hn::Or(assign, good))) continue;
    // To first order between pixel centres.
    const VI slopes = hn::BitCast(di, record.word[2]);
    const VF slope_u = hn::ConvertTo(d, hn::ShiftRight<16>(hn::ShiftLeft<16>(slopes)));
    const VF slope_v = hn::ConvertTo(d, hn::ShiftRight<16>(slopes));
    const VF change = hn::MulAdd(slope_u, hn::Sub(u, column), hn::Mul(slope_v, hn::Sub(v, row)));
    const VF celsius =
        hn::MulAdd(change, hn::Set(d, 1.0F / ThermalPixel::kSlopeScale), record.word[1]);
    const VF code =
        hn::MulAdd(hn::Sub(celsius, hn::Set(d, kMinCelsius)), hn::Set(d, kStepsPerKelvin), one);
    VI stored = hn::NearestInt(hn::Min(hn::Max(code, one), hn::Set(d, kMaxCode)));
    if (!a.keep_bad) stored = hn::IfThenElseZero(BothValid(classes), stored);
    const VI fresh = hn::Or(hn::ShiftLeft<16>(stored), classes);
    if (a.keep_lowest) {
      const VI old_code = hn::And(hn::ShiftRight<16>(old), low_half);
      const MI was_good = hn::Eq(hn::And(old, hn::Set(di, kConditionBits)), hn::Set(di, kAllGood));
      assign = hn::AndNot(hn::And(hn::And(good, was_good), hn::Gt(stored, old_code)), assign);
    }
    const MI takes = hn::And(assign, hn::Gt(stored, hn::Zero(di)));
    counts.assigned += static_cast<std::int64_t>(hn::CountTrue(di, takes));
    const VI disagreement = hn::And(old, hn::Set(di, 0x0F00));
    hn::StoreU(hn::IfThenElse(assign, hn::Or(fresh, disagreement), old), di, temperatures + i);
    if (measured == nullptr) continue;
    const MI noted = hn::Or(takes, good);
    const VI index = hn::Or(hn::Iota(di, i),
                            hn::IfThenElseZero(takes, hn::Set(di, BlockMeasurements::kAssigned)));
    hn::CompressStore(fresh, noted, di, measured->words + measured->count);
    hn::CompressStore(flags, noted, di, measured->flags + measured->count);
    measured->count +=
        static_cast<int>(hn::CompressStore(index, noted, di, measured->voxels + measured->count));
  }
}

}  // namespace isotherm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace isotherm {

HWY_EXPORT(ResampleRow);
HWY_EXPORT(DistanceRow);
HWY_EXPORT(MakePixelRow);
HWY_EXPORT(FuseBlock);

void ResampleRow(const ResampleRowArgs& args, float* out) {
  HWY_DYNAMIC_DISPATCH(ResampleRow)(args, out);
}

void DistanceRow(const float* vx, const float* vy, const float* vz, const float* position,
                 std::int32_t width, float* distance_m) {
  HWY_DYNAMIC_DISPATCH(DistanceRow)(vx, vy, vz, position, width, distance_m);
}

PixelRowCounts MakePixelRow(const PixelRowArgs& args, ThermalPixel* pixels) {
  return HWY_DYNAMIC_DISPATCH(MakePixelRow)(args, pixels);
}

void FuseBlock(const FusionKernelArgs& args, const float* first, const std::uint32_t* tsdf,
               std::uint32_t* thermal, FusionKernelCounts& counts, BlockMeasurements* measured) {
  HWY_DYNAMIC_DISPATCH(FuseBlock)(args, first, tsdf, thermal, counts, measured);
}

}  // namespace isotherm
#endif  // HWY_ONCE
