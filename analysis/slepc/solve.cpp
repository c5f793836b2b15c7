#include "slepc/solve.hpp"

#include <slepcpep.h>

#include <cmath>
#include <cstdint>

#include "base/error.hpp"

namespace eg {
namespace {

using EpsHandle = SlepcHandle<EPS, EPSDestroy>;
using PepHandle = SlepcHandle<PEP, PEPDestroy>;

/// A start vector that depends on the place in the whole, not on who holds it.
VecHandle start_vector(::Mat matrix) {
  VecHandle x;
  check_slepc(MatCreateVecs(matrix, x.out(), nullptr));
  PetscInt first = 0, last = 0;
  check_slepc(VecGetOwnershipRange(x, &first, &last));
  PetscScalar* values = nullptr;
  check_slepc(VecGetArray(x, &values));
  for (PetscInt k = first; k < last; ++k) {
    auto z = static_cast<std::uint64_t>(k) * 0x9e3779b97f4a7c15ull + 0x632be59bd9b4e019ull;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    values[k - first] = static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-52 - 1;
  }
  check_slepc(VecRestoreArray(x, &values));
  return x;
}

EpsHandle make_solver(::Mat matrix, EPSProblemType type, const SlepcOptions& options) {
  EpsHandle eps;
  check_slepc(EPSCreate(PETSC_COMM_WORLD, eps.out()));
  check_slepc(EPSSetOperators(eps, matrix, nullptr));
  check_slepc(EPSSetProblemType(eps, type));
  check_slepc(EPSSetType(eps, EPSKRYLOVSCHUR));
  check_slepc(EPSSetDimensions(eps, options.count, options.basis > 0 ? options.basis : PETSC_DEFAULT, PETSC_DEFAULT));
  check_slepc(EPSSetTolerances(eps, options.tolerance, options.restarts));
  VecHandle start = start_vector(matrix);
  check_slepc(EPSSetInitialSpace(eps, 1, start.out()));
  return eps;
}

SlepcResult solve(EPS eps) {
  check_slepc(EPSSolve(eps));
  PetscInt converged = 0;
  check_slepc(EPSGetConverged(eps, &converged));
  SlepcResult result;
  for (PetscInt k = 0; k < converged; ++k) {
    PetscScalar re = 0, im = 0;
    PetscReal residual = 0;
    check_slepc(EPSGetEigenvalue(eps, k, &re, &im));
    check_slepc(EPSComputeError(eps, k, EPS_ERROR_RELATIVE, &residual));
    result.pairs.push_back({{re, im}, residual});
  }
  ST st = nullptr;
  check_slepc(EPSGetST(eps, &st));
  PetscInt iterations = 0, basis = 0;
  check_slepc(EPSGetIterationNumber(eps, &iterations));
  check_slepc(EPSGetDimensions(eps, nullptr, &basis, nullptr));
  result.products = static_cast<int>(iterations * basis);  // at most: a restart keeps half of the basis
  return result;
}

}  // namespace

SlepcResult largest_symmetric(::Mat matrix, const SlepcOptions& options) {
  const EpsHandle eps = make_solver(matrix, EPS_HEP, options);
  check_slepc(EPSSetWhichEigenpairs(eps, EPS_LARGEST_REAL));
  SlepcResult result = solve(eps);
  if (result.pairs.empty()) throw RunError("SLEPc: no eigenvalue converged; use `--solver lanczos`");
  VecHandle x, y;
  check_slepc(MatCreateVecs(matrix, x.out(), y.out()));
  check_slepc(EPSGetEigenvector(eps, 0, x, nullptr));
  check_slepc(MatMult(matrix, x, y));
  PetscScalar xy = 0, xx = 0;
  check_slepc(VecDot(y, x, &xy));
  check_slepc(VecDot(x, x, &xx));
  result.pairs.front().value = xy / xx;
  return result;
}

SlepcResult general_end(::Mat matrix, EPSWhich end, const SlepcOptions& options) {
  const EpsHandle eps = make_solver(matrix, EPS_NHEP, options);
  check_slepc(EPSSetWhichEigenpairs(eps, end));
  return solve(eps);
}

SlepcResult quadratic_limit(::Mat k, ::Mat c, const SlepcOptions& options) {
  MatHandle a0, a1, a2;
  check_slepc(MatDuplicate(k, MAT_COPY_VALUES, a0.out()));
  check_slepc(MatScale(a0, -1));
  check_slepc(MatDuplicate(c, MAT_COPY_VALUES, a1.out()));
  check_slepc(MatScale(a1, -2));
  check_slepc(MatDuplicate(k, MAT_COPY_VALUES, a2.out()));
  check_slepc(MatZeroEntries(a2));
  check_slepc(MatShift(a2, 4));
  PepHandle pep;
  ::Mat coefficients[] = {a0, a1, a2};
  check_slepc(PEPCreate(PETSC_COMM_WORLD, pep.out()));
  check_slepc(PEPSetOperators(pep, 3, coefficients));
  check_slepc(PEPSetProblemType(pep, PEP_GENERAL));
  check_slepc(PEPSetType(pep, PEPTOAR));
  check_slepc(PEPSetWhichEigenpairs(pep, PEP_LARGEST_REAL));
  check_slepc(PEPSetScale(pep, PEP_SCALE_SCALAR, PETSC_DEFAULT, nullptr, nullptr, PETSC_DEFAULT, PETSC_DEFAULT));
  check_slepc(PEPSetDimensions(pep, options.count, options.basis > 0 ? options.basis : PETSC_DEFAULT, PETSC_DEFAULT));
  check_slepc(PEPSetTolerances(pep, options.tolerance, options.restarts));
  ST st = nullptr;
  KSP ksp = nullptr;
  PC pc = nullptr;
  check_slepc(PEPGetST(pep, &st));
  check_slepc(STGetKSP(st, &ksp));  // the leading matrix is 4: one Jacobi step inverts it
  check_slepc(KSPSetType(ksp, KSPPREONLY));
  check_slepc(KSPGetPC(ksp, &pc));
  check_slepc(PCSetType(pc, PCJACOBI));
  check_slepc(PEPSolve(pep));
  PetscInt converged = 0, iterations = 0, basis = 0;
  check_slepc(PEPGetConverged(pep, &converged));
  if (converged == 0) throw RunError("SLEPc: the quadratic problem did not converge");
  SlepcResult result;
  PetscScalar re = 0, im = 0;
  PetscReal residual = 0;
  check_slepc(PEPGetEigenpair(pep, 0, &re, &im, nullptr, nullptr));
  check_slepc(PEPComputeError(pep, 0, PEP_ERROR_BACKWARD, &residual));
  result.pairs.push_back({{re, im}, residual});
  check_slepc(PEPGetIterationNumber(pep, &iterations));
  check_slepc(PEPGetDimensions(pep, nullptr, &basis, nullptr));
  result.products = static_cast<int>(iterations * basis);
  return result;
}

}  // namespace eg
