#pragma once
// SLEPc for as long as the object lives, and what the processes tell each other.
#include <slepceps.h>

#include <utility>
#include <vector>

namespace eg {

/// Throws RunError, one line, when a call of PETSc or SLEPc failed.
void check_slepc(PetscErrorCode code);

class SlepcSession {
 public:
  SlepcSession(int argc, char** argv);
  ~SlepcSession();
  SlepcSession(const SlepcSession&) = delete;

  int rank() const { return rank_; }
  int ranks() const { return ranks_; }
  /// The number of every rank, in order, on all of them.
  std::vector<double> gather(double number) const;

 private:
  int rank_ = 0, ranks_ = 1;
};

/// Owns one object of PETSc or SLEPc.
template <class Object, PetscErrorCode (*destroy)(Object*)>
class SlepcHandle {
 public:
  SlepcHandle() = default;
  SlepcHandle(SlepcHandle&& other) noexcept : object_(std::exchange(other.object_, nullptr)) {}
  SlepcHandle& operator=(SlepcHandle&& other) noexcept {
    std::swap(object_, other.object_);
    return *this;
  }
  ~SlepcHandle() {
    if (object_) destroy(&object_);
  }
  operator Object() const { return object_; }
  Object* out() { return &object_; }  ///< for the call that makes it

 private:
  Object object_ = nullptr;
};
using MatHandle = SlepcHandle<::Mat, MatDestroy>;
using VecHandle = SlepcHandle<::Vec, VecDestroy>;

}  // namespace eg
