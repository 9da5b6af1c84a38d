#include "src/materials/named_spectra.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>

#include "src/base/numerics.h"

namespace dapple {
namespace {

constexpr double kHcInEvNm = 1239.841984;

/// Index of refraction n and extinction coefficient k.
struct ComplexIndex {
  double n, k;
};

/// Palik 1985, "Handbook of optical constants of solids", at 0.1 eV steps: Ag, Au, Cu (Lynch and Hunter), Al (Smith,
/// Shiles, Inokuti).
struct MetalRow {
  double electronVolts;
  ComplexIndex ag, al, au, cu;
};
constexpr MetalRow kMetals[] = {
    {1.4, {0.163, 5.95}, {2.24, 8.21}, {0.210, 5.88}, {0.30, 5.717}},
    {1.5, {0.145, 5.50}, {2.74, 8.31}, {0.188, 5.39}, {0.26, 5.26}},
    {1.6, {0.143, 5.09}, {2.63, 8.60}, {0.176, 4.86}, {0.25, 4.817}},
    {1.7, {0.148, 4.74}, {2.14, 8.57}, {0.164, 4.357}, {0.223, 4.43}},
    {1.8, {0.140, 4.44}, {1.74, 8.21}, {0.160, 3.80}, {0.213, 4.05}},
    {1.9, {0.140, 4.15}, {1.49, 7.82}, {0.166, 3.15}, {0.214, 3.67}},
    {2.0, {0.131, 3.88}, {1.30, 7.48}, {0.194, 3.06}, {0.272, 3.24}},
    {2.1, {0.121, 3.66}, {1.15, 7.15}, {0.236, 2.97}, {0.468, 2.809}},
    {2.2, {0.120, 3.45}, {1.02, 6.85}, {0.306, 2.88}, {0.826, 2.599}},
    {2.3, {0.129, 3.25}, {0.912, 6.55}, {0.402, 2.54}, {1.04, 2.583}},
    {2.4, {0.130, 3.07}, {0.826, 6.28}, {0.608, 2.12}, {1.12, 2.605}},
    {2.5, {0.130, 2.88}, {0.755, 6.03}, {0.916, 1.84}, {1.135, 2.564}},
    {2.6, {0.132, 2.72}, {0.695, 5.80}, {1.242, 1.796}, {1.15, 2.504}},
    {2.7, {0.144, 2.56}, {0.644, 5.58}, {1.426, 1.846}, {1.16, 2.433}},
    {2.8, {0.157, 2.40}, {0.598, 5.38}, {1.562, 1.904}, {1.17, 2.362}},
    {2.9, {0.160, 2.26}, {0.558, 5.20}, {1.616, 1.940}, {1.175, 2.289}},
    {3.0, {0.173, 2.11}, {0.523, 5.02}, {1.636, 1.958}, {1.18, 2.21}},
    {3.1, {0.173, 1.95}, {0.490, 4.86}, {1.658, 1.956}, {1.175, 2.13}},
    {3.2, {0.192, 1.81}, {0.460, 4.71}, {1.674, 1.936}, {1.18, 2.21}},
    {3.3, {0.200, 1.67}, {0.432, 4.56}, {1.696, 1.906}, {1.225, 2.015}},
    {3.4, {0.186, 1.61}, {0.407, 4.43}, {1.716, 1.862}, {1.27, 1.95}},
    {3.5, {0.209, 1.44}, {0.385, 4.30}, {1.740, 1.848}, {1.29, 1.916}},
    {3.6, {0.238, 1.24}, {0.364, 4.17}, {1.766, 1.846}, {1.31, 1.872}},
};

/// Between the rows another one, on the cubic through their four neighbours, and straight lines between those: so pbrt
/// has it, and n of copper bends so much that another interpolation would change its red by some percent.
Spectrum Metal(ComplexIndex MetalRow::*metal, double ComplexIndex::*part) {
  constexpr int kLast = static_cast<int>(std::size(kMetals)) - 1;
  const auto value = [&](int row) { return kMetals[std::clamp(row, 0, kLast)].*metal.*part; };
  std::vector<double> wavelengths, values;
  for (int row = 0; row <= kLast; ++row) {
    wavelengths.push_back(kHcInEvNm / kMetals[row].electronVolts);
    values.push_back(value(row));
    if (row == kLast) break;
    wavelengths.push_back(kHcInEvNm / (kMetals[row].electronVolts + 0.05));
    values.push_back((9 * (value(row) + value(row + 1)) - value(row - 1) - value(row + 2)) / 16);
  }
  return {wavelengths, values, Spectrum::Outside::kConstant};
}

/// Brass of 70 % copper and 30 % zinc, from 360 to 700 nm at 10 nm steps (Querry 1985, "Optical constants").
constexpr ComplexIndex kBrass[] = {
    {1.503, 1.815}, {1.497, 1.818}, {1.487, 1.818}, {1.471, 1.813}, {1.445, 1.805}, {1.405, 1.794}, {1.350, 1.786},
    {1.278, 1.784}, {1.191, 1.797}, {1.094, 1.829}, {0.994, 1.883}, {0.900, 1.957}, {0.816, 2.046}, {0.745, 2.145},
    {0.686, 2.250}, {0.639, 2.358}, {0.602, 2.464}, {0.573, 2.568}, {0.549, 2.668}, {0.527, 2.765}, {0.505, 2.860},
    {0.484, 2.958}, {0.468, 3.059}, {0.460, 3.159}, {0.450, 3.253}, {0.452, 3.345}, {0.449, 3.434}, {0.445, 3.522},
    {0.444, 3.609}, {0.444, 3.695}, {0.445, 3.778}, {0.444, 3.860}, {0.444, 3.943}, {0.445, 4.025}, {0.446, 4.106}};

Spectrum Brass(double ComplexIndex::*part) {
  std::vector<double> wavelengths, values;
  for (const ComplexIndex& row : kBrass) {
    wavelengths.push_back(360 + 10 * static_cast<double>(wavelengths.size()));
    values.push_back(row.*part);
  }
  return {wavelengths, values, Spectrum::Outside::kConstant};
}

/// n^2 = a + sum of b w^2 / (w^2 - c), w in micrometres; a is 1 in Sellmeier's formula.
struct Dispersion {
  double a;
  std::array<double, 3> b, c;

