#include "slepc/shared_timestep.hpp"

#include <algorithm>
#include <cmath>

#include "assembly/damping.hpp"
#include "assembly/linearise.hpp"
#include "slepc/block_matrix.hpp"
#include "slepc/solve.hpp"
#include "state/damping.hpp"

namespace eg {
namespace {

/// The damped limit as the largest eigenvalue 1/Δt of the quadratic problem. Local damping α adds α to every force.
double damped_step(const SnapshotPart& part, const Network& network, const DampingSpec& damping, ::Mat k) {
  MatHandle c = make_stiffness(part, dashpots(network, damping));
  check_slepc(MatScale(c, 1 + damping.local));
  check_slepc(MatShift(c, damping.mass));
  check_slepc(MatScale(k, 1 + damping.local));
  return 1 / quadratic_limit(k, c).pairs.front().value.real();
}

double asymmetry_of(::Mat a) {
  MatHandle difference;
  check_slepc(MatTranspose(a, MAT_INITIAL_MATRIX, difference.out()));
  check_slepc(MatAYPX(difference, -1, a, DIFFERENT_NONZERO_PATTERN));
  PetscReal skew = 0, all = 0;
  check_slepc(MatNorm(difference, NORM_FROBENIUS, &skew));
  check_slepc(MatNorm(a, NORM_FROBENIUS, &all));
  return all > 0 ? skew / all : 0;
}

/// Both ends of the consistent spectrum and those next to zero from below.
void solve_consistent(const SnapshotPart& part, const Network& network, SharedTimestep& report) {
  const MatHandle a = make_tangent(part, network);
  report.asymmetry = asymmetry_of(a);
  report.radius_upper = collatz_radius(a);
  std::vector<std::complex<double>> values;
  const SlepcOptions options{.tolerance = 1e-9, .count = 8, .basis = 48, .restarts = 300};
  for (const EPSWhich end : {EPS_LARGEST_MAGNITUDE, EPS_LARGEST_IMAGINARY, EPS_SMALLEST_REAL})
    for (const auto& pair : general_end(a, end, options).pairs) {
      const auto known = [&](const std::complex<double>& v) { return std::abs(v - pair.value) <= 1e-7 * std::abs(v); };
      if (std::none_of(values.begin(), values.end(), known)) values.push_back(pair.value);
    }
  report.consistent = classify(values);
}

}  // namespace

SharedTimestep shared_timestep(const SlepcSession& session, const std::string& path, bool consistent) {
  const SnapshotPart part =
      read_snapshot_part(path, static_cast<std::size_t>(session.rank()), static_cast<std::size_t>(session.ranks()));
  const Network network = linearise(part.scene, part.state);
  SharedTimestep report;
  report.particles = part.grains;
  report.rows = part.grains * static_cast<std::size_t>(network.dofs_per_grain());
  for (const double n : session.gather(static_cast<double>(network.contacts())))
    report.contacts += static_cast<std::size_t>(n);
  if (report.contacts == 0) return report;

  const MatHandle k = make_stiffness(part, network);
  const SlepcResult top = largest_symmetric(k);
  report.lambda_lower = top.pairs.front().value.real();
  report.residual = top.pairs.front().residual;
  report.products = top.products;
  report.lambda_upper = collatz_radius(k);
  const DampingSpec damping = damping_in_force(part.scene, part.state);
  if (damping.any()) report.dt_damped = damped_step(part, network, damping, k);
  if (consistent) solve_consistent(part, network, report);
  return report;
}

}  // namespace eg
