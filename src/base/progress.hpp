#pragma once
// Progress of long work, on stderr so that results on stdout stay clean.
#include <chrono>
#include <concepts>
#include <cstdio>
#include <string>
#include <utility>

namespace eg {

/// "0.42 s", "12 s", "3 min 20 s", "2 h 05 min".
std::string duration_text(double seconds);

/// A bar with rate and time left on a terminal, a line now and then elsewhere (a log file), nothing when quiet.
/// Work shorter than half a second shows nothing at all. A call of update() costs one look at the clock (30 ns).
///
///   Progress progress("compress", steps, "steps");
///   for (...) progress.update(step, [&] { return fmt::format("p = {:.3g} Pa", pressure()); });
class Progress {
 public:
  enum class Style { quiet, lines, bar };

  /// `total` in `unit` ("": nothing worth counting, only the share is shown), 0 when it is not known beforehand: then
  /// count and rate are shown without bar and time left.
  Progress(std::string label, double total, std::string unit, Style style = style_of(stderr), std::FILE* out = stderr);
  ~Progress() { finish(); }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// `done` so far, in units. The note is asked for only when something is written.
  void update(double done) {
    update(done, [] { return std::string(); });
  }
  template <std::invocable Note>
  void update(double done, Note&& note) {
    update(done, total_ > 0 ? done / total_ : unknown, std::forward<Note>(note));
  }
  /// For work whose end is told by something else than its count: `share` of the whole [0, 1], `unknown` if it cannot
  /// be told. Rate and time left refer to what was done since the first call, so a resumed run may begin anywhere.
  template <std::invocable Note>
  void update(double done, double share, Note&& note) {
    if (!begun_) begun_ = true, first_done_ = total_ > 0 ? 0 : done, first_share_ = total_ > 0 ? 0 : share;
    done_ = done, share_ = share;
    if (due()) draw(note());
  }
  static constexpr double unknown = -1;
  /// Wipes the bar, so that something else can be printed on its line.
  void clear();
  /// Ends the bar with a last line of the time taken, if anything was shown. Further calls do nothing.
  void finish();

  /// bar for a terminal, else lines.
  static Style style_of(std::FILE* out);
  /// Seconds from the start to the first line, and between lines (which then grows, up to a minute, when not a bar).
  void every(double first, double interval);

 private:
  using Clock = std::chrono::steady_clock;

  double elapsed() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }
  bool due() const { return style_ != Style::quiet && elapsed() >= next_; }
  void draw(const std::string& note);
  std::string line(double seconds, const std::string& note) const;

  std::string label_, unit_;
  double total_, done_ = 0, share_ = unknown;
  double first_done_ = 0, first_share_ = 0;  ///< at the first update
  bool begun_ = false;
  Style style_;
  std::FILE* out_;
  Clock::time_point start_ = Clock::now();
  double next_, interval_;  ///< [s] since the start; between lines
  std::size_t shown_ = 0;   ///< characters of the bar on screen
  bool any_ = false;
};

}  // namespace eg
