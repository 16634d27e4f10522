// SPDX-License-Identifier: Apache-2.0
#include "common/io/elements/vtk_cells.h"

#include "common/io/text/text_scanner.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

/// Unknown types count as volumes, so that they are rejected.
bool is_volume(std::int64_t type) {
  const ElementType* known = vtk_element_type(type);
  return !known || known->dimension == 3;
}

std::string plural_of(std::int64_t type) {
  const ElementType* known = vtk_element_type(type);
  return known ? known->name : "cells of the unknown type " + std::to_string(type);
}

}  // namespace

std::string vtk_text(const std::vector<double>& bytes) {
  std::string text;
  for (const double byte : bytes)
    text += byte >= 0 && byte < 256 ? static_cast<char>(static_cast<unsigned char>(byte)) : '?';
  return text;
}

std::vector<std::pair<std::int64_t, std::string>> parse_vtk_names(const std::string& text,
                                                                  const std::string& array,
                                                                  const std::string& file) {
  std::vector<std::pair<std::int64_t, std::string>> names;
  TextScanner lines(text, file);
  while (lines.left() > 0) {
    const std::string_view line = lines.rest_of_line();
    const std::size_t tab = line.find('\t');
    std::int64_t number = 0;
    if (tab == std::string_view::npos || !parse_number(line.substr(0, tab), number))
      throw InputError(file + ": in " + in_quotes(array) + ": expected a number, a tab and a name, found " +
                       in_quotes(line));
    names.emplace_back(number, line.substr(tab + 1));
  }
  return names;
}

void OtherVtkCells::add(std::int64_t type, std::size_t cell) {
  if (++counts_[type] > 1 || has_volumes_ || !is_volume(type)) return;
  has_volumes_ = true;
  first_volume_ = cell;
  first_volume_type_ = type;
}

std::string OtherVtkCells::refusal() const {
  KindCounts volumes;
  for (const auto& [type, count] : counts_)
    if (is_volume(type)) volumes.add(plural_of(type), count);
  return unsupported_cells(volumes, "cell " + std::to_string(first_volume_) + " (counted from 0, type " +
                                        std::to_string(first_volume_type_) + ")");
}

void OtherVtkCells::append_flat_to(std::vector<Dropped>& dropped) const {
  KindCounts flat;
  for (const auto& [type, count] : counts_)
    if (!is_volume(type)) flat.add(plural_of(type), count);
  flat.append_to(dropped);
}

}  // namespace tetwright
