// SPDX-License-Identifier: Apache-2.0
#include "tetwright/image_input.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <set>
#include <utility>

#include "common/number_text.h"
#include "mesher/images/image_smoothing.h"
#include "mesher/images/material_image.h"
#include "mesher/input/label_preparation.h"
#include "mesher/tuning/image_tuning.h"
#include "mesher/tuning/input_tuning.h"
#include "tetwright/error.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

std::string text_of(double value) {
  std::string text;
  append_number(text, value);
  return text;
}

struct Range {
  double low, high;
};

Range range_of(const std::vector<float>& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return {*low, *high};
}

void check_names(const std::vector<std::string>& names) {
  std::set<std::string> seen;
  for (const std::string& name : names) {
    if (name == outside_name)
      throw UsageError("a material of an image cannot be called 'outside', which is the rest of it");
    if (!seen.insert(name).second)
      throw UsageError("two materials of an image are called '" + name + "'; give one another name");
  }
  if (names.size() > InputTuning::Limits::max_materials)
    throw UsageError("an image with " + std::to_string(names.size()) + " materials; at most " +
                     std::to_string(InputTuning::Limits::max_materials) + " are possible");
}

/// Readers of files check this, too; an image may come from memory.
void check_values(const ImageVolume& image, const std::string& file) {
  if (image.channels.empty()) throw InputError(file, 0, "the image has no channel; give it one");
  for (const std::vector<float>& channel : image.channels) {
    if (channel.size() != image.voxels() || channel.empty())
      throw InputError(file, 0,
                       "a channel has " + std::to_string(channel.size()) + " values for " +
                           std::to_string(image.voxels()) + " voxels; give one for each");
    const auto bad = std::find_if(channel.begin(), channel.end(), [](float v) { return !std::isfinite(v); });
    if (bad != channel.end())
      throw InputError(file, 0,
                       "voxel number " + std::to_string(bad - channel.begin()) + " has the value " +
                           text_of(static_cast<double>(*bad)) +
                           "; give each voxel a finite one, such as the background's");
  }
}

/// Chooses automatic thresholds, and checks that all divide the image.
std::vector<UsedIso> thresholds_of(const std::vector<float>& values, const std::string& file,
                                   const ImageChoice& choice) {
  const Range range = range_of(values);
  const std::string has = range.low == range.high
                              ? "all its values are " + text_of(range.low)
                              : "its values are from " + text_of(range.low) + " to " + text_of(range.high);
  std::vector<UsedIso> used;
  for (const IsoValue& iso : choice.isos) {
    if (!iso.value && range.low == range.high)
      throw NothingToMeshError(
          std::string(file).append(": --iso auto finds nothing to divide: ").append(has));
    const double value = iso.value ? *iso.value : otsu_threshold(values);
    if (!std::isfinite(value)) throw UsageError("--iso " + text_of(value) + " is no finite number");
    const std::string text = text_of(value);
    if (value > range.high)
      throw NothingToMeshError(std::string(file)
                                   .append(": nothing has the value ")
                                   .append(text)
                                   .append(" of --iso or more; ")
                                   .append(has));
    if (value <= range.low)
      throw InputError(file, 0,
                       std::string("no value is below ")
                           .append(text)
                           .append(" of --iso, so that nothing would be outside; ")
                           .append(has));
    for (const UsedIso& other : used)
      if (other.value == value)
        throw UsageError(std::string("'")
                             .append(other.name)
                             .append("' and '")
                             .append(iso.name)
                             .append("' have the same --iso ")
                             .append(text));
    used.push_back({iso.name, value, !iso.value});
  }
  return used;
}

/// The band of each threshold in ascending order, in terms of their order in `used`.
std::vector<std::size_t> ascending(const std::vector<UsedIso>& used) {
  std::vector<std::size_t> order(used.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return used[a].value < used[b].value; });
  return order;
}

void check_probabilities(const ImageVolume& image, const std::string& file, const ImageChoice& choice) {
  if (choice.outside) return;
  constexpr double off = ImageTuning::probability_tolerance;
  for (std::size_t c = 0; c < image.channels.size(); ++c) {
    const Range range = range_of(image.channels[c]);
    if (range.low >= -off && range.high <= 1 + off) continue;
    throw InputError(
        file, 0,
        "the values of '" + choice.names[c] + "' are from " + text_of(range.low) + " to " +
            text_of(range.high) +
            ", and probabilities are from 0 to 1; say with --iso V from which value on a point is "
            "inside");
  }
}

struct Divided {
  std::shared_ptr<MaterialImage> image;
  std::vector<std::string> names;    ///< of the materials
  std::vector<std::size_t> numbers;  ///< of the bands' materials, from 1; that of the outside is 0
};

