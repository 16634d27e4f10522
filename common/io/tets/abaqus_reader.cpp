// SPDX-License-Identifier: Apache-2.0
#include <list>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/io/names/mesh_fields.h"
#include "common/io/tets/abaqus.h"
#include "common/io/tets/abaqus_assembly.h"
#include "common/io/tets/abaqus_lines.h"
#include "common/io/tets/abaqus_part.h"

namespace tetwright {

namespace {

class AbaqusReader {
 public:
  AbaqusReader(std::string_view bytes, const std::string& name) : in_(bytes, name) {}

  ReadTetMesh read(const ReadTetMeshOptions& options) {
    read_keywords();
    choose_instances();
    check_elements();
    ReadTetMesh result;
    MidsideNodesRead midside;
    AbaqusAssembly assembly(in_, root_, instances_);
    assembly.fill(result, midside);
    FileTriangles triangles = assembly.triangles(result.mesh.tets);
    midside.remove_from(result, triangles.triangles);
    take_material(result, options, in_.file());
    take_triangles(triangles, "surface", in_.file(), result);
    assembly.note_dropped(result.dropped);
    append_dropped_names(result.dropped, "parts without an instance", unused_);
    return result;
  }

 private:
  struct Part {
    std::string name;  ///< as spelled in the file
    AbaqusPart contents;
    std::size_t instances = 0;
  };

  void read_keywords() {
    bool began = false;
    while (in_.next()) {
      if (!in_.text().starts_with('*')) {
        if (!began)
          in_.fail("expected a keyword with an asterisk, found " + in_quotes(in_.text()) +
                   "; is this an input file of Abaqus or CalculiX?");
        continue;  // data of a skipped keyword
      }
      began = true;
      read_keyword(in_.keyword());
    }
    if (!began) in_.fail("the file is empty");
    check_closed("at the end of the file");
  }

  void read_keyword(const AbaqusKeyword& keyword) {
    if (keyword.name == "PART") {
      begin_part(keyword);
    } else if (keyword.name == "ENDPART") {
      end("*END PART", open_part_ != nullptr);
      open_part_ = nullptr;
    } else if (keyword.name == "ASSEMBLY" || keyword.name == "ENDASSEMBLY") {
      check_closed("before *" + std::string(keyword.name == "ASSEMBLY" ? "ASSEMBLY" : "END ASSEMBLY"));
    } else if (keyword.name == "INSTANCE") {
      begin_instance(keyword);
    } else if (keyword.name == "ENDINSTANCE") {
      end("*END INSTANCE", in_instance_);
      in_instance_ = false;
    } else if (keyword.name == "INCLUDE") {
      in_.fail("*INCLUDE is not supported; give the file that has the nodes and elements");
    } else if (in_instance_ && defines_mesh(keyword)) {
      (void)contents_of_instance(keyword).read(keyword, in_, named_instance(keyword));
    } else {
      (void)(open_part_ ? open_part_->contents : root_).read(keyword, in_, named_instance(keyword));
    }
  }

  /// Mesh of the instance that the keyword names; null: it names none.
  const AbaqusPart* named_instance(const AbaqusKeyword& keyword) const {
    const std::string* name = keyword.find("INSTANCE");
    const auto known = name ? instance_numbers_.find(in_capitals(*name)) : instance_numbers_.end();
    return known == instance_numbers_.end() ? nullptr : &instances_[known->second].mesh();
  }

  void check_closed(const std::string& where) const {
    if (open_part_)
      in_.fail("*END PART of the part " + in_quotes(open_part_->name) + ", which begins in line " +
               std::to_string(opened_line_) + ", is missing " + where);
    if (in_instance_)
      in_.fail("*END INSTANCE of the instance " + in_quotes(instances_.back().name) +
               ", which begins in line " + std::to_string(opened_line_) + ", is missing " + where);
  }

  void end(const std::string& keyword, bool is_open) const {
    if (!is_open) in_.fail(keyword + " without its beginning");
  }

  /// Required parameter of a keyword.
  const std::string& value_of(const AbaqusKeyword& keyword, const char* parameter) const {
    const std::string* value = keyword.find(parameter);
    if (!value || value->empty()) in_.fail("*" + keyword.name + " without " + parameter + "=");
    return *value;
  }

  void begin_part(const AbaqusKeyword& keyword) {
    check_closed("before another *PART");
    const std::string& name = value_of(keyword, "NAME");
    open_part_ = &parts_.emplace_back(Part{name, {}});
    opened_line_ = in_.number();
    if (!parts_by_name_.try_emplace(in_capitals(name), open_part_).second)
      in_.fail("a second part with the name " + in_quotes(name));
  }

