#include "app/spring_file.hpp"

#include <fmt/format.h>

#include "io/text_file.hpp"

namespace eg {

void write_springs(const Network& net, const std::string& path) {
  std::string text = fmt::format("{} {} {}\n", net.dimension, net.size(), net.springs.size());
  for (std::size_t g = 0; g < net.size(); ++g)
    text += fmt::format("{:.17g} {:.17g}\n", net.inverse_mass[g], net.rotation ? net.inverse_inertia[g] : 0.0);
  for (const auto& s : net.springs)
    text += fmt::format("{} {} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:d}\n", s.i + 1,
                        s.j == no_index ? 0 : s.j + 1, s.n.x * s.length, s.n.y * s.length, s.n.z * s.length, s.normal,
                        s.tangential, s.arm_i, s.arm_j, s.couple);
  write_file(path, text);
}

}  // namespace eg
