// SPDX-License-Identifier: Apache-2.0
#include "tools/prepare/surface_spaces.h"

#include <algorithm>

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

void SurfaceSpaces::begin_with(const std::string& space, const std::string& file) {
  first_file_ = file;
  first_space_ = space;
  if (of_others_.empty() || of_others_ == first_space_) return;
  TriangleMesh nothing;
  nothing.space = of_others_;
  if (!change_space(nothing, first_space_))
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
  // There is nothing to compare with an unknown space.
  if (!without_space_.empty() && !first_space_.empty()) {
    add(DiagnosticCode::surface_space_unknown, without_space_, "whose file names no space",
        taken(without_space_) + ", in " + first);
    findings.back().remedy = "give --surface-space LPS or RAS if that is another one";
  }
  return findings;
}

}  // namespace tetwright
