#include "stiffness/relaxation.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "assembly/apply.hpp"
#include "assembly/stiffness.hpp"
#include "base/error.hpp"
#include "eigen/conjugate_gradient.hpp"
#include "eigen/sparse_cholesky.hpp"
#include "stiffness/cluster_jacobi.hpp"

namespace eg {
namespace {

using Field = std::vector<double>;  ///< total_dofs() numbers

/// Displacement and rotation of a grain out of a field; zero for a wall.
class FieldReader {
 public:
  explicit FieldReader(const Network& network) : components_(active_components(network)), width_(components_.size()) {}
  void read(const Field& field, Index grain, Vec3& move, Vec3& turn) const {
    move = turn = {};
    if (grain == no_index) return;
    for (std::size_t k = 0; k < width_; ++k) {
      const int c = components_[k];
      (c < 3 ? move[c] : turn[c - 3]) = field[grain * width_ + k];
    }
  }
  void add(Field& field, Index grain, const Vec3& force, const Vec3& moment) const {
    if (grain == no_index) return;
    for (std::size_t k = 0; k < width_; ++k) {
      const int c = components_[k];
      field[grain * width_ + k] += c < 3 ? force[c] : moment[c - 3];
    }
  }
  /// Δ = u_j − u_i + n × (a_i θ_i + a_j θ_j), of a couple θ_j − θ_i
  Vec3 gap(const Field& field, const Spring& s) const {
    Vec3 ui, ti, uj, tj;
    read(field, s.i, ui, ti), read(field, s.j, uj, tj);
    return s.couple ? tj - ti : uj - ui + cross(s.n, s.arm_i * ti + s.arm_j * tj);
  }

 private:
  std::span<const int> components_;
  std::size_t width_;
};

Vec3 spring_force(const Spring& s, const Vec3& d) {
  return s.tangential * d + ((s.normal - s.tangential) * dot(s.n, d)) * s.n;
}

/// −Bᵀ k e of one load.
Field load_vector(const Network& network, const LoadCases& loads, int a) {
  const FieldReader reader(network);
  Field f(total_dofs(network), 0.0);
  for (const Spring& s : network.springs) {
    if (s.couple) continue;  // a homogeneous strain turns nothing
    const Vec3 force = spring_force(s, loads.jump(s, a)), turn = cross(s.n, force);
    reader.add(f, s.i, force, s.arm_i * turn);
    reader.add(f, s.j, -force, s.arm_j * turn);
  }
  return f;
}

/// Σ (Δ_a + e_a)·(Δ_b + e_b) kn along and kt across the normals, and by stress: Σ e_a·k(Δ_b + e_b); loads a, b ≤ 6.
struct Energies {
  Eigen::Matrix<double, 6, 6> normal, tangential, stress;
};

/// What springs [low, high) hold. No fields: Δ = 0.
Energies energies_of(const Network& network, const LoadCases& loads, const std::vector<Field>& fields, std::size_t low,
                     std::size_t high) {
  const FieldReader reader(network);
  Energies sum;
  sum.normal.setZero(), sum.tangential.setZero(), sum.stress.setZero();
  Eigen::Matrix<double, 3, 6> e = Eigen::Matrix<double, 3, 6>::Zero(), d = e;  // jumps; with the grains' motion
  for (std::size_t k = low; k < high; ++k) {
    const Spring& s = network.springs[k];
    for (int a = 0; a < loads.count(); ++a) {
      const Vec3 jump = s.couple ? Vec3{} : loads.jump(s, a);
      const Vec3 whole = fields.empty() ? jump : jump + reader.gap(fields[static_cast<std::size_t>(a)], s);
      e.col(a) << jump.x, jump.y, jump.z;
      d.col(a) << whole.x, whole.y, whole.z;
    }
    const Eigen::Vector3d n(s.n.x, s.n.y, s.n.z);
    const Eigen::Matrix<double, 1, 6> along = n.transpose() * d;
    const Eigen::Matrix<double, 3, 6> across = d - n * along;
    sum.normal += s.normal * along.transpose() * along;
    sum.tangential += s.tangential * across.transpose() * across;
    sum.stress += e.transpose() * (s.normal * n * along + s.tangential * across);
  }
  return sum;
}

/// Pieces are summed alone, then in order: the same for any number of threads.
Energies energies(const Network& network, const LoadCases& loads, const std::vector<Field>& fields) {
  constexpr std::size_t piece = 4096;
  const std::size_t springs = network.springs.size(), pieces = (springs + piece - 1) / piece;
  std::vector<Energies> parts(std::max<std::size_t>(1, pieces));
  parts[0] = energies_of(network, loads, fields, 0, 0);
#pragma omp parallel for schedule(static)
  for (std::size_t p = 0; p < pieces; ++p)
    parts[p] = energies_of(network, loads, fields, p * piece, std::min(springs, (p + 1) * piece));
  Energies sum = parts[0];
  for (std::size_t p = 1; p < pieces; ++p)
    sum.normal += parts[p].normal, sum.tangential += parts[p].tangential, sum.stress += parts[p].stress;
  return sum;
}

/// Translations of the whole taken out, which a periodic cell leaves free.
void project_translations(const Network& network, Field& field) {
  const auto components = active_components(network);
  const std::size_t width = components.size(), grains = network.size();
  for (std::size_t k = 0; k < width && components[k] < 3; ++k) {
    double mean = 0;
    for (std::size_t g = 0; g < grains; ++g) mean += field[g * width + k] / static_cast<double>(grains);
    for (std::size_t g = 0; g < grains; ++g) field[g * width + k] -= mean;
  }
}

class Solver {
 public:
  Solver(const Network& network, const RelaxationOptions& options, RelaxedModuli& result)
      : network_(network), options_(options), result_(result), k_(network, StiffnessOperator::Scaling::none) {
    const bool small = total_dofs(network) <= 12000;
    direct_ = options.solver == RelaxationOptions::Solver::cholesky ||
              (options.solver == RelaxationOptions::Solver::automatic && small);
    grounded_ = std::ranges::any_of(network.springs, [](const Spring& s) { return s.j == no_index; });
    result.method = direct_ ? "sparse Cholesky" : "block-Jacobi conjugate gradients";
    if (direct_)
      factorise();
    else
      jacobi_.emplace(network);
  }

