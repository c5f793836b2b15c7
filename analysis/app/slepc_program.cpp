#include "app/slepc_program.hpp"

#include <unistd.h>

#include <filesystem>

#include "app/prepare.hpp"
#include "base/error.hpp"

namespace eg {

std::string slepc_program() {
  std::error_code failed;
  const auto self = std::filesystem::read_symlink("/proc/self/exe", failed);
  const auto beside = self.parent_path() / "eigengrain-slepc";
  return !failed && std::filesystem::exists(beside, failed) ? beside.string() : "";
}

void become_slepc_program(const std::string& path, bool consistent, bool json) {
  if (kind_of(path) != InputKind::snapshot)
    throw input_error(path, 0, "this", "is no snapshot, and --solver slepc reads only snapshots",
                      "run the scene first: eigengrain run SCENE writes out/NAME/final.h5");
  const std::string program = slepc_program();
  if (program.empty())
    throw RunError(
        "--solver slepc: this program was built without SLEPc; `./dev mpi` installs slepc-dev and builds it");
  const char* arguments[] = {program.c_str(), path.c_str(), consistent ? "consistent" : "elastic",
                             json ? "json" : "text", nullptr};
  ::execv(program.c_str(), const_cast<char* const*>(arguments));
  throw RunError(program + " cannot be started");
}

}  // namespace eg
