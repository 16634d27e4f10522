// SPDX-License-Identifier: Apache-2.0
#include "tools/prepare/surface_spaces.h"

#include <algorithm>
#include <utility>

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

std::string space_of_tets(const TetMesh& mesh, const std::string& file, const std::string& mesh_space,
                          PrepareReport& report) {
  if (mesh.space.empty()) return mesh_space;
  if (!mesh_space.empty() && mesh_space != mesh.space)
    report.diagnostics.push_back({.code = DiagnosticCode::mesh_space_unused,
                                  .file = file,
                                  .what = "mesh in " + mesh.space + ", not " + mesh_space,
                                  .done = "--mesh-space is not used, since the mesh names its space"});
  return mesh.space;
}

void SurfaceSpaces::begin_with(const std::string& space, const std::string& file, bool tet_mesh) {
  first_file_ = file;
  first_space_ = space;
  first_is_tet_mesh_ = tet_mesh;
  if (of_others_.empty() || of_others_ == first_space_) return;
  TriangleMesh nothing;
  nothing.space = of_others_;
  if (!change_space(nothing, first_space_))
    throw UsageError("--surface-space: the space of the first input, " + file + ", is " +
                     known_or_not(first_space_) + ", and " + what_ + "s cannot be brought into it; " +
                     (tet_mesh ? "name it by --mesh-space LPS or RAS" : "write LPS or RAS into its header") +
                     ", or leave the option out");
}

void SurfaceSpaces::note(const std::string& before, bool converted, const std::string& file) {
  if (converted)
    converted_[before].push_back(file);
  else if (before.empty())
    without_space_.push_back(file);
  else if (before != first_space_)
    not_comparable_[before].push_back(file);
}

void SurfaceSpaces::add(TriangleMesh& surface, const Input& input) {
  if (surface.space.empty()) surface.space = of_others_;
  if (first_file_.empty()) {
    first_file_ = input.name;
    first_space_ = surface.space;
    return;
  }
  if (surface.space.empty() && input.is_value()) return;
  const std::string before = surface.space;
  note(before, change_space(surface, first_space_), input.name);
}

void SurfaceSpaces::add(std::shared_ptr<const SizeSource>& sizes, const std::string& file) {
  const std::string before = sizes->space().empty() ? of_others_ : sizes->space();
  std::shared_ptr<const SizeSource> changed = change_space(sizes, before, first_space_);
  note(before, changed != nullptr, file);
  if (changed) sizes = std::move(changed);
}

std::string SurfaceSpaces::both_spaces(const std::string& space, const std::string& file) const {
  const std::string known = space.empty() ? of_others_ : space;
  TriangleMesh nothing;
  nothing.space = known;
  if (change_space(nothing, first_space_))
    return file + " was brought from " + known + " into " + first_space_ + ", that of " + first_file_;
  const auto text = [](const std::string& of, const std::string& name, const char* option) {
    std::string out = "that of " + name + " is " + known_or_not(of);
    if (of.empty() && option) out += std::string(" (") + option + " LPS or RAS names it)";
    return out;
  };
  return text(known, file, "--surface-space") + ", " +
         text(first_space_, first_file_, first_is_tet_mesh_ ? "--mesh-space" : nullptr);
}

std::vector<Diagnostic> SurfaceSpaces::findings() const {
  std::vector<Diagnostic> findings;
  const auto add = [&](DiagnosticCode code, const Files& files, const std::string& what, std::string done) {
    findings.push_back({.code = code,
                        .file = first_file_,
                        .what = what_ + (files.size() == 1 ? " " : "s ") + what + ": " + list_of(files),
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
        taken(files) + ", since it cannot be compared with " + first +
            (first_is_tet_mesh_ && first_space_.empty() ? mesh_space_hint : ""));
  // There is nothing to compare with an unknown space.
  if (!without_space_.empty() && !first_space_.empty()) {
    add(DiagnosticCode::surface_space_unknown, without_space_, "whose file names no space",
        taken(without_space_) + ", in " + first);
    findings.back().remedy = "give --surface-space LPS or RAS if that is another one";
  }
  return findings;
}

}  // namespace tetwright
