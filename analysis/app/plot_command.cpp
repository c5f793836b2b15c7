// eigengrain plot HISTORY…: curves of histories, or their means over a part of each.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/commands.hpp"
#include "app/number_words.hpp"
#include "app/packing_input.hpp"
#include "base/error.hpp"
#include "io/history.hpp"
#include "report/table.hpp"

namespace eg {
namespace {

struct PlotFlags {
  std::vector<std::string> inputs, y, labels;
  std::string x = "time", over, figure, title;
  int stage = 0;  ///< 0: all of them
  bool json = false, logarithmic = false, pool = false;
};

/// The rows of one stage only.
HistoryTable of_stage(HistoryTable table, int stage, const std::string& path) {
  const auto numbers = table.values[table.find("stage", path)];
  for (auto& column : table.values) {
    std::size_t kept = 0;
    for (std::size_t k = 0; k < column.size(); ++k)
      if (numbers[k] == stage) column[kept++] = column[k];
    column.resize(kept);
  }
  if (table.values[0].empty())
    throw input_error(path, 0, fmt::format("--stage {}", stage), "has no row in this history", "stages count from 1");
  return table;
}

/// Values of one column, or of one over another ("deviator/mean_stress").
struct Quantity {
  std::string title;  ///< with its unit
  std::vector<double> values;
};

Quantity quantity(const HistoryTable& table, const std::string& name, const std::string& path) {
  const auto stroke = name.find('/');
  const auto column = table.find(name.substr(0, stroke), path);
  Quantity q{fmt::format("{} [{}]", name, table.columns[column].unit), table.values[column]};
  if (stroke == std::string::npos) return q;
  const auto below = table.find(name.substr(stroke + 1), path);
  const auto &over = table.columns[below].unit, &unit = table.columns[column].unit;
  q.title = fmt::format("{} [{}]", name, over == unit ? "-" : over == "-" ? unit : unit + "/" + over);
  for (std::size_t k = 0; k < q.values.size(); ++k) q.values[k] /= table.values[below][k];
  return q;
}

/// The rows that a mean is taken of: --mean-over COLUMN=FROM:TO.
struct Window {
  std::string column;
  double from = NAN, to = NAN;
};

Window window_of(const std::string& text) {
  Window w;
  const auto equals = text.find('='), colon = text.find(':');
  if (equals < colon && colon != std::string::npos) {
    w.column = text.substr(0, equals);
    w.from = number_of(text.substr(equals + 1, colon - equals - 1));
    w.to = number_of(text.substr(colon + 1));
  }
  if (std::isnan(w.from) || std::isnan(w.to))
    throw input_error("eigengrain plot", 0, fmt::format("--mean-over {}", text), "must be COLUMN=FROM:TO",
                      "for example strain_z=0.3:0.5");
  return w;
}

struct Mean {
  double value = 0, scatter = 0;  ///< standard deviation of the rows
};

Mean mean_of(const std::vector<double>& values) {
  Mean m;
  const auto count = static_cast<double>(values.size());
  double square = 0;
  for (const double v : values) m.value += v / count;
  for (const double v : values) square += (v - m.value) * (v - m.value);
  m.scatter = std::sqrt(square / count);
  return m;
}

std::vector<bool> chosen_rows(const HistoryTable& table, const Window& w, const std::string& path) {
  std::vector<bool> chosen;
  for (const double v : table.values[table.find(w.column, path)]) chosen.push_back(v >= w.from && v <= w.to);
  if (std::ranges::none_of(chosen, [](bool b) { return b; }))
    throw input_error(path, 0, fmt::format("--mean-over {}={}:{}", w.column, w.from, w.to), "holds no row",
                      "choose a range that the run has passed");
  return chosen;
}

/// histories/NAME/history.csv is NAME.
std::string name_of(const PlotFlags& flags, std::size_t k) {
  if (k < flags.labels.size()) return flags.labels[k];
  const std::filesystem::path path(flags.inputs[k]);
  return path.has_parent_path() ? path.parent_path().filename().string() : path.stem().string();
}

void finish(const PlotFlags& flags, Figure& figure) {
  if (flags.figure.empty()) return;
  figure.title = flags.title;
  figure.x.logarithmic = flags.logarithmic;
  save_figure(figure, flags.figure);
}

/// A curve a history and quantity; all rows as JSON.
int plot_curves(const PlotFlags& flags, const std::vector<HistoryTable>& tables) {
  Figure figure;
  auto out = nlohmann::json::array();
  for (std::size_t k = 0; k < tables.size(); ++k) {
    const Quantity x = quantity(tables[k], flags.x, flags.inputs[k]);
    for (const auto& name : flags.y) {
      const Quantity y = quantity(tables[k], name, flags.inputs[k]);
      const std::string label = flags.y.size() == 1        ? name_of(flags, k)
                                : flags.inputs.size() == 1 ? name
                                                           : name_of(flags, k) + ", " + name;
      figure.x.title = x.title, figure.y.title = flags.y.size() == 1 ? y.title : "";
      figure.series.push_back({.label = tables.size() * flags.y.size() > 1 ? label : "", .x = x.values, .y = y.values});
      out.push_back({{"label", label}, {x.title, x.values}, {y.title, y.values}});
    }
  }
  if (flags.json) fmt::print("{}\n", out.dump(2));
  finish(flags, figure);
  return 0;
}

struct Group {
  std::string label;
  std::vector<std::size_t> histories;
};

/// Each history alone, or with --pool those of one label together, in the order of their first.
std::vector<Group> groups_of(const PlotFlags& flags) {
  std::vector<Group> groups;
  for (std::size_t k = 0; k < flags.inputs.size(); ++k) {
    const std::string label = name_of(flags, k);
    const auto same = std::ranges::find(groups, label, &Group::label);
    if (flags.pool && same != groups.end())
      same->histories.push_back(k);
    else
      groups.push_back({label, {k}});
  }
  return groups;
}

/// One row a group: means over the window of its histories, with their scatter.
int plot_means(const PlotFlags& flags, const std::vector<HistoryTable>& tables) {
  const Window window = window_of(flags.over);
  std::vector<std::string> names{flags.x};
  names.insert(names.end(), flags.y.begin(), flags.y.end());
  std::vector<Column> columns{{"history"}};
  Figure figure;
  for (const auto& name : names) {
    columns.push_back({name, quantity(tables[0], name, flags.inputs[0]).title});
    columns.push_back({name + "_scatter", "±"});
  }
  Table report(columns);
  Series points{.line = false, .points = true};
  Series bars{.label = "± standard deviation of the rows"};
  for (const Group& group : groups_of(flags)) {
    std::vector<std::vector<double>> values(names.size());
    for (const std::size_t k : group.histories) {
      const auto rows = chosen_rows(tables[k], window, flags.inputs[k]);
      for (std::size_t n = 0; n < names.size(); ++n) {
        const Quantity q = quantity(tables[k], names[n], flags.inputs[k]);
        for (std::size_t r = 0; r < rows.size(); ++r)
          if (rows[r]) values[n].push_back(q.values[r]);
      }
    }
    std::vector<Value> row{group.label};
    std::vector<Mean> means;
    for (const auto& v : values) {
      means.push_back(mean_of(v));
      row.insert(row.end(), {means.back().value, means.back().scatter});
    }
    report.add(row);
    points.x.push_back(means[0].value), points.y.push_back(means[1].value);
    bars.x.insert(bars.x.end(), {means[0].value, means[0].value, automatic});
    bars.y.insert(bars.y.end(), {means[1].value - means[1].scatter, means[1].value + means[1].scatter, automatic});
  }
  fmt::print("{}", flags.json ? report.json().dump(2) + "\n" : report.text());
  figure.x.title = columns[1].title, figure.y.title = columns[3].title;
  figure.series = {points, bars};
  finish(flags, figure);
  return 0;
}

int plot_command(const PlotFlags& flags) {
  check_figure(flags.figure);
  if (flags.over.empty() && flags.figure.empty() && !flags.json)
    throw InputError("eigengrain plot: nothing to make of these columns; add --figure FILE, --json or --mean-over");
  if (flags.labels.size() > flags.inputs.size())
    throw InputError(fmt::format("eigengrain plot: --label names {} histories of {}; give one name each",
                                 flags.labels.size(), flags.inputs.size()));
  std::vector<HistoryTable> tables;
  for (const auto& path : flags.inputs) {
    tables.push_back(read_history(path));
    if (flags.stage > 0) tables.back() = of_stage(std::move(tables.back()), flags.stage, path);
  }
  return flags.over.empty() ? plot_curves(flags, tables) : plot_means(flags, tables);
}

}  // namespace

void add_plot_command(CLI::App& app, Action& action) {
  auto* sub = app.add_subcommand("plot", "curves of histories, or their means over a part of each");
  auto flags = std::make_shared<PlotFlags>();
  sub->add_option("input", flags->inputs, "histories (out/NAME/history.csv)")->required();
  sub->add_option("--x", flags->x, "column, or ratio of two: deviator/mean_stress (default: time)");
  sub->add_option("--y", flags->y, "likewise; several: Y1,Y2,...")->delimiter(',')->required();
  sub->add_option("--mean-over", flags->over,
                  "COLUMN=FROM:TO: means and their scatter over these rows, one line a history");
  sub->add_flag("--pool", flags->pool, "with --mean-over: histories of one label (their folder's name) make one line");
  sub->add_option("--stage", flags->stage, "rows of this stage only, from 1")->check(CLI::Range(1, 100000));
  sub->add_option("--label", flags->labels, "name of a history, in their order: L1,L2,... (default: its folder)")
      ->delimiter(',');
  sub->add_option("--figure", flags->figure, "draw it (.svg, .png or .pdf)");
  sub->add_option("--title", flags->title, "of the figure");
  sub->add_flag("--log-x", flags->logarithmic, "logarithmic axis");
  sub->add_flag("--json", flags->json, "print the numbers as JSON");
  sub->callback([flags, &action] { action = [flags] { return plot_command(*flags); }; });
}

}  // namespace eg
