// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tetwright/diagnostic.h"
#include "tetwright/label_source.h"
#include "tetwright/progress.h"
#include "tetwright/region_grid.h"
#include "tetwright/surface_mesh.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Tag and name of the outside as a material of a mesh that keeps it.
inline constexpr MaterialTag outside_tag = 0;
inline constexpr const char* outside_name = "outside";

/// How many times cells are halved where walls and gaps of a surface are thin: by default, and at most.
inline constexpr int default_wall_refinement = 3, max_wall_refinement = 8;

/// The regions that meet at a point, ascending: two on an interface, three on a junction curve, four at a
/// corner. More than four do not meet in general position; a lattice point where they appear to is not moved.
class RegionSet {
 public:
  static constexpr int capacity = 4;

  int size() const { return size_; }
  RegionIndex operator[](int i) const { return items_[i]; }
  const RegionIndex* begin() const { return items_.data(); }
  const RegionIndex* end() const { return items_.data() + size_; }
  bool contains(RegionIndex r) const { return std::find(begin(), end(), r) != end(); }
  /// Returns false, without inserting, if the set is full.
  bool insert(RegionIndex r) {
    int i = 0;
    while (i < size_ && items_[i] < r) ++i;
    if (i < size_ && items_[i] == r) return true;
    if (size_ == capacity) return false;
    for (int k = size_; k > i; --k) items_[k] = items_[k - 1];
    items_[i] = r;
    ++size_;
    return true;
  }
  bool operator==(const RegionSet& o) const { return std::equal(begin(), end(), o.begin(), o.end()); }

 private:
  std::array<RegionIndex, capacity> items_{};
  int size_ = 0;
};

/// Treatment of components that lie inside others without intersecting them.
enum class NestedRule {
  automatic,  ///< oriented against the encloser: a cavity, or a body in a cavity; oriented alike: no effect
  cavity,     ///< solids and cavities alternate from the outside to the inside
  solid,      ///< no cavities
  material    ///< closed ones become separate materials
};

/// A surface from which signed distances can be computed: inside is where the generalised winding number is
/// at least 0.5.
struct RepairedSurface {
  std::vector<Vec3> points;  ///< input units, no two equal, all used
  /// Consistently oriented in each component; no repeated triangles, three different corners each.
  std::vector<Triangle> triangles;
  /// Index of each triangle's group in the file (TriangleMesh::groups); empty if the file has none.
  std::vector<std::uint32_t> groups;
  /// The number of triangles of closed components, which come first. All their edges balance, so their
  /// winding number is an integer everywhere off the surface.
  std::size_t closed = 0;
  bool intersects_itself = false;  ///< some triangles meet elsewhere than in shared points and edges
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();  ///< bounding box
  double area = 0;                               ///< input units squared
  /// Input units cubed, without cavities. Open components contribute the volume of their cone from the centre
  /// of the box.
  double volume = 0;
};

struct SurfaceRepair {
  RepairedSurface surface;
  /// With NestedRule::material, the enclosed components, oriented outwards. Enclosers come first, so that
  /// later surfaces carve earlier ones.
  std::vector<RepairedSurface> nested;
  std::vector<Diagnostic> findings;  ///< without the file
};

/// Repairs a surface and reports every change, so that a clean closed surface has no findings. Steps, in this
/// order:
///
/// - equal points are merged; unused points, triangles with fewer than three different points and repeated
///   triangles (of either orientation) are removed;
/// - triangles are oriented consistently and split into components, inner walls are removed
///   (surface_components.h);
/// - components that are not enclosed are oriented outwards, and the components that they enclose are
///   reversed with them; enclosed ones are then oriented according to `nested` (surface_nesting.h). Only a
///   component that does not intersect the other one counts as enclosed. An open component whose outside is
///   unclear is not reversed.
///
/// Holes and self-intersections are kept, since the winding number handles them. A cavity that two
/// overlapping components both enclose is filled, because the winding number there is 1 + 1 - 1.
///
/// Cost: O(n log n + pairs of triangles that intersect). The result does not depend on the number of threads.
/// \throws InputError beginning with `file`: no triangles or only flat ones, coordinates that are not finite,
///   indices out of range, a one-sided surface
SurfaceRepair repair_surface(const TriangleMesh& surface, const std::string& file,
                             NestedRule nested = NestedRule::automatic);

/// A surface and the material that it encloses.
struct MaterialSurface {
  std::string name;
  MaterialTag tag = 0;
  TriangleMesh surface;
  std::string file;  ///< for messages
};

