// SPDX-License-Identifier: Apache-2.0
#include "common/io/surfaces/obj.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "common/io/names/group_text.h"
#include "common/io/surfaces/declared_space.h"
#include "common/io/surfaces/surface_builder.h"
#include "common/io/text/text_scanner.h"
#include "common/number_text.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

/// Next word of a statement; a backslash at the end of a line continues it on the next.
std::string_view next_word(TextScanner& in) {
  std::string_view word = in.word_on_line();
  while (word == "\\") {
    in.skip_line();
    word = in.word_on_line();
  }
  return word;
}

/// Index, from 0, of the point in "7", "7/1", "7//3" or "-1/2/3".
std::int64_t point_of(const TextScanner& in, std::string_view word, std::size_t points) {
  std::int64_t index = 0;
  if (!parse_number(word.substr(0, word.find('/')), index))
    in.fail("expected a vertex of a face such as 7 or 7/1/3, found " + in_quotes(word));
  if (index > 0 && index < no_index) return index - 1;
  if (index < 0 && index >= -static_cast<std::int64_t>(points))
    return static_cast<std::int64_t>(points) + index;
  in.fail("a face refers to point " + std::to_string(index) + ", but " + std::to_string(points) +
          " points have been read (OBJ counts from 1); export the file again");
}

/// Statements that are not read, and their contents, except statements that only concern display.
constexpr std::array<std::pair<std::string_view, const char*>, 8> other_statements{
    {{"l", "lines"},
     {"p", "point elements"},
     {"vt", "texture coordinates"},
     {"vn", "normals"},
     {"vp", "points of parameter spaces"},
     {"curv", "free-form curves"},
     {"curv2", "free-form curves"},
     {"surf", "free-form surfaces"}}};

void note_statement(std::string_view keyword, SurfaceBuilder& surface) {
  if (keyword == "s" || keyword == "mtllib") return;
  for (const auto& [statement, kind] : other_statements)
    if (statement == keyword) {
      surface.drop(kind);
      return;
    }
  surface.drop("statements " + in_quotes(keyword));
}

/// Names that a face belongs to: an object, a group and a display material.
class FaceNames {
 public:
  /// Reads the name after `keyword`.
  /// \return false if the keyword is not followed by a name
  bool read(std::string_view keyword, TextScanner& in) {
    const auto kind = std::find(keywords.begin(), keywords.end(), keyword) - keywords.begin();
    if (kind == std::ssize(keywords)) return false;
    std::string name;
    for (std::string_view word; !(word = next_word(in)).empty();) (name += name.empty() ? "" : " ") += word;
    now_[static_cast<std::size_t>(kind)] = name;
    return true;
  }

  /// Group of the next face.
  std::uint32_t group() {
    if (last_ == no_index || all_[last_] != now_) {
      const auto [known, added] = numbers_.emplace(now_, static_cast<std::uint32_t>(all_.size()));
      if (added) all_.push_back(now_);
      last_ = known->second;
    }
    return last_;
  }

  /// Groups of the faces, named by those names that differ between faces.
  /// \throws InputError if two groups would have the same name
  std::vector<SurfaceRegion> groups(const std::string& file) const {
    std::vector<SurfaceRegion> groups(all_.size());
    for (std::size_t kind = 0; kind < keywords.size(); ++kind) {
      if (std::all_of(all_.begin(), all_.end(), [&](const Names& n) { return n[kind] == all_[0][kind]; }))
        continue;
      for (std::size_t i = 0; i < all_.size(); ++i)
        if (!all_[i][kind].empty()) (groups[i].name += groups[i].name.empty() ? "" : ":") += all_[i][kind];
    }
    std::map<SurfaceRegion, std::size_t> known;
    for (std::size_t i = 0; i < groups.size(); ++i)
      if (const auto [other, added] = known.emplace(groups[i], i); !added)
        throw InputError(file, 0,
                         "the faces of " + text(all_[other->second]) + " and those of " + text(all_[i]) +
                             " would both be the patch " + in_quotes(groups[i].name) +
                             "; give one of them another name");
    return groups;
  }

