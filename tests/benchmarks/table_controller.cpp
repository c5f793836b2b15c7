// What policy = "certified" costs in a run, and how near the limit it stays: isotropic compression from 1 kPa to
// 10 MPa, and triaxial compression to 10 % of strain. Run by: ./dev bench controller [GRAINS [--json]]
#include <cstring>

#include "base/environment.hpp"
#include "report/table.hpp"
#include "support/controlled_run.hpp"

using namespace eg;

int main(int argc, char** argv) {
  fit_environment(argv);
  const auto grains = static_cast<std::size_t>(argc > 1 ? std::atof(argv[1]) : 10000);
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
  if (argc > 2 && std::strcmp(argv[2], "--json") == 0)
    fmt::print("{}\n", table.json().dump(2));
  else
    fmt::print("{} grains; the limit is proved afresh every 997 steps.\n\n{}", grains, table.text());
}
