#include "io/trim_reader.hpp"

#include <fmt/format.h>

namespace eg {

namespace {

void check_ends(const TomlReader& t, const TrimSpec& trim) {
  for (int k = 0; k < 3; ++k)
    if (!(trim.low[k] < trim.high[k])) throw t.error("", "ends below its beginning", "give ascending ends");
}

void read_box(const TomlReader& t, int dimension, TrimSpec& trim) {
  const auto axes = static_cast<std::size_t>(dimension);
  std::array<double, 3> low{}, high{};
  t.numbers("low", std::span(low).first(axes), any_number, Need::required);
  t.numbers("high", std::span(high).first(axes), any_number, Need::required);
  t.finish();
  for (int k = 0; k < dimension; ++k)
    trim.low[k] = low[static_cast<std::size_t>(k)], trim.high[k] = high[static_cast<std::size_t>(k)];
  check_ends(t, trim);
}

void read_cylinder(const TomlReader& t, int dimension, TrimSpec& trim) {
  trim.shape = TrimSpec::Shape::cylinder;
  if (dimension == 3) {
    t.choice<int>("axis", trim.axis, {{"x", 0}, {"y", 1}, {"z", 2}});
    t.number("from", trim.low[trim.axis]);
    t.number("to", trim.high[trim.axis]);
  }
  std::array<double, 2> centre{};
  t.numbers("centre", centre, any_number, Need::required);
  t.number("radius", trim.radius, positive, Need::required);
  if (t.number("inner_radius", trim.inner_radius, non_negative) && trim.inner_radius >= trim.radius)
    throw t.error("inner_radius", "leaves nothing of the cylinder", "make it smaller than radius");
  t.finish();
  for (int k = 0; k < 2; ++k) {
    const int across = (trim.axis + 1 + k) % 3;
    trim.centre[across] = centre[static_cast<std::size_t>(k)];
    trim.low[across] = trim.centre[across] - trim.radius, trim.high[across] = trim.centre[across] + trim.radius;
  }
  check_ends(t, trim);
}

}  // namespace

TrimSpec read_trim(const TomlReader& t, int dimension) {
  TrimSpec trim;
  using Keep = TrimSpec::Keep;
  t.choice<Keep>("keep", trim.keep, {{"whole", Keep::whole}, {"centre", Keep::centre}});
  const auto box = t.table("box"), cylinder = t.table("cylinder");
  t.finish();
  if (box.has_value() == cylinder.has_value())
    throw t.error(
        "", box ? "names both box and cylinder" : "names neither box nor cylinder",
        "write trim = { cylinder = { centre = [x, y], radius = r } } or trim = { box = { low = …, high = … } }");
  if (box)
    read_box(*box, dimension, trim);
  else
    read_cylinder(*cylinder, dimension, trim);
  return trim;
}

}  // namespace eg
