#include "mesher/mesher.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

#include "common/error.h"
#include "mesher/field_builder.h"
#include "mesher/field_mesher.h"
#include "mesher/material_field.h"
#include "mesher/thin_parts.h"

namespace tetwright {

namespace {

/// Cubes of input coordinates, as areas and volumes need them, must neither overflow nor vanish; single
/// precision fields hold 1e38.
constexpr double largest_coordinate = 1e50;
constexpr double smallest_in_cells = 1e-6;  ///< longest side of a surface that is looked at

/// Dense tets of an adaptive mesh for each squared finest cell of surface: they tend to the first number
/// where the solid is thick, and half of it fill one that is as thick as the second, in finest cells of
/// volume for each of surface. Fitted to scans at 32 to 256 cells: within 10 % there, up to twice too high
/// for flat ones.
constexpr double tets_per_area_thick = 29;
constexpr double half_full_thickness = 1.6;
/// Lattice tets along the surface that resolution_for_target() pays at most for each dense tet that is
/// wanted.
constexpr double most_lattice_per_dense = 4;
/// Dense tets of a uniform mesh for each finest cell of volume: the lattice has twelve.
constexpr double tets_per_volume_uniform = 12;
/// Peak memory for each dense tet, with the lattice outside; measured 54 on a scan, rounded up.
constexpr double surface_bytes_per_tet = 70;
/// As thin_parts.h refines for sheets.
constexpr double cells_per_sheet = 1.5, smallest_refined = 0.125;
constexpr std::size_t most_materials = 60000;
/// A uniform grid has leaves and lattice points all over its box.
constexpr double bytes_per_cell_uniform = 150;
/// Dense tets for each tet that is wanted in the end: fewer leave the simplifier no choice, more take time.
constexpr double surface_dense_per_target = 40;
constexpr double most_dense_tets = 20e6;
constexpr int smallest_target_resolution = 32;

double longest_side(const PreparedInput& input) { return (input.high - input.low).maxCoeff(); }

double farthest_coordinate(const PreparedInput& input) {
  return std::max(input.low.cwiseAbs().maxCoeff(), input.high.cwiseAbs().maxCoeff());
}

/// The finest cell's edge in input units.
double cell_size(const PreparedInput& input, const MesherOptions& options) {
  return finest_cell_size(options, longest_side(input), farthest_coordinate(input), input.bodies[0].file);
}

MesherEstimate estimate(const PreparedInput& input, double h, bool uniform, bool keep_outside,
                        double later_bytes_per_tet = 0) {
  double tets = 0, cells = 0, bytes = bytes_at_least;
  const auto add = [&](const PreparedSurface& s, double sides) {
    const double area = s.area / (h * h), volume = std::max(0.0, s.volume) / (h * h * h);
    if (uniform) {
      if (sides == 1) tets += tets_per_volume_uniform * volume;
    } else if (area > 0) {
      const double thickness = volume / area;
      tets += sides * tets_per_area_thick * area * thickness / (thickness + half_full_thickness);
    }
    cells += sides * area / 2;
  };
  // On a surface within another body there are tets on both sides.
  for (std::size_t b = 0; b < input.bodies.size(); ++b)
    add(input.bodies[b].surface, b == 0 && !keep_outside ? 1 : 2);
  for (const MaterialLayer& layer : input.layers) {
    // A thin one takes cells of half the size, or a quarter, ...
    double sides = 2;
    for (double side = h; !uniform && side > smallest_refined * h && layer.thickness < cells_per_sheet * side;
         side /= 2)
      sides *= 4;
    add(input.bodies[0].surface, sides);
  }
  if (uniform) {
    const double box = ((input.high - input.low) / h).prod();
    bytes += bytes_per_cell_uniform * box;
    if (keep_outside) tets = tets_per_volume_uniform * box;
  }
  return {static_cast<std::size_t>(tets),
          static_cast<std::size_t>(bytes + std::max(surface_bytes_per_tet, later_bytes_per_tet) *
                                               std::max(tets, tets_per_area_thick * cells / 2))};
}

/// Refuses an input of which a material has nothing left: which one, and what to do about it.
void check_all_there(const PreparedInput& input, const MaterialField& field,
                     const std::vector<std::uint8_t>& there) {
  if (std::count(there.begin() + 1, there.end(), 1) == 0)
    throw NothingToMeshError(
        input.bodies[0].file +
        ": the surface is smaller than a cell; use a higher resolution or a smaller voxel size");
  for (std::size_t r = 1; r < there.size(); ++r) {
    if (there[r]) continue;
    const FieldRegion& region = field.regions()[r];
    const auto body = std::find_if(input.bodies.begin(), input.bodies.end(),
                                   [&](const PreparedInput::Body& b) { return b.tag == region.tag; });
    if (body == input.bodies.end())
      throw InputError(
          input.bodies[0].file, 0,
          "nothing is left of the layer '" + region.name +
              "': it is thinner than the smallest cells or later surfaces cover it; use a higher "
              "resolution, or list the surfaces that it goes round first");
    if (body == input.bodies.begin() && !input.layers.empty())
      throw InputError(body->file, 0,
                       "nothing is left of '" + region.name +
                           "' inside its layers; make the layers thinner or use a higher resolution");
    throw InputError(
        body->file, 0,
        "nothing is left of the material '" + region.name +
            "': it is smaller than a cell or later surfaces cover it; list the outermost surface "
            "first, or use a higher resolution");
  }
}

void check_outside_is_free(const PreparedInput& input) {
  const auto taken = [](const std::string& name, MaterialTag tag) {
    if (name == outside_name || tag == outside_tag)
      throw UsageError("the material '" + name + "' of tag " + std::to_string(tag) +
                       " would be taken for the outside that is kept; give it another name or tag");
  };
  for (const PreparedInput::Body& b : input.bodies) taken(b.name, b.tag);
  for (const MaterialLayer& l : input.layers) taken(l.name, l.tag);
}

}  // namespace

PreparedInput prepare_input(std::vector<MaterialSurface> surfaces, std::vector<MaterialLayer> layers,
                            NestedRule nested) {
  if (surfaces.empty()) throw UsageError("there is no surface to mesh");
  PreparedInput input;
  std::set<MaterialTag> tags;
  for (const MaterialSurface& s : surfaces) tags.insert(s.tag);
  for (const MaterialLayer& l : layers) {
    if (!(l.thickness > 0 && std::isfinite(l.thickness)))
      throw UsageError("the layer '" + l.name + "' must have a thickness above 0, not " +
                       number_text(l.thickness));
    tags.insert(l.tag);
  }
  MaterialTag next_tag = 1;
  for (MaterialSurface& s : surfaces) {
    SurfaceInput prepared = prepare_surface(s.surface, s.file, nested);
    s.surface = {};
    for (SurfaceFinding& f : prepared.findings) input.findings.push_back({s.file, std::move(f)});
    input.bodies.push_back({s.name, s.tag, s.file, std::move(prepared.surface)});
    for (std::size_t k = 0; k < prepared.nested.size(); ++k) {
      while (!tags.insert(next_tag).second) ++next_tag;
      input.bodies.push_back(
          {s.name + "_" + std::to_string(k + 1), next_tag, s.file, std::move(prepared.nested[k])});
    }
  }
  input.layers = std::move(layers);
  input.low = input.bodies[0].surface.low;
  input.high = input.bodies[0].surface.high;
  for (const PreparedInput::Body& b : input.bodies) {
    input.low = input.low.cwiseMin(b.surface.low);
    input.high = input.high.cwiseMax(b.surface.high);
  }
  if (input.bodies.size() + input.layers.size() > most_materials)
    throw UsageError(std::to_string(input.bodies.size() + input.layers.size()) +
                     " materials are too many; at most " + std::to_string(most_materials) +
                     " can be meshed at a time");
  std::vector<std::pair<std::string, MaterialTag>> all;
  for (const PreparedInput::Body& b : input.bodies) all.emplace_back(b.name, b.tag);
  for (const MaterialLayer& l : input.layers) all.emplace_back(l.name, l.tag);
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t k = 0; k < i; ++k) {
      if (!all[i].first.empty() && all[i].first == all[k].first)
        throw UsageError("two materials are called '" + all[i].first +
                         "'; give one another name with --material NAME=FILE");
      if (all[i].second == all[k].second)
        throw UsageError("two materials have the tag " + std::to_string(all[i].second));
    }
  const double farthest = farthest_coordinate(input);
  if (farthest > largest_coordinate || longest_side(input) < 1 / largest_coordinate)
    throw InputError(
        input.bodies[0].file, 0,
        "a size of " + number_text(longest_side(input)) + " with coordinates up to " + number_text(farthest) +
            " is beyond what can be measured safely; scale the surface to between 1e-50 and 1e50");
  return input;
}

