// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <set>
#include <vector>

#include "common/io/names/mesh_parts.h"
#include "common/io/tets/msh.h"
#include "common/io/tets/msh4_numbers.h"
#include "common/io/tets/msh_data.h"
#include "common/io/tets/msh_elements.h"
#include "common/io/tets/msh_groups.h"
#include "common/io/text/text_writer.h"

namespace tetwright {

namespace {

/// A volume or surface of Gmsh's model.
struct Entity {
  int dimension;
  std::int64_t number;
  std::vector<std::int64_t> physical;  ///< groups
  std::vector<std::size_t> elements;   ///< tets or interface triangles
  std::set<std::int64_t> bounds;       ///< surfaces of a volume, negative if their normals point into it
  std::vector<Index> nodes;            ///< nodes classified on the entity, ascending
  Vec3 min = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 max = -min;
};

class Msh4Writer {
 public:
  Msh4Writer(const MeshToWrite& written, bool binary, const ByteSink& sink)
      : written_(written),
        mesh_(written.mesh),
        groups_(mesh_),
        out_(sink),
        numbers_(out_, binary),
        binary_(binary),
        physical_(msh4_volumes(mesh_)) {
    bins_ = msh_bins(mesh_, written.bins);
    name_cohesive();
    collect_entities();
    classify_nodes();
  }

  void write() {
    numbers_.begin_file();
    std::map<std::int64_t, std::string> further = names_of_bins();
    for (const CohesivePart& part : cohesive_) further[part.number] = part.name;
    write_msh4_groups(out_, groups_, physical_, further);
    write_entities();
    write_nodes();
    write_elements();
    std::string data;
    append_msh_data(data, "NodeData", written_.node_fields(), written_.nodes(), binary_, order_of_nodes());
    append_msh_data(data, "ElementData", fields_of_elements(mesh_),
                    mesh_.tets.size() + mesh_.interfaces.size(), binary_, order_of_elements());
    out_ << data;
    out_.flush();
  }

 private:
  std::map<std::int64_t, std::string> names_of_bins() const {
    std::map<std::int64_t, std::string> names;
    for (const BinDivision& division : bins_)
      for (const BinPart& bin : division.parts) names[bin.number] = bin.name;
    return names;
  }

  void name_cohesive() {
    std::map<std::int64_t, std::string> names = names_of_bins();
    std::set<std::int64_t> numbers;
    for (const auto& [tag, number] : physical_) numbers.insert(number);
    for (const auto& [tag, name] : groups_.material_names)
      if (const auto number = physical_.find(tag); number != physical_.end()) names[number->second] = name;
    cohesive_ = msh_cohesive(mesh_, numbers, names);
  }

  void collect_entities() {
    std::map<std::int64_t, Entity> surfaces, volumes;
    for (std::size_t i = 0; i < mesh_.interfaces.size(); ++i) {
      const InterfaceTriangle& t = mesh_.interfaces[i];
      const std::int64_t number = groups_.faces.number_of(t);
      Entity& surface =
          surfaces.try_emplace(number, Entity{surface_dimension, number, {number}, {}, {}, {}}).first->second;
      surface.elements.push_back(i);
      // A sheet bounds no volume, and faces between bins, which bound theirs, are not in the file.
      if (t.is_sheet() || !bins_.empty()) continue;
      volume(volumes, t.material).bounds.insert(number);
      if (t.other) volume(volumes, *t.other).bounds.insert(-number);
    }
    if (bins_.empty())
      for (std::size_t t = 0; t < mesh_.tets.size(); ++t)
        volume(volumes, mesh_.materials[t]).elements.push_back(t);
    else
      add_volumes_of_bins(volumes);
    for (auto* entities : {&surfaces, &volumes})
      for (auto& [number, entity] : *entities) entities_.push_back(std::move(entity));
    surfaces_ = surfaces.size();
    volumes_ = entities_.size() - surfaces_;
    std::int64_t last = volumes.empty() ? 0 : volumes.rbegin()->first;
    for (const CohesivePart& part : cohesive_) {
      last = std::max(last + 1, part.number);
      entities_.push_back({volume_dimension, last, {part.number}, part.wedges, {}, {}});
    }
  }

