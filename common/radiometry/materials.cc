#include "common/radiometry/materials.h"

#include <algorithm>

namespace isotherm {
namespace {

// Published values, interpolated linearly to these wavelengths; docs/materials.md has the full
// references.

constexpr IndexSample kAluminium[] = {
    {8.0, 17.71, 75.32}, {10.0, 25.83, 90.72}, {12.5, 35.49, 107.3}};
constexpr IndexSample kCopper[] = {{8.33, 6.43, 53.2}, {10.0, 8.31, 63.0}, {12.5, 11.4, 76.5}};
constexpr IndexSample kGold[] = {{8.0, 8.29, 56.2}, {10.0, 12.1, 69.2}, {12.5, 18.2, 84.7}};
constexpr IndexSample kIron[] = {{8.0, 6.166, 22.67}, {10.0, 7.069, 27.90}, {12.5, 8.347, 34.38}};
// n = kappa = sqrt(wavelength / (4 pi epsilon_0 c resistivity)), 72 micro-ohm cm.
constexpr IndexSample kStainless[] = {
    {8.0, 18.25, 18.25}, {10.0, 20.40, 20.40}, {12.5, 22.81, 22.81}};

constexpr IndexSample kAluminiumOxidised[] = {
    {8.0, 1.286, 0.035},  {8.5, 1.216, 0.051},  {9.0, 1.129, 0.078},  {9.5, 1.020, 0.124},
    {10.0, 0.882, 0.212}, {10.5, 0.731, 0.389}, {11.0, 0.660, 0.683}, {11.5, 0.740, 1.008},
    {12.0, 0.973, 1.293}, {12.5, 1.362, 1.439}, {13.0, 1.774, 1.304}};
constexpr IndexSample kAlumina[] = {
    {8.0, 1.345, 0.056},  {8.5, 1.257, 0.055},  {9.0, 1.161, 0.073},  {9.5, 1.037, 0.085},
    {10.0, 0.890, 0.094}, {10.5, 0.672, 0.118}, {11.0, 0.270, 0.249}, {11.5, 0.087, 0.723},
    {12.0, 0.078, 1.059}, {12.5, 0.082, 1.356}, {13.0, 0.080, 1.626}};
constexpr IndexSample kMagnetite[] = {
    {8.0, 3.574, 1.331},  {8.5, 3.584, 1.358},  {9.0, 3.590, 1.396},  {9.5, 3.592, 1.439},
    {10.0, 3.601, 1.479}, {10.5, 3.609, 1.516}, {11.0, 3.604, 1.555}, {11.5, 3.595, 1.596},
    {12.0, 3.573, 1.654}, {12.5, 3.554, 1.715}, {13.0, 3.521, 1.790}};
constexpr IndexSample kHematite[] = {
    {8.0, 2.409, 0.036},  {8.5, 2.367, 0.041},  {9.0, 2.322, 0.044},  {9.5, 2.268, 0.051},
    {10.0, 2.212, 0.056}, {10.5, 2.144, 0.066}, {11.0, 2.080, 0.079}, {11.5, 1.998, 0.077},
    {12.0, 1.901, 0.084}, {12.5, 1.786, 0.097}, {13.0, 1.649, 0.112}};

constexpr IndexSample kGlass[] = {{8.0, 0.939, 0.028},  {8.5, 0.613, 0.354},  {9.0, 0.736, 0.759},
                                  {9.5, 1.085, 1.187},  {10.0, 1.707, 1.123}, {10.5, 1.956, 0.809},
                                  {11.0, 1.994, 0.485}, {11.5, 1.864, 0.286}, {12.0, 1.733, 0.222},
                                  {12.5, 1.612, 0.244}, {13.0, 1.606, 0.306}};
constexpr IndexSample kSilica[] = {{8.0, 0.387, 0.334},  {8.5, 0.459, 0.930},  {9.0, 0.701, 2.280},
                                   {9.5, 2.680, 1.674},  {10.0, 2.551, 0.393}, {10.5, 2.125, 0.230},
                                   {11.0, 1.951, 0.168}, {11.5, 1.781, 0.167}, {12.0, 1.702, 0.299},
                                   {12.5, 1.817, 0.372}, {13.0, 1.913, 0.267}};
constexpr IndexSample kWater[] = {{8.0, 1.291, 0.034},  {8.5, 1.278, 0.037},  {9.0, 1.262, 0.040},
                                  {9.5, 1.243, 0.044},  {10.0, 1.218, 0.051}, {10.5, 1.185, 0.066},
                                  {11.0, 1.153, 0.097}, {11.5, 1.126, 0.142}, {12.0, 1.111, 0.199},
                                  {12.5, 1.123, 0.259}, {13.0, 1.146, 0.305}};
constexpr IndexSample kAcrylic[] = {
    {8.0, 1.402, 0.136},  {8.5, 1.454, 0.197},  {9.0, 1.635, 0.052},  {9.5, 1.569, 0.021},
    {10.0, 1.497, 0.040}, {10.5, 1.551, 0.035}, {11.0, 1.530, 0.025}, {11.5, 1.514, 0.014},
    {12.0, 1.529, 0.026}, {12.5, 1.522, 0.012}, {13.0, 1.504, 0.019}};
constexpr IndexSample kDielectric[] = {{10.0, 1.5, 0.0}};

constexpr OpticalMaterial kMaterials[] = {
    {"aluminium", "bare and smooth; a natural oxide film does not show", "Ordal 1988", kAluminium},
    {"copper", "bare and smooth", "Ordal 1985", kCopper},
    {"gold", "bare and smooth", "Ordal 1987", kGold},
    {"iron", "bare iron and carbon steel, smooth", "Ordal 1988", kIron},
    {"stainless", "austenitic (AISI 304), smooth", "Hagen-Rubens, 72 uohm cm", kStainless},
    {"aluminium-oxidised", "amorphous oxide, opaque from about 20 um (anodised)", "Kischkat 2012",
     kAluminiumOxidised},
    {"alumina", "dense ceramic, as sapphire (ordinary ray)", "Querry 1985", kAlumina},
    {"steel-oxidised", "mill scale, as magnetite", "Querry 1985", kMagnetite},
    {"rust", "as hematite (ordinary ray), thick", "Querry 1985", kHematite},
    {"glass", "window glass, soda lime", "Rubin 1985", kGlass},
    {"silica", "fused quartz", "Kitamura 2007", kSilica},
    {"water", "clean, smooth", "Hale 1973", kWater},
    {"acrylic", "PMMA; also clear coats and binders, from about 0.2 mm", "Zhang 2020", kAcrylic},
    {"paint", "glossy paint, varnish, most plastics: n = 1.5", "assumed", kDielectric},
    {"plaster", "n = 1.5; rough surfaces hold their emissivity to larger angles", "assumed",
     kDielectric},
    {"firebrick", "n = 1.5; rough surfaces hold their emissivity to larger angles", "assumed",
     kDielectric},
};

}  // namespace

std::span<const OpticalMaterial> OpticalMaterials() { return kMaterials; }

const OpticalMaterial* FindOpticalMaterial(std::string_view name) {
  const auto* found = std::ranges::find(kMaterials, name, &OpticalMaterial::name);
  return found == std::end(kMaterials) ? nullptr : found;
}

}  // namespace isotherm
