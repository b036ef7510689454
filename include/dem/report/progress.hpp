#pragma once
// Live progress of a run: a bar on a terminal, plain lines in a log.

#include <dem/core/error.hpp>
#include <dem/io/duration.hpp>
#include <dem/io/text.hpp>
#include <dem/report/eta.hpp>
#include <dem/report/terminal.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstdio>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace dem::io {

/// How Progress shows itself; every field has a working default.
struct ProgressOptions {
  int stages = 1;                ///< stages that begin() will open; shown as "[1/2]" when there are several
  std::FILE* out = stderr;       ///< kept by the caller; stderr leaves stdout to the results; null: shown nowhere
  std::optional<bool> terminal;  ///< true: bar, false: plain lines; unset: asked of `out`
  int width = 0;                 ///< cells of the bar's line; 0: the terminal's width, asked at each drawing
  double redraw_s = 0.2;         ///< terminal: least time between two drawings [s]
  double line_percent = 10;      ///< log: a line each time so many percent more are done ...
  double line_s = 60;            ///< log: ... and at the latest after so many seconds [s]
  std::function<double()> clock = steady_seconds;  ///< time [s], never running backwards
};

/// Shows how far a run of one or several stages is, how long it will take, and a text of the caller's.
///
///     Progress progress({.stages = 2});
///     progress.begin("settle");                           // ends by a criterion: no percentage
///     progress.begin("shear", 4.0);                       // ends the stage before it
///     while (...) progress.update(t, [&] { return fmt::format("sigma {:.1f} kPa", sigma / 1e3); });
///     progress.finish();
///
/// update() costs one reading of the clock when nothing is due. A stream that cannot be written to any more (its
/// terminal was closed, its disk is full) is no error: nothing is shown. Not for several threads at once.
class Progress {
 public:
  /// Total of a stage whose end is not known beforehand.
  static constexpr double kUnknown = 0;

  explicit Progress(ProgressOptions options = {})
      : options_(std::move(options)), terminal_(options_.terminal.value_or(is_terminal(options_.out))) {}
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  /// Reports an open stage as stopped, so that an exception leaves the terminal in order.
  ~Progress() {
    try {
      stop();
    } catch (...) {  // a progress line is never worth a terminate()
    }
  }

  /// Opens the next stage and finishes the one before. `total` is the amount of work in any unit (steps, simulated
  /// seconds, metres), or kUnknown; `done` is what is done already. Throws dem::Error when `total` is negative or
  /// not finite.
  void begin(std::string_view name, double total = kUnknown, double done = 0) {
    if (!std::isfinite(total) || total < 0) {
      fail("progress stage '{}': total is {}; give a finite total > 0, or Progress::kUnknown", name, total);
    }
    if (open_) finish();
    open_ = true;
    stage_ += 1;
    name_ = one_line(name);
    total_ = total;
    done_ = done;
    status_.clear();
    status_width_ = 0;
    start_ = shown_time_ = options_.clock();
    shown_percent_ = percent();
    eta_ = EtaEstimator(start_, done);
    goes_on_ = false;
    show();
  }

  /// The stage that was begun goes on where an earlier run left it: what the next update() tells as done was done then.
  void go_on() { goes_on_ = true; }

  /// Tells how much of the stage's total is done, and what else to show (one line, e.g. the stress now).
  void update(double done, std::string_view status = {}) {
    update(done, [status] { return status; });
  }

  /// The same with a function that makes the text, called only when the text will be shown.
  template <std::invocable MakeStatus>
  void update(double done, MakeStatus&& make_status) {
    done_ = done;
    const double now = options_.clock();
    if (std::exchange(goes_on_, false)) eta_ = EtaEstimator(now, done);
    if (!open_ || !due(now)) return;
    status_ = one_line(make_status());
    status_width_ = std::max(status_width_, display_width(status_));
    eta_.sample(now, done);
    shown_time_ = now;
    shown_percent_ = percent();
    show();
  }

  /// Prints a line of its own above the bar. `text` is shown as it is.
  void message(std::string_view text) {
    if (open_ && terminal_) erase_bar();
    print(fmt::format("{}\n", text));
    if (open_ && terminal_) show();
  }

