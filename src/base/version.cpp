#include "base/version.hpp"

namespace eg {

const char* version() { return EIGENGRAIN_VERSION; }

}  // namespace eg