  void begin_instance(const AbaqusKeyword& keyword) {
    check_closed("before *INSTANCE");
    if (keyword.find("INSTANCE") || keyword.find("LIBRARY"))
      in_.fail(
          "an *INSTANCE that is imported from a previous analysis is not supported; export the mesh itself");
    const std::string &name = value_of(keyword, "NAME"), &part_name = value_of(keyword, "PART");
    const auto part = parts_by_name_.find(in_capitals(part_name));
    if (part == parts_by_name_.end())
      in_.fail("the instance " + in_quotes(name) + " is of the part " + in_quotes(part_name) +
               ", which no earlier *PART defines");
    if (!instance_numbers_.try_emplace(in_capitals(name), instances_.size()).second)
      in_.fail("a second instance with the name " + in_quotes(name));
    opened_line_ = in_.number();
    in_instance_ = true;
    ++part->second->instances;
    instances_.push_back(
        {name, opened_line_, part_name, &part->second->contents, AbaqusPlacement::read(in_)});
  }

  static bool defines_mesh(const AbaqusKeyword& keyword) {
    return keyword.name == "NODE" || keyword.name == "ELEMENT" || keyword.name == "ELSET" ||
           keyword.name == "NSET" || keyword.name == "SURFACE" || keyword.name == "SOLIDSECTION";
  }

  /// The open instance's own contents: those of its part, and what is defined in the instance.
  AbaqusPart& contents_of_instance(const AbaqusKeyword& keyword) {
    AbaqusInstance& instance = instances_.back();
    if (keyword.name == "NODE" || keyword.name == "ELEMENT") {
      if (!instance.part->points.empty())
        in_.fail("the instance " + in_quotes(instance.name) +
                 " has nodes or elements of its own beside those of " + "its part " +
                 in_quotes(instance.part_name) + "; mesh either the part or the instance");
      if (instance.placement)
        in_.fail(
            "the instance " + in_quotes(instance.name) +
            " has nodes of its own and a translation or rotation, which is not supported; mesh the part " +
            "instead (in Abaqus/CAE, make the instance dependent)");
    }
    if (!instance.own) instance.own = std::make_unique<AbaqusPart>(*instance.part);
    return *instance.own;
  }

  /// In a file without instances, makes one of its only part, or of what is outside of parts.
  void choose_instances() {
    if (!instances_.empty() || !parts_.empty()) {
      if (!root_.tets.empty())
        in_.fail(root_.first_tets_line, "tets outside of *PART, in a file with parts; move them into a part");
    }
    if (instances_.empty() && parts_.size() > 1)
      in_.fail("the file has " + std::to_string(parts_.size()) +
               " parts, but no *INSTANCE in an *ASSEMBLY says where they are");
    if (instances_.empty()) {
      const AbaqusPart* only = parts_.empty() ? &root_ : &parts_.front().contents;
      instances_.push_back({"", 0, "", only, {}});
    } else {
      for (const Part& part : parts_)
        if (part.instances == 0) unused_.push_back(part.name);
    }
  }

  /// Checks the elements of all instances, and prepares the search for their numbers.
  void check_elements() {
    bool tets = false;
    root_.sort_elements(in_);
    for (Part& part : parts_) part.contents.sort_elements(in_);
    const auto check_volumes = [&](const AbaqusPart& part) {
      KindCounts volumes;
      for (const auto& [kind, n] : part.volumes) volumes.add(kind, n);
      if (!volumes.empty())
        in_.fail(part.volumes_line, unsupported_cells(volumes, "in the block that begins here"));
    };
    check_volumes(root_);
    for (AbaqusInstance& instance : instances_) {
      if (instance.own) instance.own->sort_elements(in_);
      check_volumes(instance.mesh());
      tets = tets || !instance.mesh().tets.empty();
    }
    if (!tets) in_.fail("there are no tets in it (*ELEMENT, TYPE=C3D4 or C3D10); a tet mesh is needed");
  }

  AbaqusLines in_;
  AbaqusPart root_;  ///< what is outside of parts and instances
  std::list<Part> parts_;
  std::map<std::string, Part*> parts_by_name_;           ///< in upper case
  std::vector<AbaqusInstance> instances_;                ///< in the order of the file
  std::map<std::string, std::size_t> instance_numbers_;  ///< by name in upper case
  Part* open_part_ = nullptr;
  bool in_instance_ = false;     ///< true: within the last instance
  std::size_t opened_line_ = 0;  ///< of the open part or instance
  std::vector<std::string> unused_;
};

}  // namespace

ReadTetMesh read_abaqus(std::string_view bytes, const std::string& name, const ReadTetMeshOptions& options) {
  return AbaqusReader(bytes, name).read(options);
}

}  // namespace tetwright
