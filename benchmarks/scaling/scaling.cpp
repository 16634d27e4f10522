// SPDX-License-Identifier: Apache-2.0

// Time and memory of `tetwright simplify` as functions of the size of its input, with one thread and two; or
// the serial parts of the stages of `mesh` and `simplify`.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <thread>

#include "benchmarks/processes.h"
#include "benchmarks/scaling/stage_scaling.h"
#include "common/samples/samples.h"
#include "tetwright/error.h"
#include "tetwright/io.h"

namespace tetwright {
namespace {

struct Options {
  std::vector<double> sizes{100e3, 300e3, 1e6, 3e6, 10e6};
  std::vector<unsigned> threads{1, 2};
  double reduction = 20;
  int pairs = 5;
  double pairs_below = 1.5e6;  ///< larger meshes are simplified once
  std::string surface = "/usr/share/glmark2/models/bunny.obj";
  std::string program, json;
  bool stages = false;  ///< measure the stages instead
  bool quick = false;   ///< the stages, with all numbers of threads up to those of the machine
};

/// Times arithmetic on registers, as a measure of the current speed of the machine's threads.
double compute_seconds(unsigned threads) {
  constexpr std::uint64_t steps = 400'000'000;
  const Stopwatch watch;
  std::vector<std::thread> all;
  std::vector<std::uint64_t> sums(threads);
  for (unsigned k = 0; k < threads; ++k)
    all.emplace_back([&sums, k, threads] {
      std::uint64_t x = k + 1;
      for (std::uint64_t i = 0; i < steps / threads; ++i) x = x * 6364136223846793005u + 1442695040888963407u;
      sums[k] = x;
    });
  for (std::thread& t : all) t.join();
  const double seconds = watch.seconds();
  // Read the sums, so that the compiler does not remove the loops.
  for (const std::uint64_t s : sums)
    if (s == 0) std::printf(" ");
  return seconds;
}

nlohmann::json read_json(const std::string& path) {
  std::ifstream file(path);
  return nlohmann::json::parse(file);
}

class Scaling {
 public:
  explicit Scaling(const Options& o) : o_(o) {
    if (!std::filesystem::exists(o_.program))
      throw UsageError("there is no " + o_.program + "; build the program, or name it with --program");
    if (!std::filesystem::exists(o_.surface)) {
      o_.surface = scratch_ / "knot.ply";
      write_surface(std::get<TriangleMesh>(make_sample("knot")), o_.surface);
    }
  }

  /// Measures the stages of `mesh` and `simplify`.
  int run_stages() {
    std::vector<unsigned> threads{1};
    if (o_.quick)
      for (unsigned n = 2; n <= std::thread::hardware_concurrency(); n *= 2) threads.push_back(n);
    const std::string dense = scratch_ / "dense.vtu", large = scratch_ / "large.vtu",
                      small = scratch_ / "small.vtu";
    const StageScaling scaling(o_.program, scratch_ / "stages.json", o_.quick ? 1 : 3);
    const auto mesh = [&](int resolution, const std::string& path) {
      return ScaledCall{
          "mesh --resolution " + std::to_string(resolution),
          {"mesh", o_.surface, "-o", path, "--accept-changes", "--resolution", std::to_string(resolution)}};
    };
    const auto simplify = [&](const std::string& path, int target) {
      return ScaledCall{"simplify --target-tets " + std::to_string(target),
                        {"simplify", path, "-o", small, "--target-tets", std::to_string(target)}};
    };
    std::printf(
        "%s. Cores: how many times as fast the stage would be, by its serial part and the number of "
        "parts of its loops.\n",
        o_.surface.c_str());
    // A resolution of 96 gives about half a million tets, 256 about four million.
    for (const ScaledCall& call :
         {mesh(96, dense), simplify(dense, 10'000), mesh(256, large), simplify(large, 200'000)})
      cases_.push_back(scaling.measure(call, threads));
    write_json({{"surface", o_.surface}, {"cases", cases_}}, o_.json);
    return 0;
  }