  /// Ends the open stage, if there is one, as reached.
  void finish(std::string_view status = {}) {
    end(fmt::format("done in {}", format_duration(options_.clock() - start_)), status);
  }

  /// Ends the open stage, if there is one, before its end (interrupted, failed).
  void stop(std::string_view status = {}) {
    const auto after = format_duration(options_.clock() - start_);
    end(total_ > 0 ? fmt::format("stopped at {:.0f} % after {}", percent(), after)
                   : fmt::format("stopped after {}", after),
        status);
  }

 private:
  [[nodiscard]] double percent() const { return total_ > 0 ? std::clamp(100 * done_ / total_, 0.0, 100.0) : 0.0; }

  [[nodiscard]] bool due(double now) const {
    if (terminal_) return now - shown_time_ >= options_.redraw_s;
    const double step = options_.line_percent;
    // Lines stand at multiples of the step; 100 % is left to the line of finish().
    const bool passed = percent() < 100 && std::floor(percent() / step) > std::floor(shown_percent_ / step);
    return passed || now - shown_time_ >= options_.line_s;
  }

  [[nodiscard]] std::string label() const {
    return options_.stages > 1 ? fmt::format("[{}/{}] {}", stage_, options_.stages, name_) : name_;
  }

  [[nodiscard]] std::string time_text() const {
    if (total_ <= 0) return format_duration(shown_time_ - start_);
    const auto left = eta_.left(total_);
    return left ? format_duration(*left) + " left" : "time left ?";
  }

  void show() {
    if (terminal_) {
      draw_bar();
    } else {
      print_line();
    }
  }

  void print(std::string_view text) const { show_text(options_.out, text); }

  void print_line() const {
    std::string line = label() + ": ";
    if (shown_time_ > start_) {
      if (total_ > 0) line += fmt::format("{:.0f} %, ", std::floor(percent()));
      line += time_text();
    } else {
      line += "started";
    }
    if (!status_.empty()) line += ", " + status_;
    print(line + "\n");
  }

  void draw_bar() {
    // The last cell stays free: writing into it makes some terminals wrap.
    const int width = (options_.width > 0 ? options_.width : terminal_width(options_.out)) - 1;
    std::string line = label();
    // Half of the room is left to the text behind the bar; a longer one takes more of it, and at the end all. The
    // widest text so far counts: with each text's own width the bar would jump.
    const int room = width - display_width(line) - 30;  // 30: brackets, spaces, "100 %" and "59 min 59 s left"
    const int beside_status = status_width_ > 0 ? room - status_width_ - 2 : room;
    const int cells = std::min(std::clamp(room / 2, 10, 30), beside_status);
    if (total_ > 0 && cells >= 10) {
      const int full = static_cast<int>(cells * percent() / 100);
      line += fmt::format("  [{:#<{}}{:.<{}}]", "", full, "", cells - full);
    }
    if (total_ > 0) line += fmt::format("  {:3.0f} %", std::floor(percent()));
    line += "  " + time_text();
    if (!status_.empty()) line += "  " + status_;
    line = clip(line, width);
    print("\r" + pad_right(line, bar_width_));
    bar_width_ = display_width(line);
  }

  void erase_bar() {
    print(fmt::format("\r{}\r", std::string(static_cast<std::size_t>(bar_width_), ' ')));
    bar_width_ = 0;
  }

  void end(const std::string& how, std::string_view status) {
    if (!std::exchange(open_, false)) return;
    if (terminal_) erase_bar();
    print(fmt::format("{}: {}{}{}\n", label(), how, status.empty() ? "" : ", ", one_line(status)));
  }

  ProgressOptions options_;
  bool terminal_;
  bool open_ = false, goes_on_ = false;
  int stage_ = 0;
  std::string name_, status_;
  double total_ = 0, done_ = 0;
  double start_ = 0, shown_time_ = 0, shown_percent_ = 0;
  EtaEstimator eta_;
  int status_width_ = 0;  // cells, of the stage's widest status
  int bar_width_ = 0;     // cells on the screen, to be overwritten by the next drawing
};

}  // namespace dem::io
