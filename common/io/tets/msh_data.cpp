// SPDX-License-Identifier: Apache-2.0
#include "common/io/tets/msh_data.h"

#include <cmath>
#include <limits>

#include "common/io/encodings/byte_order.h"
#include "common/io/names/mesh_fields.h"
#include "common/io/names/mesh_parts.h"
#include "common/number_text.h"
#include "common/utf8.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

constexpr std::int64_t max_components = 9;
constexpr std::size_t max_name_bytes = 120;  // see msh_name()

void append_value(std::string& out, double value) {
  if (std::isnan(value))
    out += "nan";  // without a sign, which a NaN may have and other readers reject
  else
    append_number(out, value);
}

}  // namespace

MeshField read_msh_data(TextScanner& in, const MshNumbers& like, const std::string& what,
                        const FileNumbers& numbers, std::size_t items, bool missing_allowed,
                        std::size_t& room) {
  MeshField field;
  const std::size_t strings = in.count("number of string tags", 2);
  in.skip_line();
  for (std::size_t i = 0; i < strings; ++i) {
    std::string_view line;
    std::size_t number = 0;
    do {
      if (in.left() == 0) in.fail_cut_short("name");
      number = in.line();
      line = in.rest_of_line();
    } while (line.find_first_not_of(" \t") == std::string_view::npos);
    if (i > 0) continue;
    const std::size_t open = line.find('"'), close = line.rfind('"');
    if (open == close)
      throw InputError(in.name(), number, "expected the name of a field in quotes, found " + in_quotes(line));
    field.name = std::string(line.substr(open + 1, close - open - 1));
  }
  field.name = field_name(field.name);
  const std::size_t reals = in.count("number of real tags", 2);
  for (std::size_t i = 0; i < reals; ++i) (void)in.number("real tag");
  const std::size_t integers = in.count("number of integer tags", 2);
  if (integers < 3)
    in.fail("field " + in_quotes(field.name) + " has " + std::to_string(integers) +
            " integer tags; its numbers of components and values are missing");
  (void)in.integer("time step");
  const std::int64_t components = in.integer("number of components");
  if (components < 1 || components > max_components)
    in.fail("field " + in_quotes(field.name) + " has " + std::to_string(components) +
            " components; 1, 3 and 9 are supported");
  const auto per_item = static_cast<std::size_t>(components);
  const std::int64_t promised = in.integer("number of rows");
  for (std::size_t i = 3; i < integers; ++i) (void)in.integer("integer tag");
  MshNumbers numbers_in = like.of(in);
  numbers_in.begin_binary();
  const std::size_t rows =
      numbers_in.checked_count(promised, "number of rows", 2 + 2 * per_item, 4 + 8 * per_item);
  field.components = static_cast<int>(components);
  for (std::size_t r = 0; r < rows; ++r) {
    const std::int64_t number = numbers_in.integer("number of a " + what);
    const Index item = numbers.find(number);
    if (item == no_index) {
      if (!missing_allowed)
        in.fail("field " + in_quotes(field.name) + " names " + what + " " + std::to_string(number) +
                ", which is not in the file; export it again");
      for (std::size_t k = 0; k < per_item; ++k) (void)numbers_in.number("value");
      continue;
    }
    if (field.values.empty()) {
      if (per_item * items > room)
        in.fail("field " + in_quotes(field.name) + " has " + std::to_string(rows) + " rows for " +
                std::to_string(items) + " " + what + "s; the fields of this file are mostly empty");
      room -= per_item * items;
      field.values.assign(per_item * items, std::numeric_limits<double>::quiet_NaN());
    }
    for (std::size_t k = 0; k < per_item; ++k) field.values[item * per_item + k] = numbers_in.number("value");
  }
  return field;
}

std::vector<MeshField> fields_of_elements(const TetMesh& mesh) {
  std::vector<MeshField> fields = mesh.cell_fields;
  if (fields.empty() || mesh.interfaces.empty()) return fields;
  const std::vector<TetFace> beside = faces_of_tets(mesh);
  for (MeshField& field : fields) {
    const auto n = static_cast<std::size_t>(field.components);
    field.values.reserve(field.values.size() + n * beside.size());
    for (const TetFace& face : beside)
      for (std::size_t k = 0; k < n; ++k) field.values.push_back(field.values[face.tet * n + k]);
  }
  return fields;
}

void append_msh_data(std::string& out, const std::string& section, const std::vector<MeshField>& fields,
                     std::size_t items, bool binary, const std::vector<std::size_t>& order,
                     const std::vector<std::size_t>& numbers) {
  const std::vector<std::string> names = field_names_to_write(fields, {}, msh_name);
  // Appends a section with `used` components of each item, from component `first` on, padded to `written`
  // components.
  const auto append_view = [&](const MeshField& field, const std::string& name, int first, int used,
                               int written) {
    out += "$" + section + "\n1\n\"" + name + "\"\n1\n0\n3\n0\n" + std::to_string(written) + "\n" +
           std::to_string(items) + "\n";
    const auto value = [&](std::size_t i, int k) {
      return k < used ? field.values[i * static_cast<std::size_t>(field.components) +
                                     static_cast<std::size_t>(first + k)]
                      : 0.0;
    };
    for (std::size_t row = 0; row < items; ++row) {
      const std::size_t i = order.empty() ? row : order[row];
      const std::size_t number = numbers.empty() ? i + 1 : numbers[i];
      if (binary) {
        append_bytes(out, static_cast<std::int32_t>(number));
        for (int k = 0; k < written; ++k) append_bytes(out, value(i, k));
        continue;
      }
      append_number(out, number);
      for (int k = 0; k < written; ++k) {
        out += ' ';
        append_value(out, value(i, k));
      }
      out += '\n';
    }
    if (binary) out += '\n';
    out += "$End" + section + "\n";
  };
  for (std::size_t f = 0; f < fields.size(); ++f) {
    const int n = fields[f].components;
    if (n <= max_components)
      append_view(fields[f], names[f], 0, n, n == 1 ? 1 : n <= 3 ? 3 : 9);
    else
      for (int k = 0; k < n; ++k) append_view(fields[f], names[f] + "_" + std::to_string(k), k, 1, 1);
  }
}

std::string msh_name(const std::string& name) {
  std::string out;
  for (char c : valid_utf8(name))
    out += c == '"' || c == '\\' || static_cast<unsigned char>(c) < ' ' ? '_' : c;
  if (out.size() <= max_name_bytes) return out;
  std::size_t end = max_name_bytes;
  while (end > 0 && (static_cast<unsigned char>(out[end]) & 0xC0) == 0x80) --end;  // cuts no character
  return out.substr(0, end);
}

}  // namespace tetwright