/// A layer below the first surface that becomes a material of its own.
struct MaterialLayer {
  std::string name;
  MaterialTag tag = 0;
  double thickness = 0;  ///< input units
};

/// Which body a point belongs to that several contain.
enum class OverlapRule : std::uint8_t {
  later,     ///< the last one: later bodies carve earlier ones
  first,     ///< the first one of bodies that cross; the last one of nested bodies
  error,     ///< bodies that cross are refused
  material,  ///< a body of its own, called a+b after bodies a and b that cross
};

/// How bodies that meet are joined.
struct ContactOptions {
  /// Gaps and overlaps of different bodies up to this are contact, input units.
  std::optional<double> tolerance;
  /// Tolerance in diagonals of the bounding box, used where `tolerance` is not given. The default is above
  /// the rounding of coordinates written with six digits, and below what a designer means as a gap.
  double relative_tolerance = 1e-5;
  OverlapRule overlap = OverlapRule::later;
};

/// The materials of a surface whose inner walls divide it into cells.
enum class RegionRule : std::uint8_t {
  cells,  ///< each cell is a material
  outer   ///< inner walls are left out
};

/// A name for the region that contains a point.
struct RegionSeed {
  std::string name;
  Vec3 point;  ///< input units, off the surfaces
};

/// How the cells of a surface with inner walls become materials.
struct RegionOptions {
  RegionRule rule = RegionRule::cells;
  std::vector<RegionSeed> seeds = {};
};

/// An open surface inside bodies.
struct SheetSurface {
  std::string name;
  TriangleMesh surface;  ///< any number of sheets; with named groups, these name the sheets
  std::string file;      ///< for messages
  /// True: it cuts bodies into cells, each a material. False: its triangles become faces of the mesh between
  /// tets of one material.
  bool divides = false;
};

/// Open surfaces inside bodies, such as baffles, membranes, faults and horizons.
struct SheetOptions {
  std::vector<SheetSurface> surfaces = {};
  /// Borders of dividing sheets that end before the boundary of a body are extended by at most this, input
  /// units; 0: not at all.
  double extend = 0;
};

/// z of the base below a height field, input units; std::nullopt: a tenth of the longer horizontal side below
/// its lowest point.
using BaseHeight = std::optional<double>;

/// How open surfaces become bodies.
struct OpenSurfaceOptions {
  /// Open surfaces are height fields, the tops of blocks with vertical walls and a flat base.
  std::optional<BaseHeight> base = {};
  /// Open surfaces are the fronts of shells of this thickness, above 0, input units, which lie behind them.
  std::optional<double> thickness = {};
  /// Surfaces that are mainly sheets, with one hole almost as large as they are, are closed like others
  /// instead of refused.
  bool accept_sheets = false;
};

/// How holes of surfaces are closed.
struct CapOptions {
  /// True: a hole with a flat rim gets a cap in the rim's plane. Otherwise all holes are left to the winding
  /// number.
  bool close_flat = true;
  FeatureAngle feature_angle = {};     ///< rims of flat caps that turn by more are creases
  std::vector<RegionSeed> names = {};  ///< each for the cap nearest to its point
  OpenSurfaceOptions open = {};
};

/// A hole of a surface, and its cap.
struct SurfaceHole {
  std::string name;    ///< of the patch of the mesh that closes it
  bool flat = false;   ///< closed by triangles in the plane of its rim, which are part of the surface
  bool sharp = false;  ///< flat, and the rim is a crease
  /// Area of a flat cap; of other holes that of their projection onto the plane in which it is largest. Input
  /// units squared.
  double size = 0;
  std::vector<Vec3> points;  ///< of the rim, input units; of a hole that is not flat also its centre
  std::vector<std::array<Index, 2>> rim;  ///< edges
  std::vector<Triangle> triangles;        ///< the cap; of a hole that is not flat a fan around its centre
  std::size_t surface = 0;                ///< index of the surface that has it, among those given
  std::uint32_t group = 0;  ///< of a sharp cap's triangles in that surface, see RepairedSurface::groups
};

/// Faces that two bodies share.
struct ContactReport {
  std::string first, second;   ///< materials, in the order of the bodies
  double area = 0;             ///< input units squared
  std::size_t pieces = 0;      ///< connected by edges
  double largest_gap = 0;      ///< that was closed, input units
  double largest_overlap = 0;  ///< likewise
};

