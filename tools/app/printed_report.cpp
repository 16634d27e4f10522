// SPDX-License-Identifier: Apache-2.0
#include "tools/app/printed_report.h"

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <functional>

#include "common/message_text.h"
#include "tools/app/log_file.h"
#include "tools/report/stats_json.h"

namespace tetwright {

namespace {

/// printf() into a string of at most 63 bytes.
[[gnu::format(printf, 1, 2)]] std::string text(const char* format, ...) {
  char buffer[64];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(buffer, sizeof buffer, format, arguments);
  va_end(arguments);
  return buffer;
}

/// Line such as "volume 40 x 30 x 20 voxels of 1 x 1 x 2.5, space unknown; 2 labels: 1 'bone', 2 'skin'",
/// and the thresholds of an image.
std::string volume_line(const VolumeReport& v) {
  constexpr std::size_t max_labels = 8;
  const Vec3 spacing = v.spacing();
  std::string line = text("volume %d x %d x %d voxels of ", v.size[0], v.size[1], v.size[2]) +
                     text("%.6g x %.6g x %.6g", spacing[0], spacing[1], spacing[2]) + ", space " +
                     (v.space.empty() ? "unknown" : v.space) + "; " + text("%zu label", v.labels.size()) +
                     (v.labels.size() == 1 ? ": " : "s: ");
  for (std::size_t i = 0; i < std::min(max_labels, v.labels.size()); ++i)
    line += (i ? ", " : "") + std::to_string(v.labels[i].tag) + " '" + v.labels[i].name + "'";
  if (v.labels.size() > max_labels) line += ", ...";
  for (const UsedIso& iso : v.isos)
    line += "; '" + iso.name + "' from " + text("%.9g", iso.value) + " on" +
            (iso.automatic ? " (Otsu's threshold)" : "");
  return printable(line);
}

/// Line such as "sheet 'baffle': 120 triangles, area 36, 1 piece; border of length 24 in 1 piece".
std::string sheet_line(const SheetStatistics& s) {
  const auto pieces = [](std::size_t n) { return text("%zu piece", n) + (n == 1 ? "" : "s"); };
  return printable("sheet " + in_quotes(s.name) + ": " +
                   text("%zu triangles, area %.6g, ", s.triangles, s.area) + pieces(s.pieces) + "; " +
                   (s.border_pieces == 0 ? "closed"
                                         : "border of length " + text("%.6g", s.border_length) + " in " +
                                               pieces(s.border_pieces)));
}

/// Line such as "features of 'part': 12 patches, since edges turn like those of a part".
std::string feature_line(const FeatureReport& f) {
  using Verdict = SurfacePatches::Verdict;
  const auto loose = [&] {
    // An edge has two ends.
    return text("%.3g %% of the ends of edges over 15 degrees, ", 50 * f.found.loose_ends_low) +
           text("%.3g %% of those over 35 are loose", 50 * f.found.loose_ends_high);
  };
  std::string line = "features of '" + f.name + "': ";
  switch (f.found.verdict) {
    case Verdict::off:
      line += "not searched for";
      break;
    case Verdict::smooth:
      line += f.found.any() ? "no edge is sharp enough within the named patches"
                            : "none; no edge is sharp enough";
      break;
    case Verdict::scan:
      line += "none; its edges look like those of a scan (" + loose() + ")";
      break;
    case Verdict::intersecting:
      line += "none kept; all are where the surface intersects itself";
      break;
    case Verdict::meeting:
      line += "none kept; all are where the surface meets another one or itself, or gaps are closed";
      break;
    case Verdict::staircase:
      line += "none; its edges look like those of voxels (--feature-angle DEGREES keeps them)";
      break;
    case Verdict::part:
      line += text("%zu patches with sharp edges between them", f.found.count);
      if (f.found.noisy_share > 0)
        line +=
            text("; on %.3g %% of the area", 100 * f.found.noisy_share) + " edges look like those of a scan";
      break;
  }
  return printable(line);
}

/// Line such as "curves of 'part' that are not kept: 3 of length 12 fade out, 2 of length 0.5 at patches that
/// are too small", or nothing if all are kept.
std::string lost_curves_line(const FeatureReport& f) {
  using Fate = CreaseChain::Fate;
  using Verdict = SurfacePatches::Verdict;
  // The line on the features says so of all curves.
  if (f.found.verdict == Verdict::scan || f.found.verdict == Verdict::staircase) return {};
  std::string lost;
  const auto add = [&](Fate fate, const char* what) {
    const CreaseChains::Total& total = f.found.chains.total(fate);
    if (total.count == 0) return;
    lost += (lost.empty() ? "" : ", ") + text("%zu of length %.4g ", total.count, total.length) + what;
  };
  add(Fate::faded, "fade out");
  add(Fate::small, "at patches that are too small");
  add(Fate::given_up, "given up where surfaces cross or meet or gaps are closed");
  return lost.empty() ? "" : printable("curves of '" + f.name + "' that are not kept: " + lost);
}

/// Line such as "bone|implant: parted, 32 faces and 25 pairs of points, with cohesive elements".
std::string parted_line(const PartedInterface& p) {
  std::string line =
      text("%s: parted, %zu faces and %zu pairs of points", p.name.c_str(), p.faces, p.pairs.size());
  if (p.cohesive) line += ", with cohesive elements";
  if (p.degenerate_wedges > 0) line += text(" (%zu at a border that stays joined)", p.degenerate_wedges);
  return line;
}

/// Line such as "caps: 2 of 2 holes, 12.3 % of the boundary: cap_1 (area 0.5, flat), cap_2 (area 0.1)".
std::string caps_line(const CapReport& report) {
  std::string line =
      text("caps: %zu of %zu hole%s", report.caps.size(), report.holes, report.holes == 1 ? "" : "s");
  if (report.caps.empty())
    return line + " have faces of their own: they are too small, or hidden by another body";
  constexpr std::size_t max_named = 8;
  line += text(", %.3g %% of the boundary: ", 100 * report.area / report.boundary_area);
  for (std::size_t i = 0; i < std::min(max_named, report.caps.size()); ++i) {
    const CapReport::Cap& cap = report.caps[i];
    line += (i > 0 ? ", " : "") + cap.name +
            text(" (area %.4g%s)", cap.area,
                 !cap.named ? ", not a patch"
                 : cap.flat ? ", flat"
                            : "");
  }
  if (report.caps.size() > max_named) line += text(" and %zu more", report.caps.size() - max_named);
  return printable(line);
}

std::string patches_line(const std::vector<PatchComparison>& patches) {
  constexpr std::size_t max_named = 8;
  std::string line = "named patches: ";
  for (std::size_t i = 0; i < std::min(max_named, patches.size()); ++i)
    line +=
        (i > 0 ? ", " : "") + patch_name(patches[i].group) + text(" (%zu triangles)", patches[i].triangles);
  if (patches.size() > max_named) line += text(" and %zu more", patches.size() - max_named);
  return printable(line);
}

/// A table of the faces that bodies share.
void print_contacts(const std::vector<ContactReport>& contacts) {
  constexpr std::size_t max_rows = 20;
  if (contacts.empty()) return;
  std::printf("%-26s%16s%10s%16s%16s\n", "contacts", "area", "pieces", "largest gap", "largest overlap");
  for (std::size_t i = 0; i < std::min(max_rows, contacts.size()); ++i) {
    const ContactReport& c = contacts[i];
    std::printf("%-26s%16.6g%10zu%16.3g%16.3g\n", printable(c.first + " - " + c.second).c_str(), c.area,
                c.pieces, c.largest_gap, c.largest_overlap);
  }
  if (contacts.size() > max_rows) std::printf("and %zu more\n", contacts.size() - max_rows);
}

void print_parts(const PartitionStatistics& partition) {
  const auto [fewest, most] =
      std::minmax_element(partition.parts.begin(), partition.parts.end(),
                          [](const PartSize& a, const PartSize& b) { return a.tets < b.tets; });
  const auto in_pieces = std::count_if(partition.parts.begin(), partition.parts.end(),
                                       [](const PartSize& part) { return part.pieces > 1; });
  std::printf("%zu parts of %zu to %zu tets, %zu faces between them", partition.parts.size(), fewest->tets,
              most->tets, partition.cut_faces);
  if (in_pieces > 0) std::printf("; %td of them %s not connected", in_pieces, in_pieces == 1 ? "is" : "are");
  std::printf("\n");
}

/// Line such as "values 'density': 0.1 to 1.2 in tets, mean 0.6; 16 bins".
void print_values(const ValueReport& values, const std::vector<BinsReport>& divisions) {
  std::printf("values %s: %.6g to %.6g in tets, mean %.6g", in_quotes(values.name).c_str(), values.smallest,
              values.largest, values.mean);
  for (const BinsReport& bins : divisions)
    if (bins.field == values.name) std::printf("; %zu bins", bins.bins.size());
  std::printf("\n");
}

/// Line such as "64 bricks of 128 cells (--bricks 128), 12 of them finished before: 4000000 tets coarsened".
void print_bricks(const BrickReport& bricks) {
  std::printf("%zu bricks of %d cells (--bricks %d)", bricks.bricks, bricks.cells, bricks.cells);
  if (bricks.rounds > 1) std::printf(", in %d rounds", bricks.rounds);
  if (bricks.resumed > 0) std::printf(", %zu of them finished before", bricks.resumed);
  if (bricks.repeated > 0) std::printf(", %zu made again with more cells around them", bricks.repeated);
  if (bricks.surfaces_kept > 0)
    std::printf(", %zu whose boundary is kept, as others are too near", bricks.surfaces_kept);
  std::printf(": %zu tets coarsened\n", bricks.coarse_tets);
}

}  // namespace

void print_report(const CommandLine& line, const PrepareReport& run, const PartitionStatistics* parts) {
  const MeshStatistics* columns[2] = {run.dense ? &*run.dense : nullptr, run.result ? &*run.result : nullptr};
  const char* heads[2] = {line.command == Command::prepare ? "dense" : "before", "result"};
  if (line.command == Command::mesh) columns[0] = nullptr;  // the dense mesh is the result
  const auto row = [&](const char* name, const std::function<std::string(const MeshStatistics&)>& value) {
    std::printf("%-26s", name);
    for (const MeshStatistics* m : columns)
      if (m) std::printf("%16s", value(*m).c_str());
    std::printf("\n");
  };
  std::printf("%-26s", "");
  for (int i = 0; i < 2; ++i)
    if (columns[i]) std::printf("%16s", heads[i]);
  std::printf("\n");
  row("tets", [](const MeshStatistics& m) { return text("%zu", m.tets); });
  row("points", [](const MeshStatistics& m) { return text("%zu", m.points); });
  row("materials", [](const MeshStatistics& m) { return text("%zu", m.materials.size()); });
  row("volume", [](const MeshStatistics& m) { return text("%.6g", m.volume); });
  row("smallest solid angle, sr", [](const MeshStatistics& m) { return text("%.4f", m.min_solid_angle); });
  row("mean solid angle, sr", [](const MeshStatistics& m) { return text("%.4f", m.mean_solid_angle); });
  row(text("tets below %.3g sr, %%", line.options.shapes.bound()).c_str(),
      [](const MeshStatistics& m) { return text("%.3f", m.below_percent); });
  row("dihedral angles, degrees",
      [](const MeshStatistics& m) { return text("%.1f - %.1f", m.min_dihedral, m.max_dihedral); });
  std::printf("\n");
  if (run.volume) std::printf("%s\n", volume_line(*run.volume).c_str());
  for (const FeatureReport& f : run.features) {
    std::printf("%s\n", feature_line(f).c_str());
    if (const std::string lost = lost_curves_line(f); !lost.empty()) std::printf("%s\n", lost.c_str());
  }
  if (!run.patches.empty()) std::printf("%s\n", patches_line(run.patches).c_str());
  if (run.caps) std::printf("%s\n", caps_line(*run.caps).c_str());
  print_contacts(run.contacts);
  for (const SelectedFaces& s : run.selected)
    std::printf("%s: %zu faces selected, area %.6g\n", s.name.c_str(), s.faces, s.area);
  for (const PartedInterface& p : run.parted) std::printf("%s\n", parted_line(p).c_str());
  if (run.result)
    for (const SheetStatistics& s : run.result->sheets) std::printf("%s\n", sheet_line(s).c_str());
  if (run.crease_comparison) {
    const CreaseComparison& c = *run.crease_comparison;
    std::printf("creases within %.3g %% of the diagonal, 99 %% of them within %.3g %%; %zu of %zu corners\n",
                100 * c.max_distance / c.diagonal, 100 * c.p99_distance / c.diagonal,
                c.corners - c.lost_corners, c.corners);
  }
  if (run.deviation) {
    const DeviationReport& d = *run.deviation;
    std::printf(
        "distances: at most %.4g from the mesh to the surface, %.4g from the surface to the mesh; %.4g "
        "requested\n",
        d.from_mesh.upper, d.from_surface.upper, run.tolerance);
    if (d.apart_area > 0)
      std::printf(
          "compared with the dense mesh, as it is far from the surface (caps, layers, a box): area %.4g\n",
          d.apart_area);
    if (d.hidden_area > 0)
      std::printf("not compared, as the mesh does not contain it (inner walls): area %.4g of the surface\n",
                  d.hidden_area);
  }
  if (run.edge_lengths && run.edge_lengths->with_target_length > 0)
    std::printf("edge lengths: %.1f %% within %.3g times the target (%s), median %.2f times; %.4g to %.4g\n",
                100 * run.edge_lengths->within_share(), edge_length_factor,
                in_quotes(run.sizes.source->field()).c_str(), run.edge_lengths->median,
                run.edge_lengths->shortest, run.edge_lengths->longest);
  else if (run.edge_lengths)
    std::printf("edge lengths: %.4g to %.4g\n", run.edge_lengths->shortest, run.edge_lengths->longest);
  if (run.second_order)
    std::printf(
        "second order: of %zu edges on surfaces %zu follow the surface, %zu partly, %zu are straight\n",
        run.second_order->edges, run.second_order->on_surface, run.second_order->part_way,
        run.second_order->straight);
  for (const ValueReport& values : run.values) print_values(values, run.bins);
  if (parts) print_parts(*parts);
  if (run.bricks) print_bricks(*run.bricks);
  if (run.mesher)
    std::printf("resolution %d (cells of %.4g), ", run.mesher->resolution, run.mesher->cell_size);
  std::printf("%.2f s: read %.2f", run.seconds_total, run.seconds_read);
  if (run.mesher) std::printf(", mesh %.2f", run.seconds_mesh);
  if (run.simplify) {
    const SimplifyReport& s = *run.simplify;
    if (line.command == Command::improve)
      std::printf(", improve %.2f", s.seconds_build + s.seconds_simplify + s.seconds_close);
    else
      std::printf(", simplify %.2f, improve %.2f", s.seconds_build + s.seconds_simplify, s.seconds_close);
  }
  std::printf(", write %.2f; peak memory %.0f MB\n", run.seconds_write,
              static_cast<double>(peak_bytes()) / 1e6);
}

void print_notes(const std::vector<std::string>& notes) {
  for (const std::string& note : notes) print_line("note: " + note);
}

void print_line(const std::string& text) {
  std::fprintf(stderr, "tetwright: %s\n", printable(text).c_str());
  log_line(text);
}

}  // namespace tetwright
