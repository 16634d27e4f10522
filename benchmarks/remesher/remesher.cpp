// SPDX-License-Identifier: Apache-2.0

// Time of Remesher calls by the size of region and mesh, and memory and quality after many calls.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "benchmarks/processes.h"
#include "benchmarks/remesher/lattice.h"
#include "common/geometry/box_tree.h"
#include "tetwright/error.h"
#include "tetwright/mesh_quality.h"
#include "tetwright/remesher.h"
#include "tetwright/resources.h"

namespace tetwright {
namespace {

/// Maximum displacements, in cube edges: of the lattice's points, and of a region's points by the simulated
/// motion before improve(). The second inverts some tets.
constexpr double lattice_jitter = 0.1, simulated_motion = 0.22;
/// Points closer than this to the boundary or the interface keep their distance from it, since a simulation
/// leaves surfaces smooth.
constexpr double surface_share = 0.3;
/// The lattice has edges of length 1, 1.41 and 1.73: coarsening to the first size collapses the shorter
/// kinds, refining to the second splits the longest.
constexpr double coarse_size = 2, fine_size = 1.2;
/// Number of cubes between the regions of a series of calls.
constexpr int gap = 4;
/// Three kinds of calls on two kinds of regions.
constexpr std::size_t series_of_a_size = 6;

struct Options {
  std::vector<double> sizes{1e6, 1e7};
  std::vector<std::size_t> regions{100, 1000, 10000};
  int repeats = 15;
  int calls = 1000;
  double calls_size = 1e5;
  bool fields = true;
  std::uint64_t seed = 1;
  std::string json;
};

enum class Kind { improve, coarsen, refine };
constexpr const char* kind_names[] = {"improve", "coarsen", "refine"};

/// A region, as a list of tets and as a box.
struct Region {
  std::vector<Index> tets;
  Box3 box;
};

/// A lattice with a Remesher and the operations on it.
class Subject {
 public:
  Subject(double tets, const Options& o)
      : n_(2 * std::max(8, static_cast<int>(std::lround(std::cbrt(tets / 6) / 2)))), random_(o.seed) {
    const Stopwatch watch;
    remesher_.emplace(jittered_lattice(n_, lattice_jitter, o.seed));
    seconds_ = watch.seconds();
    if (o.fields) add_fields();
  }

  /// Replaces the Remesher by a new one for the same mesh.
  void renew(bool fields) {
    TetMesh mesh = remesher_->mesh();
    remesher_.emplace(std::move(mesh));
    if (fields) add_fields();
  }

  Remesher& remesher() { return *remesher_; }
  /// Time to create the lattice and the Remesher.
  double seconds() const { return seconds_; }

  /// Up to `count` regions of `tets` tets each, separate from each other, from the boundary and from the
  /// regions of earlier calls. Every second one lies on the interface.
  /// \pre region_count() has been called for that size.
  std::vector<Region> regions(std::size_t tets, std::size_t count) {
    const auto begin = centres_.begin() + static_cast<std::ptrdiff_t>(std::min(taken_, centres_.size()));
    taken_ += count;
    const auto end = centres_.begin() + static_cast<std::ptrdiff_t>(std::min(taken_, centres_.size()));
    return regions_at({begin, end}, tets, width_of(tets));
  }

  /// Number of regions of a size that fit into the lattice.
  std::size_t region_count(std::size_t tets) {
    list_centres(width_of(tets));
    return centres_.size();
  }

  /// Moves those points of the tets that lie within a box.
  void perturb(const std::vector<Index>& tets, const Box3& box) {
    std::vector<Index> points;
    for (const Index t : tets)
      for (const Index p : remesher_->tet(t))
        if (box.contains(remesher_->position(p))) points.push_back(p);
    std::sort(points.begin(), points.end());
    points.erase(std::unique(points.begin(), points.end()), points.end());
    std::vector<Vec3> positions;
    for (const Index p : points) {
      Vec3 to = remesher_->position(p);
      for (int axis = 0; axis < 3; ++axis) {
        const double move = simulated_motion * (2 * random_.uniform() - 1);
        const auto near = [&](double plane) { return std::fabs(to[axis] - plane) < surface_share; };
        if (!near(0) && !near(n_) && !(axis == 0 && near(n_ / 2.0))) to[axis] += move;
      }
      positions.push_back(to);
    }
    remesher_->set_positions(points, positions);
  }

  RemeshChanges call(Kind kind, const RemeshRegion& region) {
    switch (kind) {
      case Kind::improve:
        return remesher_->improve(region);
      case Kind::coarsen:
        return remesher_->coarsen(region, coarse_size);
      default:
        return remesher_->refine(region, fine_size);
    }
  }