  int run() {
    std::sort(o_.sizes.begin(), o_.sizes.end());
    std::printf(
        "%s, uniform, 1:%g. Time: of the simplifier (improvement included) and of the whole program, best of "
        "the runs.\n\n%10s %9s %8s %8s %8s %8s %9s %7s %10s %6s\n",
        o_.surface.c_str(), o_.reduction, "tets", "after", "threads", "simpl. s", "whole s", "peak MB",
        "B/tet", "tets/s", "conflicts", "runs");
    for (const double size : o_.sizes) measure(size);
    const nlohmann::json memory = memory_line();
    write_json({{"surface", o_.surface}, {"reduction", o_.reduction}, {"cases", cases_}, {"memory", memory}},
               o_.json);
    return failed_ ? 1 : 0;
  }

 private:
  /// Writes a mesh to `path` and returns its number of tets.
  std::size_t make_mesh(double size, const std::string& path) {
    // The number of tets grows with the cube of the resolution: extrapolate from the last mesh, or from a
    // small trial mesh.
    if (tets_per_cell_ == 0) {
      const std::size_t trial = mesh_once(48, path);
      tets_per_cell_ = static_cast<double>(trial) / (48.0 * 48 * 48);
    }
    const int resolution = std::max(8, static_cast<int>(std::lround(std::cbrt(size / tets_per_cell_))));
    const std::size_t tets = mesh_once(resolution, path);
    tets_per_cell_ = static_cast<double>(tets) / std::pow(resolution, 3);
    return tets;
  }

  std::size_t mesh_once(int resolution, const std::string& path) {
    const std::string stats = scratch_ / "mesh.json";
    const ProgramRun r =
        run_program({o_.program, "mesh", o_.surface, "-o", path, "--accept-changes", "--uniform",
                     "--resolution", std::to_string(resolution), "--stats", stats, "--quiet"});
    if (r.status != 0)
      throw InputError("meshing at " + std::to_string(resolution) + " cells ended with status " +
                       std::to_string(r.status));
    return read_json(stats)["result"]["tets"];
  }

  /// Runs the program once and returns its statistics.
  nlohmann::json simplify_once(const std::string& mesh, std::size_t target, unsigned threads) {
    const std::string stats = scratch_ / "simplify.json";
    const ProgramRun r = run_program({o_.program, "simplify", mesh, "-o", scratch_ / "out.vtu",
                                      "--target-tets", std::to_string(target), "--threads",
                                      std::to_string(threads), "--stats", stats, "--quiet"});
    if (r.status > 1) throw InputError("simplifying ended with status " + std::to_string(r.status));
    const nlohmann::json s = read_json(stats);
    std::uint64_t conflicts = 0;
    for (const auto& it : s["iterations"]) conflicts += it["lock_conflicts"].get<std::uint64_t>();
    const auto& parts = s["seconds"];
    return {{"seconds",
             parts["build"].get<double>() + parts["simplify"].get<double>() + parts["close"].get<double>()},
            {"seconds_whole", r.seconds},
            {"peak_bytes", r.peak_bytes},
            {"tets_after", s["result"]["tets"]},
            {"below_percent", s["result"]["percent_below_threshold"]},
            {"lock_conflicts", conflicts},
            {"status", r.status}};
  }

  void measure(double size) {
    const std::string mesh = scratch_ / "dense.vtu";
    const std::size_t tets = make_mesh(size, mesh);
    const auto target = static_cast<std::size_t>(static_cast<double>(tets) / o_.reduction);
    const int runs = static_cast<double>(tets) <= o_.pairs_below ? o_.pairs : 1;
    std::vector<nlohmann::json> best(o_.threads.size());
    std::vector<double> control(o_.threads.size(), 1e9);
    for (int i = 0; i < runs; ++i)
      for (std::size_t k = 0; k < o_.threads.size(); ++k) {
        nlohmann::json one = simplify_once(mesh, target, o_.threads[k]);
        control[k] = std::min(control[k], compute_seconds(o_.threads[k]));
        if (best[k].is_null() || one["seconds"] < best[k]["seconds"]) best[k] = one;
      }
    for (std::size_t k = 0; k < o_.threads.size(); ++k) {
      nlohmann::json& b = best[k];
      const double seconds = b["seconds"], peak = b["peak_bytes"];
      std::printf("%10zu %9zu %8u %8.2f %8.2f %8.0f %9.0f %6.0fK %10zu %6d%s\n", tets,
                  b["tets_after"].get<std::size_t>(), o_.threads[k], seconds,
                  b["seconds_whole"].get<double>(), peak / 1e6, peak / static_cast<double>(tets),
                  static_cast<double>(tets) / seconds / 1000, b["lock_conflicts"].get<std::size_t>(), runs,
                  b["status"] == 0 ? "" : "  short of the target");
      b["tets"] = tets;
      b["threads"] = o_.threads[k];
      b["runs"] = runs;
      b["control_seconds"] = control[k];
      if (k > 0) {
        const double speedup = best[0]["seconds"].get<double>() / seconds;
        b["speedup"] = speedup;
        b["speedup_of_control"] = control[0] / control[k];
        std::printf("%10s %u threads against %u: %.2f times as fast; pure compute at the same time: %.2f\n",
                    "", o_.threads[k], o_.threads[0], speedup, control[0] / control[k]);
      }
      if (b["status"] != 0) failed_ = true;
      cases_.push_back(b);
    }
    std::fflush(stdout);
  }

