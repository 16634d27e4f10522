// SPDX-License-Identifier: Apache-2.0
#include "tools/prepare/image_input.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "common/unique_names.h"
#include "common/utf8.h"
#include "tetwright/error.h"
#include "tetwright/io.h"
#include "tetwright/label_masks.h"
#include "tetwright/resources.h"
#include "tools/prepare/mask_input.h"

namespace tetwright {

namespace {

bool has_fractions(const ImageVolume& image) {
  return std::any_of(image.channels.begin(), image.channels.end(), [](const std::vector<float>& channel) {
    return std::any_of(channel.begin(), channel.end(), [](float v) { return v != std::floor(v); });
  });
}

double bytes_of_channels(const ImageVolume& image) {
  double bytes = 0;
  for (const std::vector<float>& channel : image.channels)
    bytes += static_cast<double>(channel.size()) * sizeof(float);
  return bytes;
}

/// Appends the channels of an image to those before, on the same grid.
void append_channels(ImageVolume image, const std::string& file, CommonGrid& grid, ImageVolume& all) {
  grid.add(image, file);
  if (all.channels.empty()) {
    all = std::move(image);
    return;
  }
  for (std::vector<float>& channel : image.channels) all.channels.push_back(std::move(channel));
  double values = 0;
  for (const std::vector<float>& channel : all.channels) values += static_cast<double>(channel.size());
  require_memory(2 * sizeof(float) * values, "joining images like " + file, "crop them or make them coarser");
}

ImageChoice choice_of(const PrepareOptions& options) {
  ImageChoice choice;
  choice.isos = options.images.isos;
  choice.outside = options.images.outside_probability;
  choice.smoothing = options.images.smoothing.value_or(0);
  choice.min_voxels = options.labels.min_voxels.value_or(default_min_voxels);
  return choice;
}

/// Names thresholds, or turns the threshold of several images into the value of the outside.
void fit_thresholds(const std::vector<Input>& inputs, std::size_t channels, const std::string& name,
                    ImageChoice& choice) {
  std::vector<IsoValue>& isos = choice.isos;
  if (isos.empty()) return;
  if (choice.outside)
    throw UsageError(
        "--iso and --outside-probability cannot be combined; --iso is for one image, or the same "
        "for several");
  if (channels > 1) {
    if (isos.size() > 1 || !isos.front().name.empty() || !isos.front().value)
      throw UsageError(
          (inputs.size() > 1 ? "several images" : "several channels") +
          std::string(" are a material each, with one --iso V for all, or none for probability maps; " +
                      std::string("give one image for --iso NAME=V or auto")));
    choice.outside = isos.front().value;
    isos.clear();
    return;
  }
  for (IsoValue& iso : isos) {
    if (!iso.name.empty()) continue;
    if (isos.size() > 1) throw UsageError("several --iso need names: --iso NAME=V for each material");
    iso.name = name;
  }
}

}  // namespace

bool are_images(std::vector<Input>& volumes, PrepareRun& run) {
  if (run.options.images.any()) return true;
  Input& first = volumes.front();
  if (const auto* image = std::get_if<ImageVolume>(&first.value))
    return (image->channels.size() > 1 || volumes.size() > 1) && has_fractions(*image);
  if (volumes.size() == 1 || !std::holds_alternative<InputFile>(first.value) || label_layers(first.name) > 1)
    return false;
  return has_fractions(take_image(first, run.seconds_waited));
}

bool are_images_after_all(const std::vector<Input>& volumes, const LabelOptions& labels) {
  if (!labels.meshed.empty() || !labels.names_file.empty() || labels.outside) return false;
  try {
    return std::any_of(volumes.begin(), volumes.end(), [&](const Input& input) {
      if (!std::holds_alternative<InputFile>(input.value)) return false;
      const ImageVolume image = read_image(input.name, input.volume_file);
      return (image.channels.size() > 1 || volumes.size() > 1) && has_fractions(image);
    });
  } catch (const Error&) {
    return false;  // the error of the labels says more
  }
}

LabelInput read_images(std::vector<Input>& volumes, PrepareRun& run) {
  const LabelOptions& labels = run.options.labels;
  if (!labels.meshed.empty() || !labels.names_file.empty() || labels.outside)
    throw UsageError(
        "--labels, --label-names and --outside-label are for segmented volumes, and the input is "
        "an image");
  if (run.options.values.own_label)
    throw UsageError(
        "--values-mask labels is for segmented volumes, and the input is an image; give a volume, "
        "--values-mask FILE");
  if (run.options.bodies.overlap != OverlapRule::later)
    throw UsageError("--on-overlap is for surfaces and masks, and the input is an image");
  ImageChoice choice = choice_of(run.options);
  CommonGrid grid;
  ImageVolume all;
  std::map<std::string, std::string> file_of_name;
  UniqueNames names(printable_name);
  (void)names.add(outside_name);
  for (Input& input : volumes) {
    run.progress.throw_if_stopped();
    const std::string file = input.name,
                      own = input.material.empty() ? input.material_name() : input.material;
    ImageVolume image = [&] {
      const HeldMemory before(bytes_of_channels(all));
      return take_image(input, run.seconds_waited);
    }();
    const auto [same, first_with_name] = file_of_name.emplace(printable_name(own), file);
    if (!first_with_name) throw_same_name("images", same->first, same->second, file);
    const std::size_t channels = image.channels.size();
    for (std::size_t c = 0; c < channels; ++c)
      choice.names.push_back(names.add(channels == 1 ? own : own + "_" + std::to_string(c + 1)));
    append_channels(std::move(image), file, grid, all);
  }
  fit_thresholds(volumes, all.channels.size(), choice.names.front(), choice);
  const std::vector<Diagnostic> spaces = grid.findings();
  run.report.diagnostics.insert(run.report.diagnostics.end(), spaces.begin(), spaces.end());
  std::vector<UsedIso> used;
  LabelInput made = make_image_input(std::move(all), run.report.inputs.front(), choice, &used, &run.progress);
  run.report.diagnostics.insert(run.report.diagnostics.end(), made.findings.begin(), made.findings.end());
  run.report.volume.emplace(made);
  run.report.volume->isos = std::move(used);
  return made;
}

}  // namespace tetwright