MesherEstimate estimate_mesh(const PreparedInput& input, const MesherOptions& options) {
  return estimate(input, cell_size(input, options), options.uniform, options.keep_outside,
                  options.later_bytes_per_tet);
}

MeshedSurface mesh_surfaces(const PreparedInput& input, const MesherOptions& options, Progress* progress) {
  MesherReport report;
  Stages stages(progress);

  stages.begin("signed distances");
  report.cell_size = cell_size(input, options);
  if (options.keep_outside) check_outside_is_free(input);
  // So much smaller that no lattice could be laid out in numbers that are still exact; a little smaller is
  // found out by the lattice itself.
  if (longest_side(input) < report.cell_size * smallest_in_cells)
    throw NothingToMeshError(
        input.bodies[0].file +
        ": the surface is smaller than a cell; use a higher resolution or a smaller voxel size");
  report.resolution = static_cast<int>(std::ceil(longest_side(input) / report.cell_size - 0.5));
  check_memory(estimate_mesh(input, options));
  const GridFrame voxels =
      make_grid_frame(input.low, input.high, report.cell_size, options.uniform, options.keep_outside);
  std::shared_ptr<const MaterialField> field = build_field(input, voxels, options.keep_outside, progress);
  report.seconds_sdf = stages.seconds();

  stages.begin("octree");
  std::vector<MortonKey> interface_voxels = field->interface_voxels();
  ThinSheets sheets;
  if (!options.uniform) sheets = find_thin_sheets(*field, interface_voxels);
  const auto add_thin = [&](const std::vector<ThinPart>& parts, bool refined) {
    for (const ThinPart& p : parts)
      report.thin_parts.push_back({p.region == outside_region ? "" : field->regions()[p.region].name,
                                   p.places, voxels.to_input(p.first), refined});
  };
  add_thin(sheets.too_thin, true);
  add_thin(find_thin_parts(*field, interface_voxels), false);

  return mesh_field(field, std::move(interface_voxels), {sheets.refinement, std::move(sheets.cells)}, options,
                    std::move(report), stages,
                    [&](const std::vector<std::uint8_t>& there) { check_all_there(input, *field, there); });
}

int resolution_for_target(const PreparedInput& input, std::size_t target_tets) {
  if (target_tets == 0) throw UsageError("the target must be at least one tet");
  const double longest = longest_side(input);
  const double dense = std::min(most_dense_tets, surface_dense_per_target * static_cast<double>(target_tets));
  double area = 0;
  for (const PreparedInput::Body& b : input.bodies) area += b.surface.area;
  const auto enough = [&](int resolution) {
    const double h = longest / resolution;
    // A body thinner than a cell has few tets but a lattice as large as its surface: there is no end to
    // refining it.
    const double lattice = tets_per_area_thick * area / (h * h);
    return static_cast<double>(estimate(input, h, false, false).tets) >= dense ||
           lattice >= most_lattice_per_dense * dense;
  };
  // The smallest one that is enough; the estimate grows with the resolution.
  int low = smallest_target_resolution, high = largest_resolution;
  while (low < high) {
    const int middle = (low + high) / 2;
    if (enough(middle))
      high = middle;
    else
      low = middle + 1;
  }
  return low;
}

}  // namespace tetwright
