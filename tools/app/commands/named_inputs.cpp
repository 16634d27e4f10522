// SPDX-License-Identifier: Apache-2.0
#include "tools/app/commands/named_inputs.h"

#include <utility>

#include "tetwright/files.h"
#include "tetwright/sizes.h"

namespace tetwright {

namespace {

std::unique_ptr<const SizeSource> source_of(SizesObject object) {
  const std::string field = "size";
  if (auto* tets = std::get_if<TetMesh>(&object.elements))
    return tet_mesh_sizes(std::move(*tets), std::move(object.lengths), field);
  return surface_sizes(std::move(std::get<TriangleMesh>(object.elements)), std::move(object.lengths), field);
}

}  // namespace

Input input_named(const std::string& name, const CommandLine& line, NamedInputs* in_memory) {
  if (in_memory)
    if (const auto value = in_memory->values.find(name); value != in_memory->values.end())
      return {name, std::move(value->second)};
  if (name == standard_input && !line.input_format.empty())
    return {name, InputStream{line.input_format, &read_standard_input}};
  return Input(name);
}

std::vector<Input> inputs_of(const CommandLine& line, NamedInputs* in_memory) {
  std::vector<Input> inputs;
  for (const std::string& name : line.inputs) inputs.push_back(input_named(name, line, in_memory));
  for (const NamedValue& m : line.materials)
    inputs.push_back(input_named(m.value, line, in_memory).as(m.name));
  for (const NamedValue& s : line.sheets)
    inputs.push_back(input_named(s.value, line, in_memory).as_sheet(s.name));
  for (const NamedValue& p : line.partitions)
    inputs.push_back(input_named(p.value, line, in_memory).as_partition(p.name));
  return inputs;
}

void take_sizes(NamedInputs& in_memory, SizeOptions& options) {
  if (!options.field) return;
  if (const auto sizes = in_memory.sizes.find(options.field->name); sizes != in_memory.sizes.end())
    options.field->source = source_of(std::move(sizes->second));
}

void take_images(const NamedInputs& in_memory, ValueOptions& options) {
  for (ValueImage& image : options.images)
    if (const auto value = in_memory.images.find(image.file); value != in_memory.images.end())
      image.image = value->second;
  if (const auto mask = in_memory.masks.find(options.mask_file); mask != in_memory.masks.end())
    options.mask = mask->second;
}

}  // namespace tetwright
