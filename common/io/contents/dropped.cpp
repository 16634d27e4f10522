// SPDX-License-Identifier: Apache-2.0
#include "tetwright/io.h"

#include <algorithm>

#include "common/io/text/text_scanner.h"

namespace tetwright {

void KindCounts::add(const std::string& kind, std::size_t n) {
  if (n == 0) return;
  const auto known =
      std::find_if(counts_.begin(), counts_.end(), [&](const Dropped& d) { return d.what == kind; });
  if (known == counts_.end())
    counts_.push_back({kind, n});
  else
    known->count += n;
}

std::string KindCounts::text() const {
  std::string out;
  for (std::size_t i = 0; i < counts_.size(); ++i)
    out += (i == 0                   ? ""
            : i + 1 < counts_.size() ? ", "
                                     : " and ") +
           std::to_string(counts_[i].count) + " " + counts_[i].what;
  return out;
}

void KindCounts::append_to(std::vector<Dropped>& dropped) const {
  dropped.insert(dropped.end(), counts_.begin(), counts_.end());
}

std::string unsupported_cells(const KindCounts& cells, const std::string& first) {
  const std::string kinds = cells.text();
  // A rejected curved tet has more nodes than corners and edge midpoints.
  const bool curved = kinds.find("tets") != std::string::npos;
  return kinds + ", the first of them " + first + "; only tets of 4 or 10 points can be read: " +
         (curved ? "save the mesh with linear elements, for example with gmsh -order 1, and convert other "
                   "cells to tets"
                 : "convert them to tets, for example with ParaView's filter Tetrahedralize");
}

std::string quoted_list(const std::vector<std::string>& names) {
  constexpr std::size_t max_names = 6;
  std::string out;
  for (std::size_t i = 0; i < std::min(max_names, names.size()); ++i)
    out += (i ? ", " : "") + in_quotes(names[i]);
  if (names.size() > max_names) out += " and " + std::to_string(names.size() - max_names) + " more";
  return out;
}

void append_dropped_names(std::vector<Dropped>& dropped, const std::string& what,
                          const std::vector<std::string>& names) {
  if (!names.empty()) dropped.push_back({what + " (" + quoted_list(names) + ")", names.size()});
}

}  // namespace tetwright
