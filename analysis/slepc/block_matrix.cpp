#include "slepc/block_matrix.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "assembly/linearise.hpp"
#include "assembly/stiffness.hpp"

namespace eg {
namespace {

PetscInt number(std::size_t n) { return static_cast<PetscInt>(n); }

/// Blocks a row of the own grains: those of grains of the same process, and others. Pairs that two springs join count
/// twice; too many do no harm.
struct RowCounts {
  std::vector<PetscInt> near, far;
};

RowCounts count_blocks(const SnapshotPart& part, const Network& shape) {
  VecHandle counts;  // two numbers a grain; what belongs elsewhere is sent there
  check_slepc(VecCreateMPI(PETSC_COMM_WORLD, number(2 * part.own), number(2 * part.grains), counts.out()));
  const auto add = [&](Index row, bool near) {
    check_slepc(VecSetValue(counts, number(2 * part.number[row] + (near ? 0 : 1)), 1.0, ADD_VALUES));
  };
  for (std::size_t g = 0; g < part.own; ++g) add(static_cast<Index>(g), true);
  for (const Spring& s : shape.springs) {
    if (s.j == no_index || s.j == s.i) continue;
    const bool near = s.j < part.own;
    add(s.i, near), add(s.j, near);
  }
  check_slepc(VecAssemblyBegin(counts));
  check_slepc(VecAssemblyEnd(counts));
  const PetscScalar* values = nullptr;
  check_slepc(VecGetArrayRead(counts, &values));
  RowCounts rows;
  for (std::size_t g = 0; g < part.own; ++g) {
    rows.near.push_back(std::min(static_cast<PetscInt>(values[2 * g]), number(part.own)));
    rows.far.push_back(std::min(static_cast<PetscInt>(values[2 * g + 1]), number(part.grains - part.own)));
  }
  check_slepc(VecRestoreArrayRead(counts, &values));
  return rows;
}

/// M^−½ of every degree of freedom of the part.
std::vector<double> scales(const Network& shape) {
  std::vector<double> scale = inverse_mass_diagonal(shape);
  for (double& s : scale) s = std::sqrt(s);
  return scale;
}

}  // namespace

MatHandle make_block_matrix(const SnapshotPart& part, const Network& shape,
                            const std::function<void(const AddBlock&)>& emit) {
  const auto d = static_cast<std::size_t>(shape.dofs_per_grain());
  const RowCounts rows = count_blocks(part, shape);
  MatHandle m;
  check_slepc(MatCreate(PETSC_COMM_WORLD, m.out()));
  check_slepc(
      MatSetSizes(m, number(part.own * d), number(part.own * d), number(part.grains * d), number(part.grains * d)));
  check_slepc(MatSetType(m, MATBAIJ));
  check_slepc(MatXAIJSetPreallocation(m, number(d), rows.near.data(), rows.far.data(), nullptr, nullptr));
  const std::vector<double> scale = scales(shape);
  std::vector<double> block(d * d);
  emit([&](Index row, Index column, const double* values) {
    for (std::size_t r = 0; r < d; ++r)
      for (std::size_t c = 0; c < d; ++c)
        block[d * r + c] = scale[d * row + r] * values[d * r + c] * scale[d * column + c];
    const PetscInt i = number(part.number[row]), j = number(part.number[column]);
    check_slepc(MatSetValuesBlocked(m, 1, &i, 1, &j, block.data(), ADD_VALUES));
  });
  check_slepc(MatAssemblyBegin(m, MAT_FINAL_ASSEMBLY));
  check_slepc(MatAssemblyEnd(m, MAT_FINAL_ASSEMBLY));
  return m;
}

MatHandle make_stiffness(const SnapshotPart& part, const Network& network) {
  const auto components = active_components(network);
  const auto d = static_cast<Eigen::Index>(components.size());
  return make_block_matrix(part, network, [&](const AddBlock& add) {
    const std::vector<double> nothing(static_cast<std::size_t>(d * d), 0.0);  // grains without contacts keep a diagonal
    for (std::size_t g = 0; g < part.own; ++g) add(static_cast<Index>(g), static_cast<Index>(g), nothing.data());
    using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    Eigen::Matrix<double, 3, Eigen::Dynamic> b[2] = {Eigen::MatrixXd(3, d), Eigen::MatrixXd(3, d)};
    for (const Spring& s : network.springs) {
      const Eigen::Matrix3d k = contact_stiffness(s);
      const Index grain[2] = {s.i, s.j};
      const int sides = s.j == no_index ? 1 : 2;
      for (int side = 0; side < sides; ++side) {
        const auto whole = side_matrix(s, side == 0 ? ContactSide::first : ContactSide::second);
        for (Eigen::Index c = 0; c < d; ++c) b[side].col(c) = whole.col(components[static_cast<std::size_t>(c)]);
      }
      for (int r = 0; r < sides; ++r)
        for (int c = 0; c < sides; ++c) {
          const Rows block = b[r].transpose() * k * b[c];
          add(grain[r], grain[c], block.data());
        }
    }
  });
}

MatHandle make_tangent(const SnapshotPart& part, const Network& shape) {
  const auto components = active_components(shape);
  const std::size_t d = components.size();
  return make_block_matrix(part, shape, [&](const AddBlock& add) {
    std::vector<double> block(d * d, 0.0);
    for (std::size_t g = 0; g < part.own; ++g) add(static_cast<Index>(g), static_cast<Index>(g), block.data());
    for (const TangentBlock& t : consistent_blocks(part.scene, part.state)) {
      const Index grain[2] = {t.i, t.j};
      const std::size_t sides = t.j == no_index ? 1 : 2;
      for (std::size_t r = 0; r < sides; ++r)
        for (std::size_t c = 0; c < sides; ++c) {
          for (std::size_t p = 0; p < d; ++p)
            for (std::size_t q = 0; q < d; ++q)
              block[d * p + q] = t.k[12 * (6 * r + static_cast<std::size_t>(components[p])) + 6 * c +
                                     static_cast<std::size_t>(components[q])];
          add(grain[r], grain[c], block.data());
        }
    }
  });
}

namespace {

double spectral_norm(const Eigen::MatrixXd& block) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(block.transpose() * block, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, solver.eigenvalues().maxCoeff())) * (1 + 1e-12);
}

