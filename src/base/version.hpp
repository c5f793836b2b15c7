#pragma once

namespace eg {

/// Version of the program, "0.1.0".
const char* version();

}  // namespace eg
