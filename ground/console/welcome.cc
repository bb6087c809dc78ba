#include "ground/console/welcome.h"

#include "common/base/units.h"
#include "common/radiometry/materials.h"
#include "common/radiometry/radiometry.h"
#include "ground/renderer/palette.h"

namespace isotherm {
namespace {

constexpr int kColours = 256;
constexpr double kRadianceStep_k = 2.0;
/// Emissivity hardly depends on a solid's temperature: that of the band at a common one.
constexpr double kMaterial_celsius = 50.0;

void AddPalettes(live::Welcome& welcome) {
  for (int value = Palette_MIN; value <= Palette_MAX; ++value) {
    if (!Palette_IsValid(value)) continue;
    live::PaletteTable& table = *welcome.add_palettes();
    table.set_name(PaletteName(static_cast<Palette>(value)));
    for (int i = 0; i < kColours; ++i) {
      const Rgb8 colour =
          PaletteColour(static_cast<Palette>(value), static_cast<double>(i) / (kColours - 1));
      for (const std::uint8_t channel : {colour.r, colour.g, colour.b})
        table.mutable_colours()->push_back(static_cast<char>(channel));
    }
  }
}

void AddRadiance(const SpectralBand& spectral_band, live::Welcome& welcome) {
  const BandRadiance band(spectral_band);
  live::RadianceTable& table = *welcome.mutable_radiance();
  table.set_min_celsius(kMinRadiometric_celsius);
  table.set_max_celsius(kMaxRadiometric_celsius);
  for (double celsius = kMinRadiometric_celsius; celsius <= kMaxRadiometric_celsius;
       celsius += kRadianceStep_k)
    table.add_radiance(static_cast<float>(band.RadianceFromCelsius(celsius)));
}

void AddMaterials(const SpectralBand& band, live::Welcome& welcome) {
  constexpr int kRightAngle_deg = 90;
  for (const OpticalMaterial& material : OpticalMaterials()) {
    const BandEmissivity emissivity(material.index, band, kMaterial_celsius);
    live::MaterialTable& table = *welcome.add_materials();
    table.set_name(std::string(material.name));
    table.set_emissivity(emissivity.At(0.0));
    for (int degree = 0; degree <= kRightAngle_deg; ++degree) {
      table.add_by_angle(
          static_cast<float>(emissivity.At(degree * kRadPerDeg) / emissivity.At(0.0)));
    }
  }
}

}  // namespace

live::Welcome MakeWelcome(const GroundOptions& options) {
  live::Welcome welcome;
  welcome.set_software_version(ISOTHERM_VERSION);
  const auto& expert = options.interpretation().expert();
  const SpectralBand band{.min_um = expert.band_min_um(), .max_um = expert.band_max_um()};
  AddPalettes(welcome);
  AddRadiance(band, welcome);
  AddMaterials(band, welcome);
  return welcome;
}

}  // namespace isotherm
