// SPDX-License-Identifier: Apache-2.0
#include "tools/prepare/mask_input.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "common/lower_case.h"
#include "common/message_text.h"
#include "common/unique_names.h"
#include "common/utf8.h"
#include "tetwright/error.h"
#include "tetwright/io.h"

namespace tetwright {

namespace {

namespace fs = std::filesystem;

constexpr std::array<const char*, 4> zarr_metadata{".zarray", ".zgroup", ".zattrs", "zarr.json"};

bool is_layered(const Input& input) {
  return std::holds_alternative<InputFile>(input.value) && label_layers(input.name) > 1;
}

/// A mask before it has a tag.
struct NamedMask {
  MaterialTag label;  ///< in its volume
  std::string name;
};

/// The segments of a layer, by label.
std::vector<NamedMask> segments_of(const LabelVolume& layer, MaterialTag outside) {
  std::set<MaterialTag> labels;
  for (const auto& [label, name] : layer.names) labels.insert(label);
  for (const auto& [label, colour] : layer.colours) labels.insert(label);
  // Segments may lack a name.
  for (std::size_t i = 0; i < layer.labels.size(); ++i)
    if (i == 0 || layer.labels[i] != layer.labels[i - 1]) labels.insert(layer.labels[i]);
  labels.erase(outside);
  std::vector<NamedMask> segments;
  for (const MaterialTag label : labels) {
    const auto name = layer.names.find(label);
    segments.push_back({label, name != layer.names.end() && !name->second.empty()
                                   ? name->second
                                   : "segment_" + std::to_string(label)});
  }
  return segments;
}

/// Gives masks their tags.
class MaskTags {
 public:
  /// \param by_name tags that `file` gives to names
  MaskTags(std::string file, const std::map<std::string, MaterialTag>& by_name)
      : file_(std::move(file)), by_name_(by_name) {}

  /// \param wanted tag that the mask's file has for it; 0: none
  MaterialTag tag_of(const std::string& name, MaterialTag wanted, const std::string& file) {
    MaterialTag tag = wanted;
    if (!file_.empty()) {
      const auto found = by_name_.find(name);
      if (found == by_name_.end())
        throw InputError(file_, 0, "has no label called '" + name + "', the mask in " + file + "; add it");
      tag = found->second;
      if (tag <= 0)
        throw InputError(file_, 0,
                         "the label " + std::to_string(tag) + " of the mask '" + name + "' must be above 0");
    }
    if (tag == 0)
      while (used_.contains(++last_)) continue;
    if (tag == 0) tag = last_;
    used_.insert(tag);
    return tag;
  }

