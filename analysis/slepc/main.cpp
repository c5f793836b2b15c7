// The part of eigengrain that runs on many processes: `eigengrain timestep SNAPSHOT --solver slepc` becomes this
// program (arguments: SNAPSHOT elastic|consistent text|json), so that nothing else needs to load MPI.
#include <fmt/format.h>
#include <sys/resource.h>

#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>

#include "base/error.hpp"
#include "base/progress.hpp"
#include "slepc/shared_timestep.hpp"

namespace {

using namespace eg;

struct Cost {
  double seconds = 0;
  std::vector<double> memory;  ///< most that each process has held [MB]
};

double peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1e3;
}

nlohmann::json number_or_null(double x) { return std::isfinite(x) ? nlohmann::json(x) : nlohmann::json(nullptr); }

nlohmann::json json_of(const std::string& path, const SharedTimestep& r, const Cost& cost) {
  nlohmann::json j{{"input", path},
                   {"particles", r.particles},
                   {"contacts", r.contacts},
                   {"rows", r.rows},
                   {"lambda_lower", r.lambda_lower},
                   {"lambda_upper", r.lambda_upper},
                   {"dt_safe", number_or_null(2 / std::sqrt(r.lambda_upper))},
                   {"dt_limit_upper", number_or_null(2 / std::sqrt(r.lambda_lower))},
                   {"methods",
                    {{"lower", "Krylov-Schur (SLEPc)"},
                     {"upper", "block Collatz-Wielandt"},
                     {"products", r.products},
                     {"residual", r.residual}}},
                   {"dt_damped_limit_upper", r.dt_damped ? nlohmann::json(*r.dt_damped) : nlohmann::json(nullptr)},
                   {"consistent", nullptr},
                   {"ranks", cost.memory.size()},
                   {"memory_MB", cost.memory},
                   {"elapsed_s", cost.seconds}};
  if (const auto& c = r.consistent)
    j["consistent"] = {{"asymmetry", r.asymmetry},
                       {"radius_lower", c->radius},
                       {"radius_upper", r.radius_upper},
                       {"largest_real", c->largest_real},
                       {"flutter_pairs", c->flutter},
                       {"flutter_rate_per_s", c->flutter_rate},
                       {"flutter_frequency_Hz", c->flutter_frequency},
                       {"negative_real", c->collapse},
                       {"collapse_rate_per_s", c->collapse_rate},
                       {"counts_are_complete", false}};
  return j;
}

std::string text_of(const std::string& path, const SharedTimestep& r, const Cost& cost) {
  std::string out = path + "\n";
  const auto line = [&](const char* key, const std::string& value) { out += fmt::format("  {:<24}{}\n", key, value); };
  line("particles", fmt::format("{}, {} contacts, {} rows", r.particles, r.contacts, r.rows));
  if (r.contacts == 0) return out + "\nNothing touches: nothing limits the step here.\n";
  line("critical time step",
       fmt::format("{:.6g} … {:.6g} s", 2 / std::sqrt(r.lambda_upper), 2 / std::sqrt(r.lambda_lower)));
  line("  proved stable", fmt::format("{:.8g} s   by block Collatz-Wielandt", 2 / std::sqrt(r.lambda_upper)));
  line("  proved unstable above", fmt::format("{:.8g} s   by Krylov-Schur (SLEPc), residual {:.1e}, λ = {:.15e} 1/s²",
                                              2 / std::sqrt(r.lambda_lower), r.residual, r.lambda_lower));
  if (r.dt_damped)
    line("with damping", fmt::format("unstable above {:.8g} s   by the quadratic eigenproblem", *r.dt_damped));
  if (const auto& c = r.consistent) {
    line("consistent tangent",
         fmt::format("asymmetry {:.2e}, spectral radius {:.6g} … {:.6g} 1/s²", r.asymmetry, c->radius, r.radius_upper));
    line("  complex pairs", c->flutter ? fmt::format("{} found, fastest grows at {:.3g} 1/s, {:.4g} Hz", c->flutter,
                                                     c->flutter_rate, c->flutter_frequency)
                                       : "none found at the ends of the spectrum");
    line("  negative real", c->collapse
                                ? fmt::format("{} found, fastest grows at {:.3g} 1/s", c->collapse, c->collapse_rate)
                                : "none found at the ends of the spectrum");
  }
  std::string memory;
  for (const double m : cost.memory) memory += fmt::format("{}{:.0f}", memory.empty() ? "" : ", ", m);
  line("processes", fmt::format("{}, peak memory {} MB; {}", cost.memory.size(), memory, duration_text(cost.seconds)));
  return out;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    fmt::print(stderr, "eigengrain-slepc: start it as `eigengrain timestep SNAPSHOT --solver slepc`\n");
    return 2;
  }
  const std::string path = argv[1];
  const bool consistent = std::string_view(argv[2]) == "consistent", json = std::string_view(argv[3]) == "json";
  const SlepcSession session(argc, argv);
  try {
    const auto begin = std::chrono::steady_clock::now();
    const SharedTimestep report = shared_timestep(session, path, consistent);
    Cost cost;
    cost.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    cost.memory = session.gather(peak_memory());
    if (session.rank() == 0)
      fmt::print("{}", json ? json_of(path, report, cost).dump(2) + "\n" : text_of(path, report, cost));
    return 0;
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}\n", e.what());
    std::fflush(stderr);
    if (session.ranks() > 1) MPI_Abort(PETSC_COMM_WORLD, 3);  // the others may be waiting for this one
    return 3;
  }
}