/// Two bodies that cross: neither contains the other.
struct OverlapReport {
  std::string first, second;  ///< materials, in the order of the bodies
  double volume = 0;          ///< that both claimed, input units cubed
  std::string owner;          ///< the material that it belongs to
  Vec3 place = Vec3::Zero();  ///< on the boundary of its largest part, input units
};

class LabelledComplex;

/// Repaired surfaces, ready to be meshed.
struct MesherInput {
  struct Body {
    std::string name;
    MaterialTag tag;
    std::string file;
    RepairedSurface surface;
    std::vector<SurfaceRegion> groups;  ///< groups of the file, see RepairedSurface::groups
  };
  /// A group of triangles of a file, before any repair, without faces that two bodies share if each has them
  /// in a group; or these faces.
  struct Group {
    SurfaceRegion group;
    double area = 0;            ///< input units squared
    Vec3 place = Vec3::Zero();  ///< the centre of its largest triangle, input units
    /// The groups of both bodies that the shared faces are in, in the order of the bodies; empty for a group
    /// of a file.
    std::vector<SurfaceRegion> of = {};
  };
  std::vector<Body> bodies;           ///< later bodies carve earlier ones
  std::vector<MaterialLayer> layers;  ///< of the first body, outermost first
  /// A named sheet inside bodies, see LabelledComplex::SheetFace.
  struct Sheet {
    SurfaceRegion group;
    std::string file;
  };
  std::vector<Diagnostic> findings;
  /// Groups with triangles, ascending; repair may remove all of one.
  std::vector<Group> groups;
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();  ///< bounding box of all bodies, input units
  /// All surfaces as one complex, if some of them meet.
  std::shared_ptr<const LabelledComplex> complex = {};
  double joined_bytes = 0;                   ///< estimated peak memory while bodies were joined
  std::vector<ContactReport> contacts = {};  ///< by pair of bodies
  std::vector<OverlapReport> overlaps = {};
  std::vector<Sheet> sheets = {};
  std::vector<SurfaceHole> holes = {};  ///< of all surfaces, largest first
  std::string space = {};               ///< of the first surface, see TriangleMesh::space
};

/// The reason why surfaces do not define the solid of a material with certainty: a flaw of its own surface or
/// of one that carves it.
enum class SurfaceFlaw : std::uint8_t {
  none,
  open,
  touching,      ///< an edge has other than two triangles, or a point has more than one fan of them
  intersecting,  ///< itself
  meeting        ///< the surface of another material
};

/// Validates and repairs the surfaces, see repair_surface(). With NestedRule::material every enclosed
/// component becomes a body directly after its encloser, with the smallest free tag from 1 up.
///
/// A surface with *inner walls* has single sheets that are joined to others at edges of three or more
/// triangles. With RegionRule::cells each cell between its sheets becomes a body, called by a seed in it, by
/// the group that is its whole outer boundary, or NAME_1, NAME_2 and so on by volume, largest first. A wall
/// is part of both cells' surfaces. Closed shells that touch, cross or contain each other are no walls. Walls
/// inside of cells, or of a surface that is closed without them, become sheets, called by the groups that lie
/// nowhere else, or NAME_sheet; with RegionRule::outer, or with layers, they are left out.
///
/// Open surfaces whose borders lie on each other within the contact tolerance, and that close together,
/// become one with such cells, instead of the first of them. Its groups are called like the surfaces. A
/// single cell is called like the first of them.
///
/// Open surfaces first become blocks or shells, if that is asked for (OpenSurfaceOptions). The groups of
/// their faces are called top, side and base, or front, back and rim.
///
/// Flat holes are then closed, see CapOptions. Caps are called cap_1, cap_2 and so on by size, largest first.
///
/// If more than one surface has groups of triangles, names that occur in several surfaces are qualified (see
/// qualify_names()), and groups that have only a number are named after their surface.
///
/// Closed bodies that meet are then joined (ContactOptions): their surfaces are cut along the curves in which
/// they meet, and within the tolerance moved onto each other. With OverlapRule::material their common volumes
/// are appended as bodies with the smallest free tags from 1 up. Faces in a group of each of two bodies
/// become a group of their own, called NAME+NAME. Sheets become faces of the complex; their parts that are in
/// no body, or on the boundary of one, are reported.
///
/// \param progress may be null
/// \pre non-empty names differ, and so do tags
/// \throws InputError as repair_surface() does; for surfaces that enclose nothing (OpenSurfaceOptions),
/// height
///   fields that overhang and shells that cross themselves; for surfaces that cannot be joined, bodies that
///   cross with OverlapRule::error; for sheets and partitions that are closed, meet others or are in no body;
///   for coordinates too large or a size too small for areas and volumes in double precision
/// \throws UsageError for no surface; for both a base and a thickness, either without an open surface, a base
///   that is not below the surface, a thickness that is not above 0; for sheets together with layers, two
///   materials of one name or tag, a layer whose thickness is not above 0, more than 60,000 materials, a seed
///   that is in no cell or whose cell another one names, or a name for a cap that is taken or far from all
///   holes
MesherInput make_mesher_input(std::vector<MaterialSurface> surfaces, std::vector<MaterialLayer> layers = {},
                              NestedRule nested = NestedRule::automatic, const ContactOptions& contact = {},
                              const RegionOptions& regions = {}, Progress* progress = nullptr,
                              const SheetOptions& sheets = {}, const CapOptions& caps = {});

