#include "io/snapshot_part.hpp"

#include <algorithm>

#include "io/scene_file.hpp"
#include "io/snapshot_reader.hpp"

namespace eg {
namespace {

/// Numbers in ascending order as runs of rows.
Hdf5Rows runs_of(const std::vector<Index>& numbers) {
  Hdf5Rows runs;
  for (const Index n : numbers)
    if (!runs.empty() && runs.back()[0] + runs.back()[1] == n)
      ++runs.back()[1];
    else
      runs.push_back({n, 1});
  return runs;
}

/// All but the grains: contacts of the chunks that hold grains [first, last), no lists.
void read_contacts(const Hdf5Reader& file, std::size_t first, std::size_t last, State& state) {
  Hdf5Shape shape;
  const auto begin = file.read<std::uint64_t>("contacts/chunk_begin", shape);
  const std::size_t low = first / Contacts::chunk, high = (last + Contacts::chunk - 1) / Contacts::chunk;
  if (high >= begin.size() && last > first) file.damaged("contacts/chunk_begin", "has too few rows");
  Hdf5Rows rows;
  if (last > first && begin[low] < begin[high]) rows.push_back({begin[low], begin[high] - begin[low]});
  SnapshotReader reader(file, [&](const std::string& name, unsigned long long all) -> Hdf5Rows {
    if (all == 0 || name.starts_with("list/") || name.starts_with("grains/") || name == "contacts/chunk_begin")
      return {};
    if (name.starts_with("contacts/")) return rows;
    return {{0, all}};
  });
  visit_state(reader, state);
}

/// Leaves the contacts of grains [first, last); their first grain gets its number in the part, their second keeps that
/// of the file.
void keep_own(const Hdf5Reader& file, std::size_t first, std::size_t last, std::size_t grains, State& state) {
  Contacts& all = state.contacts;
  Contacts own;
  own.history_size = all.history_size, own.history_vectors = all.history_vectors, own.tail_vectors = all.tail_vectors;
  own.bond_value = all.bond_value;
  std::vector<std::size_t> kept;
  for (std::size_t c = 0; c < all.size(); ++c)
    if (!all.is_padding(c) && all.i[c] >= first && all.i[c] < last) kept.push_back(c);
  own.history.assign((kept.size() + Contacts::lanes - 1) / Contacts::lanes * Contacts::lanes * own.history_size, 0.0);
  for (const std::size_t c : kept) {
    if (all.j[c] >= grains) file.damaged("contacts/j", "names a grain that is not there");
    own.i.push_back(all.i[c] - static_cast<Index>(first));
    own.j.push_back(all.j[c]);
    if (!all.image.empty()) own.image.push_back(all.image[c]);
    if (!all.friction.empty()) own.friction.push_back(all.friction[c]);
    for (std::size_t k = 0; k < own.history_size; ++k) own.history_at(own.i.size() - 1, k) = all.history_at(c, k);
  }
  all = std::move(own);
  std::erase_if(state.wall_contacts, [&](const WallContact& c) { return c.grain < first || c.grain >= last; });
  for (auto& c : state.wall_contacts) c.grain -= static_cast<Index>(first);
  std::erase_if(state.applied, [&](const AppliedForce& f) { return f.grain < first || f.grain >= last; });
  for (auto& f : state.applied) f.grain -= static_cast<Index>(first);
}

/// Numbers of the part's grains: its own, then the others that its contacts name, ascending; turns Contacts::j into
/// numbers of the part.
std::vector<Index> number_grains(std::size_t first, std::size_t last, Contacts& contacts) {
  std::vector<Index> numbers, others;
  for (std::size_t g = first; g < last; ++g) numbers.push_back(static_cast<Index>(g));
  for (const Index j : contacts.j)
    if (j < first || j >= last) others.push_back(j);
  std::sort(others.begin(), others.end());
  others.erase(std::unique(others.begin(), others.end()), others.end());
  for (Index& j : contacts.j) {
    if (j >= first && j < last)
      j -= static_cast<Index>(first);
    else
      j = static_cast<Index>(
          last - first + static_cast<std::size_t>(std::lower_bound(others.begin(), others.end(), j) - others.begin()));
  }
  numbers.insert(numbers.end(), others.begin(), others.end());
  return numbers;
}

}  // namespace

SnapshotPart read_snapshot_part(const std::string& path, std::size_t part, std::size_t parts) {
  const Hdf5Reader file(path);
  check_snapshot_format(file, path);
  SnapshotPart p;
  p.scene = parse_scene(file.read_text("scene/text"), file.read_text("scene/file"));
  p.grains = file.rows("grains/position");
  const std::size_t first = part_begin(p.grains, part, parts), last = part_begin(p.grains, part + 1, parts);
  p.own = last - first;
  read_contacts(file, first, last, p.state);
  keep_own(file, first, last, p.grains, p.state);
  p.number = number_grains(first, last, p.state.contacts);
  const Hdf5Rows rows = runs_of(p.number);
  SnapshotReader grains(file, [&](const std::string&, unsigned long long all) { return all > 0 ? rows : Hdf5Rows{}; });
  visit_grains(grains, p.state.grains);
  return p;
}

}  // namespace eg