  int cubes() const { return n_; }
  Random& random() { return random_; }

 private:
  void add_fields() {
    std::vector<double> at_points(remesher_->point_slots()), at_tets(remesher_->tet_slots());
    for (double& x : at_points) x = random_.uniform();
    for (double& x : at_tets) x = random_.uniform();
    remesher_->add_point_field(1, std::move(at_points));
    remesher_->add_tet_field(1, std::move(at_tets));
  }

  /// Width of a region including the gap, in cubes.
  static int width_of(std::size_t tets) {
    return static_cast<int>(std::ceil(std::cbrt(static_cast<double>(tets) / 6))) + gap;
  }

  void list_centres(int width) {
    centres_.clear();
    const int across = (n_ - gap) / width, beside = ((n_ - gap) / 2 - width / 2) / width;
    const auto centre = [&](int x, int y, int z) {
      return Vec3(n_ / 2.0 + x * width, gap / 2.0 + (y + 0.5) * width, gap / 2.0 + (z + 0.5) * width);
    };
    std::vector<Vec3> inside, on_interface;
    for (int x = -beside; x <= beside; ++x)
      for (int y = 0; y < across; ++y)
        for (int z = 0; z < across; ++z) (x == 0 ? on_interface : inside).push_back(centre(x, y, z));
    random_.shuffle(std::span(inside));
    random_.shuffle(std::span(on_interface));
    for (std::size_t i = 0; i < std::min(inside.size(), on_interface.size()); ++i) {
      centres_.push_back(inside[i]);
      centres_.push_back(on_interface[i]);
    }
  }

  /// Finds the regions at the centres. Reads the whole mesh, so that a call starts with cold processor
  /// caches.
  std::vector<Region> regions_at(const std::vector<Vec3>& centres, std::size_t tets, double width) const {
    struct Candidate {
      double distance;  ///< distance of its nearest vertex from the centre, in the maximum norm
      Index tet;
      bool operator<(const Candidate& b) const {
        return distance != b.distance ? distance < b.distance : tet < b.tet;
      }
    };
    std::vector<std::vector<Candidate>> near(centres.size());
    // Find the centre near a point: each cell of the grid has at most one.
    const auto cell = [&](const Vec3& p) {
      const auto axis = [&](double x) { return static_cast<int>(std::floor(x / width)); };
      return std::array<int, 3>{axis(p.x() - n_ / 2.0 + width / 2), axis(p.y() - gap / 2.0),
                                axis(p.z() - gap / 2.0)};
    };
    std::map<std::array<int, 3>, std::size_t> centre_of;
    for (std::size_t i = 0; i < centres.size(); ++i) centre_of[cell(centres[i])] = i;
    for (Index t = 0; t < remesher_->tet_slots(); ++t) {
      if (!remesher_->has_tet(t)) continue;
      std::array<Vec3, 4> p;
      for (int k = 0; k < 4; ++k) p[k] = remesher_->position(remesher_->tet(t)[k]);
      const auto found = centre_of.find(cell((p[0] + p[1] + p[2] + p[3]) / 4));
      if (found == centre_of.end()) continue;
      double distance = width;
      for (const Vec3& x : p)
        distance = std::min(distance, (x - centres[found->second]).cwiseAbs().maxCoeff());
      near[found->second].push_back({distance, t});
    }
    std::vector<Region> regions;
    for (std::size_t i = 0; i < centres.size(); ++i) {
      std::vector<Candidate>& list = near[i];
      const std::size_t size = std::min(tets, list.size());
      if (size == 0) continue;
      std::nth_element(list.begin(), list.begin() + static_cast<std::ptrdiff_t>(size - 1), list.end());
      const Vec3 half = Vec3::Constant(list[size - 1].distance);
      Region region{{}, {centres[i] - half, centres[i] + half}};
      for (std::size_t k = 0; k < size; ++k) region.tets.push_back(list[k].tet);
      regions.push_back(std::move(region));
    }
    return regions;
  }

