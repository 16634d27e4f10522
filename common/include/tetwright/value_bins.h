// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tetwright/tet_mesh.h"

namespace tetwright {

/// How the values of tets are divided into bins.
struct BinRule {
  /// Number of bins of equal width between the smallest and the largest value in each material.
  std::size_t count = 0;
  /// Instead of `count`: ascending values between bins, the same for all materials. The first bin is below
  /// the first one, the last bin is the last one and above.
  std::vector<double> edges = {};
};
inline constexpr std::size_t max_bins = 10'000;

/// Elastic modulus by value: factor * (scale * value + offset) ^ exponent. Negative results of the
/// calibration count as 0.
struct ModulusLaw {
  double factor = 1, exponent = 1;
  double scale = 1, offset = 0;  ///< calibration of the value, such as from gray values to density
  double minimum = 0;            ///< smaller moduli become this; 0: none
  double poisson = 0.3;          ///< Poisson's ratio; that of bone in most finite element studies
};

/// Tets of one material with similar values.
struct ValueBin {
  MaterialTag material;
  std::size_t number;  ///< from 1, ascending with the values; bins without tets are left out
  std::string name;    ///< unique: the material's name and the number, such as "bone_001"; see name_apart()
  double low, high;    ///< bounds; infinite for the outer bins of BinRule::edges
  std::size_t tets;    ///< their number, at least 1
  double volume;       ///< input units cubed
  double mean;         ///< of the values, weighted by volume
  std::optional<double> modulus = {};
};

/// Division of a mesh into bins.
struct TetBins {
  std::string field;                   ///< name of the values
  std::vector<ValueBin> bins;          ///< ascending by material and number
  std::vector<std::uint32_t> of_tets;  ///< index of each tet's bin
  std::optional<double> poisson = {};  ///< set with the moduli
};

/// Divides the tets of each material into bins.
///
/// \param field name of the values
/// \param values one for each tet, finite
TetBins bin_tets(const TetMesh& mesh, const std::string& field, const std::vector<double>& values,
                 const BinRule& rule);

/// Gives the bins of several divisions of a mesh names that differ: with the name of the values, such as
/// "bone_density_001". Leaves a single division as it is.
void name_apart(const TetMesh& mesh, std::span<TetBins> divisions);

/// The division that formats use where a tet can only be in one: that with moduli, otherwise the first one.
///
/// \pre there is one
std::size_t leading_division(std::span<const TetBins> divisions);

/// Modulus of a value. A result that is not above 0 or not finite is no modulus.
double modulus_of(const ModulusLaw& law, double value);

/// Gives each bin the modulus of its mean.
///
/// \throws UsageError if a modulus is not above 0 or not finite, with the bin and what to do
void set_moduli(const ModulusLaw& law, TetBins& bins);

/// Number of each tet's bin within its material, as an integer cell field called `<field>_bin`.
MeshField field_of_bins(const TetBins& bins);

/// Table of the bins as comma-separated values, with a header line. The bins of several divisions are listed
/// one after the other, with a column for the name of the values.
std::string table_of_bins(const TetMesh& mesh, std::span<const TetBins> divisions);

}  // namespace tetwright