  /// Straight line through the peaks of the smallest mesh of at least about a million tets and of the largest
  /// mesh, with the first number of threads. If all meshes are smaller, through the first and the last.
  nlohmann::json memory_line() const {
    std::vector<std::pair<double, double>> points;
    for (const auto& c : cases_)
      if (c["threads"] == o_.threads[0]) points.push_back({c["tets"], c["peak_bytes"]});
    if (points.size() < 2) return nullptr;
    std::size_t first = 0;
    for (std::size_t i = 0; i + 1 < points.size(); ++i)
      if (points[i].first >= 0.9e6) {
        first = i;
        break;
      }
    const auto& [n0, b0] = points[first];
    const auto& [n1, b1] = points.back();
    const double slope = (b1 - b0) / (n1 - n0), constant = b0 - slope * n0;
    std::printf("\npeak memory: %.1f MB + %.1f bytes a tet (from %.0f to %.0f tets)\n", constant / 1e6, slope,
                n0, n1);
    return {{"bytes_per_tet", slope}, {"constant_bytes", constant}, {"from_tets", n0}, {"to_tets", n1}};
  }

  Options o_;
  ScratchFolder scratch_;
  double tets_per_cell_ = 0;
  nlohmann::json cases_ = nlohmann::json::array();
  bool failed_ = false;
};

}  // namespace
}  // namespace tetwright

int main(int argc, char** argv) {
  tetwright::Options o;
  std::error_code ignored;
  o.program = (std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path() / "tetwright").string();
  CLI::App app("Time and peak memory of `tetwright simplify` by the size of its input.", "scaling");
  app.add_option("--sizes", o.sizes, "Tets, separated by commas")
      ->delimiter(',')
      ->check(CLI::Range(1000.0, 1e9))
      ->capture_default_str();
  app.add_option("--threads", o.threads, "Numbers of threads; the first is what the others are compared with")
      ->delimiter(',')
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  app.add_option("--reduction", o.reduction, "Tets for each one wanted")
      ->check(CLI::Range(1.1, 10000.0))
      ->capture_default_str();
  app.add_option("--pairs", o.pairs, "Interleaved runs of each size, of which the best counts")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  app.add_option("--pairs-below", o.pairs_below, "Larger meshes are run once")->capture_default_str();
  app.add_option("--surface", o.surface, "What is meshed (where it is missing: the sample knot)")
      ->capture_default_str();
  app.add_option("--program", o.program, "tetwright")->capture_default_str();
  app.add_flag("--stages", o.stages,
               "Instead, the serial part of each stage of `mesh` and `simplify`, and the speed-ups that it "
               "implies");
  app.add_flag("--quick", o.quick,
               "As --stages, and the speed-ups with 2, 4, 8 ... threads, up to those of the machine; at most "
               "five minutes");
  app.add_option("--json", o.json, "Write all that was measured to this file");
  CLI11_PARSE(app, argc, argv);
  try {
    tetwright::Scaling scaling(o);
    return o.stages || o.quick ? scaling.run_stages() : scaling.run();
  } catch (const std::exception& e) {
    std::fprintf(stderr, "scaling: %s\n", e.what());
    return 1;
  }
}