  int n_;
  Random random_;
  std::optional<Remesher> remesher_;
  double seconds_ = 0;
  std::vector<Vec3> centres_;  ///< centres of regions
  std::size_t taken_ = 0;      ///< number of centres used
};

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

double megabytes(std::size_t bytes) { return static_cast<double>(bytes) / 1e6; }

/// Measures calls of every kind on regions of one size.
nlohmann::json measure_calls(double size, std::size_t tets, const Options& o) {
  const ThreadLimit one(1);
  Subject subject(size, o);
  const std::size_t count = subject.remesher().tet_count();
  const std::size_t calls = std::min<std::size_t>(o.repeats, subject.region_count(tets) / series_of_a_size);
  nlohmann::json series = nlohmann::json::array();
  for (const Kind kind : {Kind::improve, Kind::coarsen, Kind::refine})
    for (const bool box : {false, true}) {
      std::vector<double> ms, set_ms;
      std::size_t operations = 0, changed = 0;
      for (const Region& region : subject.regions(tets, calls)) {
        if (kind == Kind::improve) {
          const ThreadStopwatch watch;
          subject.perturb(region.tets, region.box);
          set_ms.push_back(1000 * watch.seconds());
        }
        const RemeshRegion remesh_region =
            box ? RemeshRegion::box(region.box.low, region.box.high) : RemeshRegion::tets(region.tets);
        const ThreadStopwatch watch;
        const RemeshChanges changes = subject.call(kind, remesh_region);
        ms.push_back(1000 * watch.seconds());
        operations += changes.operations;
        changed += changes.added_tets.size();
      }
      if (ms.empty()) continue;
      series.push_back({{"region", tets},
                        {"kind", kind_names[static_cast<int>(kind)]},
                        {"as", box ? "box" : "list"},
                        {"calls", ms.size()},
                        {"median_ms", median(ms)},
                        {"max_ms", *std::max_element(ms.begin(), ms.end())},
                        {"set_positions_ms", median(set_ms)},
                        {"operations", static_cast<double>(operations) / static_cast<double>(ms.size())},
                        {"added_tets", static_cast<double>(changed) / static_cast<double>(ms.size())}});
    }
  return {{"tets", count},
          {"cubes", subject.cubes()},
          {"build_seconds", subject.seconds()},
          {"resident_bytes", resident_bytes_now()},
          {"series", series}};
}

/// Measures a long series of calls: each of many regions is refined, coarsened, moved and improved. Records
/// the state after the first call, after each quarter, and after another quarter with a new Remesher of the
/// same mesh; the difference shows what the old one has accumulated.
nlohmann::json measure_row(const Options& o) {
  const ThreadLimit one(1);
  Subject subject(o.calls_size, o);
  const std::size_t first_count = subject.remesher().tet_count();
  constexpr double half = 2.5;  // a box of about 1,000 tets
  std::vector<double> ms;       // since the last recorded state
  nlohmann::json states = nlohmann::json::array();
  const auto take_state = [&](int calls) {
    const Remesher& r = subject.remesher();
    reset_peak();
    states.push_back({{"calls", calls},
                      {"median_ms", median(ms)},
                      {"max_ms", *std::max_element(ms.begin(), ms.end())},
                      {"resident_bytes", resident_bytes_now()},
                      {"tets", r.tet_count()},
                      {"tet_slots", r.tet_slots()},
                      {"point_slots", r.point_slots()}});
    ms.clear();
  };
  Vec3 centre = Vec3::Zero();
  std::vector<Index> moved;
  const auto make_call = [&](int call) {
    Remesher& r = subject.remesher();
    const Kind kind = call % 3 == 0 ? Kind::refine : call % 3 == 1 ? Kind::coarsen : Kind::improve;
    if (kind == Kind::refine)
      for (int axis = 0; axis < 3; ++axis) centre[axis] = subject.random().uniform() * subject.cubes();
    const Box3 box{centre - Vec3::Constant(half), centre + Vec3::Constant(half)};
    if (kind == Kind::improve) {
      std::erase_if(moved, [&](Index t) { return !r.has_tet(t); });
      subject.perturb(moved, box);
    }
    const ThreadStopwatch watch;
    const RemeshChanges changes = subject.call(kind, RemeshRegion::box(box.low, box.high));
    ms.push_back(1000 * watch.seconds());
    moved = changes.added_tets;
  };
  for (int call = 0; call < o.calls; ++call) {
    make_call(call);
    if (call == 0 || 4 * (call + 1) % o.calls < 4) take_state(call + 1);
  }
  const TetMesh mesh = subject.remesher().mesh();
  subject.renew(o.fields);
  moved.clear();
  for (int call = 0; call < std::max(3, o.calls / 4); ++call) make_call(call);
  take_state(o.calls + std::max(3, o.calls / 4));
  nlohmann::json faults = nlohmann::json::array();
  for (const MeshFinding& f : check_mesh(mesh)) faults.push_back(mesh_finding_line(f));
  return {{"calls", o.calls}, {"tets_before", first_count}, {"states", states}, {"faults", faults}};
}

nlohmann::json checked(nlohmann::json answer) {
  if (answer.contains("error")) throw InternalError(answer["error"].get<std::string>());
  return answer;
}

int run(const Options& o) {
  nlohmann::json all{{"sizes", nlohmann::json::array()}};
  for (const double size : o.sizes) {
    nlohmann::json m;
    for (const std::size_t region : o.regions) {
      const nlohmann::json part = checked(in_child([&] { return measure_calls(size, region, o); }));
      if (m.is_null()) {
        m = part;
      } else {
        m["series"].insert(m["series"].end(), part["series"].begin(), part["series"].end());
      }
    }
    std::printf(
        "%zu tets, one thread, %s; taken over in %.1f s, %.0f MB\n\n%8s %8s %5s %6s %10s %9s %8s %8s %11s\n",
        m["tets"].get<std::size_t>(), o.fields ? "a field of points and one of tets" : "no fields",
        m["build_seconds"].get<double>(), megabytes(m["resident_bytes"].get<std::size_t>()), "region", "call",
        "as", "calls", "median ms", "max ms", "operat.", "new tets", "set pos. ms");
    for (const auto& s : m["series"])
      std::printf("%8zu %8s %5s %6zu %10.2f %9.2f %8.0f %8.0f %11.2f\n", s["region"].get<std::size_t>(),
                  s["kind"].get<std::string>().c_str(), s["as"].get<std::string>().c_str(),
                  s["calls"].get<std::size_t>(), s["median_ms"].get<double>(), s["max_ms"].get<double>(),
                  s["operations"].get<double>(), s["added_tets"].get<double>(),
                  s["set_positions_ms"].get<double>());
    std::printf("\n");
    std::fflush(stdout);
    all["sizes"].push_back(m);
  }
  if (o.calls == 0) {
    write_json(all, o.json);
    return 0;
  }
  const nlohmann::json row = checked(in_child([&] { return measure_row(o); }));
  std::printf("%d calls in a row on %zu tets\n\n%8s %10s %9s %9s %10s %12s %12s\n", o.calls,
              row["tets_before"].get<std::size_t>(), "calls", "median ms", "max ms", "tets", "tet slots",
              "point slots", "resident MB");
  for (const auto& s : row["states"])
    std::printf("%8d %10.2f %9.2f %9zu %10zu %12zu %12.1f\n", s["calls"].get<int>(),
                s["median_ms"].get<double>(), s["max_ms"].get<double>(), s["tets"].get<std::size_t>(),
                s["tet_slots"].get<std::size_t>(), s["point_slots"].get<std::size_t>(),
                megabytes(s["resident_bytes"].get<std::size_t>()));
  for (const auto& fault : row["faults"]) std::printf("fault: %s\n", fault.get<std::string>().c_str());
  if (row["faults"].empty()) std::printf("mesh check: nothing found\n");
  all["row"] = row;
  write_json(all, o.json);
  return row["faults"].empty() ? 0 : 1;
}

}  // namespace
}  // namespace tetwright