/// ‖A_ij‖₂ of the blocks of the own rows, a number a block.
MatHandle block_norms(::Mat matrix, std::size_t& most) {
  PetscInt d = 1, first = 0, last = 0, all = 0;
  check_slepc(MatGetBlockSize(matrix, &d));
  check_slepc(MatGetOwnershipRange(matrix, &first, &last));
  check_slepc(MatGetSize(matrix, &all, nullptr));
  const PetscInt own = (last - first) / d;
  std::vector<std::vector<std::pair<PetscInt, double>>> rows(static_cast<std::size_t>(own));
  std::vector<PetscInt> near(rows.size(), 0), far(rows.size(), 0);
  for (PetscInt g = 0; g < own; ++g) {
    Eigen::MatrixXd band;
    std::vector<PetscInt> grains;
    for (PetscInt k = 0; k < d; ++k) {
      PetscInt count = 0;
      const PetscInt* columns = nullptr;
      const PetscScalar* values = nullptr;
      check_slepc(MatGetRow(matrix, first + g * d + k, &count, &columns, &values));
      if (k == 0) band.resize(d, count);
      for (PetscInt c = 0; c < count; ++c) band(k, c) = values[c];
      if (k == 0)
        for (PetscInt c = 0; c < count; c += d) grains.push_back(columns[c] / d);
      check_slepc(MatRestoreRow(matrix, first + g * d + k, &count, &columns, &values));
    }
    for (std::size_t c = 0; c < grains.size(); ++c) {
      rows[static_cast<std::size_t>(g)].emplace_back(
          grains[c], spectral_norm(band.middleCols(static_cast<Eigen::Index>(c) * d, d)));
      const bool inside = grains[c] * d >= first && grains[c] * d < last;
      ++(inside ? near : far)[static_cast<std::size_t>(g)];
    }
    most = std::max(most, grains.size());
  }
  MatHandle n;
  check_slepc(MatCreateAIJ(PETSC_COMM_WORLD, own, own, all / d, all / d, 0, near.data(), 0, far.data(), n.out()));
  for (PetscInt g = 0; g < own; ++g)
    for (const auto& [column, norm] : rows[static_cast<std::size_t>(g)])
      check_slepc(MatSetValue(n, first / d + g, column, norm, INSERT_VALUES));
  check_slepc(MatAssemblyBegin(n, MAT_FINAL_ASSEMBLY));
  check_slepc(MatAssemblyEnd(n, MAT_FINAL_ASSEMBLY));
  return n;
}

}  // namespace

double collatz_radius(::Mat matrix, int sweeps) {
  std::size_t most = 0;
  const MatHandle n = block_norms(matrix, most);
  VecHandle y, product, ratio, diagonal;
  check_slepc(MatCreateVecs(n, y.out(), product.out()));
  check_slepc(VecDuplicate(y, ratio.out()));
  check_slepc(VecDuplicate(y, diagonal.out()));
  check_slepc(MatGetDiagonal(n, diagonal));
  check_slepc(VecSet(y, 1.0));
  double best = std::numeric_limits<double>::infinity();
  for (int sweep = 0; sweep <= sweeps; ++sweep) {
    check_slepc(MatMult(n, y, product));
    check_slepc(VecPointwiseDivide(ratio, product, y));
    PetscReal largest = 0;
    check_slepc(VecMax(ratio, nullptr, &largest));
    best = std::min(best, largest);
    if (!(largest > 0)) break;
    // Averaging with y damps the sign-changing modes of a lattice and keeps y positive.
    check_slepc(VecPointwiseMult(ratio, diagonal, y));
    check_slepc(VecAXPY(product, 0.5, ratio));
    check_slepc(VecMax(product, nullptr, &largest));
    check_slepc(VecScale(product, 1 / largest));
    check_slepc(VecShift(product, 1e-30));
    check_slepc(VecCopy(product, y));
  }
  double all = static_cast<double>(most);
  MPI_Allreduce(MPI_IN_PLACE, &all, 1, MPI_DOUBLE, MPI_MAX, PETSC_COMM_WORLD);
  return best * (1 + (2 * all + 64) * std::numeric_limits<double>::epsilon());
}

}  // namespace eg