Divided divide_by_thresholds(ImageVolume& image, const std::string& file, const ImageChoice& choice,
                             std::vector<UsedIso>* used_isos, const Progress* progress) {
  std::vector<float> values = std::move(image.channels.front());
  std::vector<UsedIso> used = thresholds_of(values, file, choice);
  const std::vector<std::size_t> order = ascending(used);
  std::vector<double> thresholds;
  thresholds.reserve(order.size());
  for (const std::size_t i : order) thresholds.push_back(used[i].value);
  if (choice.smoothing > 0) {
    std::vector<float> smooth = values;
    smooth_image(image.size, choice.smoothing, smooth, progress);
    thresholds = volume_keeping_thresholds(std::move(values), smooth, thresholds);
    values = std::move(smooth);
  }
  Divided divided;
  divided.image = std::make_shared<MaterialImage>(
      MaterialImage::nested(image.size, std::move(values), std::move(thresholds)));
  divided.numbers.push_back(0);
  for (const std::size_t i : order) divided.numbers.push_back(i + 1);
  for (const UsedIso& iso : used) divided.names.push_back(iso.name);
  if (used_isos) *used_isos = std::move(used);
  return divided;
}

Divided divide_by_channels(ImageVolume& image, const std::string& file, const ImageChoice& choice,
                           const Progress* progress) {
  check_probabilities(image, file, choice);
  const auto make = [&](std::vector<std::vector<float>> channels) {
    return std::make_shared<MaterialImage>(
        MaterialImage::largest(image.size, std::move(channels), choice.outside));
  };
  Divided divided{make(std::move(image.channels)), choice.names, {}};
  divided.numbers.resize(divided.image->bands());
  std::iota(divided.numbers.begin(), divided.numbers.end(), std::size_t{0});
  if (choice.smoothing > 0) {
    const std::vector<BandSize> sizes = sizes_of(*divided.image, bands_of(*divided.image));
    std::vector<std::vector<float>> channels = std::move(*divided.image).take_channels();
    for (std::vector<float>& channel : channels)
      smooth_image(image.size, choice.smoothing, channel, progress);
    divided.image = make(std::move(channels));
    keep_volumes(*divided.image, sizes, progress);
  }
  return divided;
}

}  // namespace

LabelInput make_image_input(ImageVolume image, const std::string& file, const ImageChoice& choice,
                            std::vector<UsedIso>* used, Progress* progress) {
  const std::size_t channels = image.channels.size();
  check_values(image, file);
  if (!(choice.smoothing >= 0 && choice.smoothing <= ImageTuning::max_smoothing))
    throw UsageError("--smooth " + text_of(choice.smoothing) + " is not between 0 and " +
                     text_of(ImageTuning::max_smoothing) + " voxels");
  if (choice.outside && !std::isfinite(*choice.outside))
    throw UsageError("--outside-probability " + text_of(*choice.outside) + " is no finite number");
  const bool by_thresholds = !choice.isos.empty();
  if (by_thresholds && channels > 1)
    throw UsageError(file + " has " + std::to_string(channels) +
                     " channels, and thresholds are for one; give a file of one channel");
  std::vector<std::string> names = choice.names;
  if (by_thresholds) {
    names.clear();
    for (const IsoValue& iso : choice.isos) names.push_back(iso.name);
  }
  check_names(names);
  TETWRIGHT_CHECK(by_thresholds || names.size() == channels);
  const double voxels = static_cast<double>(image.channels.front().size());
  // Smoothing needs a copy of a channel and one that is reordered; regions at most two bytes for each voxel.
  require_memory(voxels * (sizeof(float) * static_cast<double>(channels + (choice.smoothing > 0 ? 2 : 0)) +
                           sizeof(RegionIndex)),
                 "the image " + file, "crop it or make it coarser");

  Divided divided = by_thresholds ? divide_by_thresholds(image, file, choice, used, progress)
                                  : divide_by_channels(image, file, choice, progress);
  if (progress) progress->throw_if_stopped();
  LabelInput result;
  set_grid(image, file, result);
  result.regions = bands_of(*divided.image);
  const std::vector<BandSize> sizes = sizes_of(*divided.image, result.regions);
  std::vector<std::size_t> band_of(sizes.size());
  for (std::size_t b = 0; b < sizes.size(); ++b) band_of[divided.numbers[b]] = b;
  result.band_regions.assign(sizes.size(), on_interface);
  result.band_regions[0] = outside_region;
  for (std::size_t material = 1; material < sizes.size(); ++material) {
    const std::size_t band = band_of[material];
    const std::string& name = divided.names[material - 1];
    const auto n = static_cast<std::size_t>(sizes[band].voxels);
    if (n == 0) {
      result.findings.push_back({.code = DiagnosticCode::masks_empty,
                                 .file = file,
                                 .what = "material '" + name + "' that no voxel has",
                                 .count = 1,
                                 .done = "not in the mesh"});
      continue;
    }
    result.materials.push_back({name, static_cast<MaterialTag>(material), n, n, {}, sizes[band].volume});
    result.band_regions[band] = static_cast<RegionIndex>(result.materials.size());
  }
  if (result.materials.empty())
    throw NothingToMeshError(file + ": no point is in any of its materials; see --outside-probability");
  result.regions.renumber(result.band_regions);
  result.image = std::move(divided.image);
  prepare_regions(result, choice.min_voxels, "voxels, none of them outside", progress);
  return result;
}

}  // namespace tetwright
