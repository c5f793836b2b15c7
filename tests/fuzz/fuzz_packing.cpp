// Any bytes as a packing: grains inside their cell, or one line.
#include <cstdint>
#include <string_view>

#include "io/packing_file.hpp"
#include "one_line.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  expect_result_or_one_line([&] {
    const auto packing = eg::parse_packing({reinterpret_cast<const char*>(data), size}, "fuzz");
    for (std::size_t i = 0; i < packing.size(); ++i) {
      if (!(packing.radius[i] > 0)) std::abort();
      for (int k = 0; k < packing.dimension; ++k)
        if (!(packing.position[i][k] >= 0 && packing.position[i][k] < packing.box[k])) std::abort();
    }
  });
  return 0;
}