 private:
  std::string file_;
  const std::map<std::string, MaterialTag>& by_name_;
  std::set<MaterialTag> used_;
  MaterialTag last_ = 0;
};

/// Whether all segments of the layers have different labels, all above 0.
bool labels_differ(const std::vector<std::vector<NamedMask>>& layers) {
  std::set<MaterialTag> seen;
  for (const std::vector<NamedMask>& layer : layers)
    for (const NamedMask& segment : layer)
      if (segment.label <= 0 || !seen.insert(segment.label).second) return false;
  return true;
}

/// The files in a folder, in the order of their names.
struct FolderFiles {
  std::vector<std::string> volumes;  ///< but for slices: TIFF and DICOM
  std::vector<std::string> others;   ///< surfaces, tet meshes and .vdb files
};

/// \throws InputError if the folder cannot be read

FolderFiles files_of(const std::string& folder) {
  FolderFiles files;
  std::error_code error;
  std::set<std::string> headers;  // without their extension
  fs::directory_iterator entries(folder, error);
  for (; !error && entries != fs::directory_iterator(); entries.increment(error)) {
    const fs::directory_entry& entry = *entries;
    std::error_code unknown;
    if (entry.is_directory(unknown)) continue;
    const std::string file = entry.path().string(), extension = lower_case(entry.path().extension().string());
    if (entry.path().filename().string().starts_with('.')) continue;
    if (extension == ".hdr") headers.insert(file_stem(file));
    const FileKind kind = file_kind(file);
    if (extension == ".tif" || extension == ".tiff") continue;
    if (kind == FileKind::volume && is_dicom(file)) continue;
    if (kind == FileKind::volume)
      files.volumes.push_back(file);
    else if (kind != FileKind::unknown || is_vdb(file))
      files.others.push_back(file);
  }
  if (error) throw InputError(folder, 0, "cannot read this folder: " + error.message());
  // The two files of a pair are one volume.
  std::erase_if(files.volumes, [&](const std::string& file) {
    return lower_case(fs::path(file).extension().string()) == ".img" && headers.contains(file_stem(file));
  });
  std::sort(files.volumes.begin(), files.volumes.end());
  std::sort(files.others.begin(), files.others.end());
  return files;
}

/// Whether a path is that of a zarr array, which is a folder of many files.
bool is_zarr(const std::string& path) {
  std::error_code error;
  return lower_case(fs::path(path).extension().string()) == ".zarr" ||
         std::any_of(zarr_metadata.begin(), zarr_metadata.end(),
                     [&](const char* name) { return fs::exists(fs::path(path) / name, error); });
}

/// Name of the mask in a file: that of the file, without the second extension of 3D Slicer's segmentations.
std::string mask_name(const std::string& file) {
  const std::string stem = file_stem(file);
  constexpr std::string_view segmentation = ".seg";
  return stem.ends_with(segmentation) ? stem.substr(0, stem.size() - segmentation.size()) : stem;
}

}  // namespace

std::vector<Input> with_masks_of_folders(std::vector<Input> inputs, PrepareReport& report) {
  std::vector<Input> all;
  for (Input& input : inputs) {
    std::error_code error;
    if (!std::holds_alternative<InputFile>(input.value) || input.role != Input::Role::body ||
        !fs::is_directory(input.name, error) || is_zarr(input.name)) {
      all.push_back(std::move(input));
      continue;
    }
    const FolderFiles files = files_of(input.name);
    if (input.kind() == FileKind::volume) {
      // Slices.
      if (!files.volumes.empty())
        throw UsageError(input.name + " has slices (" + (is_dicom(input.name) ? "DICOM" : ".tif") +
                         ") and other volumes, such as " +
                         fs::path(files.volumes.front()).filename().string() +
                         "; keep them in different folders, or give the files");
      all.push_back(std::move(input));
      continue;
    }
    if (files.volumes.empty())
      throw UsageError(input.name +
                       ": there is no volume in this folder, in which each volume would be a mask (" +
                       known_extensions(FileKind::volume) + "); folders in it are not searched");
    if (!input.material.empty())
      throw UsageError(input.name +
                       " is a folder of masks, each a material with the name of its file; leave "
                       "out the name " +
                       input.material);
    if (!files.others.empty())
      report.diagnostics.push_back(
          {.code = DiagnosticCode::input_dropped,
           .file = input.name,
           .what =
               (files.others.size() == 1 ? "file that is no mask, " : "files that are no masks, the first ") +
               fs::path(files.others.front()).filename().string(),
           .count = files.others.size(),
           .done = "not read"});
    for (const std::string& file : files.volumes) all.push_back(Input(file).as_mask());
  }
  return all;
}

bool are_masks(const std::vector<Input>& volumes) {
  return volumes.size() > 1 || volumes.front().mask || !volumes.front().material.empty() ||
         is_layered(volumes.front());
}

void throw_same_name(const std::string& what, const std::string& name, const std::string& file,
                     const std::string& other) {
  throw UsageError(file + " and " + other + " are two " + what + " called '" + name +
                   "'; name them apart, such as --material " + name + "_1=" + file + " --material " + name +
                   "_2=" + other);
}

LabelVolume join_masks(std::vector<Input>& volumes, LabelChoice& choice, PrepareRun& run) {
  std::map<std::string, MaterialTag> known;
  if (!choice.names_file.empty())
    for (const auto& [tag, name] : choice.names)
      if (!known.emplace(name, tag).second)
        throw InputError(choice.names_file, choice.name_lines.contains(tag) ? choice.name_lines.at(tag) : 0,
                         "labels " + std::to_string(known.at(name)) + " and " + std::to_string(tag) +
                             " are both called '" + name + "'; a mask has one label");
  LabelMasks masks(run.options.bodies.overlap, known);
  MaskTags tags(choice.names_file, known);
  UniqueNames names(printable_name);
  (void)names.add("outside");
  std::map<std::string, const Input*> input_of_name;
  double done = 0;
  for (Input& input : volumes) {
    run.progress.throw_if_stopped();
    const std::string& file = input.name;
    std::vector<LabelVolume> layers;
    std::vector<std::vector<NamedMask>> of_layers;
    const bool layered = is_layered(input);
    if (layered) {
      if (!input.material.empty())
        throw UsageError(file +
                         " has several segments, each a material with its own name; leave out the name " +
                         input.material);
      layers = read_label_layers(file, input.volume_file);
      for (const LabelVolume& layer : layers) of_layers.push_back(segments_of(layer, choice.outside_label));
    } else {
      layers.push_back(take_label_volume(input, run.seconds_waited));
      const MaterialTag label = label_of_mask(layers.front(), choice.outside_label, file);
      // A name that is given comes before that in the file, and that before the name of the file.
      std::string name = input.material;
      const std::map<MaterialTag, std::string>& in_file = layers.front().names;
      if (name.empty() && in_file.size() == 1)
        name = in_file.begin()->second;  // also of an empty mask
      else if (const auto named = in_file.find(label); name.empty() && named != in_file.end())
        name = named->second;
      if (name.empty()) name = input.is_value() ? input.name : mask_name(file);
      of_layers.push_back({{label, name}});
    }
    const bool keep_labels = layered && volumes.size() == 1 && labels_differ(of_layers);
    for (std::size_t l = 0; l < layers.size(); ++l) {
      std::map<MaterialTag, LabelMask> added;
      for (const NamedMask& mask : of_layers[l]) {
        const std::string name = names.add(mask.name);
        // Segments of a file cannot be named by options; a number makes their names unique.
        if (!layered) {
          const auto [same, first_with_name] = input_of_name.emplace(printable_name(mask.name), &input);
          if (!first_with_name) throw_same_name("masks", same->first, same->second->name, file);
        }
        if (printable_name(mask.name) == "outside")
          throw UsageError(
              file +
              ": a mask cannot be called 'outside', which is the name of what is in no mask; give it "
              "another name with --material NAME=FILE");
        if (name != printable_name(mask.name))
          run.report.diagnostics.push_back(
              {.code = DiagnosticCode::names_qualified,
               .file = file,
               .what = "mask called '" + printable_name(mask.name) + "' like another one",
               .count = 1,
               .done = "called '" + name + "' in the mesh"});
        added[mask.label] = {name, tags.tag_of(name, keep_labels ? mask.label : 0, file)};
      }
      // A mask without voxels has the outside label, which no voxel of a mask has.
      masks.add(std::move(layers[l]), file, added, choice.outside_label);
    }
    run.progress.update(++done / static_cast<double>(volumes.size()));
  }
  LabelMasks::Joined joined = std::move(masks).join(run.report.inputs.front());
  run.report.overlaps = std::move(joined.overlaps);
  run.report.diagnostics.insert(run.report.diagnostics.end(), joined.findings.begin(), joined.findings.end());
  choice.names = joined.volume.names;
  choice.outside_label = 0;
  return std::move(joined.volume);
}

}  // namespace tetwright
