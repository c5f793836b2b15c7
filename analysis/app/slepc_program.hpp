#pragma once
#include <string>

namespace eg {

/// Where eigengrain-slepc lies, beside this program; "" when it was not built.
std::string slepc_program();

/// Becomes that program: `eigengrain timestep SNAPSHOT --solver slepc`, also under mpirun. Returns never; throws
/// InputError unless `path` is a snapshot, RunError with the remedy when the program was not built.
[[noreturn]] void become_slepc_program(const std::string& path, bool consistent, bool json);

}  // namespace eg
