#include "slepc/session.hpp"

#include <fmt/format.h>

#include "base/error.hpp"

namespace eg {

void check_slepc(PetscErrorCode code) {
  if (code == 0) return;
  const char* text = nullptr;
  PetscErrorMessage(code, &text, nullptr);
  throw RunError(fmt::format("SLEPc gave up: {}", text ? text : fmt::format("error {}", static_cast<int>(code))));
}

SlepcSession::SlepcSession(int argc, char** argv) {
  check_slepc(SlepcInitialize(&argc, &argv, nullptr, nullptr));
  PetscPushErrorHandler(PetscReturnErrorHandler, nullptr);  // errors become one line, not a trace
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank_);
  MPI_Comm_size(PETSC_COMM_WORLD, &ranks_);
}

SlepcSession::~SlepcSession() { SlepcFinalize(); }

std::vector<double> SlepcSession::gather(double number) const {
  std::vector<double> all(static_cast<std::size_t>(ranks_));
  MPI_Allgather(&number, 1, MPI_DOUBLE, all.data(), 1, MPI_DOUBLE, PETSC_COMM_WORLD);
  return all;
}

}  // namespace eg
