// SPDX-License-Identifier: Apache-2.0
#include "tools/prepare/surface_spaces.h"

#include <algorithm>

#include "common/images/grid_box.h"
#include "common/message_text.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

/// Maximum number of files listed in a message.
constexpr std::size_t max_files_named = 5;

std::string list_of(const std::vector<std::string>& files) {
  std::string out;
  for (std::size_t i = 0; i < std::min(files.size(), max_files_named); ++i)
    out += (i == 0 ? "'" : ", '") + printable(files[i]) + "'";
  return out + (files.size() > max_files_named ? ", ..." : "");
}

std::string known_or_not(const std::string& space) { return space.empty() ? "unknown" : space; }

}  // namespace

void SurfaceSpaces::begin_with(const LabelGrid& volume, const std::string& file) {
  volume_ = true;
  first_file_ = file;
  first_space_ = volume.space;
  if (of_others_.empty() || of_others_ == first_space_) return;
  LabelGrid copy = volume;
  if (!change_space(copy, of_others_))
    throw UsageError(
        "--surface-space: the space of the first input, " + file + ", is " + known_or_not(first_space_) +
        ", and surfaces cannot be brought into it; write LPS or RAS into its header, or leave the "
        "option out");
}

void SurfaceSpaces::add(TriangleMesh& surface, const std::string& file) {
  if (surface.space.empty()) surface.space = of_others_;
  if (first_file_.empty()) {
    first_file_ = file;
    first_space_ = surface.space;
    return;
  }
  const std::string before = surface.space;
  if (change_space(surface, first_space_))
    converted_[before].push_back(file);
  else if (before.empty())
    without_space_.push_back(file);
  else if (before != first_space_)
    not_comparable_[before].push_back(file);
}

std::vector<Diagnostic> SurfaceSpaces::findings() const {
  std::vector<Diagnostic> findings;
  const auto add = [&](DiagnosticCode code, const Files& files, const std::string& what, std::string done) {
    findings.push_back({.code = code,
                        .file = first_file_,
                        .what = (files.size() == 1 ? "surface " : "surfaces ") + what + ": " + list_of(files),
                        .count = files.size(),
                        .done = std::move(done)});
  };
  const auto taken = [](const Files& files) {
    return std::string(files.size() == 1 ? "taken as it is" : "taken as they are");
  };
  const std::string first = "that of the first input, " + known_or_not(first_space_);
  for (const auto& [space, files] : converted_)
    add(DiagnosticCode::space_converted, files, "in another space, " + space, "brought into " + first);
  for (const auto& [space, files] : not_comparable_)
    add(DiagnosticCode::space_unknown, files, "in another space, " + space,
        taken(files) + ", since it cannot be compared with " + first);
  // Surfaces alone may all be without a space.
  if (!without_space_.empty() && (volume_ || !first_space_.empty())) {
    add(DiagnosticCode::surface_space_unknown, without_space_, "whose file names no space",
        taken(without_space_) + ", in " + first);
    findings.back().remedy = "give --surface-space LPS or RAS if that is another one";
  }
  return findings;
}

void check_surface_meets(const TriangleMesh& surface, const std::string& surface_file,
                         const LabelGrid& volume, const std::string& volume_file) {
  Box3 box;
  for (const Vec3& p : surface.points) box.add(p);
  const Box3 of_volume = box_of(volume);
  if (!box.intersects(of_volume))
    throw boxes_apart(surface_file, "no part of the surface is in " + volume_file, "the surface", box,
                      "the volume", of_volume);
}

}  // namespace tetwright