  /// `energy`: Σ e·k e of the load.
  Field solve(Field load, double energy) {
    if (!grounded_) project_translations(network_, load);
    Field x(load.size());
    const double error = direct_ ? solve_directly(load, x) : iterate(load, x, energy);
    if (!grounded_) project_translations(network_, x);
    errors_.push_back(error);
    return x;
  }
  const std::vector<double>& errors() const { return errors_; }  ///< EᵀKE of each load

 private:
  /// K + 1e-9 of its diagonal: what the shift costs in energy is its square, refined away below.
  void factorise() {
    auto k = stiffness_matrix(network_);
    for (Eigen::Index c = 0; c < k.cols(); ++c) {
      double& entry = k.coeffRef(c, c);
      entry = entry > 0 ? entry * (1 + shift) : 1.0;
    }
    if (!cholesky_.factorise(k))
      throw RunError("the stiffness matrix has no Cholesky factor: a spring has a stiffness that is not positive");
  }

  double solve_directly(const Field& load, Field& x) {
    Field r = load, correction(x.size()), product(x.size());
    std::fill(x.begin(), x.end(), 0.0);
    double error = 0;
    for (int pass = 0; pass < 3; ++pass) {
      cholesky_.solve(r, correction);
      error = std::max(0.0, dot(r, correction));  // energy of the step: the error before it
      add_scaled(x, 1, correction);
      k_.apply(x, product);
      r = load;
      add_scaled(r, -1, product);
    }
    ++result_.iterations;
    return error;
  }

  double iterate(const Field& load, Field& x, double energy) {
    const auto done = conjugate_gradient(k_, *jacobi_, load, x, {options_.tolerance, energy});
    result_.iterations += done.iterations;
    result_.converged = result_.converged && done.converged;
    return done.error;
  }

  static constexpr double shift = 1e-9;
  const Network& network_;
  const RelaxationOptions& options_;
  RelaxedModuli& result_;
  StiffnessOperator k_;
  bool direct_ = false, grounded_ = false;
  std::optional<ClusterJacobi> jacobi_;
  SparseCholesky cholesky_{network_.dofs_per_grain()};
  std::vector<double> errors_;
};

double largest_asymmetry(const Eigen::Matrix<double, 6, 6>& stress) {
  double worst = 0;
  for (Eigen::Index a = 0; a < stress.rows(); ++a)
    for (Eigen::Index b = 0; b < a; ++b)
      if (const double size = std::sqrt(std::abs(stress(a, a) * stress(b, b))); size > 0)
        worst = std::max(worst, std::abs(stress(a, b) - stress(b, a)) / size);
  return worst;
}

}  // namespace

RelaxedModuli relax(const Network& network, const LoadCases& loads, double volume, const RelaxationOptions& options) {
  RelaxedModuli result;
  const Energies affine = energies(network, loads, {});
  const auto moduli = [&](const Eigen::Matrix<double, 6, 6>& sum) -> Eigen::MatrixXd {
    return (sum + sum.transpose()).topLeftCorner(loads.count(), loads.count()) / (2 * volume);
  };
  result.affine = moduli(affine.stress);
  result.normal = moduli(affine.normal), result.tangential = moduli(affine.tangential);
  if (network.springs.empty()) return result;
  Solver solver(network, options, result);
  std::vector<Field> fields;
  for (int a = 0; a < loads.count(); ++a) {
    fields.push_back(solver.solve(load_vector(network, loads, a), affine.stress(a, a)));
    if (options.progress) options.progress(a + 1);
  }
  const Energies relaxed = energies(network, loads, fields);
  result.normal = moduli(relaxed.normal), result.tangential = moduli(relaxed.tangential);
  result.asymmetry = largest_asymmetry(relaxed.stress);
  for (int a = 0; a < loads.count(); ++a)
    if (const double whole = relaxed.normal(a, a) + relaxed.tangential(a, a); whole > 0)
      result.error = std::max(result.error, solver.errors()[static_cast<std::size_t>(a)] / whole);
  return result;
}

}  // namespace eg
