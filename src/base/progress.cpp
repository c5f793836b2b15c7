#include "base/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace eg {

namespace {

/// Three digits, without an exponent where they are whole.
std::string count_text(double x) { return x < 1000 ? fmt::format("{:.3g}", x) : fmt::format("{:.0f}", x); }

}  // namespace

std::string duration_text(double seconds) {
  if (seconds < 9.95) return fmt::format("{:.2g} s", seconds);
  const auto whole = std::llround(seconds);
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  const auto minutes = std::llround(seconds / 60);
  return fmt::format("{} h {:02} min", minutes / 60, minutes % 60);
}

Progress::Style Progress::style_of(std::FILE* out) { return isatty(fileno(out)) ? Style::bar : Style::lines; }

Progress::Progress(std::string label, double total, std::string unit, Style style, std::FILE* out)
    : label_(std::move(label)), unit_(std::move(unit)), total_(total), style_(style), out_(out) {
  if (style == Style::bar)
    every(0.5, 0.1);
  else
    every(5, 5);
}

void Progress::every(double first, double interval) { next_ = first, interval_ = interval; }

std::string Progress::line(double seconds, const std::string& note) const {
  const double rate = seconds > 0 ? (done_ - first_done_) / seconds : 0;
  std::string text = label_;
  if (share_ >= 0) {
    const double share = std::clamp(share_, 0.0, 1.0), gained = share - first_share_;
    if (style_ == Style::bar) {
      constexpr int width = 24;
      const auto filled = static_cast<int>(share * width);
      text += fmt::format(" [{:=<{}}{: <{}}]", "", filled, "", width - filled);
    }
    text += fmt::format(" {:3.0f} %", std::floor(100 * share));
    if (gained > 0) text += fmt::format("  {} left", duration_text(seconds * (1 - share) / gained));
  } else {
    text += fmt::format(" {:.0f} {}", done_, unit_);
  }
  if (!unit_.empty()) text += fmt::format("  {} {}/s", count_text(rate), unit_);
  if (!note.empty()) text += "  " + note;
  return text;
}

void Progress::draw(const std::string& note) {
  const double seconds = elapsed();
  const std::string text = line(seconds, note);
  if (style_ == Style::bar)
    fmt::print(out_, "\r{:<{}}", text, shown_);
  else
    fmt::print(out_, "{}\n", text);
  std::fflush(out_);
  shown_ = text.size();
  any_ = true;
  next_ = seconds + interval_;
  if (style_ == Style::lines) interval_ = std::min(2 * interval_, 60.0);
}

void Progress::clear() {
  if (style_ != Style::bar || shown_ == 0) return;
  fmt::print(out_, "\r{:<{}}\r", "", shown_);
  std::fflush(out_);
  shown_ = 0;
}

void Progress::finish() {
  if (any_) {
    const std::string what = unit_.empty() ? "done" : fmt::format("{:.0f} {}", done_, unit_);
    const std::string text = fmt::format("{}: {} in {}", label_, what, duration_text(elapsed()));
    fmt::print(out_, "{}{:<{}}\n", style_ == Style::bar ? "\r" : "", text, style_ == Style::bar ? shown_ : 0);
    std::fflush(out_);
  }
  any_ = false;
  style_ = Style::quiet;
}

}  // namespace eg
