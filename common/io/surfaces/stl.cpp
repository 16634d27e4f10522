// SPDX-License-Identifier: Apache-2.0
#include "common/io/surfaces/stl.h"

#include <cctype>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "common/io/encodings/byte_order.h"
#include "common/io/names/group_text.h"
#include "common/io/surfaces/declared_space.h"
#include "common/io/surfaces/point_merger.h"
#include "common/io/surfaces/surface_builder.h"
#include "common/io/text/text_scanner.h"
#include "common/number_text.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

constexpr std::size_t stl_text_size = 80;                   ///< arbitrary bytes at the beginning
constexpr std::size_t stl_header_size = stl_text_size + 4;  ///< and the number of triangles
constexpr std::size_t record_size = 50;                     ///< normal, three points, two bytes of attributes

TriangleMesh read_binary(std::string_view bytes, const std::string& name, std::size_t triangles,
                         std::vector<Dropped>* dropped) {
  SurfaceBuilder surface(name);
  surface.reserve(triangles / 2, triangles);
  PointMerger merger(surface, triangles / 2);
  for (std::size_t t = 0; t < triangles; ++t) {
    const std::size_t begin = stl_header_size + t * record_size + 12;
    std::array<std::int64_t, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t at = begin + 12 * k;
      Vec3 p;
      for (std::size_t d = 0; d < 3; ++d)
        p[d] = load<float>(bytes.data() + at + 4 * d, !little_endian_machine);
      corners[k] = merger.add(p, [&] { return "byte " + std::to_string(at); });
    }
    surface.add_fan(corners);
    if (bytes[begin + 36] != 0 || bytes[begin + 37] != 0) surface.drop("triangles with attribute bytes");
  }
  const std::size_t end = stl_header_size + triangles * record_size;
  surface.drop("bytes after the last triangle", bytes.size() - end);
  TriangleMesh mesh = surface.finish(dropped);
  mesh.space = declared_space(bytes.substr(0, stl_text_size));
  return mesh;
}

/// Compares without regard to case.
/// \param expected in lower case
bool is_word(std::string_view word, std::string_view expected) {
  return std::equal(word.begin(), word.end(), expected.begin(), expected.end(),
                    [](char a, char b) { return std::tolower(static_cast<unsigned char>(a)) == b; });
}

void expect(TextScanner& in, std::string_view expected) {
  const std::string_view word = in.word();
  if (word.empty()) in.fail_cut_short(expected);
  if (!is_word(word, expected)) in.fail("expected " + in_quotes(expected) + ", found " + in_quotes(word));
}

/// Names of the solids in a file.
class SolidNames {
 public:
  /// \param name rest of the line; may have any content
  void add(std::string_view name, std::size_t line) {
    const std::size_t begin = name.find_first_not_of(" \t\r"), end = name.find_last_not_of(" \t\r");
    names_.emplace_back(begin == std::string_view::npos ? "" : name.substr(begin, end - begin + 1));
    lines_.push_back(line);
  }
  std::uint32_t last() const { return static_cast<std::uint32_t>(names_.size() - 1); }

  /// Groups of the solids. A solid without a name gets its position in the file as the group number.
  /// \throws InputError if two solids have the same name
  std::vector<SurfaceRegion> groups(const std::string& file) const {
    std::vector<SurfaceRegion> groups;
    std::map<std::string, std::size_t> lines;
    for (std::size_t i = 0; i < names_.size(); ++i) {
      if (names_[i].empty()) {
        groups.push_back({static_cast<std::int64_t>(i + 1), ""});
        continue;
      }
      groups.push_back({0, names_[i]});
      const auto [known, added] = lines.emplace(groups[i].name, lines_[i]);
      if (!added)
        throw InputError(file, lines_[i],
                         "a solid is called " + in_quotes(groups[i].name) + ", like the one in line " +
                             std::to_string(known->second) + "; give one of them another name");
    }
    return groups;
  }

 private:
  std::vector<std::string> names_;
  std::vector<std::size_t> lines_;
};

