#include <algorithm>
#include <cmath>

#include "common/error.h"
#include "common/parallel.h"
#include "mesher/field_builder.h"
#include "mesher/field_mesher.h"
#include "mesher/label_field.h"
#include "mesher/label_thickness.h"
#include "mesher/mesher.h"

namespace tetwright {

namespace {

/// Dense tets of an adaptive mesh for each face between two materials, as large as a squared cell; half of
/// them for one to the outside.
constexpr double tets_per_face = 45;
/// Of a uniform mesh, for each cell.
constexpr double tets_per_cell = 12;
/// Peak memory for each dense tet, beside what follows; measured 33 to 36 on volumes of 2 to 106 million
/// tets.
constexpr double bytes_per_tet = 40;
/// For each voxel: its label in the file and region, and what thin labels take to be found.
constexpr double bytes_per_voxel = 8;
/// Dense tets for each tet that is wanted in the end.
constexpr double dense_per_target = 5;
/// Finer cells show nothing more of voxels.
constexpr int most_cells_per_voxel = 4;

double longest_side(const PreparedLabels& labels) {
  const Vec3 spacing = labels.directions.colwise().norm();
  double longest = 0;
  for (int a = 0; a < 3; ++a) longest = std::max(longest, spacing[a] * labels.size[a]);
  return longest;
}

double cell_size(const PreparedLabels& labels, const MesherOptions& options) {
  const double longest = longest_side(labels);
  return finest_cell_size(options, longest, labels.origin.cwiseAbs().maxCoeff() + longest, labels.file);
}

/// Areas of the faces between voxels of different regions, input units: with outside, and among materials.
struct FaceAreas {
  double outer = 0, inner = 0;
};

FaceAreas face_areas(const PreparedLabels& labels) {
  const std::array<int, 3>& n = labels.size;
  std::vector<std::array<std::size_t, 6>> counts(static_cast<std::size_t>(n[2]));
  parallel_for(0, counts.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t z = begin; z < end; ++z) {
      counts[z] = {};
      const auto row = static_cast<std::size_t>(n[0]), slice = row * n[1];
      for (int y = 0; y < n[1]; ++y)
        for (int x = 0; x < n[0]; ++x) {
          const std::size_t i = z * slice + static_cast<std::size_t>(y) * row + x;
          const RegionIndex here = labels.regions[i];
          const auto add = [&](int axis, bool there, std::size_t step) {
            const RegionIndex next = there ? labels.regions[i + step] : outside_region;
            if (next != here) ++counts[z][axis + (next == outside_region || here == outside_region ? 0 : 3)];
          };
          add(0, x + 1 < n[0], 1);
          add(1, y + 1 < n[1], row);
          add(2, z + 1 < counts.size(), slice);
          // The first voxels along an axis have a face to the outside beyond, too.
          if (here != outside_region) {
            counts[z][0] += x == 0;
            counts[z][1] += y == 0;
            counts[z][2] += z == 0;
          }
        }
    }
  });
  FaceAreas areas;
  for (int a = 0; a < 3; ++a) {
    const double face = labels.directions.col((a + 1) % 3).cross(labels.directions.col((a + 2) % 3)).norm();
    for (const auto& c : counts) {
      areas.outer += face * static_cast<double>(c[a]);
      areas.inner += face * static_cast<double>(c[a + 3]);
    }
  }
  return areas;
}

MesherEstimate estimate(const PreparedLabels& labels, const FaceAreas& areas, double h,
                        const MesherOptions& options) {
  const double voxel = std::abs(labels.directions.determinant());
  std::size_t inside = 0;
  for (const LabelMaterial& m : labels.materials) inside += m.voxels;
  const double all = static_cast<double>(labels.voxel_count());
  double tets = tets_per_face * (areas.inner + (options.keep_outside ? 1 : 0.5) * areas.outer) / (h * h);
  if (options.uniform)
    tets = tets_per_cell * voxel / (h * h * h) * (options.keep_outside ? all : static_cast<double>(inside));
  return {static_cast<std::size_t>(tets),
          static_cast<std::size_t>(bytes_at_least + bytes_per_voxel * all +
                                   std::max(bytes_per_tet, options.later_bytes_per_tet) * tets)};
}

void check_all_there(const PreparedLabels& labels, const std::vector<std::uint8_t>& there) {
  if (std::count(there.begin() + 1, there.end(), 1) == 0)
    throw NothingToMeshError(
        labels.file +
        ": the labels are smaller than a cell; use a higher resolution or a smaller voxel size");
  for (std::size_t r = 1; r < there.size(); ++r)
    if (!there[r])
      throw InputError(
          labels.file, 0,
          "nothing is left of '" + labels.materials[r - 1].name + "' (" +
              std::to_string(labels.materials[r - 1].voxels) +
              " voxels) in cells this large; use a smaller --voxel-size, or merge such islands by a "
              "larger --min-voxels");
}

}  // namespace

MesherEstimate estimate_mesh(const PreparedLabels& labels, const MesherOptions& options) {
  return estimate(labels, face_areas(labels), cell_size(labels, options), options);
}

double cell_size_for_target(const PreparedLabels& labels, std::size_t target_tets) {
  if (target_tets == 0) throw UsageError("the target must be at least one tet");
  const FaceAreas areas = face_areas(labels);
  const double voxel = voxel_size(labels);
  const double wanted = dense_per_target * static_cast<double>(target_tets);
  // Tets grow with the square of the cells.
  const double at_voxel = static_cast<double>(estimate(labels, areas, voxel, {}).tets);
  const double finer = std::sqrt(std::max(1.0, wanted / std::max(1.0, at_voxel)));
  return std::max(voxel / std::min(finer, static_cast<double>(most_cells_per_voxel)),
                  longest_side(labels) / largest_resolution);
}

double default_cell_size(const PreparedLabels& labels) {
  return std::max(voxel_size(labels), longest_side(labels) / largest_resolution);
}

MeshedSurface mesh_labels(const PreparedLabels& labels, const MesherOptions& options, Progress* progress) {
  MesherReport report;
  Stages stages(progress);
  stages.begin("signed distances");
  report.cell_size = cell_size(labels, options);
  report.resolution = static_cast<int>(std::ceil(longest_side(labels) / report.cell_size - 0.5));
  if (options.keep_outside)
    for (const LabelMaterial& m : labels.materials)
      if (m.tag == outside_tag || m.name == outside_name)
        throw UsageError("the material '" + m.name + "' of tag " + std::to_string(m.tag) +
                         " would be taken for the outside that is kept; leave --keep-outside away or give it "
                         "another name");
  check_memory(estimate_mesh(labels, options));
  const GridFrame voxels = label_frame(labels, report.cell_size, options.uniform);
  const std::shared_ptr<const MaterialField> field =
      LabelField::make(labels, voxels, options.keep_outside, progress);
  report.seconds_sdf = stages.seconds();

  stages.begin("octree");
  ThinLabels thin;
  if (!options.uniform) thin = find_thin_labels(labels, voxels, progress);
  for (const ThinPart& p : thin.too_thin)
    report.thin_parts.push_back({p.region == outside_region ? "" : field->regions()[p.region].name, p.places,
                                 voxels.to_input(p.first), true});
  return mesh_field(field, field->interface_voxels(), std::move(thin.finer), options, std::move(report),
                    stages, [&](const std::vector<std::uint8_t>& there) { check_all_there(labels, there); });
}

}  // namespace tetwright