/// The longest side of the bounding box, input units.
double longest_side(const MesherInput& input);

/// The largest absolute coordinate of the bounding box, input units.
double largest_coordinate(const MesherInput& input);

/// Selects the labels of a segmented volume that are meshed, and names them.
struct LabelChoice {
  /// Labels that become materials, as inclusive ranges; all others are outside. Empty: all except the outside
  /// label.
  std::vector<std::pair<MaterialTag, MaterialTag>> labels;
  std::map<MaterialTag, std::string> names;  ///< labels without a name are called label_N
  /// The file that `names` were read from, and the line of each, for messages; may be empty.
  std::string names_file;
  std::map<MaterialTag, std::size_t> name_lines;
  MaterialTag outside_label = 0;
  /// Islands of fewer voxels, which touch at least in a corner, are merged into the region with which they
  /// share most voxel faces; 0 or 1: none.
  std::size_t min_voxels = 8;
};

/// Range of the number of parts that a region of voxels may have: from the number of parts connected by
/// faces, edges or corners to the number of parts connected by faces. Unlimited if not counted.
struct LabelParts {
  std::size_t touching = 0, by_faces = std::numeric_limits<std::size_t>::max();
  std::optional<Vec3> smallest_place;  ///< centre of a voxel of the smallest part by faces, input units
};

/// A label that is meshed.
struct LabelMaterial {
  std::string name;
  MaterialTag tag = 0;             ///< the label
  std::size_t voxels = 0;          ///< after merging small islands, 1 or more
  std::size_t voxels_in_file = 0;  ///< before merging
  LabelParts parts = {};           ///< after merging
  /// Volume between the interfaces of an image before merging, voxels; std::nullopt for labels, whose volume
  /// is that of their voxels.
  std::optional<double> image_volume = {};
  /// Voxels that bodies take; std::nullopt: there are none in the volume.
  std::optional<double> carved = {};
};

/// A chosen label that is not meshed because all its voxels were in small islands.
struct LostLabel {
  MaterialTag tag = 0;
  std::string name;
  std::size_t voxels = 0;
  Vec3 place = Vec3::Zero();  ///< centre of one of its voxels, input units
};

class MaterialImage;

/// Two regions with voxels that touch as read.
struct LabelContact {
  MaterialOrOutside first, second;  ///< labels; the outside comes first
  /// Voxel faces that they share after small islands were merged; 0 if they only touch in edges and corners,
  /// or only islands did.
  std::uint64_t faces = 0;
  Vec3 place = Vec3::Zero();  ///< centre of a voxel where they touch, input units
};

/// Two large parts of a label, or of the outside, that became one as an island between them was merged.
struct FusedParts {
  MaterialOrOutside label;
  Vec3 place = Vec3::Zero();  ///< centre of a voxel of the island, input units
};

