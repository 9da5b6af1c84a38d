// The spectra that pbrt knows by name: metals, glasses and illuminants, from published measurements and formulas.
//
// Metals: "metal-Ag-eta", "metal-Ag-k", and so for Al, Au, Cu, CuZn, MgO, TiO2. Glasses (indices): "glass-BK7",
// "glass-BAF10", "glass-FK51A", "glass-LASF9", "glass-SF5", "glass-SF10", "glass-SF11" ("glass-F5", "glass-F10",
// "glass-F11" are pbrt-v4's names for the last three). Illuminants: "stdillum-A", "stdillum-D50", "stdillum-D65",
// "stdillum-F1" to "-F12", "illum-acesD60".
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "src/base/error.h"
#include "src/materials/spectrum.h"

namespace dapple {

/// The wavelength, in nm, at which one number stands for a dispersive index of refraction: the helium d line.
inline constexpr double kFraunhoferD = 587.56;

/// Throws `Error` at `location` that lists the known names where `name` is none of them. The F illuminants have the
/// published chromaticity, but a smooth spectrum: right for lights (`EmissionToColorV4`), not for anything seen through
/// a narrow filter.
Spectrum NamedSpectrum(std::string_view name, const FileLocation& location = {});
bool IsSpectrumName(std::string_view name);
/// All names that `NamedSpectrum` knows.
std::vector<std::string> SpectrumNames();

}  // namespace dapple
