#include "timestep/estimates.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace eg {
namespace {

using std::numbers::pi;

/// Diagonal of K, a grain: translations x, y, z [N/m] and rotations [N m].
struct DiagonalSums {
  std::array<double, 3> translation{};
  std::array<double, 3> rotation_arm{};     ///< Σ kt a² (1 − n_a²)
  std::array<double, 3> rotation_radius{};  ///< the same with the full radius R
};

std::vector<DiagonalSums> diagonal_sums(const Network& network) {
  std::vector<DiagonalSums> sums(network.size());
  for (const Spring& s : network.springs) {
    const auto add = [&](Index grain, double arm) {
      const double r = network.radius[grain];
      for (int a = 0; a < 3; ++a) {
        const auto k = static_cast<std::size_t>(a);
        const double along = s.n[a] * s.n[a];
        if (s.couple) {
          const double couple = s.normal * along + s.tangential * (1 - along);
          sums[grain].rotation_arm[k] += couple, sums[grain].rotation_radius[k] += couple;
          continue;
        }
        sums[grain].translation[k] += s.normal * along + s.tangential * (1 - along);
        sums[grain].rotation_arm[k] += s.tangential * arm * arm * (1 - along);
        sums[grain].rotation_radius[k] += s.tangential * r * r * (1 - along);
      }
    };
    add(s.i, s.arm_i);
    if (s.j != no_index) add(s.j, s.arm_j);
  }
  return sums;
}

/// min √(m/k) over translations and √(I/k) over rotations of movable grains; `arms` with contact arms, else radii.
double least_diagonal_period(const Network& network, bool arms) {
  const auto sums = diagonal_sums(network);
  const bool solid = network.dimension == 3;
  double largest = 0;  // of k/m and k/I
  for (std::size_t g = 0; g < network.size(); ++g)
    for (std::size_t a = 0; a < 3; ++a) {
      if (solid || a < 2) largest = std::max(largest, sums[g].translation[a] * network.inverse_mass[g]);
      if (!network.rotation || !(solid || a == 2)) continue;
      const double k = arms ? sums[g].rotation_arm[a] : sums[g].rotation_radius[a];
      largest = std::max(largest, k * network.inverse_inertia[g]);
    }
  return 1 / std::sqrt(largest);
}

class Table {
 public:
  void add(const char* name, double dt, const char* formula, const char* source, bool rigorous = false) {
    if (std::isfinite(dt) && dt > 0) rows_.push_back({name, dt, formula, source, rigorous});
  }
  std::vector<Estimate> sorted() {
    std::stable_sort(rows_.begin(), rows_.end(), [](const auto& a, const auto& b) { return a.dt < b.dt; });
    return std::move(rows_);
  }

 private:
  std::vector<Estimate> rows_;
};

void add_stiffness_rules(const Network& network, const NetworkSummary& s, Table& table) {
  const double strict = std::sqrt(s.mass_min / s.normal_max), mean = std::sqrt(s.mass_mean / s.normal_mean);
  table.add("single-dof-min", 2 * strict, "2√(m_min/K_max)", "single degree of freedom");
  table.add("single-dof-mean", 2 * mean, "2√(m_mean/K_mean)", "single degree of freedom");
  table.add("cundall-strack", 0.2 * std::sqrt(0.5) * strict, "0.1·2√(m_min/(2K_max))",
            "Cundall and Strack 1979; Hart et al. 1988");
  table.add("tsuji-min", pi / 5 * strict, "(π/5)√(m_min/K_max)", "Tsuji et al. 1993");
  table.add("tsuji-mean", pi / 5 * mean, "(π/5)√(m_mean/K_mean)", "Tsuji et al. 1993");
  table.add("tu-andrade", 1.2 * std::sqrt(s.mass_min / s.tangential_max), "1.2√(m_min/Kt_max)", "Tu and Andrade 2008");
  table.add("itasca", least_diagonal_period(network, true), "min over grains of √(m/k_trans), √(I/k_rot)",
            "Itasca 2008");
  table.add("yade", 0.8 * std::sqrt(2.0) * least_diagonal_period(network, false),
            "0.8·√2·min √(m/Σ[(kn−kt)n²+kt]), √(I/Σ[kt R²(1−n²)])", "YADE GlobalStiffnessTimeStepper");
}

void add_bounds(const Network& network, Table& table) {
  table.add("element", element_time_step(network), "min over contacts of 2/ω_e, masses shared equally",
            "O'Sullivan and Bray 2004", true);
  table.add("gershgorin", gershgorin_time_step(network), "2/√(largest row sum)", "Gershgorin 1931", true);
}

void add_wave_rules(const Network& network, const NetworkSummary& s, const EstimateMaterial& material, Table& table) {
  if (!material.shear_modulus || !material.poisson || !material.density) return;
  const double g = *material.shear_modulus, nu = *material.poisson, rho = *material.density;
  const double rayleigh = pi * std::sqrt(rho / g) / (0.1631 * nu + 0.8766);
  const char* rayleigh_source = "Kremmer and Favier 2001; Li et al. 2005";
  table.add("rayleigh-rmin", rayleigh * s.radius_min, "πR_min√(ρ/G)/(0.1631ν+0.8766)", rayleigh_source);
  table.add("rayleigh-rmean", rayleigh * s.radius_mean, "πR_mean√(ρ/G)/(0.1631ν+0.8766)", rayleigh_source);
  const double p_wave = std::sqrt(rho / (2 * g * (1 + nu)));
  table.add("p-wave-rmin", p_wave * s.radius_min, "R_min√(ρ/E)", "YADE PWaveTimeStep");
  table.add("p-wave-rmean", p_wave * s.radius_mean, "R_mean√(ρ/E)", "YADE PWaveTimeStep");
  if (!material.max_speed || network.dimension != 3) return;
  const double e_star = g / (1 - nu);
  const auto hertz = [&](double r) {  // of two equal spheres: m* = m/2, R* = R/2
    const double m_star = 0.5 * rho * 4 / 3 * pi * r * r * r;
    return 2.87 * std::pow(m_star * m_star / (0.5 * r * e_star * e_star * *material.max_speed), 0.2);
  };
  table.add("hertz-time-rmin", hertz(s.radius_min), "2.87(m*²/(R*E*²v_max))^0.2 at R_min", "LIGGGHTS");
  table.add("hertz-time-rmean", hertz(s.radius_mean), "2.87(m*²/(R*E*²v_max))^0.2 at R_mean", "LIGGGHTS");
}

}  // namespace

std::vector<Estimate> time_step_estimates(const Network& network, const EstimateMaterial& material) {
  const NetworkSummary summary = summarise(network);
  if (network.springs.empty() || summary.movable == 0) return {};
  Table table;
  add_stiffness_rules(network, summary, table);
  add_bounds(network, table);
  add_wave_rules(network, summary, material, table);
  return table.sorted();
}

}  // namespace eg