  /// The kinds of elements, in the order in which they are numbered.
  enum class Kind { tets, triangles, wedges };
  Kind kind_of(const Entity& entity) const {
    if (entity.dimension == surface_dimension) return Kind::triangles;
    return &entity >= entities_.data() + surfaces_ + volumes_ ? Kind::wedges : Kind::tets;
  }
  /// Number of an element, less one.
  std::size_t number_of(Kind kind, std::size_t element) const {
    return (kind == Kind::tets        ? 0
            : kind == Kind::triangles ? mesh_.tets.size()
                                      : mesh_.tets.size() + mesh_.interfaces.size()) +
           element;
  }

  /// Adds a volume for each combination of bins that a tet is in, which is in the groups of all of them.
  void add_volumes_of_bins(std::map<std::int64_t, Entity>& volumes) const {
    std::map<std::vector<std::uint32_t>, std::int64_t> number_of;
    std::vector<std::uint32_t> key(bins_.size());
    const auto key_of = [&](std::size_t t) -> const std::vector<std::uint32_t>& {
      for (std::size_t d = 0; d < bins_.size(); ++d) key[d] = bins_[d].bins->of_tets[t];
      return key;
    };
    for (std::size_t t = 0; t < mesh_.tets.size(); ++t) number_of.try_emplace(key_of(t), 0);
    // With one division a volume has the number of its bin.
    const std::vector<BinPart>& leading = bins_.front().parts;
    std::int64_t last = leading.front().number - 1;
    for (auto& [bins, number] : number_of) {
      number = bins_.size() == 1 ? leading[bins[0]].number : ++last;
      Entity entity{volume_dimension, number, {physical_.at(leading[bins[0]].bin->material)}, {}, {}, {}};
      for (std::size_t d = 0; d < bins_.size(); ++d)
        entity.physical.push_back(bins_[d].parts[bins[d]].number);
      volumes.emplace(number, std::move(entity));
    }
    for (std::size_t t = 0; t < mesh_.tets.size(); ++t)
      volumes.at(number_of.at(key_of(t))).elements.push_back(t);
  }

  Entity& volume(std::map<std::int64_t, Entity>& volumes, MaterialTag tag) const {
    const std::int64_t number = physical_.at(tag);
    return volumes.try_emplace(number, Entity{volume_dimension, number, {number}, {}, {}, {}}).first->second;
  }

  /// Classifies each node on the first entity that has an element at it, surfaces before volumes.
  void classify_nodes() {
    std::vector<std::uint8_t> done(written_.nodes(), 0);
    for (Entity& entity : entities_) {
      for (const std::size_t e : entity.elements)
        for (const Index node : nodes_of(entity, e)) {
          const Vec3& p = written_.node(node);
          entity.min = entity.min.cwiseMin(p);
          entity.max = entity.max.cwiseMax(p);
          if (done[node]) continue;
          done[node] = 1;
          entity.nodes.push_back(node);
        }
      std::sort(entity.nodes.begin(), entity.nodes.end());
    }
    // Nodes without a tet.
    Entity& rest = entities_[surfaces_ + volumes_ - 1];
    for (std::size_t node = 0; node < done.size(); ++node)
      if (!done[node]) rest.nodes.push_back(static_cast<Index>(node));
  }

  /// Nodes of an element in Gmsh's order.
  std::vector<Index> nodes_of(const Entity& entity, std::size_t element) const {
    std::vector<Index> nodes;
    const auto add = [&](const auto& corners) { nodes.insert(nodes.end(), corners.begin(), corners.end()); };
    const auto add_midside = [&](Index m) { nodes.push_back(static_cast<Index>(mesh_.points.size()) + m); };
    const Kind kind = kind_of(entity);
    if (kind == Kind::wedges) {
      add(mesh_.wedges[element]);
    } else if (kind == Kind::triangles) {
      add(mesh_.interfaces[element].ids);
      if (written_.midside)
        for (const Index m : written_.midside->of_faces[element]) add_midside(m);
    } else {
      add(mesh_.tets[element]);
      if (written_.midside)
        for (const std::size_t m : msh_midside_order) add_midside(written_.midside->of_tets[element][m]);
    }
    return nodes;
  }

