#include "state/scene.hpp"

namespace eg {

std::vector<BodySpec> box_bodies(int dimension) {
  std::vector<BodySpec> bodies;
  for (int k = 0; k < dimension; ++k)
    for (const char* side : {"_low", "_high"}) {
      BodySpec body;
      body.name = std::string(1, "xyz"[k]) + side;
      bodies.push_back(body);
    }
  return bodies;
}

}  // namespace eg
