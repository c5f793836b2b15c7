// What policy = "certified" costs in a run, and how near the limit it stays: isotropic compression from 1 kPa to
// 10 MPa, and triaxial compression to 10 % of strain. Run by: ./dev bench controller [GRAINS [--json]]
#include "report/table.hpp"
#include "support/controlled_run.hpp"
#include "support/program.hpp"

using namespace eg;

namespace {

int print_table(std::size_t grains, bool json) {
  Table table({{"stage"},
               {"steps"},
               {"instants"},
               {"largest", "largest dt", "limit", 4},
               {"mean", "mean dt", "limit", 4},
               {"mean_over_target", "mean dt", "safety limit", 4},
               {"evaluations"},
               {"cost", "controller", "% of run", 3}});
  for (const char* stages : {test::squeeze, test::triaxial}) {
    const Scene scene = test::controlled_scene(grains, stages);
    for (const auto& s : test::controlled_run(scene, 997))
      table.add({s.name, static_cast<std::int64_t>(s.steps), std::int64_t{s.instants}, s.largest, s.mean(),
                 s.mean() / scene.timestep.safety, static_cast<std::int64_t>(s.evaluations), 100 * s.cost()});
  }
  if (json)
    fmt::print("{}\n", table.json().dump(2));
  else
    fmt::print("{} grains; the limit is proved afresh every 997 steps.\n\n{}", grains, table.text());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Cost and margin of the certified step in a run", "table_controller"};
  std::size_t grains = 10000;
  app.add_option("grains", grains, "number of grains")->check(test::grain_counts)->capture_default_str();
  bool json = false;
  app.add_flag("--json", json, "as JSON");
  return test::run_program(app, argc, argv, [&] { return print_table(grains, json); });
}