  double operator()(double nm) const {
    const double w2 = Sqr(nm / 1000);
    double n2 = a;
    for (size_t i = 0; i < 3; ++i) n2 += b[i] * w2 / (w2 - c[i]);
    return std::sqrt(n2);
  }
};

/// Of Schott's data sheets (2000s; the SF ones are those of the lead-free N-SF glasses).
struct Glass {
  const char* name;
  Dispersion dispersion;
};
constexpr Glass kGlasses[] = {
    {"glass-BK7", {1, {1.03961212, 0.231792344, 1.01046945}, {0.00600069867, 0.0200179144, 103.560653}}},
    {"glass-BAF10", {1, {1.5851495, 0.143559385, 1.08521269}, {0.00926681282, 0.0424489805, 105.613573}}},
    {"glass-FK51A", {1, {0.971247817, 0.216901417, 0.904651666}, {0.00472301995, 0.0153575612, 168.68133}}},
    {"glass-LASF9", {1, {2.00029547, 0.298926886, 1.80691843}, {0.0121426017, 0.0538736236, 156.530829}}},
    {"glass-SF5", {1, {1.52481889, 0.187085527, 1.42729015}, {0.011254756, 0.0588995392, 129.141675}}},
    {"glass-SF10", {1, {1.62153902, 0.256287842, 1.64447552}, {0.0122241457, 0.0595736775, 147.468793}}},
    {"glass-SF11", {1, {1.73759695, 0.313747346, 1.89878101}, {0.013188707, 0.0623068142, 155.23629}}},
};

/// Stephens and Malitson 1952.
constexpr Dispersion kMagnesiumOxide = {
    1, {1.111033, 0.8460085, 7.808527}, {Sqr(0.0712465), Sqr(0.1375204), Sqr(26.89302)}};
/// Rutile, extraordinary ray: n^2 = 7.197 + 0.3322 / (w^2 - 0.0843) (DeVore 1951), in the form above.
constexpr Dispersion kTitaniumDioxide = {7.197 - 0.3322 / 0.0843, {0.3322 / 0.0843, 0, 0}, {0.0843, 0, 0}};

struct Entry {
  std::string name;
  std::function<Spectrum()> make;
};

void AddMetals(std::vector<Entry>* entries) {
  const auto add = [&](const std::string& metal, auto n, auto k) {
    entries->push_back({"metal-" + metal + "-eta", n});
    entries->push_back({"metal-" + metal + "-k", k});
  };
  const auto addTable = [&](const std::string& name, ComplexIndex MetalRow::*metal) {
    add(
        name, [metal] { return Metal(metal, &ComplexIndex::n); }, [metal] { return Metal(metal, &ComplexIndex::k); });
  };
  const auto transparent = [] { return Spectrum::Sampled([](double) { return 0.; }); };
  addTable("Ag", &MetalRow::ag);
  addTable("Al", &MetalRow::al);
  addTable("Au", &MetalRow::au);
  addTable("Cu", &MetalRow::cu);
  add(
      "CuZn", [] { return Brass(&ComplexIndex::n); }, [] { return Brass(&ComplexIndex::k); });
  add(
      "MgO", [] { return Spectrum::Sampled(kMagnesiumOxide); }, transparent);
  add(
      "TiO2", [] { return Spectrum::Sampled(kTitaniumDioxide); }, transparent);
}

void AddGlasses(std::vector<Entry>* entries) {
  for (const Glass& glass : kGlasses) {
    const auto make = [&glass] { return Spectrum::Sampled(glass.dispersion); };
    const std::string name = glass.name;
    entries->push_back({name, make});
    if (name.starts_with("glass-SF"))
      entries->push_back({"glass-F" + name.substr(std::string("glass-SF").size()), make});
  }
}

void AddIlluminants(std::vector<Entry>* entries) {
  constexpr double kScaleChange = 1.4388 / 1.4380;  // of the temperature scale since the illuminants got their names
  const auto addDaylight = [&](const std::string& name, double kelvin) {
    entries->push_back({name, [kelvin] { return Spectrum::Sampled(Daylight::OfTemperature(kelvin)); }});
  };
  entries->push_back({"stdillum-A", [] { return Spectrum::Sampled(IlluminantA); }});
  addDaylight("stdillum-D50", 5000 * kScaleChange);
  addDaylight("stdillum-D65", 6500 * kScaleChange);
  for (int lamp = 1; lamp <= 12; ++lamp) {
    entries->push_back({"stdillum-F" + std::to_string(lamp),
                        [lamp] { return Spectrum::Sampled(Daylight::OfChromaticity(FluorescentWhite(lamp))); }});
  }
  addDaylight("illum-acesD60", 6000 * kScaleChange);
}

const std::vector<Entry>& Entries() {
  static const std::vector<Entry> kEntries = [] {
    std::vector<Entry> entries;
    AddMetals(&entries);
    AddGlasses(&entries);
    AddIlluminants(&entries);
    return entries;
  }();
  return kEntries;
}

}  // namespace

Spectrum NamedSpectrum(std::string_view name, const FileLocation& location) {
  for (const Entry& entry : Entries()) {
    if (entry.name == name) return entry.make();
  }
  std::string known;
  for (const Entry& entry : Entries()) known += (known.empty() ? "\"" : ", \"") + entry.name + "\"";
  throw Error(location, "no spectrum is named \"" + std::string(name) + "\"; expected one of " + known);
}

bool IsSpectrumName(std::string_view name) {
  return std::any_of(Entries().begin(), Entries().end(), [&](const Entry& entry) { return entry.name == name; });
}

std::vector<std::string> SpectrumNames() {
  std::vector<std::string> names;
  for (const Entry& entry : Entries()) names.push_back(entry.name);
  return names;
}

}  // namespace dapple
