// SPDX-License-Identifier: Apache-2.0
#include "common/io/surfaces/off.h"

#include <vector>

#include "common/io/surfaces/surface_builder.h"
#include "common/io/text/text_scanner.h"
#include "common/number_text.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

/// Reads the optional keyword.
/// \return the next word: the number of points
std::string_view read_keyword(TextScanner& in) {
  const std::string_view first = in.word();
  if (first.empty()) in.fail("the file is empty");
  double number = 0;
  if (parse_number(first, number)) return first;
  std::string_view prefix = first;
  if (!prefix.ends_with("OFF"))
    in.fail("expected OFF at the beginning, found " + in_quotes(first) + "; is this an OFF file?");
  prefix.remove_suffix(3);
  // The prefixes occur in this order. Their values follow the coordinates of a point and are skipped.
  for (std::string_view letter : {"ST", "C", "N"})
    if (prefix.starts_with(letter)) prefix.remove_prefix(letter.size());
  if (!prefix.empty())
    in.fail("the variant " + in_quotes(first) + " is not supported; export plain three-dimensional OFF");
  std::string_view next = in.word();
  if (next == "BINARY") in.fail("binary OFF is not supported; export it as ASCII");
  return next;
}

}  // namespace

TriangleMesh read_off(std::string_view bytes, const std::string& name, std::vector<Dropped>* dropped) {
  TextScanner in(bytes, name, '#');
  const std::string_view first = read_keyword(in);
  if (first.empty()) in.fail_cut_short("number of points");
  std::int64_t points = 0;
  if (!parse_number(first, points) || points < 0)
    in.fail("expected the number of points, found " + in_quotes(first));
  const std::size_t faces = in.count("number of faces", 2);
  in.skip_line();  // the number of edges is not used
  // A point takes at least the six bytes of "0 0 0" and a line end.
  if (static_cast<std::uint64_t>(points) > (in.left() + 1) / 6)
    in.fail("the number of points is " + std::to_string(points) + ", but only " + std::to_string(in.left()) +
            " bytes follow; the file is truncated or its header is wrong");

  SurfaceBuilder surface(name);
  surface.reserve(static_cast<std::size_t>(points), faces);
  const auto place = [&] { return "line " + std::to_string(in.line()); };
  for (std::int64_t i = 0; i < points; ++i) {
    const double x = in.coordinate(), y = in.coordinate(), z = in.coordinate();
    surface.add_point({x, y, z}, place);
    if (!in.word_on_line().empty()) surface.drop("points with colours, normals or texture coordinates");
    in.skip_line();
  }
  std::vector<std::int64_t> polygon;
  for (std::size_t i = 0; i < faces; ++i) {
    polygon.resize(in.count("number of vertices of a face", 2));
    for (std::int64_t& index : polygon) index = in.integer("index of a point");
    surface.add_polygon(polygon, place);
    if (!in.word_on_line().empty()) surface.drop("faces with colours");
    in.skip_line();
  }
  return surface.finish(dropped);
}

std::string write_off(const TriangleMesh& mesh) {
  std::string out = "OFF\n";
  append_number(out, mesh.points.size());
  out += ' ';
  append_number(out, mesh.triangles.size());
  out += " 0\n";
  for (const Vec3& p : mesh.points) {
    append_point(out, p);
    out += '\n';
  }
  for (const Triangle& t : mesh.triangles) {
    out += '3';
    for (Index i : t) {
      out += ' ';
      append_number(out, i);
    }
    out += '\n';
  }
  return out;
}

}  // namespace tetwright
