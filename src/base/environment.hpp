#pragma once

namespace eg {

/// Starts the program over (once) in the environment that OpenMP and glibc read only when a program is loaded: threads
/// wait in a loop long enough for the gaps within a step, and no longer; memory comes in huge pages where the system
/// allows. What the user has set stays. `argv` as given to main().
void fit_environment(char** argv);

}  // namespace eg
