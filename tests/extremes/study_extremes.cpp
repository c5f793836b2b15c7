// The page docs/stability.md and its twin docs/stability.json. Run by: ./dev study extremes [--large]
#include <fstream>
#include <nlohmann/json.hpp>

#include "extremes.hpp"
#include "support/program.hpp"

using namespace eg;

namespace {

std::string step(double x) { return std::isinf(x) ? "∞" : fmt::format("{:.6g}", x); }

std::string line(const test::ExtremeRow& r) {
  if (!r.refusal.empty()) return fmt::format("| {} | | | refused: {} | | | | |\n", r.name, r.refusal);
  const auto& i = r.interval;
  const double width = i.lambda_lower > 0 ? i.lambda_upper / i.lambda_lower - 1 : 0;
  return fmt::format("| {} | {} | {} | {} … {} | {:.1e} | {} | {} | {:.3g} |\n", r.name, r.grains, r.contacts,
                     step(i.dt_safe), step(i.dt_limit_upper), width,
                     r.truth.empty() ? "–" : fmt::format("{} ({})", step(0.5 * (r.truth_low + r.truth_high)), r.truth),
                     i.method_upper, 1e3 * i.seconds);
}

nlohmann::json json_of(const test::ExtremeRow& r) {
  const auto& i = r.interval;
  return {{"name", r.name},           {"refusal", r.refusal},     {"grains", r.grains},
          {"contacts", r.contacts},   {"dt_safe", i.dt_safe},     {"dt_limit_upper", i.dt_limit_upper},
          {"truth", r.truth},         {"truth_low", r.truth_low}, {"truth_high", r.truth_high},
          {"method", i.method_upper}, {"seconds", i.seconds},     {"holds", r.holds()}};
}

int write_study(const std::string& folder, bool large) {
  std::ofstream page(folder + "/stability.md");
  page
      << "# The proved step on ugly cases\n\nWritten by `./dev study extremes` (`--large`: 10⁶ grains too); the same "
         "as "
         "JSON in `stability.json`, times in s.\nMade networks have k and m of order 1, the others quartz spheres of "
         "1 mm. *interval*: proved stable … proved unstable above, without\nthe dense solver; *width* in λ; *truth*: "
         "the "
         "whole spectrum, or bisection by stepping; *cost*: of the interval.\nA row that did not hold would say so.\n\n"
         "| case | grains | contacts | interval of the step [s] | width | truth [s] | upper end of λ by | cost [ms] |\n"
         "|---|---|---|---|---|---|---|---|\n";
  auto all = nlohmann::json::array();
  bool holds = true;
  for (const auto& extreme : test::extremes(large)) {
    const auto row = test::work_out(extreme);
    std::string text = line(row);
    if (!row.holds()) text.replace(0, 2, "| **DOES NOT HOLD** "), holds = false;
    page << text << std::flush;
    fmt::print("{}", text);
    std::fflush(stdout);
    all.push_back(json_of(row));
  }
  std::ofstream(folder + "/stability.json") << all.dump(1) << "\n";
  return holds ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"The proved step held against the truth on ugly cases: stability.md and stability.json",
               "study_extremes"};
  std::string folder = ".";
  app.add_option("folder", folder, "where they are written")->check(CLI::ExistingDirectory)->capture_default_str();
  bool large = false;
  app.add_flag("--large", large, "10⁶ grains too");
  return test::run_program(app, argc, argv, [&] { return write_study(folder, large); });
}
