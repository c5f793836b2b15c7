#include "io/snapshot.hpp"

#include "base/error.hpp"
#include "base/version.hpp"
#include "io/scene_file.hpp"
#include "io/snapshot_reader.hpp"
#include "io/state_check.hpp"
#include "io/text_file.hpp"

namespace eg {

namespace {

class Writer {
 public:
  explicit Writer(Hdf5Writer& file) : file_(file) {}

  template <class T>
  void value(const std::string& name, const std::string& unit, const T& x) {
    using P = PartsOf<T>;
    std::vector<Stored<T>> data(P::width);
    for (std::size_t k = 0; k < P::width; ++k) data[k] = static_cast<Stored<T>>(P::at(x, k));
    Hdf5Shape shape;
    add_shape<T>(shape);
    file_.write(name, unit, shape, data);
  }
  template <class T>
  void array(const std::string& name, const std::string& unit, const std::vector<T>& all) {
    column(name, unit, all, itself);
  }
  template <class T, class Project>
  void column(const std::string& name, const std::string& unit, const std::vector<T>& all, Project field) {
    using Field = decltype(field(all[0]));
    using P = PartsOf<Field>;
    std::vector<Stored<Field>> data(all.size() * P::width);
    for (std::size_t i = 0; i < all.size(); ++i) {
      auto&& x = field(all[i]);
      for (std::size_t k = 0; k < P::width; ++k) data[i * P::width + k] = P::at(x, k);
    }
    Hdf5Shape shape{all.size()};
    add_shape<Field>(shape);
    file_.write(name, unit, shape, data);
  }
  void history(const std::string& name, const std::string& unit, const Contacts& contacts) {
    std::vector<double> data;
    data.reserve(contacts.size() * contacts.history_size);
    for (std::size_t c = 0; c < contacts.size(); ++c)
      for (std::size_t k = 0; k < contacts.history_size; ++k) data.push_back(contacts.history_at(c, k));
    file_.write(name, unit, {contacts.size(), contacts.history_size}, data);
  }

 private:
  Hdf5Writer& file_;
};

}  // namespace

void check_snapshot_format(const Hdf5Reader& file, const std::string& path) {
  if (!file.has("format_version"))
    throw input_error(path, 0, "is no snapshot:", "it is an HDF5 file of another program",
                      "name a .h5 file that a run has written");
  int version = 0;
  SnapshotReader(file).value("format_version", "", version);
  if (version != snapshot_version)
    throw input_error(path, 0, fmt::format("format_version = {}", version),
                      fmt::format("must be {} for eigengrain {}", snapshot_version, eg::version()),
                      "read it with the version that wrote it, " + file.read_text("program_version"));
}

void write_snapshot(const std::string& path, const Scene& scene, const State& state) {
  if (scene.text.empty()) throw RunError(path + ": cannot be written, since the scene has no text to store");
  replace_file(path, [&](const std::string& temporary) {
    Hdf5Writer file(temporary, path);
    Writer writer(file);
    writer.value("format_version", "", snapshot_version);
    file.write_text("program_version", version());
    file.write_text("scene/file", scene.file);
    file.write_text("scene/text", scene.text);
    visit_state(writer, state);
    file.close();
  });
}

Snapshot read_snapshot(const std::string& path) {
  const Hdf5Reader file(path);
  check_snapshot_format(file, path);
  Snapshot snapshot{parse_scene(file.read_text("scene/text"), file.read_text("scene/file")), {}};
  SnapshotReader reader(file);
  visit_state(reader, snapshot.state);
  check_state(snapshot.scene, snapshot.state, path);
  return snapshot;
}

bool looks_like_snapshot(const std::string& path) { return Hdf5Reader::recognises(path); }

}  // namespace eg
