// Temperatures for the voxels of a block in SIMD lanes. Compiled once per instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "ground/thermal/fuse_block_kernel.cc"
#include "common/simd/kernel_prelude-inl.h"  // Before everything else.

#include "common/simd/packing-inl.h"
#include "ground/surface/block_layout.h"
#include "ground/thermal/thermal_kernel.h"
#include "ground/thermal/voxel_layout.h"
#include "ground/tsdf/voxel_kernel-inl.h"
#include "ground/tsdf/voxel_layout.h"

HWY_BEFORE_NAMESPACE();
namespace isotherm::HWY_NAMESPACE {

/// Neither distance nor angle is bad.
HWY_INLINE MI BothValid(VI classes) {
  return hn::And(hn::Ne(hn::And(classes, hn::Set(di, ThermalLayout::kAngleMask)), hn::Zero(di)),
                 hn::Ne(hn::And(classes, hn::Set(di, ThermalLayout::kDistanceMask)), hn::Zero(di)));
}

/// Where a voxel's new temperature is no better than the one it has (algorithm 6). Where the
/// classes are equal, `known_better` says so.
HWY_INLINE MI KeepsOld(VI old_word, VI word, MI known_better) {
  // Smaller is better: distance, then angle, then motion (whose code grows the better it is).
  const auto order = [&](VI classes) {
    constexpr std::uint32_t kDistanceAndAngle =
        ThermalLayout::kDistanceMask | ThermalLayout::kAngleMask;
    return hn::Sub(
        hn::ShiftLeft<ThermalLayout::kClassBits>(hn::And(classes, hn::Set(di, kDistanceAndAngle))),
        hn::And(hn::ShiftRight<ThermalLayout::kMotionShift>(classes),
                hn::Set(di, ThermalLayout::kClassMask)));
  };
  const VI new_order = order(word);
  const VI old_order = order(old_word);
  const MI worse =
      hn::Or(hn::Gt(new_order, old_order), hn::And(hn::Eq(new_order, old_order), known_better));
  // A voxel never measured has no valid classes either.
  return hn::And(BothValid(old_word), hn::Or(hn::Not(BothValid(word)), worse));
}

/// The temperatures of voxels, as ThermalLayout's codes.
HWY_INLINE VI OldTemperature(VI old_word) {
  return hn::And(hn::ShiftRight<ThermalLayout::kCodeShift>(old_word),
                 hn::Set(di, ThermalLayout::kCodeMask));
}

/// SigmaCodes of the temperatures of the lanes that begin at voxel `i`; 0 = not known.
HWY_INLINE VI OldSigmas(const BlockSigmas& sigmas, int i) {
  constexpr int kRow = BlockSigmas::kRowVoxels;
  const hn::Rebind<std::uint8_t, DI> bytes;
  const int lanes = static_cast<int>(hn::Lanes(di));
  HWY_ALIGN std::uint8_t codes[hn::MaxLanes(di) + kRow];
  for (int lane = 0; lane < lanes; lane += kRow) {
    const std::uint8_t* row = sigmas.rows[static_cast<std::size_t>((i + lane) / kRow)];
    if (row != nullptr) {
      std::memcpy(codes + lane, row, kRow);
    } else {
      std::memset(codes + lane, 0, kRow);
    }
  }
  // Vectors shorter than a row begin within it.
  return hn::PromoteTo(di, hn::LoadU(bytes, codes + i % kRow));
}

/// Kelvin of SigmaCodes other than 0.
HWY_INLINE VF SigmaKelvin(VI code) {
  const VI bits = hn::Add(code, hn::Set(di, static_cast<std::int32_t>(SigmaCode::kBias)));
  return hn::BitCast(d, hn::ShiftLeft<SigmaCode::kShift>(bits));
}

/// Where the temperature that a voxel has is known better than its new one, `temperature`, and the
/// two agree: where they do not, one of them is wrong, whatever its uncertainty, or the surface has
/// changed, and the new one is as good as any.
HWY_INLINE MI IsKnownBetter(const BlockSigmas& sigmas, int i, VI flags, VI old_word,
                            VI temperature) {
  const VI old_code = OldSigmas(sigmas, i);
  const VI code = hn::And(hn::ShiftRight<ThermalPixel::kSigmaShift>(flags), hn::Set(di, 0xFF));
  const VF difference = hn::Mul(
      hn::ConvertTo(d, hn::Sub(temperature, OldTemperature(old_word))),
      hn::Set(d, 1.0F / (SigmaCode::kAgree * static_cast<float>(ThermalLayout::kStepsPerKelvin))));
  const VF old_sigma = SigmaKelvin(old_code);
  const VF sigma = SigmaKelvin(code);
  const VF variance = hn::MulAdd(sigma, sigma, hn::Mul(old_sigma, old_sigma));
  const MF agree = hn::Le(hn::Mul(difference, difference), variance);
  const MI better = hn::And(hn::Gt(old_code, hn::Zero(di)), hn::Gt(code, old_code));
  return hn::And(better, hn::RebindMask(di, agree));
}

/// Where a voxel was measured under good conditions, and lower than now.
HWY_INLINE MI OldIsLower(VI old_word, VI code) {
  const VI old_classes = hn::And(old_word, hn::Set(di, ThermalLayout::kConditionMask));
  return hn::And(hn::Eq(old_classes, hn::Set(di, kAllGood)),
                 hn::Gt(code, OldTemperature(old_word)));
}

/// Observed voxels whose distance is below `max_code` on either side of the surface.
HWY_INLINE MI NearSurface(VI tsdf_word, VI max_code) {
  const VI weight = hn::And(tsdf_word, hn::Set(di, TsdfLayout::kWeightMask));
  const VI tsdf_code = hn::ShiftRight<TsdfLayout::kTsdfShift>(tsdf_word);
  return hn::And(hn::Gt(weight, hn::Zero(di)), hn::Lt(hn::Abs(tsdf_code), max_code));
}

/// Where voxels are in the thermal image.
struct ImagePlace {
  VF u, v;         ///< Pixels.
  VF column, row;  ///< Place of the nearest pixel.
};

HWY_INLINE ImagePlace ProjectVoxels(const FusionKernelArgs& a, const Vector3& p) {
  const VF half = hn::Set(d, 0.5F);
  const VF inverse_z = Reciprocal(p.z);
  ImagePlace place;
  place.u = hn::MulAdd(hn::Mul(p.x, inverse_z), hn::Set(d, a.fx), hn::Set(d, a.cx));
  place.v = hn::MulAdd(hn::Mul(p.y, inverse_z), hn::Set(d, a.fy), hn::Set(d, a.cy));
  place.column = hn::Floor(hn::Add(place.u, half));
  place.row = hn::Floor(hn::Add(place.v, half));
  return place;
}

/// The voxels of `candidates` that lie before the camera and within its image.
HWY_INLINE MF InImage(const FusionKernelArgs& a, MF candidates, const Vector3& p,
                      const ImagePlace& place) {
  const VF zero = hn::Zero(d);
  const auto within = [&](VF pixel, std::int32_t size) {
    return hn::And(hn::Ge(pixel, zero), hn::Lt(pixel, hn::Set(d, static_cast<float>(size))));
  };
  return hn::And(hn::And(candidates, hn::Gt(p.z, zero)),
                 hn::And(within(place.column, a.width), within(place.row, a.height)));
}

/// Where voxels lie within max_distance_m of their pixels' surfaces, along the line of sight. A
/// plane stands for the surface (PixelPlane), so that neither the size of a pixel nor the angle at
/// which it is seen is taken for a distance from it, as it is with the vertex at the pixel's centre
/// alone (algorithm 5). With s = 1 + u du + v dv, the line of sight to voxel p meets the plane at
/// depth / s p.z of the way: |p| |1 - depth / (s p.z)| is the distance.
HWY_INLINE MF OnSurface(const FusionKernelArgs& a, const Vector3& p, const ImagePlace& place,
                        VF depth, VI plane) {
  constexpr int kVShift = PixelPlane::kVShift;
  const VF per_u = hn::ConvertTo(d, hn::ShiftRight<kVShift>(hn::ShiftLeft<kVShift>(plane)));
  const VF per_v = hn::ConvertTo(d, hn::ShiftRight<kVShift>(plane));
  const VF change = hn::MulAdd(per_u, hn::Sub(place.u, place.column),
                               hn::Mul(per_v, hn::Sub(place.v, place.row)));
  const VF s = hn::MulAdd(change, hn::Set(d, 1.0F / PixelPlane::kScale), hn::Set(d, 1.0F));
  const VF scaled_z = hn::Mul(s, p.z);
  const VF off = hn::Sub(scaled_z, depth);
  const VF squared = hn::MulAdd(p.x, p.x, hn::MulAdd(p.y, p.y, hn::Mul(p.z, p.z)));
  const VF limit = hn::Mul(scaled_z, hn::Set(d, a.max_distance_m));
  return hn::Lt(hn::Mul(hn::Mul(off, off), squared), hn::Mul(limit, limit));
}

/// The temperature at a place, as ThermalLayout's code: to first order between pixel centres.
HWY_INLINE VI TemperatureCode(const RecordVectors& record, const ImagePlace& place) {
  constexpr int kSlopeVShift = ThermalPixel::kSlopeVShift;
  const VF one = hn::Set(d, 1.0F);
  const VI slopes = hn::BitCast(di, record.word[2]);
  const VF slope_u =
      hn::ConvertTo(d, hn::ShiftRight<kSlopeVShift>(hn::ShiftLeft<kSlopeVShift>(slopes)));
  const VF slope_v = hn::ConvertTo(d, hn::ShiftRight<kSlopeVShift>(slopes));
  const VF change = hn::MulAdd(slope_u, hn::Sub(place.u, place.column),
                               hn::Mul(slope_v, hn::Sub(place.v, place.row)));
  const VF celsius =
      hn::MulAdd(change, hn::Set(d, 1.0F / ThermalPixel::kSlopeScale), record.word[1]);
  const VF code = hn::MulAdd(hn::Sub(celsius, hn::Set(d, ThermalLayout::kMin_celsius)),
                             hn::Set(d, ThermalLayout::kStepsPerKelvin), one);
  return hn::NearestInt(hn::Min(hn::Max(code, one), hn::Set(d, ThermalLayout::kMaxCode)));
}

/// Appends the lanes of `noted` to what was measured; `i` is the first lane's voxel.
HWY_INLINE void Note(int i, VI fresh, VI flags, MI noted, MI takes, BlockMeasurements& measured) {
  const VI index =
      hn::Or(CountFrom(i), hn::IfThenElseZero(takes, hn::Set(di, BlockMeasurements::kAssigned)));
  const Packing<DI> packing(noted);
  packing.Store(fresh, measured.words + measured.count);
  packing.Store(flags, measured.flags + measured.count);
  packing.Store(index, measured.voxels + measured.count);
  measured.count += packing.count();
}

// Gives the voxels near the surface the temperatures of the pixels they are seen in. A voxel takes
// part if it lies within max_distance_m of the surface that its pixel shows (algorithm 5, with the
// plane through the vertex), and takes the temperature unless the one it has was measured under
// better conditions (algorithm 6), is less uncertain under equal ones and agrees, or, with
// keep_lowest, is lower under conditions as good. Rows: lanes are neighbours along x, then y, of a
// layer; words are TsdfLayout's and ThermalLayout's of the same 512 voxels, pixels ThermalPixel,
// sigmas bytes in rows of 8 voxels. Fast: most vectors have no voxel near the surface and end at
// their first load; a pixel is one load of 16 bytes and a word; what was measured is written
// packed, so that the slow part (MeasurementRecorder) meets these voxels only.
void FuseBlock(const FusionKernelArgs& a, const BlockVoxels& block, FusionKernelCounts& counts,
               BlockMeasurements* measured) {
  const int lanes = static_cast<int>(hn::Lanes(d));
  constexpr int kLayer = BlockLayout::kLayerVoxels;
  const auto* distances = reinterpret_cast<const std::int32_t*>(block.tsdf);
  auto* temperatures = reinterpret_cast<std::int32_t*>(block.thermal);
  const BlockPoints points(a.axes, block.first);
  HWY_ALIGN std::int32_t pixels[hn::MaxLanes(d)];
  const VI conditions = hn::Set(di, ThermalLayout::kConditionMask);
  const VI all_good = hn::Set(di, kAllGood);
  const VI max_code = hn::Set(di, a.max_tsdf_code + 1);
  const VF width = hn::Set(d, static_cast<float>(a.width));
  const VI nowhere = hn::Set(di, a.width * a.height);
  for (int i = 0; i < kBlockVoxels; i += lanes) {
    const VI word = hn::LoadU(di, distances + i);
    const MI near = NearSurface(word, max_code);
    if (hn::AllFalse(di, near)) continue;
    const Vector3 p = points.At(points.Origin(i / kLayer), i % kLayer);
    const ImagePlace place = ProjectVoxels(a, p);
    const MF inside = InImage(a, hn::RebindMask(d, near), p, place);
    // Exact in single precision: images have far less than 2^24 pixels.
    const VI in_image = hn::ConvertTo(di, hn::MulAdd(place.row, width, place.column));
    const VI pixel = hn::IfThenElse(hn::RebindMask(di, inside), in_image, nowhere);
    hn::Store(pixel, di, pixels);
    const RecordVectors record = GatherRecords(a.pixels, pixels);
    const VI flags = hn::BitCast(di, record.word[3]);
    const VI plane = hn::GatherIndex(di, a.planes, pixel);
    const auto has = [&](std::int32_t bit) {
      return hn::Ne(hn::And(flags, hn::Set(di, bit)), hn::Zero(di));
    };
    const MF near_plane = OnSurface(a, p, place, record.word[0], plane);
    const MI on_surface =
        hn::And(hn::RebindMask(di, hn::And(inside, near_plane)), has(ThermalPixel::kSeen));
    const VI old = hn::LoadU(di, temperatures + i);
    const VI classes = hn::And(flags, conditions);
    const MI assignable = hn::And(on_surface, has(ThermalPixel::kAssignable));
    counts.considered += static_cast<std::int64_t>(hn::CountTrue(di, on_surface));
    if (hn::AllFalse(di, assignable)) continue;
    MI assign = assignable;
    const MI good = hn::And(assignable, hn::Eq(classes, all_good));
    VI stored = TemperatureCode(record, place);
    if (a.validate) {
      MI known_better = IsKnownBetter(block.sigmas, i, flags, old, stored);
      if (a.keep_lowest) known_better = hn::AndNot(good, known_better);
      assign = hn::AndNot(KeepsOld(old, classes, known_better), assign);
    }
    if (hn::AllFalse(di, hn::Or(assign, good))) continue;
    if (!a.keep_bad) stored = hn::IfThenElseZero(BothValid(classes), stored);
    const VI fresh = hn::Or(hn::ShiftLeft<ThermalLayout::kCodeShift>(stored), classes);
    if (a.keep_lowest) assign = hn::AndNot(hn::And(good, OldIsLower(old, stored)), assign);
    const MI takes = hn::And(assign, hn::Gt(stored, hn::Zero(di)));
    counts.assigned += static_cast<std::int64_t>(hn::CountTrue(di, takes));
    const VI disagreement = hn::And(old, hn::Set(di, ThermalLayout::kDisagreementMask));
    hn::StoreU(hn::IfThenElse(assign, hn::Or(fresh, disagreement), old), di, temperatures + i);
    if (measured != nullptr) Note(i, fresh, flags, hn::Or(takes, good), takes, *measured);
  }
}

}  // namespace isotherm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace isotherm {

HWY_EXPORT(FuseBlock);

void FuseBlock(const FusionKernelArgs& args, const BlockVoxels& block, FusionKernelCounts& counts,
               BlockMeasurements* measured) {
  HWY_DYNAMIC_DISPATCH(FuseBlock)(args, block, counts, measured);
}

}  // namespace isotherm
#endif  // HWY_ONCE
