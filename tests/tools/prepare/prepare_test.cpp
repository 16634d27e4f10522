// SPDX-License-Identifier: Apache-2.0
// Tests that the library gives the same bytes as the program and the Python package, for files and for values
// in memory; that it prints nothing, leaves oneTBB's limits unchanged, is cancelled promptly, and can be
// called from several threads at the same time. This test links none of the program's own sources.
#include "tetwright/prepare.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <thread>

#include "common/samples/samples.h"
#include "tests/common/io/expect_error.h"
#include "tests/tools/program.h"
#include "tetwright/io.h"
#include "tetwright/resources.h"

namespace tetwright::prepare_test {
namespace {

std::string bytes_of(const Prepared& prepared, const std::string& file) {
  write_tet_mesh({prepared.mesh, prepared.midside ? &*prepared.midside : nullptr}, file);
  return contents(file);
}

std::string program_bytes(const std::string& arguments, const std::string& file, int status = 0) {
  const Answer a = run(arguments + " -o " + file);
  EXPECT_EQ(a.status, status) << arguments << "\n" << a.err;
  return contents(file);
}

TriangleMesh surface(const char* name) { return std::get<TriangleMesh>(make_sample(name)); }

PrepareOptions small_target() {
  PrepareOptions options;
  options.target.tets = 800;
  options.cells.resolution = 20;
  options.acceptance.accept_changes = true;  // cells are large compared with the body's features
  return options;
}
const std::string small_target_words = " --target-tets 800 --resolution 20 --accept-changes";

TEST(Prepare, GivesTheProgramsBytes) {
  const TemporaryFolder f;
  const std::string scan = f / "torus.ply";
  write_surface(surface("torus"), scan);
  PrepareOptions options = small_target();
  options.order = 2;
  const Prepared made = prepare({scan}, options);
  EXPECT_FALSE(made.falls_short());
  EXPECT_EQ(bytes_of(made, f / "a.vtu"),
            program_bytes("prepare " + scan + small_target_words + " --order 2", f / "b.vtu"));
  ASSERT_TRUE(made.reference);
  EXPECT_EQ(made.reference_name, "the input");
  EXPECT_TRUE(made.field);
  EXPECT_TRUE(made.report.mesher && made.report.simplify && made.report.second_order);
  EXPECT_EQ(made.report.result->tets, made.mesh.tets.size());
}

TEST(Prepare, StepsByThemselvesGiveTheProgramsBytes) {
  const TemporaryFolder f;
  const std::string scan = f / "torus.ply", dense = f / "dense.vtu";
  write_surface(surface("torus"), scan);
  const auto same = [&](const Prepared& made, const std::string& call, const std::string& file) {
    EXPECT_EQ(bytes_of(made, f / "made.vtu"), program_bytes(call, file, made.falls_short())) << call;
  };
  PrepareOptions options;
  options.cells.resolution = 20;
  same(mesh_scans({scan}, options), "mesh " + scan + " --resolution 20", dense);
  options = {};
  options.target.tets = 900;
  same(simplify_mesh(dense, options), "simplify " + dense + " --target-tets 900", f / "simplified.vtu");
  options = {};
  options.shapes.max_iterations = 2;
  same(improve_mesh(dense, options), "improve " + dense + " --max-iterations 2", f / "improved.vtu");
}

TEST(Prepare, ValuesInMemoryGiveTheBytesOfTheirFiles) {
  const TemporaryFolder f;
  const std::string outer = f / "outer.off", inner = f / "inner.off", organs = f / "organs.nrrd";
  write_surface(surface("sphere"), outer);
  write_surface(surface("torus"), inner);
  write_label_volume(std::get<LabelVolume>(make_sample("organs")), organs);
  PrepareOptions options = small_target();
  options.target.tets = 1200;  // the curve in which the surfaces cross needs them
  std::vector<Input> values;
  values.emplace_back("outer", read_surface(outer));
  values.push_back(Input("other", read_surface(inner)).as("inner"));
  EXPECT_EQ(bytes_of(prepare(std::move(values), options), f / "a.vtu"),
            program_bytes("prepare " + outer + " --material inner=" + inner +
                              " --target-tets 1200 --resolution 20 --accept-changes",
                          f / "b.vtu"));
  options = {};
  options.target.tets = 2000;
  options.cells.size = 3;
  options.labels.meshed = {{1, 3}, {5, 5}};  // without the skin of one voxel, which takes long
  options.acceptance.accept_changes = true;
  values.clear();
  values.emplace_back("organs", Input::Value(read_label_volume(organs)));
  const Prepared made = prepare(std::move(values), options);
  EXPECT_EQ(bytes_of(made, f / "c.vtu"),
            program_bytes(
                "prepare " + organs + " --labels 1-3,5 --target-tets 2000 --voxel-size 3 --accept-changes",
                f / "d.vtu", made.falls_short()));
}

#ifdef TETWRIGHT_PYTHON_FOLDER
TEST(Prepare, GivesThePythonPackagesBytes) {
  const TemporaryFolder f;
  const std::string scan = f / "torus.ply";
  write_surface(surface("torus"), scan);
  const std::string script = "import tetwright; tetwright.prepare('" + scan +
                             "', target_tets=800, resolution=20, accept_changes=True).write('" +
                             (f / "b.vtu") + "')";
  ASSERT_EQ(
      std::system(("PYTHONPATH=" TETWRIGHT_PYTHON_FOLDER " PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 -c \"" +
                   script + "\"")
                      .c_str()),
      0);
  EXPECT_EQ(bytes_of(prepare({scan}, small_target()), f / "a.vtu"), contents(f / "b.vtu"));
}
#endif

/// Returns the text that `work` writes to a standard stream.
std::string written_to(int stream, const std::function<void()>& work) {
  const TemporaryFolder f;
  std::fflush(nullptr);
  const int before = dup(stream), file = open((f / "out").c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  dup2(file, stream);
  work();
  std::fflush(nullptr);
  dup2(before, stream);
  close(before);
  close(file);
  return contents(f / "out");
}

TEST(Prepare, WritesNothingToTheStandardStreams) {
  const auto work = [] {
    PrepareOptions options = small_target();
    options.target.tolerance = Length{3, true};
    options.acceptance.strict = true;
    std::vector<Input> one;
    one.emplace_back("open", surface("open_sphere"));  // causes findings
    const Prepared made = prepare(std::move(one), options);
    EXPECT_TRUE(made.falls_short());
    EXPECT_FALSE(made.diagnostics().empty());
    EXPECT_ANY_THROW(prepare({"not_there.ply"}, options));
  };
  EXPECT_EQ(written_to(STDOUT_FILENO, work), "");
  EXPECT_EQ(written_to(STDERR_FILENO, work), "");
}

/// Calls a function with each stage that begins.
class Watch : public Progress {
 public:
  explicit Watch(std::function<void(Watch&)> at_stage) : at_stage_(std::move(at_stage)) {}
  void begin_stage(std::string_view name) override {
    stage_ = name;
    ++stages;
    at_stage_(*this);
  }
  std::string stage() const override { return stage_; }
  int stages = 0;

 private:
  std::function<void(Watch&)> at_stage_;
  std::string stage_;
};

TEST(Prepare, LeavesTheLimitsOfOneTbbAsTheyAre) {
  const auto limit = [] {
    return tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  };
  const std::size_t before = limit();
  PrepareOptions options = small_target();
  options.limits.threads = 4 * hardware_threads();
  Watch watch([&](Watch&) { EXPECT_EQ(limit(), before); });
  std::vector<Input> one;
  one.emplace_back("torus", surface("torus"));
  (void)prepare(std::move(one), options, &watch);
  EXPECT_GT(watch.stages, 3);
  EXPECT_EQ(limit(), before);
  EXPECT_EQ(thread_count(), hardware_threads());
}

/// Processor time of this process, seconds; the load of other processes does not count.
double processor_seconds() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

TEST(Prepare, EndsWithinASecondOnceItIsCancelled) {
  PrepareOptions options;
  options.target.tets = 2000;
  options.cells.resolution = 32;
  options.order = 2;
  options.limits.threads = 1;
  int stages = 1;
  for (int stage = 1; stage <= stages; ++stage) {
    std::atomic<double> cancelled_at = 0;
    std::thread canceller;
    Watch watch([&](Watch& w) {
      if (w.stages != stage) return;
      canceller = std::thread([&w, &cancelled_at] {
        // In the middle of the stage, if it is a long one.
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        cancelled_at = processor_seconds();
        w.cancel();
      });
    });
    std::vector<Input> one;
    one.emplace_back("torus", surface("torus"));
    bool interrupted = false;
    try {
      (void)prepare(std::move(one), options, &watch);
    } catch (const Interrupted&) {
      interrupted = true;
    }
    const double ended_at = processor_seconds();
    if (canceller.joinable()) canceller.join();
    if (interrupted) EXPECT_LT(ended_at - cancelled_at, 1) << "stage '" << watch.stage() << "'";
    if (stage == 1) EXPECT_TRUE(interrupted);
    stages = std::max(stages, watch.stages + (interrupted ? 1 : 0));
  }
  EXPECT_GT(stages, 3);
}

TEST(Prepare, TwoCallsAtATimeGiveTheBytesOfOneAfterTheOther) {
  const TemporaryFolder f;
  const auto bytes = [&](const char* name, const std::string& file) {
    std::vector<Input> one;
    one.emplace_back("body", surface(name));
    PrepareOptions options = small_target();
    options.limits.threads = 2;
    return bytes_of(prepare(std::move(one), options), f / file);
  };
  const std::string torus = bytes("torus", "a.vtu"), sphere = bytes("sphere", "b.vtu");
  for (int round = 0; round < 2; ++round) {
    std::string other;
    std::thread beside([&] { other = bytes("torus", "c.vtu"); });
    EXPECT_EQ(bytes("sphere", "d.vtu"), sphere);
    beside.join();
    EXPECT_EQ(other, torus);
  }
}

TEST(Prepare, RefusesOptionsThatDoNotGoTogether) {
  const auto message = [](const PrepareOptions& options) {
    std::vector<Input> one;
    one.emplace_back("torus", surface("torus"));
    return error_of<UsageError>([&] { (void)prepare(std::move(one), options); });
  };
  EXPECT_NE(message({}).find("--target-tets is required"), std::string::npos);
  PrepareOptions both = small_target();
  both.cells.size = 1;
  EXPECT_NE(message(both).find("not both"), std::string::npos);
  PrepareOptions probability = small_target();
  probability.images.outside_probability = 2;
  EXPECT_NE(message(probability).find("--outside-probability 2 "), std::string::npos);
  PrepareOptions bins = small_target();
  bins.values.images.push_back({"q", "absent.nrrd"});
  bins.values.bins.push_back({"q", {.edges = {2, 1}}});
  EXPECT_NE(message(bins).find("must ascend, and 1 follows 2"), std::string::npos);
  bins.values.bins[0] = {"q", {.count = 2}, ModulusLaw{.factor = -1}};
  EXPECT_NE(message(bins).find("the factor -1 of the law must be a number above 0"), std::string::npos);
  bins.values.images.push_back({"r", "absent.nrrd"});
  bins.values.bins = {{"q", {.count = 2}, ModulusLaw()}, {"r", {.count = 2}, ModulusLaw()}};
  EXPECT_NE(message(bins).find("--modulus q and --modulus r: only one is possible"), std::string::npos);
  EXPECT_NE(error_of<UsageError>([] { (void)prepare({}, small_target()); }).find("no input"),
            std::string::npos);
}

}  // namespace
}  // namespace tetwright::prepare_test