 private:
  static constexpr std::array<std::string_view, 3> keywords{"o", "g", "usemtl"};
  using Names = std::array<std::string, 3>;

  /// Text for messages: o "a", g "b".
  static std::string text(const Names& names) {
    std::string out;
    for (std::size_t kind = 0; kind < keywords.size(); ++kind)
      if (!names[kind].empty())
        out += (out.empty() ? "" : ", ") + std::string(keywords[kind]) + " " + in_quotes(names[kind]);
    return out;
  }

  Names now_;
  std::vector<Names> all_;  ///< combinations of names that faces have
  std::map<Names, std::uint32_t> numbers_;
  std::uint32_t last_ = no_index;  ///< index of the last face's names
};

}  // namespace

TriangleMesh read_obj(std::string_view bytes, const std::string& name, std::vector<Dropped>* dropped) {
  TextScanner in(bytes, name, '#');
  if (in.at_end()) in.fail("the file is empty");
  SurfaceBuilder surface(name);
  const auto place = [&] { return "line " + std::to_string(in.line()); };
  FaceNames names;
  std::vector<std::int64_t> polygon;
  std::int64_t largest = -1;
  std::size_t largest_line = 0;
  while (!in.at_end()) {
    const std::string_view keyword = in.word();
    if (keyword == "v") {
      Vec3 p;
      for (int k = 0; k < 3; ++k) {
        const std::string_view word = next_word(in);
        if (word.empty()) in.fail("a point with fewer than three coordinates; the file may be truncated");
        if (!parse_number(word, p[k])) in.fail("expected a coordinate, found " + in_quotes(word));
      }
      surface.add_point(p, place);
      if (!next_word(in).empty()) surface.drop("points with a weight or a colour");
    } else if (keyword == "f") {
      polygon.clear();
      for (std::string_view word; !(word = next_word(in)).empty();) {
        polygon.push_back(point_of(in, word, surface.point_count()));
        if (polygon.back() > largest) {
          largest = polygon.back();
          largest_line = in.line();
        }
      }
      if (polygon.size() < 3)
        in.fail("a face with " + std::to_string(polygon.size()) +
                " vertices; at least three are needed; the file may be truncated");
      surface.begin_group(names.group());
      surface.add_fan(polygon);
    } else if (!names.read(keyword, in)) {
      note_statement(keyword, surface);
    }
    // The last word of the line may be the backslash that continues it.
    for (std::string_view word; !(word = next_word(in)).empty();) {
    }
  }
  // A face may precede its points, so indices are checked at the end.
  if (largest >= static_cast<std::int64_t>(surface.point_count()))
    throw InputError(name, largest_line,
                     "a face refers to point " + std::to_string(largest + 1) + ", but there are " +
                         std::to_string(surface.point_count()) +
                         " points; the file is truncated or was exported incorrectly");
  TriangleMesh mesh = surface.finish(dropped, names.groups(name));
  mesh.space = space_in_comments(bytes, '#');
  return mesh;
}

std::string write_obj(const TriangleMesh& mesh) {
  std::string out;
  if (const std::string space = short_name_of_space(mesh.space); !space.empty())
    out += "# SPACE=" + space + '\n';
  for (const Vec3& p : mesh.points) {
    out += "v ";
    append_point(out, p);
    out += '\n';
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (!mesh.groups.empty() && (i == 0 || mesh.triangle_groups[i] != mesh.triangle_groups[i - 1]))
      out += "g " + word_without_hash(group_text(mesh.groups[mesh.triangle_groups[i]])) + '\n';
    out += 'f';
    for (const Index v : mesh.triangles[i]) {
      out += ' ';
      append_number(out, std::uint64_t{v} + 1);
    }
    out += '\n';
  }
  return out;
}

}  // namespace tetwright
