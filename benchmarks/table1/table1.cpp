// SPDX-License-Identifier: Apache-2.0

// Table 1 of Cutler, Dorsey & McMillan 2004, measured again: the paper's columns next to ours.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>

#include "benchmarks/processes.h"
#include "benchmarks/table1/rows.h"
#include "tetwright/error.h"
#include "tetwright/io.h"

namespace tetwright {
namespace {

struct Options {
  std::string data, write, json;
  std::vector<std::string> rows, schedules{"tuned", "paper"};
  unsigned threads = 0;
  int repeat = 1;
  std::uint64_t seed = 1;
};

std::string short_count(std::size_t n) { return std::to_string((n + 500) / 1000) + "K"; }

std::string row_name(const PaperRow& row) { return row.model + (":" + short_count(row.target_tets)); }

bool is_wanted(const PaperRow& row, const std::vector<std::string>& wanted) {
  return wanted.empty() || std::any_of(wanted.begin(), wanted.end(), [&](const std::string& w) {
           return w == row.model || w == row_name(row);
         });
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

std::string minutes(double seconds) {
  char text[32];
  std::snprintf(text, sizeof text, "%02d:%02d", static_cast<int>(seconds) / 60,
                static_cast<int>(seconds) % 60);
  return text;
}

void print_heads() {
  std::printf(
      "Under 0.1 sr and smallest angle: paper | ours. Time: of simplify() alone, median. To and from the "
      "scan: rms / max,\n%% of its diagonal.\n\n");
  std::printf("%-14s %-6s %7s %7s %9s %7s %8s %7s %15s %15s %11s %11s %13s %13s %7s %6s %7s %7s %s\n",
              "model", "sched.", "before", "after", "iters", "paper", "s", "speed", "paper % <0.1",
              "ours % <0.1", "min sr", "dihedrals", "to scan", "from scan", "volume", "MB", "tried/s",
              "done/s", "valid");
}

void print_row(const PaperRow& p, const std::string& schedule, const nlohmann::json& r) {
  char iterations[16], paper_below[24], below[24], angle[24], dihedrals[24], to[24], from[24];
  const auto get = [&](const char* a, const char* b) { return r[a][b].get<double>(); };
  std::snprintf(iterations, sizeof iterations, "%d | %d", p.iterations, r["iterations"].get<int>());
  std::snprintf(paper_below, sizeof paper_below, "%.1f -> %.1f", p.below_before, p.below_after);
  std::snprintf(below, sizeof below, "%.3f -> %.3f", r["below_before_percent"].get<double>(),
                r["below_after_percent"].get<double>());
  std::snprintf(angle, sizeof angle, "%.2f | %.3f", p.min_after, r["min_solid_angle"].get<double>());
  std::snprintf(dihedrals, sizeof dihedrals, "%.1f-%.1f", r["min_dihedral"].get<double>(),
                r["max_dihedral"].get<double>());
  std::snprintf(to, sizeof to, "%.3f / %.2f", get("to_scan", "rms_percent"), get("to_scan", "max_percent"));
  std::snprintf(from, sizeof from, "%.3f / %.2f", get("from_scan", "rms_percent"),
                get("from_scan", "max_percent"));
  const double seconds = r["seconds"];
  const bool sound = r["findings"].empty() && r["topology_differences"].empty();
  std::printf(
      "%-14s %-6s %7zu %7zu %9s %7s %8.2f %6.0fx %15s %15s %11s %11s %13s %13s %7.4f %6.0f %7s %7s %s\n",
      row_name(p).c_str(), schedule.c_str(), r["tets_before"].get<std::size_t>(),
      r["tets_after"].get<std::size_t>(), iterations, minutes(p.seconds).c_str(), seconds,
      p.seconds / seconds, paper_below, below, angle, dihedrals, to, from, r["volume_ratio"].get<double>(),
      r["peak_bytes"].get<double>() / 1e6,
      short_count(static_cast<std::size_t>(get("operations", "tried") / seconds)).c_str(),
      short_count(static_cast<std::size_t>(get("operations", "done") / seconds)).c_str(),
      sound ? "yes" : "NO");
  for (const auto& finding : r["findings"])
    std::printf("  finding: %s\n", finding.get<std::string>().c_str());
  for (const auto& difference : r["topology_differences"])
    std::printf("  topology differs: %s\n", difference.get<std::string>().c_str());
  std::fflush(stdout);
}

/// Measures all repetitions of a row with one schedule, each in a separate process.
nlohmann::json measure(const PaperRow& p, const std::string& schedule, const std::string& dense,
                       const std::string& scan, const Options& o) {
  nlohmann::json row;
  std::vector<double> seconds;
  for (int i = 0; i < o.repeat; ++i) {
    RowOptions options;
    options.simplify.target_tets = p.target_tets;
    options.simplify.schedule = schedule == "paper" ? Schedule::paper : Schedule::tuned;
    options.simplify.seed = o.seed;
    options.threads = o.threads;
    options.measure_more = i == 0;
    if (i == 0 && !o.write.empty())
      options.write_to = o.write + "/" + p.model + "_" + short_count(p.target_tets) + "_" + schedule + ".vtu";
    const nlohmann::json one = in_child([&] { return run_row(dense, scan, options); });
    if (one.contains("error")) return one;
    if (i == 0) row = one;
    seconds.push_back(one["seconds"]);
  }
  row["seconds"] = median(seconds);
  row["seconds_each"] = seconds;
  return row;
}

int run(const Options& o) {
  if (!o.write.empty()) std::filesystem::create_directories(o.write);
  const ScratchFolder scratch;
  nlohmann::json all = {{"data", o.data}, {"seed", o.seed}, {"rows", nlohmann::json::array()}};
  std::map<std::string, nlohmann::json> dense_meshes;  // of this run, by model
  bool failed = false;
  print_heads();
  for (const PaperRow& p : paper_table) {
    if (!is_wanted(p, o.rows)) continue;
    const std::string scan = o.data + "/" + p.scan;
    if (!std::filesystem::exists(scan)) {
      std::printf("%-14s skipped: there is no %s\n", row_name(p).c_str(), scan.c_str());
      all["rows"].push_back({{"row", row_name(p)}, {"skipped", "no " + scan}});
      continue;
    }
    const std::string dense =
        o.write.empty() ? scratch / (std::string(p.model) + ".vtu") : o.write + "/" + p.model + "_dense.vtu";
    nlohmann::json& made = dense_meshes[p.model];
    if (made.is_null()) made = in_child([&] { return make_dense(scan, p.initial_tets, dense); });
    for (const std::string& schedule : o.schedules) {
      nlohmann::json row = made;
      if (!made.contains("error")) row = measure(p, schedule, dense, scan, o);
      if (row.contains("error")) {
        failed = true;
        std::printf("%-14s %-6s failed: %s\n", row_name(p).c_str(), schedule.c_str(),
                    row["error"].get<std::string>().c_str());
      } else {
        print_row(p, schedule, row);
      }
      row["row"] = row_name(p);
      row["schedule"] = schedule;
      row["dense"] = made;
      row["paper"] = {{"tets_before", p.initial_tets},
                      {"tets_after", p.target_tets},
                      {"iterations", p.iterations},
                      {"seconds", p.seconds},
                      {"below_before_percent", p.below_before},
                      {"below_after_percent", p.below_after},
                      {"min_solid_angle", p.min_after}};
      all["rows"].push_back(row);
    }
  }
  write_json(all, o.json);
  return failed ? 1 : 0;
}

}  // namespace
}  // namespace tetwright

int main(int argc, char** argv) {
  tetwright::Options o;
  if (const char* data = std::getenv("TETWRIGHT_DATA"))
    o.data = data;
  else
    o.data = "../shared/data";
  CLI::App app("Table 1 of Cutler, Dorsey & McMillan 2004 beside ours, row by row.", "table1");
  app.add_option("--data", o.data, "Folder of the scans (default: TETWRIGHT_DATA, else ../shared/data)");
  std::string names;
  for (const auto& p : tetwright::paper_table) names += " " + tetwright::row_name(p);
  app.add_option("--rows", o.rows, "Models or rows, separated by commas; of" + names)
      ->delimiter(',')
      ->check([&](const std::string& text) {
        for (const auto& p : tetwright::paper_table)
          if (tetwright::is_wanted(p, {text})) return std::string();
        return "'" + text + "' is no row; there are" + names;
      });
  app.add_option("--schedules", o.schedules, "tuned, paper or both, separated by a comma")
      ->delimiter(',')
      ->check(CLI::IsMember({"tuned", "paper"}))
      ->capture_default_str();
  app.add_option("--threads", o.threads, "0: all of the machine")->capture_default_str();
  app.add_option("--repeat", o.repeat, "Runs of each row; the time is the median")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--seed", o.seed)->capture_default_str();
  app.add_option("--write", o.write, "Keep the dense meshes and the results in this folder, as .vtu");
  app.add_option("--json", o.json, "Write all that was measured to this file");
  CLI11_PARSE(app, argc, argv);
  try {
    return tetwright::run(o);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "table1: %s\n", e.what());
    return 1;
  }
}
