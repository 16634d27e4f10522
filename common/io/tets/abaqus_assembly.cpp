// SPDX-License-Identifier: Apache-2.0
#include "common/io/tets/abaqus_assembly.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "common/io/names/mesh_parts.h"
#include "common/io/surfaces/placed_limit.h"
#include "common/portable_math.h"
#include "common/unique_names.h"

namespace tetwright {

Vec3 AbaqusPlacement::operator()(const Vec3& p) const {
  Vec3 moved = translation ? Vec3(p + *translation) : p;
  if (rotation) {
    const auto& [point, axis, cosine, sine] = *rotation;
    const Vec3 from_axis = moved - point;
    // Rodrigues' formula.
    moved = point + cosine * from_axis + sine * axis.cross(from_axis) +
            ((1 - cosine) * axis.dot(from_axis)) * axis;
  }
  return moved;
}

AbaqusPlacement AbaqusPlacement::read(AbaqusLines& in) {
  AbaqusPlacement placement;
  const auto numbers = [&](std::size_t least, std::size_t most, const char* what) {
    std::vector<std::string_view> fields = in.fields();
    while (fields.size() > least && fields.back().empty()) fields.pop_back();
    if (fields.size() < least || fields.size() > most)
      in.fail("expected " + std::to_string(most) + " numbers of a " + what + ", found " +
              in_quotes(in.text()));
    std::vector<double> values(most, 0.0);
    for (std::size_t i = 0; i < fields.size(); ++i)
      if (!fields[i].empty()) values[i] = in.finite_number(fields[i], what);
    return values;
  };
  if (!in.next_data()) return placement;
  const std::vector<double> t = numbers(1, 3, "translation");
  if (t != std::vector<double>(3, 0.0)) placement.translation = Vec3(t[0], t[1], t[2]);
  if (!in.next_data()) return placement;
  const std::vector<double> r = numbers(7, 7, "rotation");
  const Vec3 a(r[0], r[1], r[2]), b(r[3], r[4], r[5]);
  const Vec3 axis = b - a;
  const double length = axis.cwiseAbs().maxCoeff();
  if (length == 0) in.fail("the axis of the rotation has no length: both of its points are " + place_text(a));
  if (!std::isfinite(length)) in.fail("the points of the rotation's axis are too far apart");
  const auto [cosine, sine] = portable_cosine_sine(r[6]);
  if (sine != 0 || cosine != 1) placement.rotation = {a, Vec3(axis / length).normalized(), cosine, sine};
  if (in.next_data())
    in.fail("a third line of an *INSTANCE, which has a translation and a rotation; found " +
            in_quotes(in.text()));
  return placement;
}

AbaqusAssembly::AbaqusAssembly(const AbaqusLines& in, const AbaqusPart& root,
                               const std::vector<AbaqusInstance>& instances)
    : in_(in), root_(root), instances_(instances) {
  std::size_t tets = 0;
  for (const AbaqusInstance& instance : instances_) {
    const AbaqusPart& mesh = instance.mesh();
    if (!instance.name.empty())
      bodies_by_name_[in_capitals(instance.name)] = mesh.tets.empty() ? no_body : bodies_.size();
    if (mesh.tets.empty()) continue;
    bodies_.push_back({&instance, &mesh, tets});
    tets += mesh.tets.size();
  }
}

std::string AbaqusAssembly::name_in(const Body& body, const std::string& name) const {
  if (!several()) return name;
  return name.empty() ? body.instance->name : body.instance->name + "." + name;
}

void AbaqusAssembly::fill(ReadTetMesh& read, MidsideNodesRead& midside) {
  TetMesh& mesh = read.mesh;
  PlacedLimit limit;
  std::set<const AbaqusPart*> placed;
  for (const Body& body : bodies_) {
    const AbaqusPart& part = *body.mesh;
    const AbaqusPlacement& place = body.instance->placement;
    if (!placed.insert(&part).second) limit.add(part.points.size() + part.tets.size(), in_.file());
    if (mesh.points.size() + part.points.size() >= no_index)
      in_.fail(body.instance->line, "more than " + std::to_string(no_index - 1) + " points; split the mesh");
    const auto first = static_cast<Index>(mesh.points.size());
    mesh.points.insert(mesh.points.end(), part.points.begin(), part.points.end());
    if (place)
      for (std::size_t i = first; i < mesh.points.size(); ++i) {
        mesh.points[i] = place(mesh.points[i]);
        if (!mesh.points[i].allFinite())
          in_.fail(body.instance->line, "translation or rotation moves node " +
                                            place_text(part.points[i - first]) +
                                            " out of the range of numbers");
      }
    mesh.tets.reserve(mesh.tets.size() + part.tets.size());
    for (Tet tet : part.tets) {
      for (Index& v : tet) v += first;
      mesh.tets.push_back(tet);
    }
    for (Wedge wedge : part.wedges) {
      for (Index& v : wedge) v += first;
      mesh.wedges.push_back(wedge);
    }
    for (std::array<Index, 6> nodes : part.midside) {
      for (Index& v : nodes) v += first;
      midside.add_tet(nodes);
    }
  }
  set_materials(read);
}

bool AbaqusAssembly::add_tet_of(const Body& body, std::int64_t number, std::vector<Index>& tets) {
  const Index t = body.mesh->elements.find(number);
  if (t != no_index) tets.push_back(static_cast<Index>(body.first_tet + t));
  return t != no_index;
}

/// Refuses sets in sets that no program nests so deeply.
void AbaqusAssembly::check_nesting(std::size_t sets, std::size_t line) const {
  constexpr std::size_t max_sets = 1000;
  if (sets > max_sets)
    in_.fail(line,
             "more than " + std::to_string(max_sets) + " element sets include each other; list the elements");
}

/// Collects the tets in a set and in the sets that it includes.
void AbaqusAssembly::add_tets_of(const Body& body, const std::string& set, std::size_t line,
                                 std::set<std::string>& open, std::vector<Index>& tets) const {
  if (!open.insert(set).second) return;  // the set includes itself
  check_nesting(open.size(), line);
  const AbaqusPart& part = *body.mesh;
  if (!part.has_set(set))
    in_.fail(line, "there is no element set " + in_quotes(set) +
                       (several() ? " in the instance " + in_quotes(body.instance->name) : ""));
  if (const auto block = part.block_sets.find(set); block != part.block_sets.end())
    for (std::size_t t = 0; t < part.block_set.size(); ++t)
      if (part.block_set[t] == block->second) tets.push_back(static_cast<Index>(body.first_tet + t));
  const auto known = part.sets.find(set);
  if (known == part.sets.end()) return;
  for (const AbaqusPart::Members& members : known->second) {
    for (const std::int64_t number : members.numbers) (void)add_tet_of(body, number, tets);
    for (const std::string& other : members.sets) add_tets_of(body, other, line, open, tets);
  }
}

const AbaqusAssembly::Body* AbaqusAssembly::body_of(const std::string& instance, std::size_t line) const {
  const auto known = bodies_by_name_.find(instance);
  if (known == bodies_by_name_.end()) in_.fail(line, "there is no instance " + in_quotes(instance));
  return known->second == no_body ? nullptr : &bodies_[known->second];
}

void AbaqusAssembly::add_tets_of_root(const std::string& name, std::size_t line, std::set<std::string>& open,
                                      std::vector<Index>& tets) {
  const auto add_of = [&](const Body& body, const std::string& what) {
    std::set<std::string> open_there;
    if (std::int64_t number = 0; parse_number(what, number))
      other_faces_ += add_tet_of(body, number, tets) ? 0 : 1;
    else
      add_tets_of(body, what, line, open_there, tets);
  };
  if (const auto set = root_.sets.find(name); set != root_.sets.end()) {
    if (!open.insert(name).second) return;
    check_nesting(open.size(), line);
    for (const AbaqusPart::Members& members : set->second) {
      const Body* body = !members.instance.empty() ? body_of(members.instance, members.line)
                         : several()               ? nullptr
                                                   : &bodies_.front();
      if (body)
        for (const std::int64_t number : members.numbers) (void)add_tet_of(*body, number, tets);
      for (const std::string& other : members.sets)
        if (members.instance.empty())
          add_tets_of_root(other, members.line, open, tets);
        else if (body)
          add_of(*body, other);
    }
    return;
  }
  for (std::size_t dot = name.find('.'); dot != std::string::npos; dot = name.find('.', dot + 1))
    if (bodies_by_name_.contains(name.substr(0, dot))) {
      if (const Body* body = body_of(name.substr(0, dot), line)) add_of(*body, name.substr(dot + 1));
      return;
    }
  if (several()) in_.fail(line, "there is no element set " + in_quotes(name) + " in the assembly");
  add_of(bodies_.front(), name);
}

/// Materials of a body, with the names that they have among those of others.
std::vector<AbaqusAssembly::Material> AbaqusAssembly::materials_of(const Body& body) const {
  const AbaqusPart& part = *body.mesh;
  std::vector<Material> materials;
  const auto spelled = [&](const std::string& key) {
    const auto known = part.set_names.find(key);
    if (known == part.set_names.end()) return std::string();
    const auto own = several() ? in_.material_names().end() : in_.material_names().find(key);
    return own == in_.material_names().end() ? known->second : own->second;
  };
  for (const auto& [set, line] : part.sections) {
    std::set<std::string> open;
    std::vector<Index> tets;
    add_tets_of(body, set, line, open, tets);
    if (!tets.empty()) materials.push_back({set, spelled(set), std::move(tets)});
  }
  if (materials.empty() && !(part.block_names.size() == 1 && part.block_names[0].empty())) {
    for (const std::string& name : part.block_names) materials.push_back({name, spelled(name), {}});
    for (std::size_t t = 0; t < part.block_set.size(); ++t)
      materials[part.block_set[t]].tets.push_back(static_cast<Index>(body.first_tet + t));
  }
  if (!several()) return materials;
  std::vector<Index> all;
  for (const Material& m : materials) all.insert(all.end(), m.tets.begin(), m.tets.end());
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  const bool one = materials.size() == 1 && all.size() == part.tets.size();
  for (Material& m : materials) m.name = name_in(body, one ? "" : m.name);
  if (all.size() == part.tets.size()) return materials;
  Material rest{"", body.instance->name, {}};
  for (std::size_t t = 0; t < part.tets.size(); ++t)
    if (const auto id = static_cast<Index>(body.first_tet + t);
        !std::binary_search(all.begin(), all.end(), id))
      rest.tets.push_back(id);
  materials.push_back(std::move(rest));
  return materials;
}

std::vector<AbaqusAssembly::Material> AbaqusAssembly::all_materials() {
  std::vector<Material> materials;
  for (const Body& body : bodies_)
    for (Material& m : materials_of(body)) materials.push_back(std::move(m));
  if (&root_ == bodies_.front().mesh) return materials;
  for (const auto& [set, line] : root_.sections) {
    std::set<std::string> open;
    Material m{set, "", {}};
    add_tets_of_root(set, line, open, m.tets);
    if (const auto known = root_.set_names.find(set); known != root_.set_names.end()) m.name = known->second;
    if (!m.tets.empty()) materials.push_back(std::move(m));
  }
  return materials;
}

void AbaqusAssembly::set_materials(ReadTetMesh& read) {
  TetMesh& mesh = read.mesh;
  const std::vector<Material> materials = all_materials();
  if (materials.empty()) return;
  // Comments of write_abaqus() are in files without instances.
  const std::map<std::string, MaterialTag> tags =
      several() ? std::map<std::string, MaterialTag>() : in_.tags();
  std::set<MaterialTag> taken;
  for (const Material& m : materials)
    if (const auto tag = tags.find(m.key); tag != tags.end()) taken.insert(tag->second);
  MaterialTag next = 1;
  const auto free_tag = [&] {
    while (taken.contains(next)) ++next;
    return next++;
  };
  constexpr std::int64_t none = std::numeric_limits<std::int64_t>::min();
  std::vector<std::int64_t> of_tets(mesh.tets.size(), none);
  UniqueNames unique([](const std::string& name) { return name; }, true);
  for (const Material& m : materials) {
    const auto known = tags.find(m.key);
    const MaterialTag tag = known != tags.end() ? known->second : free_tag();
    for (const Index t : m.tets) {
      if (of_tets[t] != none && of_tets[t] != tag) ++twice_;
      of_tets[t] = tag;
    }
    if (!m.name.empty()) mesh.material_names[tag] = several() ? unique.add(m.name) : m.name;
  }
  const MaterialTag rest = free_tag();
  for (const std::int64_t tag : of_tets)
    mesh.materials.push_back(tag == none ? rest : static_cast<MaterialTag>(tag));
  const auto has_sections = [](const AbaqusPart* part) { return !part->sections.empty(); };
  const std::vector<const AbaqusPart*> parts = used_parts();
  read.material_field = std::any_of(parts.begin(), parts.end(), has_sections) ? "SOLID SECTION" : "ELSET";
}

FileTriangles AbaqusAssembly::triangles(const std::vector<Tet>& tets) {
  // Corners of each face.
  constexpr std::array<std::array<std::size_t, 3>, 4> corners{{{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}}};
  FileTriangles triangles;
  triangles.name_form = [](const std::string& name) { return plain_name(name); };
  std::map<std::string, std::vector<std::array<Index, 2>>> surfaces;  // tets and sides, by name
  for (const Body& body : bodies_)
    for (const auto& [name, sides] : body.mesh->surfaces) {
      auto& faces = surfaces[name_in(body, name)];
      for (const AbaqusPart::Side& side : sides) {
        std::vector<Index> of_side;
        std::set<std::string> open;
        if (std::int64_t number = 0; parse_number(side.what, number))
          other_faces_ += add_tet_of(body, number, of_side) ? 0 : 1;
        else
          add_tets_of(body, side.what, side.line, open, of_side);
        for (const Index t : of_side) faces.push_back({t, static_cast<Index>(side.side)});
      }
    }
  if (&root_ != bodies_.front().mesh)
    for (const auto& [name, sides] : root_.surfaces) {
      auto& faces = surfaces[name];
      for (const AbaqusPart::Side& side : sides) {
        std::vector<Index> of_side;
        std::set<std::string> open;
        add_tets_of_root(side.what, side.line, open, of_side);
        for (const Index t : of_side) faces.push_back({t, static_cast<Index>(side.side)});
      }
    }
  std::int64_t number = 0;
  for (const auto& [name, faces] : surfaces) {
    const auto own = several() ? in_.surface_names().end() : in_.surface_names().find(in_capitals(name));
    triangles.names[++number] = own == in_.surface_names().end() ? name : own->second;
    for (const auto& [t, side] : faces) {
      const auto& c = corners[side - 1];
      triangles.add({tets[t][c[0]], tets[t][c[1]], tets[t][c[2]]}, number);
    }
  }
  return triangles;
}

std::vector<const AbaqusPart*> AbaqusAssembly::used_parts() const {
  std::vector<const AbaqusPart*> parts;
  const auto add = [&](const AbaqusPart* part) {
    if (std::find(parts.begin(), parts.end(), part) == parts.end()) parts.push_back(part);
  };
  for (const AbaqusInstance& instance : instances_) add(&instance.mesh());
  add(&root_);
  return parts;
}

/// Number of cohesive elements in the assembly, and in parts without tets.
std::size_t AbaqusAssembly::wedges_left_out() const {
  std::size_t count = 0;
  for (const AbaqusPart* part : used_parts())
    if (part->tets.empty()) count += part->wedges.size();
  return count;
}

void AbaqusAssembly::note_dropped(std::vector<Dropped>& dropped) const {
  KindCounts others;
  std::vector<std::string> node_sets, node_surfaces, element_sets, empty;
  bool sections = false;
  for (const AbaqusPart* part : used_parts()) {
    for (const auto& [kind, n] : part->others) others.add(kind, n);
    for (const std::string& name : part->node_sets)
      if (!part->surfaces.contains(name)) node_sets.push_back(name);
    node_surfaces.insert(node_surfaces.end(), part->other_surfaces.begin(), part->other_surfaces.end());
    for (const auto& [key, set] : part->sets) element_sets.push_back(part->set_names.at(key));
    sections = sections || !part->sections.empty();
  }
  if (other_faces_ > 0) others.add("faces of other elements in surfaces", other_faces_);
  if (&root_ != bodies_.front().mesh && !root_.points.empty())
    others.add("nodes outside of parts", root_.points.size());
  if (const std::size_t wedges = wedges_left_out(); wedges > 0)
    others.add("cohesive elements outside of parts with tets", wedges);
  others.append_to(dropped);
  if (twice_ > 0) dropped.push_back({"tets in several sections; the last one is used", twice_});
  append_dropped_names(dropped, "node sets", node_sets);
  append_dropped_names(dropped, "surfaces of nodes", node_surfaces);
  if (!sections) append_dropped_names(dropped, "element sets", element_sets);
  for (const AbaqusInstance& instance : instances_)
    if (instance.mesh().tets.empty()) empty.push_back(instance.name);
  append_dropped_names(dropped, "instances without tets", empty);
}

}  // namespace tetwright