  void write_entities() {
    out_ << "$Entities\n";
    numbers_.size(0).size(0).size(surfaces_).size(entities_.size() - surfaces_).end_line();
    for (const Entity& entity : entities_) {
      numbers_.integer(entity.number);
      for (const Vec3& corner : {entity.min, entity.max})
        for (const double x : corner) numbers_.real(x);
      numbers_.size(entity.physical.size());
      for (const std::int64_t group : entity.physical) numbers_.integer(group);
      numbers_.size(entity.bounds.size());
      for (const std::int64_t bound : entity.bounds) numbers_.integer(bound);
      numbers_.end_line();
    }
    numbers_.end("Entities");
  }

  void write_nodes() {
    out_ << "$Nodes\n";
    const auto used = static_cast<std::size_t>(
        std::count_if(entities_.begin(), entities_.end(), [](const Entity& e) { return !e.nodes.empty(); }));
    numbers_.size(used).size(written_.nodes()).size(1).size(written_.nodes()).end_line();
    for (const Entity& entity : entities_) {
      if (entity.nodes.empty()) continue;
      begin_block(entity, 0, entity.nodes.size());
      for (const Index node : entity.nodes) numbers_.size(node + std::size_t{1}).end_line();
      for (const Index node : entity.nodes) {
        for (const double x : written_.node(node)) numbers_.real(x);
        numbers_.end_line();
      }
    }
    numbers_.end("Nodes");
  }

  void begin_block(const Entity& entity, std::int64_t kind, std::size_t items) {
    numbers_.integer(entity.dimension).integer(entity.number).integer(kind).size(items).end_line();
  }

  /// Writes the elements. Tets are numbered from 1 in the order of the mesh, followed by the triangles and
  /// the wedges, since fields refer to tets by these numbers.
  void write_elements() {
    out_ << "$Elements\n";
    const std::size_t all = mesh_.tets.size() + mesh_.interfaces.size() + mesh_.wedges.size();
    numbers_.size(entities_.size()).size(all).size(1).size(all).end_line();
    for (const Entity& entity : entities_) {
      const Kind kind = kind_of(entity);
      const bool quadratic = written_.midside != nullptr;
      begin_block(entity,
                  kind == Kind::wedges ? element::wedge.msh
                  : kind == Kind::triangles
                      ? (quadratic ? element::quadratic_triangle : element::triangle).msh
                      : (quadratic ? element::quadratic_tet : element::tet).msh,
                  entity.elements.size());
      for (const std::size_t e : entity.elements) {
        numbers_.size(number_of(kind, e) + 1);
        for (const Index node : nodes_of(entity, e)) numbers_.size(node + std::size_t{1});
        numbers_.end_line();
      }
    }
    numbers_.end("Elements");
  }

  // Orders in which write_nodes() and write_elements() list their items.
  std::vector<std::size_t> order_of_nodes() const {
    std::vector<std::size_t> order;
    for (const Entity& entity : entities_)
      order.insert(order.end(), entity.nodes.begin(), entity.nodes.end());
    return order;
  }
  std::vector<std::size_t> order_of_elements() const {
    std::vector<std::size_t> order;
    // Fields have no values of wedges.
    for (const Entity& entity : entities_)
      if (const Kind kind = kind_of(entity); kind != Kind::wedges)
        for (const std::size_t e : entity.elements) order.push_back(number_of(kind, e));
    return order;
  }

  const MeshToWrite& written_;
  const TetMesh& mesh_;
  MshGroups groups_;
  TextWriter out_;
  Msh4Numbers numbers_;
  bool binary_;
  std::map<std::int64_t, std::int64_t> physical_;  ///< physical groups by material
  std::vector<BinDivision> bins_;                  ///< their combinations are volumes
  std::vector<CohesivePart> cohesive_;             ///< likewise
  std::vector<Entity> entities_;                   ///< surfaces, then volumes, the cohesive ones last
  std::size_t surfaces_ = 0, volumes_ = 0;         ///< numbers of them, without the cohesive ones
};

}  // namespace

void write_msh41(const MeshToWrite& written, const ByteSink& sink) {
  Msh4Writer(written, false, sink).write();
}

void write_msh41_binary(const MeshToWrite& written, const ByteSink& sink) {
  Msh4Writer(written, true, sink).write();
}

}  // namespace tetwright
