#include "io/scene_file.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <sstream>

#include "contact/laws.hpp"
#include "io/boundary_reader.hpp"
#include "io/grading_reader.hpp"
#include "io/scene_settings.hpp"
#include "io/stage_reader.hpp"
#include "io/stl.hpp"
#include "io/text_file.hpp"
#include "io/toml_parse.hpp"
#include "io/toml_reader.hpp"
#include "io/trim_reader.hpp"

namespace eg {

namespace {

constexpr auto required = Need::required;
using NamedTables = std::vector<std::pair<std::string, TomlReader>>;

Material read_material(const std::string& name, const TomlReader& t) {
  Material m;
  m.name = name;
  t.number("density", m.density, positive, required);
  t.number("friction", m.friction, non_negative, required);
  t.number("shear_modulus", m.shear_modulus, positive);
  t.number("poisson", m.poisson, open(-1, 0.5));
  t.number("normal_stiffness", m.normal_stiffness, positive);
  t.number("shear_stiffness", m.shear_stiffness, non_negative);
  t.number("effective_modulus", m.effective_modulus, positive);
  t.number("stiffness_ratio", m.stiffness_ratio, positive);
  t.number("hertz_exponent", m.hertz_exponent, closed(1, 3));
  t.number("roughness", m.roughness, non_negative);
  t.number("rolling_friction", m.rolling_friction, non_negative);
  t.number("bond_modulus", m.bond_modulus, positive);
  t.number("bond_stiffness_ratio", m.bond_stiffness_ratio, positive);
  t.number("bond_radius_ratio", m.bond_radius_ratio, above_up_to(0, 1));
  t.number("bond_moment_share", m.bond_moment_share, closed(0, 1));
  t.number("bond_tensile_strength", m.bond_tensile_strength, positive);
  t.number("bond_shear_strength", m.bond_shear_strength, positive);
  t.finish();
  return m;
}

std::string joined(const ConstantSet& set) {
  std::string text;
  for (const auto& c : set) text += fmt::format("{}{}", text.empty() ? "" : " and ", c.key);
  return text;
}

bool given(const Material& m, const MaterialConstant& c) { return !std::isnan(m.*c.value); }

void check_further_constants(const Material& m, const TomlReader& t, const std::string& law) {
  ConstantSet needed;
  with_law(law, [&]<class Law>(Law) { needed = further_constants<Law>(); });
  for (const auto& c : needed)
    if (!given(m, c))
      throw t.error("", fmt::format("lacks {} for the law \"{}\"", c.key, law), fmt::format("add {}", c.key));
}

/// Number of the set of constants that the material gives; throws when it gives none or several.
std::size_t constants_given(const Material& m, const TomlReader& t, const std::string& law) {
  std::vector<ConstantSet> sets;
  with_law(law, [&](auto l) { sets = l.constant_sets(); });
  std::size_t found = sets.size();
  for (std::size_t k = 0; k < sets.size(); ++k) {
    const auto is_given = [&](const MaterialConstant& c) { return given(m, c); };
    const auto any = std::ranges::find_if(sets[k], is_given);
    if (any == sets[k].end()) continue;
    if (found < sets.size())
      throw t.error(any->key, fmt::format("contradicts {}", sets[found][0].key), "keep one set of the two");
    const auto lacking = std::ranges::find_if_not(sets[k], is_given);
    if (lacking != sets[k].end())
      throw t.error(any->key, fmt::format("needs {} beside it for the law \"{}\"", lacking->key, law),
                    fmt::format("add {}", lacking->key));
    found = k;
  }
  if (found < sets.size()) return found;
  std::string remedy;
  for (const auto& set : sets) remedy += fmt::format("{}{}", remedy.empty() ? "add " : ", or ", joined(set));
  throw t.error("", fmt::format("lacks the constants of the law \"{}\"", law), remedy);
}

NamedTables read_materials(const TomlReader& top, Scene& scene) {
  const auto tables = top.table("material", required)->named_tables();
  if (tables.empty()) throw top.error("material", "holds no material", "add [material.NAME]");
  for (const auto& [name, t] : tables) scene.materials.push_back(read_material(name, t));
  return tables;
}

PairSpec read_pair(const TomlReader& t, const Scene& scene) {
  PairSpec pair;
  std::vector<std::string> names;
  t.choices("materials", names, material_names(scene), required);
  if (names.size() != 2)
    throw t.error("materials", "must name two materials", "the same one twice for its own contacts");
  pair.first = names[0], pair.second = names[1];
  t.number("friction", pair.friction, non_negative, required);
  t.finish();
  return pair;
}

void read_friction_scatter(const TomlReader& t, ContactSpec& contact) {
  t.number("deviation", contact.friction_deviation, closed(0, 1), required);
  t.choice<bool>("per", contact.friction_by_grain, {{"contact", false}, {"grain", true}}, required);
  t.finish();
}

void read_contact(const TomlReader& t, const NamedTables& materials, Scene& scene) {
  t.choice("law", scene.contact.law, law_names(), required);
  t.choice("arms", scene.contact.arms, {"overlap", "radius"});
  if (const auto scatter = t.table("friction_scatter")) read_friction_scatter(*scatter, scene.contact);
  for (const auto& pair : t.tables("pair")) scene.contact.pairs.push_back(read_pair(pair, scene));
  t.finish();
  std::size_t set_of_first = 0;
  for (std::size_t k = 0; k < materials.size(); ++k) {
    const auto& table = materials[k].second;
    const auto set = constants_given(scene.materials[k], table, scene.contact.law);
    check_further_constants(scene.materials[k], table, scene.contact.law);
    if (k == 0) set_of_first = set;
    if (set != set_of_first)
      throw table.error("", fmt::format("gives other constants than material.{}", materials[0].first),
                        "describe all materials by the same constants");
  }
}

void read_lattice(const TomlReader& t, int dimension, SpecimenSpec& s) {
  const std::vector<std::string> plane{"square", "hexagonal"}, space{"sc", "bcc", "fcc", "fcc-110", "fcc-111", "hcp"};
  t.text("lattice", s.lattice, required);
  const auto& other = dimension == 2 ? space : plane;
  if (std::ranges::find(other, s.lattice) != other.end())
    throw t.error("lattice", fmt::format("is a lattice of {} dimensions", dimension == 2 ? 3 : 2),
                  fmt::format("set dimension = {}", dimension == 2 ? 3 : 2));
  t.choice("lattice", s.lattice, dimension == 2 ? plane : space);

  std::array<double, 3> cells{4, 4, dimension == 3 ? 4. : 1.};
  const auto axes = static_cast<std::size_t>(dimension);
  t.numbers("cells", std::span(cells).first(axes), closed(1, 100000));
  for (std::size_t k = 0; k < 3; ++k) {
    if (cells[k] != std::floor(cells[k])) throw t.error("cells", "must hold whole numbers");
    s.cells[k] = static_cast<int>(cells[k]);
  }
  if (cells[0] * cells[1] * cells[2] > 5e8) throw t.error("cells", "make more than 500 million cells");

  t.number("radius", s.radius, positive, required);
  const bool overlap = t.number("overlap", s.overlap, from_below(0, 0.5));
  if (t.number("pressure", s.pressure, positive) && overlap)
    throw t.error("pressure", "contradicts overlap", "keep one of the two");
  t.number("radius_scatter", s.radius_scatter, closed(0, 0.33));
}

void read_cloud(const TomlReader& t, int dimension, SpecimenSpec& s) {
  const bool coarse = t.integer("coarse_count", s.coarse_count, closed(1, 4e9));
  t.integer("count", s.count, closed(1, 4e9), coarse ? Need::optional : required);
  if (coarse && t.has("count")) throw t.error("coarse_count", "contradicts count", "keep one of the two");
  s.grading = read_grading(t);
  if (coarse && !s.grading.gap)
    throw t.error("coarse_count", "counts the coarse grains of a gap grading, which this is not",
                  "give count, or grading = { coarse = …, fines = …, fines_content = … }");
  double scale = 1;
  if (t.number("scale", scale, positive)) s.grading.scale(scale);
  t.number("solid_fraction", s.solid_fraction, open(0, dimension == 3 ? 0.7 : 0.9));  // below dense packings
  if (t.number("expand_to", s.expand_to, open(0, 1)) && s.expand_to <= s.solid_fraction)
    throw t.error("expand_to", fmt::format("must be above solid_fraction = {:g}", s.solid_fraction),
                  "the grains of the cloud grow until they fill the box so far");
  t.numbers("aspect", std::span(s.aspect).first(static_cast<std::size_t>(dimension)), positive);
  std::array<double, 3> box{};
  if (!t.numbers("box", std::span(box).first(static_cast<std::size_t>(dimension)), positive)) return;
  s.box = {box[0], box[1], box[2]};
  for (const char* key : {"solid_fraction", "aspect"})
    if (t.has(key)) throw t.error(key, "contradicts box", "keep one of the two");
}

void read_specimen(const TomlReader& t, int dimension, SpecimenSpec& s) {
  using Source = SpecimenSpec::Source;
  t.choice<Source>("source", s.source, {{"lattice", Source::lattice}, {"cloud", Source::cloud}, {"file", Source::file}},
                   required);
  switch (s.source) {
    case Source::lattice:
      read_lattice(t, dimension, s);
      break;
    case Source::cloud:
      read_cloud(t, dimension, s);
      break;
    case Source::file:
      t.text("path", s.path, required);
      break;
  }
  if (const auto trim = t.table("trim")) s.trim = read_trim(*trim, dimension);
  t.finish();
}

void read_damping(const TomlReader& t, DampingSpec& d) {
  t.number("local", d.local, from_below(0, 1));
  t.number("mass", d.mass, non_negative);
  t.number("normal_ratio", d.normal_ratio, non_negative);
  t.number("shear_ratio", d.shear_ratio, non_negative);
  t.finish();
}

void read_timestep(const TomlReader& t, TimestepSpec& s) {
  constexpr std::string_view estimate = "estimate:";
  t.text("policy", s.policy);
  if (!s.policy.starts_with(estimate) || s.policy.size() == estimate.size())
    t.choice("policy", s.policy, {"certified", "fixed", "estimate:NAME"});
  const bool fixed = s.policy == "fixed";
  t.number("fixed", s.fixed, positive, fixed ? required : Need::optional);
  if (!fixed && t.has("fixed")) throw t.error("fixed", "is read with policy = \"fixed\" only", "remove one of the two");
  t.number("safety", s.safety, above_up_to(0, 1));
  t.finish();
}

void read_stages(const TomlReader& top, Scene& scene) {
  for (const auto& t : top.tables("stage")) {
    scene.stages.push_back(read_stage(t, scene));
    for (std::size_t k = 0; k + 1 < scene.stages.size(); ++k)
      if (scene.stages[k].name == scene.stages.back().name)
        throw t.error("name", "is the name of another stage already", "give every stage a name of its own");
  }
}

void read_top(const TomlReader& top, Scene& scene) {
  top.has("settings");  // applied already
  top.text("title", scene.title);
  top.integer("dimension", scene.dimension, closed(2, 3), required);
  top.flag("rotation", scene.rotation);
  top.integer("seed", scene.seed, closed(0, 0x1p53 - 1));
  top.vector("gravity", scene.dimension, scene.gravity);
  const auto materials = read_materials(top, scene);
  read_contact(*top.table("contact", required), materials, scene);
  const auto specimen = *top.table("specimen", required);
  read_specimen(specimen, scene.dimension, scene.specimen);
  read_boundary(*top.table("boundary", required), scene);
  if (scene.boundary.kind == BoundarySpec::Kind::periodic && norm(scene.gravity) > 0)
    throw top.error("gravity", "has no ground in a cell that is periodic in every direction: grains would fall forever",
                    "leave it out, or set boundary.type to \"box\" or \"free\" with walls");
  if (scene.specimen.trim && scene.boundary.kind == BoundarySpec::Kind::periodic)
    throw specimen.error("trim", "leaves nothing that is periodic", "set boundary.type to \"box\" or \"free\"");
  if (const auto t = top.table("damping")) read_damping(*t, scene.damping);
  if (const auto t = top.table("timestep")) read_timestep(*t, scene.timestep);
  if (const auto t = top.table("record")) {
    t->flag("energy", scene.energy);
    t->finish();
  }
  read_stages(top, scene);
  const auto grows = [](const StageSpec& s) { return s.radius_growth > 0; };
  if (!std::isnan(scene.specimen.expand_to) && !std::ranges::any_of(scene.stages, grows))
    throw top.error("specimen", "has expand_to, but no stage lets grains grow", "add radius_growth to a stage");
  top.finish();
}

/// `settings` of the file, or those from outside.
void apply_settings(toml::table& table, const std::string& file, SceneSettings settings) {
  const TomlReader top(table, file);
  if (top.has("settings") && !settings.empty())
    throw top.error("settings", "are in the scene already", "add yours to that line of the file");
  top.texts("settings", settings);
  for (const auto& setting : settings) apply_setting(table, setting, file);
}

std::string with_settings(std::string_view text, const SceneSettings& settings) {
  if (settings.empty()) return std::string(text);
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  toml::array list;
  for (const auto& setting : settings) list.push_back(setting);
  std::ostringstream line;
  line << "settings = " << toml::toml_formatter(list, toml::format_flags::none) << "\n";
  return line.str() + std::string(text);
}

}  // namespace

Scene parse_scene(std::string_view text, const std::string& file, const SceneSettings& settings) {
  Scene scene;
  scene.file = file;
  scene.text = with_settings(text, settings);
  toml::table table = parse_toml(text, file);
  if (table.empty()) throw input_error(file, 0, "is an empty scene:", "it holds no keys", "see cases/ for examples");
  apply_settings(table, file, settings);
  read_top(TomlReader(table, file), scene);
  return scene;
}

Scene read_scene(const std::string& path, const SceneSettings& settings) {
  Scene scene = parse_scene(read_file(path), path, settings);
  const std::string folder = std::filesystem::path(path).parent_path().string();
  for (std::size_t k = 0; k < scene.boundary.meshes.size(); ++k) {
    auto& mesh = scene.boundary.meshes[k];
    const auto error = [&](std::string_view rule, std::string_view remedy = {}) {
      return scene_error(scene, fmt::format("boundary.mesh[{}].file", k),
                         fmt::format("boundary.mesh[{}].file = \"{}\"", k + 1, mesh.path), rule, remedy);
    };
    if (!std::filesystem::exists(resolve_path(scene, mesh.path)))
      throw error("names a file that is not there", "paths start from the folder of the scene");
    try {
      read_mesh_file(mesh, folder);
    } catch (const InputError& e) {
      throw error(fmt::format("cannot be a wall: {}", e.what()));
    }
  }
  return scene;
}

InputError scene_error(const Scene& scene, std::string_view key, std::string_view subject, std::string_view rule,
                       std::string_view remedy) {
  const toml::table table = parse_toml(scene.text, scene.file);
  const auto node = table.at_path(key);
  const long before = table.contains("settings") ? 1 : 0;  // the line that holds them comes first
  return one_line_error(scene.file, node ? static_cast<long>(node.node()->source().begin.line) - before : 0, subject,
                        rule, remedy);
}

std::string resolve_path(const Scene& scene, const std::string& path) {
  return (std::filesystem::path(scene.file).parent_path() / path).string();
}

}  // namespace eg