/// A segmented volume, or an image divided into materials, ready to be meshed.
struct LabelInput {
  std::string file;
  std::array<int, 3> size{};
  Vec3 origin = Vec3::Zero();
  Eigen::Matrix3d directions = Eigen::Matrix3d::Identity();
  std::string space;   ///< see LabelVolume
  RegionGrid regions;  ///< 0 is outside, i + 1 is materials[i]
  /// The image whose values decide where between voxel centres the interfaces are; null for labels.
  std::shared_ptr<const MaterialImage> image = {};
  /// Regions of the bands of `image`; on_interface for those without voxels.
  std::vector<RegionIndex> band_regions = {};
  std::vector<LabelMaterial> materials;  ///< by ascending tag
  MaterialTag largest_label = 0;         ///< in the file, whether it is meshed or not
  std::vector<LostLabel> lost;           ///< by ascending tag
  std::size_t merged_islands = 0;        ///< including those of the outside
  std::size_t merged_voxels = 0;
  /// Parts of the outside that do not reach the border of the volume. Parts are not counted if there are
  /// more than 2^32 - 2 runs of equal voxels along the first axis.
  LabelParts outside_parts;
  std::vector<LabelContact> contacts = {};  ///< of the voxels as read
  std::vector<FusedParts> fused = {};       ///< by the merging of islands
  std::vector<Diagnostic> findings;         ///< changes to the input, for the user

  std::uint64_t voxel_count() const { return regions.voxels(); }
};

/// Chooses the labels and merges islands of fewer than `min_voxels` voxels into their neighbours, see
/// merge_small_islands(). If no island has that many voxels, nothing is merged and a finding says so. The
/// result does not depend on the number of threads.
///
/// The source is read once, by layers of whole blocks, and freed before islands are merged. The regions take
/// about half a byte for each voxel; for islands see merge_small_islands().
///
/// \param file file name for messages
/// \param progress may be null
/// \throws UsageError for invalid ranges and names: the outside label is chosen, two labels share a name, a
///   label is called "outside"
/// \throws InputError for invalid names that come from a file, a chosen label that does not exist (with a
///   list of those that do), more than 60,000 labels, small islands in more than 2^32 - 2 runs, or as
///   LabelSource::read() does, for the first block with an error
/// \throws OutputError if memory does not suffice
/// \throws NothingToMeshError if all voxels are outside
/// \throws Interrupted
LabelInput make_label_input(std::unique_ptr<const LabelSource> source, const std::string& file,
                            const LabelChoice& choice, Progress* progress);

/// A segmented volume with bodies that carve its labels: implants, electrodes, tools. Ready to be meshed.
struct ImplantedVolume {
  LabelInput labels;
  MesherInput bodies;                         ///< without layers and sheets
  std::vector<MaterialTag> protected_labels;  ///< that bodies do not carve, ascending
};

/// Puts bodies into a segmented volume. Bodies are never cut off: the mesh of one that crosses the volume's
/// border continues beyond it, where labels and a kept outside end, and a finding of `bodies` says so.
/// \throws UsageError for bodies with layers or sheets, names or tags that labels have, and a protected label
///   that does not exist
/// \throws InputError for a body that does not meet the volume, and for more than 60,000 labels and bodies
ImplantedVolume make_implanted_volume(LabelInput labels, MesherInput bodies,
                                      std::vector<MaterialTag> protected_labels = {});

/// Splits a surface into one surface per group of triangles, in the order of their first triangles. The
/// results have no groups. A surface without groups is returned unchanged, called `name`. A group without a
/// name is named after `name` and its number; triangles in no group form a surface called `name`.
std::vector<NamedSurface> split_solids(TriangleMesh surface, const std::string& name);

// OpenVDB files (.vdb), the exchange format of level sets; they may also hold segmented volumes.

/// Reads the level sets of a file as surfaces, in the file's order: their zero levels in the file's world
/// coordinates, oriented with the negative side inside. They are closed except where the level set itself
/// ends. Memory grows with the file.
///
/// A level set is a grid of floats of the class "level set", or without a class but with a positive
/// background and values of both signs. Other grids are ignored.
///
/// \throws InputError beginning with `file`: not a .vdb file, damaged or truncated, no level set in it (with
///   a list of the grids), two of one name, one without a surface
std::vector<NamedSurface> read_level_sets(const std::string& file);

/// Reads the labels of a file that has no level set but one grid of int32 or int64. The volume is the
/// bounding box of the active voxels; inactive voxels in it have the values that OpenVDB gives them, usually
/// the background. Index coordinates refer to voxel centres. Memory grows with the file and by 4 bytes per
/// voxel.
///
/// \param max_voxels 2^31 or fewer
/// \return nothing for a file with a level set or without such a grid
/// \throws InputError beginning with `file`: not a .vdb file, damaged or truncated, several such grids (with
///   their names), no active voxel, more than `max_voxels` voxels, values beyond 32 bits, a transform that is
///   not linear or not invertible
std::optional<LabelVolume> read_label_grid(const std::string& file,
                                           std::size_t max_voxels = std::size_t{1} << 31);

}  // namespace tetwright
