#pragma once
// What the tables of speed share: pinning, medians, and LAMMPS as a rival on the same work.
#include <fmt/format.h>
#include <omp.h>
#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "state/state.hpp"

namespace eg::bench {

/// Of several rounds.
struct Spread {
  std::vector<double> values;
  double at(double share) {
    std::sort(values.begin(), values.end());
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1) + 0.5)];
  }
  /// median (least–most)
  std::string text(int digits = 2) {
    return values.empty() ? std::string("-")
                          : fmt::format("{:.{}f} ({:.{}f}–{:.{}f})", at(0.5), digits, at(0), digits, at(1), digits);
  }
};

/// This process, and what it starts, on the first core only; or on all again.
inline void pin(bool one) {
  static const cpu_set_t all = [] {
    cpu_set_t s;
    sched_getaffinity(0, sizeof s, &s);
    return s;
  }();
  cpu_set_t set = all;
  if (one) {
    int first = 0;
    while (!CPU_ISSET(first, &all)) ++first;
    CPU_ZERO(&set);
    CPU_SET(first, &set);
  }
  sched_setaffinity(0, sizeof set, &set);
}

/// A folder with a LAMMPS job on the grains of `state`: `setup` follows read_data, "run N" is the caller's too.
class Lammps {
 public:
  Lammps(const State& state, double density, const std::string& boundary, const std::string& setup)
      : folder_(std::filesystem::temp_directory_path() / fmt::format("eigengrain_rival_{}", getpid())) {
    std::filesystem::create_directories(folder_);
    std::ofstream data(folder_ / "packing.data");
    data << "packing\n\n" << state.grains.size() << " atoms\n1 atom types\n\n";
    for (int k = 0; k < 3; ++k) data << fmt::format("0 {:.17g} {}lo {}hi\n", state.cell.h(k, k), "xyz"[k], "xyz"[k]);
    data << "\nAtoms # sphere\n\n";
    for (std::size_t i = 0; i < state.grains.size(); ++i) {
      Vec3 x = state.grains.position[i].vec();
      for (int k = 0; k < 3; ++k)
        if (state.cell.periodic[static_cast<std::size_t>(k)])
          x[k] -= state.cell.h(k, k) * std::floor(x[k] / state.cell.h(k, k));
      data << fmt::format("{} 1 {:.17g} {:.17g} {:.17g} {:.17g} {:.17g}\n", i + 1, 2 * state.grains.radius(i), density,
                          x.x, x.y, x.z);
    }
    std::ofstream(folder_ / "in.step") << "units si\natom_style sphere\nboundary " << boundary
                                       << "\nnewton off\ncomm_modify vel yes\nread_data " << folder_.string()
                                       << "/packing.data\nneigh_modify delay 0 every 1 check yes\nthermo 1000000\n"
                                       << setup;
  }
  ~Lammps() { std::filesystem::remove_all(folder_); }
  Lammps(const Lammps&) = delete;
  Lammps& operator=(const Lammps&) = delete;

  /// Time that LAMMPS reports for its last run [s]; negative when it does not run.
  double seconds() const {
    FILE* pipe =
        popen(("OMP_NUM_THREADS=1 lmp -in " + (folder_ / "in.step").string() + " -log none 2>/dev/null").c_str(), "r");
    if (!pipe) return -1;
    double seconds = -1;
    for (char line[512]; std::fgets(line, sizeof line, pipe);) std::sscanf(line, "Loop time of %lf", &seconds);
    pclose(pipe);
    return seconds;
  }

 private:
  std::filesystem::path folder_;
};

}  // namespace eg::bench
