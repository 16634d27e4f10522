// SPDX-License-Identifier: Apache-2.0
#include "common/io/tets/usd.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "common/geometry/predicates.h"
#include "common/io/text/text_writer.h"
#include "common/message_text.h"
#include "common/unique_names.h"
#include "common/utf8.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

NameRules usd_names() {
  return {.form = [](const std::string& name) { return plain_name(name); }};
}

using SinglePoint = std::array<float, 3>;

SinglePoint in_single_precision(const Vec3& p) {
  return {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())};
}

bool is_finite(const SinglePoint& p) {
  return std::all_of(p.begin(), p.end(), [](float x) { return std::isfinite(x); });
}

std::string usd_string(const std::string& name) {
  std::string out = "\"";
  for (const char c : printable_name(name)) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + '"';
}

/// Writes "(1, 2, 3)".
template <class Numbers>
void write_tuple(TextWriter& out, const Numbers& numbers) {
  const char* before = "(";
  for (const auto number : numbers) {
    out << before << number;
    before = ", ";
  }
  out << ')';
}

/// Writes the items of a list in brackets, several in a line.
class UsdList {
 public:
  UsdList(TextWriter& out, const std::string& attribute) : out_(out) { out_ << attribute << " = ["; }
  void begin_item() {
    if (count_ > 0) out_ << (count_ % items_in_line == 0 ? ",\n        " : ", ");
    ++count_;
  }
  void end() { out_ << "]\n"; }

 private:
  static constexpr std::size_t items_in_line = 8;
  TextWriter& out_;
  std::size_t count_ = 0;
};

void write_points(TextWriter& out, const TetMesh& mesh) {
  std::vector<SinglePoint> points;
  points.reserve(mesh.points.size());
  for (const Vec3& p : mesh.points) {
    points.push_back(in_single_precision(p));
    if (!is_finite(points.back()))
      throw InputError(
          "point " + place_text(p) +
          " is beyond single precision, in which .usda has coordinates; scale the mesh, or write "
          "another format");
  }
  SinglePoint low = points.front(), high = low;
  for (const SinglePoint& p : points)
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], p[k]);
      high[k] = std::max(high[k], p[k]);
    }
  out << "    float3[] extent = [";
  write_tuple(out, low);
  out << ", ";
  write_tuple(out, high);
  out << "]\n    uniform token orientation = \"rightHanded\"\n";
  UsdList list(out, "    point3f[] points");
  for (const SinglePoint& p : points) {
    list.begin_item();
    write_tuple(out, p);
  }
  list.end();
}

void write_subset(TextWriter& out, const char* type, const char* family, const std::string& name,
                  const std::string& own_name, std::int64_t number, const std::vector<std::uint64_t>& items) {
  out << "\n    def GeomSubset \"" << name << "\"\n    {\n        uniform token elementType = \"" << type
      << "\"\n        uniform token familyName = \"" << family << "\"\n";
  UsdList list(out, "        int[] indices");
  for (const std::uint64_t item : items) {
    list.begin_item();
    out << item;
  }
  list.end();
  out << "        custom string tetwright:name = " << usd_string(own_name)
      << "\n        custom int64 tetwright:number = " << number << "\n    }\n";
}

/// Parts of the mesh without groups of inner faces.
MeshParts parts_with_boundary(const TetMesh& mesh, const NameRules& rules) {
  MeshParts parts = mesh_parts(mesh, rules);
  for (MeshParts::Surface& surface : parts.surfaces)
    std::erase_if(surface.faces, [&](std::size_t f) { return mesh.interfaces[f].other.has_value(); });
  return parts;
}

}  // namespace

MeshParts usd_parts(const TetMesh& mesh) {
  MeshParts parts = names_of_parts(mesh, usd_names());
  // Subsets of tets and of faces are children of one mesh.
  UniqueNames unique([](const std::string& name) { return name; });
  for (MeshParts::Material& material : parts.materials) material.name = unique.add(material.name);
  for (MeshParts::Surface& surface : parts.surfaces) surface.name = unique.add(surface.name);
  return parts;
}

SinglePrecisionLoss single_precision_loss(const TetMesh& mesh) {
  SinglePrecisionLoss loss;
  std::vector<SinglePoint> points;
  for (const Vec3& p : mesh.points) points.push_back(in_single_precision(p));
  const auto exact = [&](Index v) { return Vec3(points[v][0], points[v][1], points[v][2]); };
  for (const Tet& tet : mesh.tets) {
    const bool finite = std::all_of(tet.begin(), tet.end(), [&](Index v) { return is_finite(points[v]); });
    if (finite && orient3d(exact(tet[0]), exact(tet[1]), exact(tet[2]), exact(tet[3])) > 0) continue;
    const auto p = [&](std::size_t k) { return mesh.points[tet[k]]; };
    if (orient3d(p(0), p(1), p(2), p(3)) <= 0) continue;
    if (loss.tets++ == 0) loss.first = (p(0) + p(1) + p(2) + p(3)) / 4;
  }
  // Equal points of the mesh are no loss.
  const auto distinct = [](auto all) {
    std::sort(all.begin(), all.end());
    return static_cast<std::size_t>(std::unique(all.begin(), all.end()) - all.begin());
  };
  std::vector<std::array<double, 3>> own;
  for (const Vec3& p : mesh.points) own.push_back({p.x(), p.y(), p.z()});
  loss.points = distinct(std::move(own)) - distinct(std::move(points));
  return loss;
}

void write_usd(const MeshToWrite& written, const ByteSink& sink) {
  const TetMesh& mesh = written.mesh;
  TETWRIGHT_CHECK(!written.midside);
  const MeshParts own = parts_with_boundary(mesh, printable_names()), names = usd_parts(mesh);
  TextWriter out(sink);
  out << "#usda 1.0\n(\n    defaultPrim = \"mesh\"\n    doc = \"Written by tetwright\"\n)\n\n"
      << "def TetMesh \"mesh\"\n{\n";
  write_points(out, mesh);
  UsdList tets(out, "    int4[] tetVertexIndices");
  for (const Tet& tet : mesh.tets) {
    tets.begin_item();
    write_tuple(out, tet);
  }
  tets.end();
  UsdList faces(out, "    int3[] surfaceFaceVertexIndices");
  std::vector<std::uint64_t> face_numbers(mesh.interfaces.size());
  std::uint64_t number = 0;
  for (std::size_t f = 0; f < mesh.interfaces.size(); ++f) {
    if (mesh.interfaces[f].other) continue;
    face_numbers[f] = number++;
    faces.begin_item();
    write_tuple(out, mesh.interfaces[f].ids);
  }
  faces.end();
  out << "    uniform token subsetFamily:materialBind:familyType = \"partition\"\n"
      << "    uniform token subsetFamily:boundary:familyType = \"nonOverlapping\"\n";
  for (std::size_t m = 0; m < own.materials.size(); ++m)
    write_subset(out, "tetrahedron", "materialBind", names.materials[m].name, own.materials[m].name,
                 own.materials[m].tag, {own.materials[m].tets.begin(), own.materials[m].tets.end()});
  for (std::size_t s = 0; s < own.surfaces.size(); ++s) {
    const MeshParts::Surface& surface = own.surfaces[s];
    if (surface.faces.empty()) continue;
    std::vector<std::uint64_t> items;
    for (const std::size_t f : surface.faces) items.push_back(face_numbers[f]);
    write_subset(out, "face", "boundary", names.surfaces[s].name, surface.name, surface.number, items);
  }
  out << "}\n";
  out.flush();
}

}  // namespace tetwright