int main(int argc, char** argv) {
  tetwright::Options o;
  bool quick = false, no_fields = false;
  CLI::App app(
      "Time of a Remesher's calls by region and mesh, on one thread, and what 1,000 calls leave behind.",
      "remesher");
  app.add_option("--sizes", o.sizes, "Tets of the meshes, separated by commas")
      ->delimiter(',')
      ->check(CLI::Range(3000.0, 1e9))
      ->capture_default_str();
  app.add_option("--regions", o.regions, "Tets of a region, separated by commas")
      ->delimiter(',')
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  app.add_option("--repeats", o.repeats,
                 "Calls of each kind, fewer where the mesh has no room for their regions")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--calls", o.calls, "Calls in a row; 0: none")
      ->check(CLI::Range(0, 1000000))
      ->capture_default_str();
  app.add_option("--calls-size", o.calls_size, "Tets of the mesh of the calls in a row")
      ->check(CLI::Range(3000.0, 1e9))
      ->capture_default_str();
  app.add_flag("--no-fields", no_fields, "Carry no fields");
  app.add_flag("--quick", quick, "Small meshes and few calls: shows that it works, in seconds");
  app.add_option("--seed", o.seed)->capture_default_str();
  app.add_option("--json", o.json, "Write all that was measured to this file");
  CLI11_PARSE(app, argc, argv);
  o.fields = !no_fields;
  if (quick) {
    o.sizes = {1e5};
    o.regions = {100, 1000};
    o.repeats = 3;
    o.calls = 40;
    o.calls_size = 5e4;
  }
  try {
    return tetwright::run(o);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "remesher: %s\n", e.what());
    return 1;
  }
}
