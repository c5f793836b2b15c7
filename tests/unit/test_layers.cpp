// The layers of CMakeLists.txt, held against every #include of src/ and analysis/.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace {

using Names = std::set<std::string>;
using Graph = std::map<std::string, Names>;  ///< module → modules it names, or file → files it includes

std::string read(const std::filesystem::path& path) {
  std::ifstream in(path);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

std::vector<std::string> first_groups(const std::string& text, const std::regex& pattern) {
  std::vector<std::string> found;
  for (std::sregex_iterator it(text.begin(), text.end(), pattern), end; it != end; ++it) found.push_back((*it)[1]);
  return found;
}

/// Module → all modules below it, from the eigengrain_module(name folder uses...) lines.
Graph layers_of(const std::string& cmake) {
  Graph uses;
  for (const auto& line : first_groups(cmake, std::regex(R"((?:^|\n)eigengrain_module\(([^)]*)\))"))) {
    std::istringstream words(line);
    std::string name, folder, word;
    words >> name >> folder;
    auto& below = uses[name];
    while (words >> word)
      if (word.starts_with("eg_")) below.insert(word.substr(3));
  }
  for (std::size_t round = 0; round < uses.size(); ++round)  // transitive closure
    for (auto& [name, below] : uses)
      for (const auto& direct : Names(below)) below.insert(uses[direct].begin(), uses[direct].end());
  return uses;
}

std::string folder_of(const std::string& file) { return file.substr(0, file.find('/')); }

/// File → what it includes in quotes; names are relative to src/ or analysis/, as the includes are.
Graph includes_of(const std::filesystem::path& project) {
  const std::regex include(R"((?:^|\n)[ \t]*#[ \t]*include[ \t]*"([^"]+)\")");
  Graph graph;
  for (const char* root : {"src", "analysis"})
    for (const auto& entry : std::filesystem::recursive_directory_iterator(project / root)) {
      const auto kind = entry.path().extension();
      if (kind != ".hpp" && kind != ".cpp") continue;
      const auto found = first_groups(read(entry.path()), include);
      graph[entry.path().lexically_relative(project / root).generic_string()] = {found.begin(), found.end()};
    }
  return graph;
}

/// One line an include that the layers forbid or that names no file.
std::vector<std::string> layer_faults(const Graph& layers, const Graph& includes) {
  std::vector<std::string> faults;
  for (const auto& [file, targets] : includes) {
    const auto own = layers.find(folder_of(file));
    if (own == layers.end()) faults.push_back(file + " lies in no module of CMakeLists.txt");
    for (const auto& target : targets) {
      const auto folder = folder_of(target);
      if (!includes.contains(target))
        faults.push_back(file + " includes \"" + target + "\", which is no file of src/ or analysis/");
      else if (own != layers.end() && folder != own->first && !own->second.contains(folder))
        faults.push_back(file + " includes \"" + target + "\": " + own->first + " may not use " + folder);
    }
  }
  return faults;
}

/// A cycle reachable from `file` as "a -> b -> a", or "". `done` collects files known to lead to none.
std::string cycle_from(const std::string& file, const Graph& graph, std::vector<std::string>& path, Names& done) {
  if (done.contains(file)) return {};
  for (const auto& earlier : path)
    if (earlier == file) return path.back() + " -> " + file;
  path.push_back(file);
  if (const auto here = graph.find(file); here != graph.end())
    for (const auto& next : here->second)
      if (auto cycle = cycle_from(next, graph, path, done); !cycle.empty()) return cycle;
  path.pop_back();
  done.insert(file);
  return {};
}

std::string cycle_in(const Graph& graph) {
  Names done;
  for (const auto& [file, targets] : graph) {
    std::vector<std::string> path;
    if (auto cycle = cycle_from(file, graph, path, done); !cycle.empty()) return cycle;
  }
  return {};
}

const std::filesystem::path project = EIGENGRAIN_SOURCE_DIR;

TEST(Layers, EveryIncludeStaysBelowItsFolder) {
  const auto includes = includes_of(project);
  ASSERT_GT(includes.size(), 10u);
  for (const auto& fault : layer_faults(layers_of(read(project / "CMakeLists.txt")), includes)) ADD_FAILURE() << fault;
}

TEST(Layers, NoFoldersUseEachOther) { EXPECT_EQ(cycle_in(layers_of(read(project / "CMakeLists.txt"))), ""); }

TEST(Layers, NoFilesIncludeEachOther) { EXPECT_EQ(cycle_in(includes_of(project)), ""); }

TEST(Layers, AssemblyAndDynamicsAreStrangers) {
  const auto layers = layers_of(read(project / "CMakeLists.txt"));
  EXPECT_FALSE(layers.at("assembly").contains("dynamics"));
  EXPECT_FALSE(layers.at("dynamics").contains("assembly"));
  EXPECT_TRUE(layers.at("specimen").contains("base"));
}

TEST(LayerCheck, FindsUpwardIncludeStrayFolderAndMissingFile) {
  const auto layers =
      layers_of("eigengrain_module(low src/low fmt::fmt)\neigengrain_module(high src/high PRIVATE eg_low)\n");
  const Graph includes{{"low/a.hpp", {"high/b.hpp"}}, {"high/b.hpp", {"low/c.hpp"}}, {"odd/d.hpp", {}}};
  EXPECT_EQ(layer_faults(layers, includes).size(), 3u);
  EXPECT_TRUE(layer_faults(layers, {{"low/a.hpp", {}}, {"high/b.hpp", {"low/a.hpp"}}}).empty());
}

TEST(LayerCheck, FindsCycle) {
  EXPECT_EQ(cycle_in({{"a", {"b"}}, {"b", {"c"}}, {"c", {"b"}}}), "c -> b");
  EXPECT_EQ(cycle_in({{"a", {"b", "c"}}, {"b", {"c"}}, {"c", {}}}), "");
}

}  // namespace
