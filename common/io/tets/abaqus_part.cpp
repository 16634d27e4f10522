// SPDX-License-Identifier: Apache-2.0
#include "common/io/tets/abaqus_part.h"

#include <algorithm>
#include <optional>

#include "tetwright/parted_interfaces.h"

namespace tetwright {

namespace {

/// Kind of an element, as determined by the beginning of its type.
enum class AbaqusKind { tet, quadratic_tet, cohesive, volume, flat };

AbaqusKind kind_of_abaqus(const std::string& type) {
  if (type == "COH3D6") return AbaqusKind::cohesive;
  // C3D is a continuum element; with a prefix, AC3D is an acoustic and DC3D a thermal one.
  const std::size_t at = type.find("C3D");
  if (at > 1)  // or npos
    return type.starts_with("SC") || type.starts_with("CSS") ? AbaqusKind::volume : AbaqusKind::flat;
  std::string nodes;
  for (std::size_t i = at + 3; i < type.size() && type[i] >= '0' && type[i] <= '9'; ++i) nodes += type[i];
  return nodes == "4" ? AbaqusKind::tet : nodes == "10" ? AbaqusKind::quadratic_tet : AbaqusKind::volume;
}

void count(std::vector<std::pair<std::string, std::size_t>>& counts, const std::string& kind, std::size_t n) {
  if (n > 0) counts.emplace_back(kind, n);
}

/// Reads a data line "first, last, step".
void generate_numbers(std::vector<std::int64_t>& numbers, std::size_t max_numbers, const AbaqusLines& in) {
  const std::vector<std::string_view> fields = in.fields();
  if (fields.size() < 2) in.fail("expected the first and the last number, found " + in_quotes(in.text()));
  const std::int64_t first = in.whole_number(fields[0], "first number"),
                     last = in.whole_number(fields[1], "last number"),
                     step = fields.size() > 2 && !fields[2].empty() ? in.whole_number(fields[2], "step") : 1;
  if (step < 1) in.fail("a step of " + std::to_string(step) + "; it must be 1 or more");
  // Limit the numbers to as many as there are elements, whatever the file says.
  const auto max_steps = static_cast<std::int64_t>(std::max<std::size_t>(max_numbers, 1));
  if (last < first || (last - first) / step >= max_steps)
    in.fail(in_quotes(in.text()) + " are more elements than the " + std::to_string(max_numbers) +
            " tets before it");
  for (std::int64_t n = first; n <= last; n += step) numbers.push_back(n);
}

}  // namespace

bool AbaqusPart::read(const AbaqusKeyword& keyword, AbaqusLines& in, const AbaqusPart* instance) {
  if (keyword.name == "NODE")
    read_nodes(in);
  else if (keyword.name == "ELEMENT")
    read_elements(keyword, in);
  else if (keyword.name == "ELSET")
    read_set(keyword, in, (instance ? *instance : *this).element_count());
  else if (keyword.name == "NSET")
    note_node_set(keyword, in);
  else if (keyword.name == "SURFACE")
    read_surface(keyword, in);
  else if (keyword.name == "SOLIDSECTION")
    note_section(keyword, in);
  else
    return false;
  return true;
}

void AbaqusPart::read_nodes(AbaqusLines& in) {
  sorted_ = false;
  while (in.next_data()) {
    const std::vector<std::string_view> fields = in.fields();
    if (fields.size() < 4) in.fail("expected a number and three coordinates, found " + in_quotes(in.text()));
    nodes.add(in.whole_number(fields[0], "number of a node"));
    Vec3 p;
    for (std::size_t k = 0; k < 3; ++k)
      p[static_cast<Eigen::Index>(k)] = in.finite_number(fields[k + 1], "coordinate");
    if (points.size() >= no_index - 1)
      in.fail("more than " + std::to_string(no_index - 1) + " points; split the mesh");
    points.push_back(p);
  }
}

void AbaqusPart::read_elements(const AbaqusKeyword& keyword, AbaqusLines& in) {
  const std::string* type = keyword.find("TYPE");
  if (!type) in.fail(keyword.line, "*ELEMENT without TYPE=");
  const AbaqusKind kind = kind_of_abaqus(in_capitals(*type));
  const std::string* set = keyword.find("ELSET");
  const std::size_t nodes_each = kind == AbaqusKind::tet ? 4 : kind == AbaqusKind::cohesive ? 6 : 10;
  if (kind == AbaqusKind::cohesive) sort_nodes(in);
  if (kind == AbaqusKind::tet || kind == AbaqusKind::quadratic_tet) {
    sort_nodes(in);
    if (first_tets_line == 0) first_tets_line = keyword.line;
  }
  std::vector<std::int64_t> numbers;  // of an element; all of its lines but the last end with a comma
  std::size_t others_read = 0;
  while (in.next_data()) {
    const bool goes_on = in.text().ends_with(',');
    if (kind == AbaqusKind::volume || kind == AbaqusKind::flat) {
      others_read += goes_on ? 0 : 1;
      continue;
    }
    std::vector<std::string_view> fields = in.fields();
    if (goes_on) fields.pop_back();
    for (const std::string_view field : fields) numbers.push_back(in.whole_number(field, "number"));
    if (numbers.size() < nodes_each + 1 && goes_on) continue;
    if (numbers.size() != nodes_each + 1)
      in.fail("element " + std::to_string(numbers[0]) + " of type " + *type + " has " +
              std::to_string(numbers.size() - 1) + " nodes instead of " + std::to_string(nodes_each));
    if (kind == AbaqusKind::cohesive) {
      add_wedge(numbers, *type, keyword.line, in);
      numbers.clear();
      continue;
    }
    add_tet(numbers, set ? in_capitals(*set) : "", in);
    if (set) set_names.emplace(in_capitals(*set), *set);
    numbers.clear();
  }
  if (!numbers.empty()) in.fail("the file ends within an element; it is truncated");
  if (kind == AbaqusKind::volume) {
    if (volumes_line == 0) volumes_line = keyword.line;
    volumes.emplace_back("elements of type " + *type, others_read);
  } else if (kind == AbaqusKind::flat) {
    count(others, "elements of type " + *type, others_read);
  }
}

void AbaqusPart::sort_nodes(const AbaqusLines& in) {
  if (sorted_) return;
  sorted_ = true;
  if (const std::optional<std::int64_t> twice = nodes.sort())
    in.fail("node " + std::to_string(*twice) + " appears twice");
}

void AbaqusPart::sort_elements(const AbaqusLines& in) {
  if (const std::optional<std::int64_t> twice = elements.sort())
    in.fail("element " + std::to_string(*twice) + " appears twice");
}

Index AbaqusPart::node(std::int64_t element, std::int64_t number, const AbaqusLines& in) const {
  const Index index = nodes.find(number);
  if (index == no_index)
    in.fail("element " + std::to_string(element) + " refers to node " + std::to_string(number) +
            ", which no earlier *NODE defines; export the file again");
  return index;
}

void AbaqusPart::add_tet(const std::vector<std::int64_t>& numbers, const std::string& set,
                         const AbaqusLines& in) {
  Tet tet;
  for (std::size_t k = 0; k < 4; ++k) tet[k] = node(numbers[0], numbers[k + 1], in);
  tets.push_back(tet);
  elements.add(numbers[0]);
  block_set.push_back(index_of_set(set));
  if (numbers.size() == 5) return;
  std::array<Index, 6>& of_tet = midside.emplace_back();
  for (std::size_t k = 0; k < 6; ++k) of_tet[k] = node(numbers[0], numbers[k + 5], in);
}

void AbaqusPart::add_wedge(const std::vector<std::int64_t>& numbers, const std::string& type,
                           std::size_t line, const AbaqusLines& in) {
  Wedge wedge;
  for (std::size_t k = 0; k < wedge.size(); ++k) wedge[k] = node(numbers[0], numbers[k + 1], in);
  if (is_cohesive(wedge, points)) {
    wedges.push_back(wedge);
    return;
  }
  if (volumes_line == 0) volumes_line = line;
  count(volumes, "elements of type " + type + " whose nodes do not coincide in pairs", 1);
}

std::uint32_t AbaqusPart::index_of_set(const std::string& set) {
  const auto [known, added] = block_sets.try_emplace(set, static_cast<std::uint32_t>(block_names.size()));
  if (added) block_names.push_back(set);
  return known->second;
}

std::size_t AbaqusPart::element_count() const {
  std::size_t count = elements.size() + wedges.size();
  for (const auto* kinds : {&volumes, &others})
    for (const auto& [kind, n] : *kinds) count += n;
  return count;
}

void AbaqusPart::read_set(const AbaqusKeyword& keyword, AbaqusLines& in, std::size_t max_numbers) {
  const std::string *name = keyword.find("ELSET"), *instance = keyword.find("INSTANCE");
  if (!name || name->empty()) in.fail(keyword.line, "*ELSET without a name");
  std::vector<Members>& set = sets[in_capitals(*name)];
  Members& members = set.emplace_back(Members{instance ? in_capitals(*instance) : "", keyword.line, {}, {}});
  set_names.emplace(in_capitals(*name), *name);
  const bool generate = keyword.find("GENERATE") != nullptr;
  while (in.next_data())
    if (generate)
      generate_numbers(members.numbers, max_numbers, in);
    else
      for (const std::string_view field : in.fields()) {
        if (field.empty()) continue;
        if (std::int64_t number = 0; parse_number(field, number))
          members.numbers.push_back(number);
        else
          members.sets.push_back(in_capitals(field));
      }
}

void AbaqusPart::note_node_set(const AbaqusKeyword& keyword, AbaqusLines& in) {
  if (const std::string* name = keyword.find("NSET")) node_sets.push_back(*name);
  in.skip_data();
}

void AbaqusPart::read_surface(const AbaqusKeyword& keyword, AbaqusLines& in) {
  const std::string* name = keyword.find("NAME");
  const std::string* type = keyword.find("TYPE");
  if (!name || name->empty()) in.fail(keyword.line, "*SURFACE without NAME=");
  if (type && in_capitals(*type) != "ELEMENT") {
    other_surfaces.push_back(*name);
    return;
  }
  std::vector<Side>& sides = surfaces[*name];
  const std::string* instance = keyword.find("INSTANCE");
  const std::string prefix = instance ? in_capitals(*instance) + "." : "";
  while (in.next_data()) {
    const std::vector<std::string_view> fields = in.fields();
    const std::string side = fields.size() > 1 ? in_capitals(fields[1]) : "";
    if (side.size() != 2 || side[0] != 'S' || side[1] < '1' || side[1] > '4')
      in.fail("expected an element or set and its side S1 to S4, found " + in_quotes(in.text()));
    sides.push_back({prefix + in_capitals(fields[0]), side[1] - '0', in.number()});
  }
}

void AbaqusPart::note_section(const AbaqusKeyword& keyword, AbaqusLines& in) {
  const std::string* set = keyword.find("ELSET");
  if (!set) in.fail(keyword.line, "*SOLID SECTION without ELSET=");
  sections.emplace_back(in_capitals(*set), keyword.line);
}

}  // namespace tetwright