TriangleMesh read_ascii(std::string_view bytes, const std::string& name, std::vector<Dropped>* dropped) {
  TextScanner in(bytes, name);
  SurfaceBuilder surface(name);
  PointMerger merger(surface, 0);
  SolidNames solids;
  std::string space;
  while (!in.at_end()) {
    expect(in, "solid");
    const std::size_t line = in.line();
    const std::string_view title = in.rest_of_line();
    solids.add(title, line);
    if (space.empty()) space = declared_space(title);
    surface.begin_group(solids.last());
    for (;;) {
      const std::string_view word = in.word();
      if (word.empty()) in.fail("the file ends without \"endsolid\"; it is truncated");
      if (is_word(word, "endsolid")) {
        in.skip_line();
        break;
      }
      if (!is_word(word, "facet")) in.fail("expected \"facet\" or \"endsolid\", found " + in_quotes(word));
      // The normal is ignored; some programs write "nan".
      expect(in, "normal");
      for (int k = 0; k < 3; ++k) (void)in.word();
      expect(in, "outer");
      expect(in, "loop");
      std::array<std::int64_t, 3> corners;
      for (std::int64_t& corner : corners) {
        expect(in, "vertex");
        const double x = in.coordinate(), y = in.coordinate(), z = in.coordinate();
        corner = merger.add({x, y, z}, [&] { return "line " + std::to_string(in.line()); });
      }
      expect(in, "endloop");
      expect(in, "endfacet");
      surface.add_fan(corners);
    }
  }
  TriangleMesh mesh = surface.finish(dropped, solids.groups(name));
  mesh.space = std::move(space);
  return mesh;
}

}  // namespace

TriangleMesh read_stl(std::string_view bytes, const std::string& name, std::vector<Dropped>* dropped) {
  if (bytes.empty()) throw InputError(name + ": the file is empty");
  const bool says_solid = bytes.size() >= 5 && is_word(bytes.substr(0, 5), "solid");
  if (bytes.size() < stl_header_size) {
    if (says_solid) return read_ascii(bytes, name, dropped);
    throw InputError(name + ": only " + std::to_string(bytes.size()) +
                     " bytes, too short for an STL file; it is truncated or not STL");
  }
  const std::size_t triangles = load<std::uint32_t>(bytes.data() + stl_text_size, !little_endian_machine);
  const std::size_t expected = stl_header_size + triangles * record_size;
  // Files of both kinds may begin with "solid". A binary file has its size in the header; a text file has no
  // zero bytes.
  const bool has_zeros = bytes.find('\0') != std::string_view::npos;
  const bool is_text =
      bytes.size() != expected && (says_solid || bytes.substr(0, 64).find("solid") < 64) && !has_zeros;
  if (is_text) return read_ascii(bytes, name, dropped);
  if (expected > bytes.size())
    throw InputError(name + ": byte 80: " + std::to_string(triangles) + " triangles need " +
                     std::to_string(expected) + " bytes, but the file has " + std::to_string(bytes.size()) +
                     "; it is truncated or not STL");
  return read_binary(bytes, name, triangles, dropped);
}

namespace {

void append_facet(std::string& out, const Vec3& a, const Vec3& b, const Vec3& c) {
  Vec3 normal = (b - a).cross(c - a);
  const double length = normal.norm();
  normal = length > 0 && std::isfinite(length) ? Vec3(normal / length) : Vec3(0, 0, 0);
  out += "facet normal ";
  append_point(out, normal);
  out += "\n outer loop\n";
  for (const Vec3* p : {&a, &b, &c}) {
    out += "  vertex ";
    append_point(out, *p);
    out += '\n';
  }
  out += " endloop\nendfacet\n";
}

}  // namespace

std::string write_stl(const TriangleMesh& mesh) {
  std::string out;
  const std::size_t solids = std::max<std::size_t>(mesh.groups.size(), 1);
  for (std::size_t g = 0; g < solids; ++g) {
    const std::string name = mesh.groups.empty() ? "tetwright" : printable_word(group_text(mesh.groups[g]));
    out += "solid " + name + '\n';
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
      if (!mesh.groups.empty() && mesh.triangle_groups[i] != g) continue;
      const Triangle& t = mesh.triangles[i];
      append_facet(out, mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]]);
    }
    out += "endsolid " + name + '\n';
  }
  return out;
}

}  // namespace tetwright
