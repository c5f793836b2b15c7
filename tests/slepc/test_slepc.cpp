// `--solver slepc` on one process and on several, against the program's own answers.
#include <gtest/gtest.h>

#include "assembly/linearise.hpp"
#include "dynamics/engine.hpp"
#include "io/scene_file.hpp"
#include "io/snapshot.hpp"
#include "specimen/make_packing.hpp"
#include "specimen/make_state.hpp"
#include "state/damping.hpp"
#include "support/case_run.hpp"
#include "support/scene_text.hpp"
#include "timestep/consistent.hpp"
#include "timestep/damped_interval.hpp"

namespace eg {
namespace {

const std::string text = "title = \"shared\"\ndimension = 3\n" + test::quartz + R"([contact]
law = "hertz-mindlin"
[specimen]
source = "lattice"
lattice = "fcc"
radius = 1e-3
cells = [2, 2, 2]
overlap = 0.01
radius_scatter = 0.002
[boundary]
type = "periodic"
[damping]
local = 0.1
mass = 2e4
normal_ratio = 0.3
shear_ratio = 0.2
)";

class Slepc : public ::testing::Test {
 protected:
  void SetUp() override {
    scene_ = parse_scene(text, "shared.toml");
    state_ = make_state(scene_, make_packing(scene_));
    { Engine lists(scene_, state_); }
    std::size_t count = 0;  // half of the contacts slide, all in some direction of their plane
    for (std::size_t c = 0; c < state_.contacts.size(); ++c)
      if (!state_.contacts.is_padding(c) && ++count % 2 == 0)
        for (std::size_t k = 0; k < 3; ++k) state_.contacts.history_at(c, k) = k == 0 ? 1e3 : 0.5e3;
    write_snapshot(path_, scene_, state_);
  }
  void TearDown() override { std::filesystem::remove(path_); }

  nlohmann::json shared(int processes, const std::string& options = "") const {
    const std::string command = std::string(EIGENGRAIN_MPIRUN) + " --oversubscribe --allow-run-as-root -n " +
                                std::to_string(processes) + " " + EIGENGRAIN_PROGRAM + " timestep " + path_ +
                                " --solver slepc --json " + options + " 2>/dev/null";
    std::FILE* pipe = popen(command.c_str(), "r");
    std::string out;
    std::array<char, 4096> part{};
    while (const auto n = std::fread(part.data(), 1, part.size(), pipe)) out.append(part.data(), n);
    EXPECT_EQ(pclose(pipe), 0) << command;
    return nlohmann::json::parse(out, nullptr, false);
  }

  Scene scene_;
  State state_;
  const std::string path_ =
      (std::filesystem::temp_directory_path() / ("eigengrain_shared_" + std::to_string(getpid()) + ".h5")).string();
};

TEST_F(Slepc, EveryNumberOfProcessesGivesTheDenseAnswer) {
  const Network net = linearise(scene_, state_);
  const StepInterval exact = step_interval(net, {.dense_limit = 1000});
  const auto damped = damped_interval(net, damping_in_force(scene_, state_), exact, {.dense_limit = 1000});
  double first = 0;
  for (const int processes : {1, 2}) {
    const auto j = shared(processes);
    ASSERT_TRUE(j.is_object());
    const double lambda = j.at("lambda_lower");
    if (processes == 1) first = lambda;
    EXPECT_NEAR(lambda, exact.lambda_lower, 1e-9 * lambda);
    EXPECT_NEAR(lambda, first, 1e-10 * first);
    EXPECT_GE(j.at("lambda_upper").get<double>(), exact.lambda_lower);
    EXPECT_LT(j.at("lambda_upper").get<double>(), 1.6 * exact.lambda_lower);
    EXPECT_NEAR(j.at("dt_damped_limit_upper").get<double>(), damped.dt_limit_upper, 1e-5 * damped.dt_limit_upper);
    EXPECT_EQ(j.at("memory_MB").size(), static_cast<std::size_t>(processes));
    EXPECT_EQ(j.at("contacts").get<std::size_t>(), net.springs.size());
  }
}

TEST_F(Slepc, ConsistentSpectrum) {
  const Network net = linearise(scene_, state_);
  const auto own = consistent_report(scene_, state_, net, {.dense_limit = 1000});
  EXPECT_GT(own.asymmetry, 0.01);
  const auto j = shared(2, "--linearisation consistent").at("consistent");
  EXPECT_NEAR(j.at("asymmetry").get<double>(), own.asymmetry, 1e-9);
  EXPECT_NEAR(j.at("radius_lower").get<double>(), own.spectrum.radius, 1e-6 * own.spectrum.radius);
  EXPECT_GE(j.at("radius_upper").get<double>(), own.spectrum.radius);
  EXPECT_NEAR(j.at("collapse_rate_per_s").get<double>(), own.spectrum.collapse_rate, 1e-4 * own.spectrum.collapse_rate);
}

}  // namespace
}  // namespace eg
